// The tables of the page.
function verdictTable() {
  const heads = [{ name: "Compared with" }, { name: "Quantity" }, { name: "Computed", number: true }, { name: "Value", number: true }, { name: "Tolerance", number: true }, { name: "Unit" }, { name: "Source of the value", class: "source" }, { name: "" }];
  table("verdict-table", heads, summary.verdicts.map(v => {
    const good = v.verdict === "holds";
    return { failing: !good, cells: [v.comparison, v.quantity, show(v.computed, 6), show(v.reference, 6), tolerance(v.tolerance, v.unit), v.unit === "1" ? "" : v.unit, v.source, mark(good)] };
  }));
}

const CERTIFICATES = {
  max_penetration_mm: ["Deepest penetration, also between the contact points", "mm", "penetration_mm"],
  min_contact_force_N: ["Smallest contact force of a point (negative: tensile)", "N", null],
  max_complementarity_mJ: ["Complementarity: force times open gap of a point", "mJ", null],
  cone_violation: ["Friction beyond its cone, of the largest", "", "cone"],
  balance_error: ["Punch force less die force and inertia, of the larger", "", "balance"],
  work_error: ["Work of the punch less internal, contact and inertia work", "", "work"],
  energy_error: ["Work of the punch less the energies, of the larger", "", null],
  residual_norm_mm: ["Residual where Newton stopped", "mm", "residual_mm"],
};

function certificateTable() {
  const heads = [{ name: "Certificate" }, { name: "Worst", number: true }, { name: "Limit", number: true }, { name: "Unit" }, { name: "Step", number: true }, { name: "Stroke, mm", number: true }, { name: "At the end", number: true }];
  const rows = [];
  for (const [name, [words, unit, limit]] of Object.entries(CERTIFICATES)) {
    const worst = summary.worst.find(w => w.certificate === name);
    if (!worst || (name === "cone_violation" && model.friction === 0)) continue;
    const bound = limit === null ? null : summary.tolerances[limit];
    const text = name === "min_contact_force_N" ? `−${show(summary.tolerances.tensile_force)} of the force` : bound === null || bound === undefined ? "none" : show(bound);
    const failing = bound !== null && bound !== undefined && !(Math.abs(worst.value) <= bound * (1 + 1e-9));
    rows.push({ failing, cells: [words, show(worst.value, 3), text, unit, worst.step, fixed(depth(worst.t_ms), 2), show(column(name)[column(name).length - 1], 3)] });
  }
  table("certificate-table", heads, rows);
}

function angleTable() {
  // As they follow in time: full stroke, its release, the end of the motion, its release.
  const turn = depth(model.time_load), order = name => {
    const depthOf = Number((name.match(/^tools vanish at (.*) mm$/) || [])[1]);
    return name === "full stroke" ? 0 : name === "end of the motion" ? 2 : Math.abs(depthOf - turn) < 1e-3 ? 1 : 3;
  };
  const fits = summary.angle_fit_residuals_mm;
  table("angle-table", [{ name: "When" }, { name: "Angle, degrees", number: true }, { name: "Fit, mm", number: true }],
    Object.entries(summary.angles_deg).sort(([a], [b]) => order(a) - order(b)).map(([name, angle]) => ({ cells: [name, fixed(angle, 2), show(fits[name], 2)] })));
}

function provenanceTables() {
  const p = summary.provenance, given = Object.entries(p.options).filter(([name, value]) => data.defaults[name] !== value && name !== "output_dir");
  const code = text => element("code", { text });
  const rows = [
    ["Program", `ssnp155 ${p.version}, revision ${p.git_revision}`],
    ["PETSc", `${p.petsc_version} (headers ${p.build.petsc_headers || "unknown"}), direct solver ${p.build.direct_solver || "unknown"}`],
    ["MPI ranks", p.mpi_ranks],
    ["Unknowns", p.build.unknowns],
    ["Mesh", `${model.elements[0]} × ${model.elements[1]} quadratic elements on the half sheet`],
    ["Options that differ from the reference case", given.length ? code(given.map(([n, v]) => `-${n} ${v}`).join("  ")) : "none: this is the reference case"],
    ["Time", `${show(summary.timing.cpu_s, 3)} s of processors, ${show(summary.timing.wall_s, 3)} s on the clock`],
    ...Object.entries(p.inputs || {}).map(([name, sum]) => [`SHA-256 of ${name}`, code(sum)]),
  ];
  table("provenance-table", [{ name: "", class: "what" }, { name: "", class: "name" }], rows.map(cells => ({ cells })));
  table("option-table", [{ name: "Option" }, { name: "Value" }, { name: "Reference case", class: "source" }],
    Object.entries(p.options).map(([name, value]) => ({ cells: [code(`-${name}`), value, data.defaults[name] === value ? "" : data.defaults[name] ?? ""] })));
}

function header() {
  const failing = summary.verdicts.filter(v => v.verdict !== "holds").length, done = summary.status === "finished";
  const compared = summary.verdicts.some(v => v.source !== "certificate of every step");
  // Other tools are another problem, whatever the rest is.
  const files = ["punch_profile", "die_profile"].map(name => summary.provenance.options[name]).filter(path => path && path !== "benchmark");
  document.getElementById("title").textContent = files.length
    ? `Sheet between tools from ${files.map(path => path.split("/").pop()).join(" and ")}` : "NAFEMS contact benchmark 3 · SSNP155";
  const differs = Object.entries(summary.provenance.options).filter(([n, v]) => data.defaults[n] !== v);
  document.getElementById("subtitle").textContent = `${model.friction > 0 ? `With friction, coefficient ${show(model.friction)}` : "Without friction"}; stroke ${show(model.stroke)} mm, `
    + `${model.unload_fraction > 0 ? `${show(100 * model.unload_fraction)} % of it back` : "not taken back"}; ${model.elements[0]} × ${model.elements[1]} quadratic elements`
    + `${compared || !done ? "" : `. There are no reference values for this case${differs.length ? "" : ""}: only the certificate is judged`}.`;
  const status = document.getElementById("status");
  const kind = summary.status === "not converged" ? "bad" : done && !failing ? "good" : "warn", text = data.headline;
  status.className = `status ${kind}`; status.textContent = text;
  document.title = `ssnp155: ${text.toLowerCase()}`;
}

function failure() {
  const box = document.getElementById("failure"), d = summary.diagnosis;
  const list = (items, kind = "ul") => { const made = element(kind); items.forEach(text => made.append(element("li", {}, sentence(text)))); return made; };
  if (summary.status !== "finished") {
    const paused = summary.status === "interrupted";
    box.hidden = false;
    if (paused) box.className = "paused";
    box.append(element("h2", { text: paused ? "The run was asked to end, and can go on" : "The run did not finish" }));
    if (d) {
      const dl = element("dl", { style: "margin:0" }), add = (name, ...what) => dl.append(element("dt", { text: name }), element("dd", {}, ...what));
      add("Where", d.place); add("Why", sentence(d.cause));
      if (d.observed.length) add("What was seen", list(d.observed));
      if (d.tried.length) add("What was tried", list(d.tried));
      if (d.remedies.length) add("What you can do", list(d.remedies, "ol"));
      box.append(dl);
    } else box.append(element("p", {}, sentence(summary.reason || "No reason is known.")));
    if (paused) box.append(element("p", {}, sentence("It goes on with the same options and -restart.")));
    box.append(element("p", { class: "small", text: "Everything below is valid up to the last accepted step." }));
  }
  if (summary.notes && summary.notes.length) {
    const notes = document.getElementById("notes");
    notes.hidden = false;
    summary.notes.forEach(text => notes.append(element("p", { text })));
  }
}

function tiles() {
  const force = column("force_N"), time = column("t_ms"), angles = summary.angles_deg, box = document.getElementById("tiles");
  const add = (value, text) => box.append(element("div", { class: "tile" }, element("b", { text: value }), element("span", { text })));
  const turn = time.findIndex(t => Math.abs(t - model.time_load) < 1e-6), last = time.length - 1;
  if (turn >= 0) add(`${fixed(force[turn], 1)} N`, "punch force at full stroke");
  else if (last >= 0) add(`${fixed(force[last], 1)} N`, `punch force at ${fixed(column("stroke_mm")[last], 2)} mm`);
  if (angles["full stroke"] !== undefined) add(`${fixed(angles["full stroke"], 2)}°`, "angle at full stroke");
  const free = Object.entries(angles).filter(([n]) => n.startsWith("tools vanish"));
  if (free.length) add(`${fixed(free[0][1], 2)}°`, `angle, ${free[0][0]}`);
  const strain = data.states.strain_max;
  add(`${show(strain < 1e-8 ? 0 : 100 * strain, 3)} %`, "largest plastic strain shown");
  add(summary.counts.steps, `steps, ${summary.counts.refused_solves} solves refused`);
  add(summary.counts.newton_iterations, "Newton iterations");
  add(`${show(summary.timing.wall_s, 3)} s`, `on ${summary.provenance.mpi_ranks} rank${summary.provenance.mpi_ranks > 1 ? "s" : ""}`);
}
