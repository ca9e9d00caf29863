// Charts in SVG: lines, stems and marks over two axes, a cursor for the state shown, the nearest point under the pointer.
const SVG = "http://www.w3.org/2000/svg";
const charts = [];

function svg(name, attributes, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

// series: {name, color, x, y, width, kind: "line" | "stems" | "marks" | "bars", hidden in the legend, dash, tolerance}
class Chart {
  constructor(id, options) {
    this.box = document.getElementById(id);
    this.options = { height: 300, log: false, ...options };
    this.legend = element("div", { class: "legend" });
    this.svg = svg("svg", { role: "img", "aria-label": options.title || id });
    this.tip = element("div", { class: "tip" });
    this.box.append(this.legend, this.svg, this.tip);
    this.cursor = null;
    this.svg.addEventListener("pointermove", event => this.point(event, false));
    this.svg.addEventListener("pointerleave", () => { this.tip.style.display = "none"; this.dot?.setAttribute("visibility", "hidden"); });
    this.svg.addEventListener("click", event => this.point(event, true));
    charts.push(this);
  }

  range(axis) {
    const given = this.options[axis + "Range"];
    if (given) return given;
    let [low, high] = [Infinity, -Infinity];
    for (const s of this.options.series) for (const v of s[axis]) if (v !== null && isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
    if (low > high) return [0, 1];
    if (axis === "y" && this.options.log) {
      const below = Math.floor(Math.log10(low) * 2) / 2, above = Math.ceil(Math.log10(high) * 2) / 2, flat = above > below ? 0 : 0.5;
      return [10 ** (below - flat), 10 ** (above + flat)];
    }
    if (axis === "y") {
      low = Math.min(low, 0);
      if (low > -0.02 * high) low = Math.min(low, 0);
      const step = ticks(low, Math.max(high, low + 1e-12), 5), width = step.length > 1 ? step[1] - step[0] : high - low || 1;
      high = Math.ceil(high / width - 1e-9) * width || 1;
      if (low < -0.02 * high) low = Math.floor(low / width) * width;
    }
    return high > low ? [low, high] : [low, low + 1];
  }

  draw(width) {
    const o = this.options, W = width || this.box.clientWidth || 600, H = o.height;
    this.W = W;
    this.frame = { left: 58, right: W - 14, top: 10, bottom: H - 42 };
    this.xr = this.range("x"); this.yr = this.range("y");
    const f = this.frame, [x0, x1] = this.xr, [y0, y1] = this.yr;
    this.X = x => f.left + (x - x0) / (x1 - x0) * (f.right - f.left);
    this.Y = o.log ? y => f.bottom - Math.log(y / y0) / Math.log(y1 / y0) * (f.bottom - f.top) : y => f.bottom - (y - y0) / (y1 - y0) * (f.bottom - f.top);
    this.svg.setAttribute("viewBox", `0 0 ${W} ${H}`);
    this.svg.replaceChildren();
    const put = (...a) => this.svg.appendChild(svg(...a));
    for (const x of ticks(x0, x1, W / 90)) {
      put("line", { x1: this.X(x), x2: this.X(x), y1: f.top, y2: f.bottom, stroke: "var(--line)" });
      put("text", { x: this.X(x), y: f.bottom + 17, "text-anchor": "middle" }, o.xTick ? o.xTick(x) : show(x));
    }
    const levels = o.log ? [] : ticks(y0, y1, H / 60);
    if (o.log) for (let p = Math.ceil(Math.log10(y0) - 1e-9); 10 ** p <= y1 * 1.0001; p++) levels.push(10 ** p);
    if (o.log && levels.length < 2) for (let p = Math.floor(Math.log10(y0)); p <= Math.log10(y1); p++) for (const m of [2, 3, 5]) { const v = m * 10 ** p; if (v >= y0 && v <= y1) levels.push(v); }
    for (const y of levels) {
      put("line", { x1: f.left, x2: f.right, y1: this.Y(y), y2: this.Y(y), stroke: y === 0 ? "var(--axis)" : "var(--line)" });
      put("text", { x: f.left - 7, y: this.Y(y) + 4, "text-anchor": "end" }, o.yTick ? o.yTick(y) : show(y));
    }
    put("path", { d: `M${f.left} ${f.top}V${f.bottom}H${f.right}`, fill: "none", stroke: "var(--axis)" });
    put("text", { x: (f.left + f.right) / 2, y: H - 5, "text-anchor": "middle", class: "label" }, o.xLabel);
    put("text", { x: 13, y: (f.top + f.bottom) / 2, "text-anchor": "middle", class: "label", transform: `rotate(-90 13 ${(f.top + f.bottom) / 2})` }, o.yLabel);
    if (o.turn !== undefined && o.turn > x0 && o.turn < x1) {
      put("line", { x1: this.X(o.turn), x2: this.X(o.turn), y1: f.top, y2: f.bottom, stroke: "var(--faint)", "stroke-dasharray": "3 3" });
    }
    o.series.forEach(s => this.series(s, put));
    if (o.turn !== undefined && o.turn > x0 && o.turn < x1) put("text", { x: this.X(o.turn) - 6, y: o.log ? f.bottom - 7 : f.top + 11, "text-anchor": "end" }, "the punch turns");
    this.line = put("path", { fill: "none", stroke: "var(--ink)", "stroke-width": 1, visibility: "hidden", "pointer-events": "none" });
    this.spot = put("circle", { r: 4.5, fill: "var(--page)", stroke: "var(--ink)", "stroke-width": 2, visibility: "hidden", "pointer-events": "none" });
    this.dot = put("circle", { r: 3.5, fill: "var(--ink)", visibility: "hidden", "pointer-events": "none" });
    this.key();
    this.mark(this.cursor);
  }

  series(s, put) {
    const points = [], X = this.X, Y = this.Y;
    for (let i = 0; i < s.x.length; i++) if (s.y[i] !== null && isFinite(s.y[i]) && (!this.options.log || s.y[i] > 0)) points.push([X(s.x[i]), Y(s.y[i]), i]);
    const n = v => v.toFixed(1), zero = Y(this.options.log ? this.yr[0] : 0);
    if (s.kind === "stems") put("path", { d: points.map(([x, y]) => `M${n(x)} ${n(zero)}V${n(y)}`).join(""), stroke: s.color, "stroke-width": s.width || Math.min(3, Math.max(0.8, 0.5 * (this.frame.right - this.frame.left) / Math.max(points.length, 1))), fill: "none" });
    else if (s.kind === "marks") for (const [x, y, i] of points) {
      if (s.tolerance) {
        const [a, b] = [Y(s.y[i] - s.tolerance[i]), Y(s.y[i] + s.tolerance[i])];
        put("path", { d: `M${x} ${a}V${b}M${x - 5} ${a}h10M${x - 5} ${b}h10`, stroke: s.color, "stroke-width": 2, fill: "none" });
      }
      put("circle", { cx: x, cy: y, r: s.radius || 3, fill: s.color });
    } else put("path", { d: "M" + points.map(([x, y]) => `${n(x)} ${n(y)}`).join("L"), stroke: s.color, "stroke-width": s.width || 2, fill: "none", "stroke-linejoin": "round", "stroke-dasharray": s.dash || "none" });
  }

  key() {
    this.legend.replaceChildren(...this.options.series.filter(s => s.name && s.x.length).map(s => {
      const sign = element("i", s.kind === "marks" ? { class: "dot", style: `background:${s.color}` } : { style: `border-color:${s.color};border-top-style:${s.dash ? "dashed" : "solid"};border-top-width:${Math.max(2, Math.min(s.width || 2, 3))}px` });
      return element("span", {}, sign, s.name);
    }));
  }

  // Shows where the state of the slider is: a vertical line, and a spot if there is a value.
  mark(at) {
    this.cursor = at;
    if (!at || !this.line) return;
    const x = this.X(at.x), inside = at.x >= this.xr[0] && at.x <= this.xr[1];
    this.line.setAttribute("visibility", inside ? "visible" : "hidden");
    this.line.setAttribute("d", `M${x} ${this.frame.top}V${this.frame.bottom}`);
    const seen = inside && at.y !== undefined && isFinite(at.y) && (!this.options.log || at.y > 0);
    this.spot.setAttribute("visibility", seen ? "visible" : "hidden");
    if (seen) { this.spot.setAttribute("cx", x); this.spot.setAttribute("cy", this.Y(at.y)); }
  }

  point(event, click) {
    const box = this.svg.getBoundingClientRect(), scale = this.W / box.width;
    const px = (event.clientX - box.left) * scale, py = (event.clientY - box.top) * scale;
    let best = null, least = 40 * 40;
    for (const s of this.options.series) for (let i = 0; i < s.x.length; i++) {
      if (s.y[i] === null || !isFinite(s.y[i])) continue;
      const x = this.X(s.x[i]), y = this.Y(s.y[i]), d = (x - px) ** 2 + 0.25 * (y - py) ** 2;
      if (d < least) { least = d; best = { s, i, x, y }; }
    }
    this.dot.setAttribute("visibility", best ? "visible" : "hidden");
    this.tip.style.display = best ? "block" : "none";
    if (!best) return;
    this.dot.setAttribute("cx", best.x); this.dot.setAttribute("cy", best.y);
    this.tip.textContent = this.options.tip ? this.options.tip(best.s, best.i) : `${show(best.s.x[best.i])}: ${show(best.s.y[best.i])}`;
    const left = best.x / scale + 12, room = this.box.clientWidth - this.tip.offsetWidth - 4;
    this.tip.style.left = `${Math.min(left, room)}px`;
    this.tip.style.top = `${(this.svg.offsetTop + best.y / scale) - 38}px`;
    if (click && best.s.time) goTo(best.s.time[best.i]);
  }
}
