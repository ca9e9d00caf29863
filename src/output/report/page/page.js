// Puts the page together and keeps slider, pictures and cursors in step.
const OURS = "var(--ours)", OURS_LIGHT = "var(--ours-light)", THEIRS = "var(--theirs)";
const times = column("t_ms"), travels = times.map(travel), turnTravel = model.unload_fraction > 0 ? model.stroke : undefined;
const stroke = column("stroke_mm");
const travelRange = [0, Math.max(travels[travels.length - 1] || 0, 1e-3)];
// Closed contact points by state 1, 2, 3. Forward is along the tool's outline: outwards on the die, inwards on the punch.
const STATES = [["stick", "var(--ink)"], ["slip forward", "var(--theirs)"], ["slip backward", "var(--third)"]];
let pressureChart = null;

function goTo(time) {
  let best = 0;
  states.times.forEach((t, i) => { if (Math.abs(t - time) < Math.abs(states.times[best] - time)) best = i; });
  setState(best);
}

function setState(s) {
  look.state = Math.min(Math.max(s, 0), states.count - 1);
  const slider = document.getElementById("state");
  slider.value = look.state;
  const t = states.times[look.state], row = times.findIndex(x => Math.abs(x - t) < 1e-6 * Math.max(t, 1));
  const force = row >= 0 ? column("force_N")[row] : 0;
  const going = t > model.time_load * (1 + 1e-9) ? "up" : "down";
  document.getElementById("readout").innerHTML = `stroke <b>${fixed(depth(t), 2)} mm</b>, going ${going} · <b>${row >= 0 || t === 0 ? `${fixed(force, 1)} N` : "–"}</b> · t ${fixed(t, 1)} ms`;
  slider.setAttribute("aria-valuetext", `stroke ${fixed(depth(t), 2)} mm`);
  drawSheet(); drawPressure();
  for (const chart of charts) {
    if (!chart.options.at) continue;
    chart.mark(chart.options.at(t, row));
  }
}

function drawPressure() {
  const up = { x: [], y: [] }, low = { x: [], y: [] }, friction = STATES.map(() => ({ x: [], y: [] }));
  contacts(look.state, (x, y, upper, pressure, traction, along, state) => {
    const s = upper ? up : low; s.x.push(along); s.y.push(upper ? pressure : -pressure);
    const f = friction[state - 1];
    if (model.friction > 0 && f) { f.x.push(along); f.y.push((upper ? 1 : -1) * Math.abs(traction)); }
  });
  const o = pressureChart.options;
  o.series = [
    { name: "punch side, shown upwards", color: "var(--punch-mark)", kind: "stems", width: 2, ...up },
    { name: "die side, shown downwards", color: "var(--die-mark)", kind: "stems", width: 2, ...low },
    ...STATES.map(([name, color], k) => ({ name: `friction traction, ${name}`, color, kind: "marks", radius: 2.4, ...friction[k] })),
  ];
  const most = Math.max(10, ...up.y, ...low.y.map(v => -v)), step = ticks(0, most, 3)[1] || 10, end = Math.ceil(most / step) * step;
  o.yRange = [low.x.length ? -end : 0, up.x.length || !low.x.length ? end : 0];
  pressureChart.draw(pressureChart.W);
}

function makeCharts() {
  const f = column("force_N"), turn = times.findIndex(t => t >= model.time_load * (1 - 1e-9)), cut = turn < 0 ? times.length : turn + 1;
  const part = (list, from, to) => list.slice(from, to);
  const reference = data.reference, tipForce = (s, i) => `${fixed(s.x[i], 2)} mm: ${fixed(s.y[i], 2)} N`;
  const atZero = list => [0, ...list];
  new Chart("force", {
    title: "Force of the punch against its stroke", xLabel: "stroke of the punch, mm", yLabel: "force on the whole sheet, N", height: 340, tip: tipForce,
    series: [
      { name: "loading", color: OURS, width: 2.4, x: atZero(part(stroke, 0, cut)), y: atZero(part(f, 0, cut)), time: atZero(part(times, 0, cut)) },
      ...(cut < times.length ? [{ name: "unloading", color: OURS_LIGHT, width: 2.4, x: stroke.slice(cut - 1), y: f.slice(cut - 1), time: times.slice(cut - 1) }] : []),
      ...(reference.curve.length ? [{ name: reference.name, color: THEIRS, width: 1.3, x: reference.curve.map(p => p[0]), y: reference.curve.map(p => p[1]) }] : []),
      ...(reference.points.length ? [{ name: "reference values with tolerance", color: THEIRS, kind: "marks", x: reference.points.map(p => p[0]), y: reference.points.map(p => p[1]), tolerance: reference.points.map(p => p[2]) }] : []),
    ],
    at: (t, row) => ({ x: depth(t), y: row >= 0 ? f[row] : t === 0 ? 0 : NaN }),
  });
  document.getElementById("force-caption").textContent = reference.curve.length
    ? "Beside it code_aster's curve of the same loading without friction: rigid contact at the nodes, hence its saw-tooth. The force near full stroke is steep and varies between solvers."
    : reference.points.length ? "Beside it the reference values of this case; their sources are in the table above." : "Nobody else's values are known for this case.";
  const energies = [["work of the punch", "external_work_mJ", "var(--ink)"], ["plastic", "plastic_dissipation_mJ", "var(--theirs)"], ["elastic", "strain_energy_mJ", OURS], ["friction", "friction_work_mJ", "var(--fourth)"], ["compliance of the contact", "compliance_energy_mJ", "var(--faint)"], ["kinetic", "kinetic_energy_mJ", "var(--third)"]];
  new Chart("energies", {
    title: "Energies against the travel of the punch", xLabel: "travel of the punch, mm", yLabel: "energy of the whole sheet, mJ", height: 340, turn: turnTravel, xRange: travelRange,
    series: energies.map(([name, key, color], k) => ({ name, color, width: k ? 1.8 : 2.4, dash: k ? "" : "6 3", x: travels, y: column(key), time: times })),
    tip: (s, i) => `${s.name}: ${show(s.y[i])} mJ at ${fixed(s.x[i], 2)} mm`,
    at: t => ({ x: travel(t) }),
  });
  makeBalanceCharts();
  const refused = column("refused_solves"), where = refused.map((n, i) => n > 0 ? i : -1).filter(i => i >= 0), pick = list => where.map(i => list[i]);
  const marks = list => ({ name: "after refused solves", color: "var(--punch-mark)", kind: "marks", radius: 3.4, x: pick(travels), y: pick(list), time: pick(times), of: pick(refused) });
  const tip = unit => (s, i) => `${fixed(s.x[i], 2)} mm: ${show(s.y[i])} ${unit}${s.of ? `, ${s.of[i]} refused before` : ""}`;
  const dt = column("dt_ms"), newton = column("newton_iterations");
  new Chart("steps", { title: "Step size", xLabel: "travel of the punch, mm", yLabel: "step, ms", log: true, height: 270, turn: turnTravel, xRange: travelRange, tip: tip("ms"),
    series: [{ name: "step", color: OURS, width: 1.8, x: travels, y: dt, time: times }, marks(dt)], at: (t, row) => ({ x: travel(t), y: row >= 0 ? dt[row] : NaN }) });
  const total = refused.reduce((a, b) => a + b, 0), open = summary.counts.refused_solves - total;
  document.getElementById("steps-caption").textContent = total + open === 0 ? "No solve was refused." : `Red: steps that were accepted after ${total} refused solves altogether.${open > 0 ? ` ${open} more solves were refused where the run ended.` : ""}`;
  new Chart("newton", { title: "Newton iterations", xLabel: "travel of the punch, mm", yLabel: "iterations of the step", height: 270, turn: turnTravel, xRange: travelRange, tip: tip("iterations"),
    series: [{ name: "iterations", color: OURS, kind: "stems", x: travels, y: newton, time: times }, marks(newton)], at: (t, row) => ({ x: travel(t), y: row >= 0 ? newton[row] : NaN }) });
  pressureChart = new Chart("pressure", { title: "Contact pressure along the sheet", xLabel: "place along the sheet from its middle, mm", yLabel: "pressure, MPa", height: 250, xRange: [0, model.half_length], series: [],
    tip: (s, i) => `${fixed(s.x[i], 3)} mm: ${fixed(Math.abs(s.y[i]), 1)} MPa`, yTick: v => show(Math.abs(v)) });
}

// How far the run is from statics, and how well the balance of energy is closed: shares, so on a logarithmic axis.
function makeBalanceCharts() {
  let most = 0;
  const largestForce = column("force_N").map(force => most = Math.max(most, Math.abs(force)));
  const share = (part, of) => part.map((value, i) => of[i] > 0 ? Math.abs(value) / of[i] : NaN);
  const work = column("external_work_mJ"), dissipated = column("integrator_dissipation_mJ");
  const chart = (id, title, series) => new Chart(id, {
    title, xLabel: "travel of the punch, mm", yLabel: "", yTick: v => show(v).replace(/^1 · /, ""), log: true, height: 270, turn: turnTravel, xRange: travelRange,
    series: series.map(([name, color, y]) => ({ name, color, width: 1.8, x: travels, y, time: times })),
    tip: (s, i) => `${s.name}: ${show(s.y[i], 2)} at ${fixed(s.x[i], 2)} mm`,
    at: t => ({ x: travel(t) }),
  });
  chart("quasi-static", "Shares of kinetic energy and inertia against the travel of the punch", [
    ["kinetic energy, of the elastic energy", "var(--third)", share(column("kinetic_energy_mJ"), column("strain_energy_mJ"))],
    ["inertia force, of the largest punch force so far", OURS, share(column("inertia_N"), largestForce)],
  ]);
  chart("balance", "Errors of the balance of energy against the travel of the punch", [
    ["work without a taker", "var(--fourth)", column("work_error").map(Math.abs)],
    ["dissipated by the time integration, of the work", "var(--third)", share(dissipated, work)],
    ["work less energies: the step's length", THEIRS, column("energy_error").map(Math.abs)],
  ]);
}

function play() {
  const button = document.getElementById("play");
  let timer = null;
  const stop = () => { clearInterval(timer); timer = null; button.textContent = "Play"; document.getElementById("readout").setAttribute("aria-live", "polite"); };
  button.addEventListener("click", () => {
    if (timer) return stop();
    if (look.state === states.count - 1) setState(0);
    button.textContent = "Pause";
    document.getElementById("readout").setAttribute("aria-live", "off");
    timer = setInterval(() => { setState(look.state + 1); if (look.state === states.count - 1) stop(); }, Math.max(30, Math.min(400, 9000 / states.count)));
  });
  return stop;
}

function redraw(width) { charts.forEach(chart => chart.draw(width)); setState(look.state); }

header(); failure(); tiles(); verdictTable(); certificateTable(); angleTable(); provenanceTables(); makeCharts();
document.getElementById("thinned").textContent = states.count < states.saved
  ? `${states.count} of the ${states.saved} saved states are in this page, evenly chosen; positions and values are rounded to 1/65535 of their range.`
  : `All ${states.saved} saved states are in this page; positions and values are rounded to 1/65535 of their range.`;
for (const width of [3, 6, 12].map(k => k * model.thickness)) {
  const chosen = width === look.zoom ? { selected: "" } : {};
  document.getElementById("zoom").append(element("option", { value: width, text: `${show(width)} mm`, ...chosen }));
}
const slider = document.getElementById("state"), stopPlaying = play();
slider.max = states.count - 1;
slider.addEventListener("input", () => { stopPlaying(); setState(Number(slider.value)); });
document.getElementById("field").addEventListener("change", event => { look.field = event.target.value; setState(look.state); });
document.getElementById("focus").addEventListener("change", event => { look.focus = event.target.value; look.at = null; setState(look.state); });
document.getElementById("zoom").addEventListener("change", event => { look.zoom = Number(event.target.value); setState(look.state); });
document.getElementById("whole").addEventListener("click", event => {
  const box = event.target.getBoundingClientRect(), [mx, my, mm] = wholeView.box;
  look.at = [mx + (event.clientX - box.left - box.width / 2) * mm, my - (event.clientY - box.top - box.height / 2) * mm];
  document.querySelectorAll("input[name=focus]").forEach(input => { input.checked = false; });
  setState(look.state);
});
// At first the deepest state: full stroke, or where the run ended.
look.state = states.times.reduce((best, t, i) => depth(t) > depth(states.times[best]) + 1e-9 ? i : best, 0);
redraw();
let waiting = 0;
window.addEventListener("resize", () => { cancelAnimationFrame(waiting); waiting = requestAnimationFrame(() => redraw()); });
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw());
window.addEventListener("beforeprint", () => { document.documentElement.classList.add("printing"); charts.forEach(chart => chart.draw(chart.box.id === "pressure" ? 700 : 340)); drawSheet(true); });
window.addEventListener("afterprint", () => { document.documentElement.classList.remove("printing"); redraw(); });
