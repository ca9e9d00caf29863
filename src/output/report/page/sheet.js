// The deformed sheet between its tools, on two canvases with equal axes: all of it, and a close-up.
const COLORS = (() => {
  // viridis (van der Walt and Smith 2015, CC0) at nine places, as in the figures beside this page.
  const map = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121], [110, 206, 88], [253, 231, 37]];
  return Array.from({ length: 256 }, (_, k) => {
    const at = k / 255 * 8, i = Math.min(Math.floor(at), 7), f = at - i;
    return `rgb(${map[i].map((c, j) => Math.round(c + f * (map[i + 1][j] - c))).join(",")})`;
  });
})();
// Lengths of the pictures follow from the sheet: how far tools go on beyond it, and what is left free around it.
const FAR = 10 * model.half_length, MARGIN = model.half_length / 20;
// A colour of the style sheet, which a canvas does not know by its name.
const tone = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// Both tools from left to right; their last lines go straight on.
const outlines = (() => {
  const onward = line => {
    const [[x0, y0], [x1, y1]] = line.slice(-2), far = FAR / Math.hypot(x1 - x0, y1 - y0);
    return [...line, [x1 + far * (x1 - x0), y1 + far * (y1 - y0)]];
  };
  const whole = line => [...line.slice().reverse().map(([x, y]) => [-x, y]), ...line];
  return { die: whole(onward(model.die)), punch: whole(onward(model.punch)) };
})();
// How deep the die is to be shown, and from where on it holds the sheet.
const dieDepth = Math.min(Math.max(...model.die.map(point => -point[1])), model.half_length);
const dieEdge = (model.die.find(point => point[1] > -1e-6) || [model.half_length])[0];

// Edges of one element only: the outline of the sheet, without the plane of symmetry.
const outline = (() => {
  const seen = new Map(), c = states.corners;
  for (let e = 0; e < states.elements.length; e += c) for (let k = 0; k < 4; k++) {
    const a = states.elements[e + k], b = states.elements[e + (k + 1) % 4];
    const key = Math.min(a, b) * 1e7 + Math.max(a, b);
    if (seen.has(key)) seen.delete(key); else seen.set(key, [a, b, c === 8 ? states.elements[e + 4 + k] : -1]);
  }
  return [...seen.values()].filter(([a, b]) => place(0, a)[0] > 1e-3 || place(0, b)[0] > 1e-3);
})();

const look = { state: 0, field: "strain", focus: "strain", zoom: 6 * model.thickness, at: null };

function valueAt(s, n) { const f = states.fields[look.field]; return f.top * f.values[s * states.nodes + n] / 65535; }

function prepare(canvas, height, forced) {
  const width = forced || canvas.clientWidth || 700, ratio = Math.max(window.devicePixelRatio || 1, 1.5);
  canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
  canvas.style.height = `${height}px`;
  const c = canvas.getContext("2d");
  c.setTransform(ratio, 0, 0, ratio, 0, 0); c.clearRect(0, 0, width, height);
  return { c, width, height };
}

// box: [x, y, mm per pixel] of the middle of the canvas.
function scene(view, box, near) {
  const { c, width, height } = view, [mx, my, mm] = box, s = look.state, k = 1 / mm;
  const X = x => width / 2 + (x - mx) * k, Y = y => height / 2 - (y - my) * k;
  const down = depth(states.times[s]);
  c.lineJoin = "round";
  const ink = tone("ink"), toolLine = tone("faint"), mesh = tone("mesh"), punchMark = tone("punch-mark"), dieMark = tone("die-mark"), halo = tone("page");
  const tool = (line, shift, level, fill) => {
    c.beginPath();
    line.forEach(([x, y], i) => i ? c.lineTo(X(x), Y(y - shift)) : c.moveTo(X(x), Y(y - shift)));
    c.lineTo(X(line[line.length - 1][0]), Y(level)); c.lineTo(X(line[0][0]), Y(level)); c.closePath();
    c.fillStyle = fill; c.fill(); c.strokeStyle = toolLine; c.lineWidth = 1.1; c.stroke();
  };
  tool(outlines.die, 0, -FAR, tone("die")); tool(outlines.punch, down, 2 * FAR, tone("punch"));
  c.strokeStyle = tone("axis"); c.setLineDash([6, 4]); c.lineWidth = 1; c.beginPath(); c.moveTo(X(0), 0); c.lineTo(X(0), height); c.stroke(); c.setLineDash([]);
  const top = states.fields[look.field].scale, n = states.corners, list = states.elements;
  const size = k * model.half_length / model.elements[0], edges = size > 9, pieces = edges ? Math.min(6, Math.max(1, Math.round(size / 10))) : 1;
  for (const side of [1, -1]) for (let e = 0; e < list.length; e += n) {
    const corner = []; let value = 0, out = true;
    for (let a = 0; a < n; a++) {
      const [x, y] = place(s, list[e + a]), p = [X(side * x), Y(y)];
      if (p[0] > -60 && p[0] < width + 60 && p[1] > -60 && p[1] < height + 60) out = false;
      corner.push(p);
    }
    if (out) continue;
    const v = [0, 1, 2, 3].map(a => valueAt(s, list[e + a]) / top);
    const at = (i, j, f) => { const a = i / pieces, b = j / pieces; return (1 - a) * (1 - b) * f(0) + a * (1 - b) * f(1) + a * b * f(2) + (1 - a) * b * f(3); };
    // An element with mid-sides: bilinear between its corners, plus what the mid-sides add (serendipity).
    const bulge = n === 8 ? [4, 5, 6, 7].map((m, q) => [0, 1].map(d => corner[m][d] - 0.5 * (corner[q][d] + corner[(q + 1) % 4][d]))) : null;
    const point = (i, j) => [0, 1].map(d => {
      let value = at(i, j, a => corner[a][d]);
      if (bulge) { const a = i / pieces, b = j / pieces; value += 4 * a * (1 - a) * ((1 - b) * bulge[0][d] + b * bulge[2][d]) + 4 * b * (1 - b) * (a * bulge[1][d] + (1 - a) * bulge[3][d]); }
      return value;
    });
    for (let i = 0; i < pieces; i++) for (let j = 0; j < pieces; j++) {
      const mean = at(i + 0.5, j + 0.5, a => v[a]);
      c.fillStyle = c.strokeStyle = COLORS[Math.round(255 * Math.min(Math.max(mean, 0), 1))]; c.lineWidth = 0.7;
      c.beginPath();
      [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].forEach(([a, b], q) => { const p = point(a, b); q ? c.lineTo(...p) : c.moveTo(...p); });
      c.closePath(); c.fill(); c.stroke();
    }
    if (edges) { c.strokeStyle = mesh; c.lineWidth = 0.7; c.beginPath(); path(c, corner, n); c.stroke(); }
  }
  c.strokeStyle = ink; c.lineWidth = near ? 1.2 : 0.8; c.beginPath();
  for (const side of [1, -1]) for (const [a, b, m] of outline) {
    const p = place(s, a), q = place(s, b);
    c.moveTo(X(side * p[0]), Y(p[1]));
    if (m >= 0) { const r = place(s, m); c.quadraticCurveTo(X(side * (2 * r[0] - 0.5 * (p[0] + q[0]))), Y(2 * r[1] - 0.5 * (p[1] + q[1])), X(side * q[0]), Y(q[1])); } else c.lineTo(X(side * q[0]), Y(q[1]));
  }
  c.stroke();
  contacts(s, (x, y, upper) => {
    c.fillStyle = upper ? punchMark : dieMark; c.strokeStyle = halo; c.lineWidth = 1;
    for (const side of near ? [1, -1] : [1]) { c.beginPath(); c.arc(X(side * x), Y(y), near ? 3.6 : 2.2, 0, 7); c.fill(); if (near) c.stroke(); }
  });
  return { X, Y, k };
}

function path(c, corner, n) {
  c.moveTo(...corner[0]);
  for (let q = 0; q < 4; q++) {
    const a = corner[q], b = corner[(q + 1) % 4];
    if (n === 8) { const m = corner[4 + q]; c.quadraticCurveTo(2 * m[0] - 0.5 * (a[0] + b[0]), 2 * m[1] - 0.5 * (a[1] + b[1]), ...b); } else c.lineTo(...b);
  }
}

// Calls f(x, y, upper, pressure, friction, along, state of contact) for each contact point that carries a force in state s.
function contacts(s, f) {
  const t = states.contact;
  for (let i = t.starts[s]; i < t.starts[s + 1]; i++) {
    const [pressure, friction, x, y] = t.values.subarray(4 * i, 4 * i + 4), number = t.points[i];
    f(x, y, t.upper[number] === 1, pressure, friction, t.along[number], t.status[i]);
  }
}

function focusPoint() {
  const s = look.state;
  if (look.at) return look.at;
  if (look.focus === "middle") return [0.35 * look.zoom, (place(s, lowest)[1] + 0.3 * look.zoom)];
  let best = null, most = 0;
  if (look.focus === "punch" || look.focus === "die") contacts(s, (x, y, upper, p) => { if (upper === (look.focus === "punch") && p > most) { most = p; best = [x, y]; } });
  else for (let n = 0; n < states.nodes; n++) { const v = valueAt(s, n); if (v > most) { most = v; best = place(s, n); } }
  return best || place(s, lowest);
}
// The node that is lowest on the plane of symmetry at the start.
const lowest = (() => { let best = 0; for (let n = 1; n < states.nodes; n++) { const [x, y] = place(0, n), [u, v] = place(0, best); if (x + 0.01 * y < u + 0.01 * v) best = n; } return best; })();

// The whole picture: the right half and a little of the left one, the same for all states.
function wholeBox(width, height) {
  const [, x1, y0, y1] = states.span, low = Math.min(y0, -dieDepth) - MARGIN, high = Math.max(y1, 4 * MARGIN) + MARGIN;
  const left = -0.14 * x1, right = x1 + MARGIN;
  return [(left + right) / 2, (low + high) / 2, Math.max((right - left) / width, (high - low) / height)];
}

function bar(view, box) {
  // A length to measure by, in the lower right corner.
  const { c, width, height } = view, want = 0.16 * width * box[2], length = [50, 20, 10, 5, 2, 1, 0.5, 0.2].find(l => l <= want) || 0.1, w = length / box[2];
  c.strokeStyle = c.fillStyle = tone("ink"); c.lineWidth = 1.5; c.beginPath(); c.moveTo(width - 18 - w, height - 20); c.lineTo(width - 18, height - 20);
  for (const x of [width - 18 - w, width - 18]) { c.moveTo(x, height - 24); c.lineTo(x, height - 16); }
  c.stroke(); c.font = "12.5px sans-serif"; c.textAlign = "center"; c.fillText(`${length} mm`, width - 18 - w / 2, height - 27);
}

let wholeView = null, nearView = null;
function drawSheet(printing) {
  const canvas = document.getElementById("whole"), near = document.getElementById("near");
  const w = printing ? 380 : canvas.clientWidth, wn = printing ? 300 : near.clientWidth, height = Math.round(Math.max(w * 0.82, 240));
  const a = prepare(canvas, height, w), b = prepare(near, w > wn * 1.6 || wn >= w ? wn * 0.9 : height, wn);
  const box = wholeBox(a.width, a.height);
  wholeView = { ...scene(a, box, false), box };
  const [fx, fy] = focusPoint(), close = [fx, fy, look.zoom / b.width];
  nearView = { ...scene(b, close, true), box: close };
  const { c } = a, hw = look.zoom / 2, hh = hw * b.height / b.width;
  c.strokeStyle = tone("frame"); c.lineWidth = 1.4;
  c.strokeRect(wholeView.X(fx - hw), wholeView.Y(fy + hh), 2 * hw * wholeView.k, 2 * hh * wholeView.k);
  c.fillStyle = tone("soft"); c.font = "13px sans-serif"; c.textAlign = "left";
  c.fillText("die", wholeView.X(Math.min(dieEdge + MARGIN, box[0] + 0.4 * a.width * box[2])), a.height - 14);
  const tip = model.thickness - depth(states.times[look.state]);
  if (wholeView.Y(tip) > 34) c.fillText("punch", wholeView.X(1.2), Math.max(wholeView.Y(tip + 0.24 * model.half_length), 22));
  bar(a, box); bar(b, close);
  const at = `at a stroke of ${fixed(depth(states.times[look.state]), 2)} mm`;
  canvas.setAttribute("aria-label", `The sheet between punch and die ${at}, coloured by ${states.fields[look.field].name}`);
  near.setAttribute("aria-label", `Close-up of the sheet ${at}`);
  document.getElementById("near-caption").textContent = `Close-up, ${show(look.zoom)} mm wide, framed in red on the left. Dots: contact points that carry a force.`;
  document.getElementById("whole-caption").textContent = "True shape, equal scales. Dashed: plane of symmetry. Click to move the close-up.";
  colorBar(printing);
}

function colorBar(printing) {
  const canvas = document.getElementById("scale"), { c, width } = prepare(canvas, 50, printing ? 700 : 0), f = states.fields[look.field];
  const left = 2, right = Math.min(width - 2, 560), X = v => left + v / f.scale * (right - left);
  for (let k = 0; k < 256; k++) { c.fillStyle = COLORS[k]; c.fillRect(left + k / 256 * (right - left), 0, (right - left) / 256 + 0.7, 13); }
  c.fillStyle = tone("soft"); c.strokeStyle = tone("faint"); c.font = "12px sans-serif"; c.textAlign = "center";
  for (const v of ticks(0, f.scale, width < 480 ? 4 : 7)) { c.beginPath(); c.moveTo(X(v), 13); c.lineTo(X(v), 18); c.stroke(); c.textAlign = v === 0 ? "left" : X(v) > right - 14 ? "right" : "center"; c.fillText(show(v), X(v), 31); }
  c.textAlign = "left"; c.fillStyle = tone("ink"); c.font = "13px sans-serif";
  let most = 0; for (let n = 0; n < states.nodes; n++) most = Math.max(most, valueAt(look.state, n));
  if (most < 1e-4 * f.scale) most = 0;
  if (width > right + 250) c.fillText(`${f.name}${f.unit ? `, ${f.unit}` : ""}; here at most ${show(most, 3)}`, right + 16, 11);
  else c.fillText(`${f.name}${f.unit ? `, ${f.unit}` : ""}; here at most ${show(most, 3)}`, left, 46);
}
