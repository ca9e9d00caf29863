// What all pages use: numbers as text, ticks of an axis, elements, tables, and the data in the page.
const data = JSON.parse(document.getElementById("data").textContent);

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

// A text in which the name of an option is not broken between two lines.
function sentence(text) {
  const made = document.createDocumentFragment();
  text.split(/(-[a-z]\w+)/).forEach((part, i) => made.append(i % 2 ? element("span", { class: "option" }, part) : part));
  return made;
}

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) key === "text" ? made.textContent = value : made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function table(id, heads, rows) {
  const made = document.getElementById(id), headed = heads.some(h => h.name);
  if (!rows.length) { made.closest(".scroll").replaceChildren(element("p", { class: "small", text: "Nothing to show." })); return; }
  const head = element("tr");
  heads.forEach(h => head.append(element("th", { scope: "col", class: h.number ? "number" : "", text: h.name || "" }, ...(h.name || !headed ? [] : [element("span", { class: "hidden", text: h.hidden || "verdict" })]))));
  const body = element("tbody");
  for (const row of rows) {
    const line = element("tr", row.failing ? { class: "failing" } : {});
    row.cells.forEach((cell, i) => {
      const td = element("td", { class: heads[i].class || (heads[i].number ? "number" : "") });
      td.append(cell instanceof Node ? cell : String(cell));
      line.append(td);
    });
    body.append(line);
  }
  // A table that is wider than the page is scrolled, with the keyboard, too.
  const about = made.closest("section, div[id]")?.querySelector("h2")?.textContent || "Table";
  made.setAttribute("aria-label", about);
  for (const [name, value] of Object.entries({ tabindex: "0", role: "region", "aria-label": `${about}, scrolls sideways` })) made.closest(".scroll").setAttribute(name, value);
  if (headed) made.append(element("thead", {}, head));
  made.append(body);
}

const mark = good => element("span", { class: `mark ${good ? "good" : "bad"}`, text: good ? "✓ holds" : "✗ fails" });

function tolerance(t, unit) {
  if (t === "at_most") return "at most";
  if (t === "at_least") return "at least";
  return t.relative !== undefined ? `${show(100 * t.relative)} %` : `± ${show(t.absolute)}${unit && unit !== "1" ? ` ${unit}` : ""}`;
}
