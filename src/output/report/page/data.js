// Data of the page: unpacked once, then only read. Units are mm, N, MPa, ms.
const data = JSON.parse(document.getElementById("data").textContent);
const history_ = data.history, model = data.model, summary = data.summary;
const column = name => history_[name] || [];

function bytes(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

const states = (() => {
  const s = data.states, c = s.contact;
  const starts = [0];
  c.counts.forEach(n => starts.push(starts[starts.length - 1] + n));
  return {
    count: s.times.length, saved: s.saved, times: s.times, nodes: s.nodes, corners: s.corners, span: s.span,
    elements: new Uint32Array(bytes(s.elements)),
    positions: new Uint16Array(bytes(s.positions)),
    fields: {
      strain: { values: new Uint16Array(bytes(s.strain)), top: s.strain_max, name: "equivalent plastic strain", unit: "" },
      stress: { values: new Uint16Array(bytes(s.stress)), top: s.stress_max, name: "von Mises stress", unit: "MPa" },
    },
    contact: { along: c.along, upper: c.upper, starts, points: new Uint32Array(bytes(c.points)), values: new Float32Array(bytes(c.values)), status: c.status },
  };
})();

// How far the punch is down at time t, and how far it has travelled, down and back.
function depth(t) {
  const back = Math.min(Math.max((t - model.time_load) / model.time_unload, 0), 1);
  return model.stroke * (Math.min(Math.max(t / model.time_load, 0), 1) - model.unload_fraction * back);
}
function travel(t) { return t <= model.time_load ? depth(t) : 2 * model.stroke - depth(t); }

// Position of node n in state s, mm.
function place(s, n) {
  const i = 2 * (s * states.nodes + n), [x0, x1, y0, y1] = states.span;
  return [x0 + (x1 - x0) * states.positions[i] / 65535, y0 + (y1 - y0) * states.positions[i + 1] / 65535];
}

// A number with `digits` significant digits, without trailing zeros; powers of ten where it is very small or large.
function show(value, digits = 4) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e7) {
    const [m, e] = value.toExponential(Math.min(digits - 1, 2)).split("e");
    return `${String(Number(m)).replace("-", "−")} · 10${[...String(Number(e))].map(c => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻").join("")}`;
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}
// The same with all zeros, for what changes while one looks.
const fixed = (value, decimals) => isFinite(value) && value !== null ? value.toFixed(decimals).replace("-", "−") : "–";

function ticks(low, high, wanted) {
  const raw = (high - low) / Math.max(wanted, 1), power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= raw * 0.999);
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) list.push(Number((k * step).toPrecision(12)));
  return list;
}

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) key === "text" ? made.textContent = value : made.setAttribute(key, value);
  made.append(...children);
  return made;
}
