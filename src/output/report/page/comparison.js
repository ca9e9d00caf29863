// Two runs side by side: A and B, each with its summary and the columns of its history.
const NAMES = ["A", "B"], COLORS = ["var(--ours)", "var(--theirs)"];
const runs = data.map((run, k) => {
  const options = run.summary.provenance.options, number = name => Number(options[name]);
  const motion = { stroke: number("stroke"), down: number("time_load") };
  const column = name => run.history[name] || [];
  const times = column("t_ms"), stroke = column("stroke_mm");
  const turn = times.findIndex(t => t >= motion.down * (1 - 1e-9)), cut = turn < 0 ? times.length : turn + 1;
  return { ...run, name: NAMES[k], color: COLORS[k], options, column, times, stroke, cut, travel: stroke.map((d, i) => times[i] <= motion.down ? d : 2 * motion.stroke - d) };
});
const goTo = () => {};
const pair = f => runs.map(f);
const difference = ([a, b]) => Number.isFinite(a) && Number.isFinite(b) ? show(b - a) : "";

function heads() {
  for (const run of runs) {
    const { summary } = run, failing = summary.verdicts.filter(v => v.verdict !== "holds").length, done = summary.status === "finished";
    const kind = summary.status === "not converged" ? "bad" : done && !failing ? "good" : "warn";
    const words = done ? failing ? `finished, ${failing} of ${summary.verdicts.length} verdicts fail` : "finished, every verdict holds" : summary.status === "interrupted" ? "interrupted: it can go on" : "did not finish";
    document.getElementById("runs").append(element("div", { class: "run", style: `border-top-color:${run.color}` },
      element("h2", { text: run.name }), element("p", { class: "mono", text: run.folder }), element("p", { class: `status ${kind}`, text: words }),
      ...(summary.reason ? [element("p", { class: "small", text: summary.reason })] : [])));
  }
}

const three = first => [{ name: first }, { name: "A", number: true }, { name: "B", number: true }];

function optionTable() {
  const names = [...new Set(runs.flatMap(run => Object.keys(run.options)))].sort(), code = text => element("code", { text });
  const rows = names.filter(n => n !== "output_dir" && runs[0].options[n] !== runs[1].options[n]).map(n => ({ cells: [code(`-${n}`), ...pair(run => run.options[n] ?? "not used")] }));
  table("option-table", [{ name: "Option" }, { name: "A", class: "name" }, { name: "B", class: "name" }], rows);
}

function numberTable() {
  const rows = [], add = (name, values, digits = 4) => rows.push({ cells: [name, ...values.map(v => typeof v === "string" ? v : show(v, digits)), difference(values)] });
  const last = name => pair(run => run.column(name)[run.times.length - 1]);
  add("Steps", pair(run => run.summary.counts.steps), 6);
  add("Solves refused", pair(run => run.summary.counts.refused_solves), 6);
  add("Newton iterations", pair(run => run.summary.counts.newton_iterations), 7);
  add("Processor time, s", pair(run => run.summary.timing.cpu_s), 3);
  add("Greatest force, N", pair(run => run.column("force_N").reduce((a, b) => Math.max(a, b), 0)), 5);
  add("Force at full stroke, N", pair(run => run.cut <= run.times.length && run.times.length && run.cut > 0 && run.times[run.cut - 1] >= Number(run.options.time_load) * (1 - 1e-9) ? run.column("force_N")[run.cut - 1] : undefined), 5);
  const angles = [...new Set(runs.flatMap(run => Object.keys(run.summary.angles_deg)))];
  for (const name of angles) add(`Angle, ${name}, degrees`, pair(run => run.summary.angles_deg[name]), 5);
  add("Work of the punch at the end, mJ", last("external_work_mJ"), 5);
  add("Deepest penetration, mm", pair(run => run.column("max_penetration_mm").reduce((a, b) => Math.max(a, b), 0)));
  table("number-table", [...three("Quantity"), { name: "B less A", number: true }], rows);
}

function charts_() {
  const of = (run, x, y, from, to) => ({ x: x.slice(from, to), y: y.slice(from, to) });
  const parts = run => {
    const f = run.column("force_N"), down = { name: run.name, color: run.color, width: 2.2, x: [0, ...run.stroke.slice(0, run.cut)], y: [0, ...f.slice(0, run.cut)] };
    return run.cut < run.times.length ? [down, { color: run.color, width: 2.2, dash: "5 4", ...of(run, run.stroke, f, run.cut - 1) }] : [down];
  };
  new Chart("force", { title: "Force of the punch of both runs against its stroke", xLabel: "stroke of the punch, mm", yLabel: "force on the whole sheet, N", height: 340, series: runs.flatMap(parts), tip: (s, i) => `${fixed(s.x[i], 2)} mm: ${fixed(s.y[i], 2)} N` });

  // B's force between its steps, at the strokes of A, on the way down.
  const [a, b] = runs, fa = a.column("force_N"), fb = b.column("force_N"), xs = [], ys = [];
  for (let i = 0, j = 0; i < a.cut; i++) {
    while (j < b.cut - 1 && b.stroke[j] < a.stroke[i] - 1e-9) j++;
    if (j >= b.cut || b.stroke[j] < a.stroke[i] - 1e-9) break;
    const exact = Math.abs(b.stroke[j] - a.stroke[i]) < 1e-9, x0 = j ? b.stroke[j - 1] : 0, f0 = j ? fb[j - 1] : 0;
    xs.push(a.stroke[i]); ys.push((exact ? fb[j] : f0 + (fb[j] - f0) * (a.stroke[i] - x0) / (b.stroke[j] - x0)) - fa[i]);
  }
  new Chart("difference", { title: "Force of B less that of A against the stroke, going down", xLabel: "stroke of the punch, mm", yLabel: "difference of the forces, N", height: 340,
    series: [{ name: "B less A", color: "var(--ink)", width: 1.8, x: xs, y: ys }], tip: (s, i) => `${fixed(s.x[i], 2)} mm: ${show(s.y[i])} N` });
  const most = ys.reduce((m, y) => Math.max(m, Math.abs(y)), 0);
  document.getElementById("difference-caption").textContent = xs.length ? `On the way down, at the steps of A; between its own steps B counts as straight. At most ${show(most, 3)} N.` : "The runs have no stroke in common.";
  const travelled = [0, Math.max(...runs.map(run => run.travel[run.travel.length - 1] || 0), 1e-3)];
  new Chart("steps", { title: "Step size of both runs against the travel of the punch", xLabel: "travel of the punch, mm", yLabel: "step, ms", log: true, height: 270, xRange: travelled,
    series: runs.map(run => ({ name: run.name, color: run.color, width: 1.6, x: run.travel, y: run.column("dt_ms") })), tip: (s, i) => `${s.name}, ${fixed(s.x[i], 2)} mm: ${show(s.y[i])} ms` });
  new Chart("newton", { title: "Newton iterations of both runs, summed up, against the travel of the punch", xLabel: "travel of the punch, mm", yLabel: "iterations so far", height: 270, xRange: travelled,
    series: runs.map(run => { let sum = 0; return { name: run.name, color: run.color, width: 2, x: run.travel, y: run.column("newton_iterations").map(n => sum += n) }; }), tip: (s, i) => `${s.name}, ${fixed(s.x[i], 2)} mm: ${show(s.y[i], 6)}` });
}

function verdictTable() {
  const key = v => `${v.quantity} (${v.comparison}: ${v.source}, ${v.reference})`, rows = new Map();
  runs.forEach((run, k) => run.summary.verdicts.forEach(v => { const row = rows.get(key(v)) || { v, both: [null, null] }; row.both[k] = v; rows.set(key(v), row); }));
  table("verdict-table", [{ name: "Compared with" }, { name: "Quantity" }, { name: "A", number: true }, { name: "" }, { name: "B", number: true }, { name: "" }, { name: "Value", number: true }, { name: "Tolerance", number: true }, { name: "Unit" }],
    [...rows.values()].map(({ v, both }) => ({
      failing: both.some(w => w && w.verdict !== "holds"),
      cells: [v.comparison, v.quantity, ...both.flatMap(w => w ? [show(w.computed, 6), mark(w.verdict === "holds")] : ["–", ""]), show(v.reference, 6), tolerance(v.tolerance, v.unit), v.unit === "1" ? "" : v.unit],
    })));
}

function provenanceTable() {
  const of = f => pair(run => f(run.summary.provenance));
  const rows = [["Revision", ...of(p => `${p.version}, ${p.git_revision}`)], ["PETSc", ...of(p => p.petsc_version)], ["Direct solver", ...of(p => p.build.direct_solver || "–")], ["MPI ranks", ...of(p => String(p.mpi_ranks))], ["Unknowns", ...of(p => p.build.unknowns)], ["BLAS", ...of(p => p.build.blas || "–")]];
  table("provenance-table", [{ name: "" , class: "what" }, { name: "A", class: "name" }, { name: "B", class: "name" }], rows.map(cells => ({ cells })));
}

heads(); optionTable(); numberTable(); charts_(); verdictTable(); provenanceTable();
const redraw = width => charts.forEach(chart => chart.draw(width));
redraw();
let waiting = 0;
window.addEventListener("resize", () => { cancelAnimationFrame(waiting); waiting = requestAnimationFrame(() => redraw()); });
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw());
window.addEventListener("beforeprint", () => { document.documentElement.classList.add("printing"); redraw(340); });
window.addEventListener("afterprint", () => { document.documentElement.classList.remove("printing"); redraw(); });
