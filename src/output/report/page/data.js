// Data of the page: unpacked once, then only read. Units are mm, N, MPa, ms.
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
      strain: { values: new Uint16Array(bytes(s.strain)), top: s.strain_max, scale: Math.max(s.strain_max, 1e-4), name: "equivalent plastic strain", unit: "" },
      stress: { values: new Uint16Array(bytes(s.stress)), top: s.stress_max, scale: Math.max(s.stress_max, 1), name: "von Mises stress", unit: "MPa" },
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
