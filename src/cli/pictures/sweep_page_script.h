// The text of the page of a sweep around its title and its data.
#pragma once

namespace anholon::cli {

inline constexpr const char* kSweepPageHead = R"page(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'">
<title>)page";

inline constexpr const char* kSweepPageBody = R"page(</title>
<style>
:root{color-scheme:light dark;--ink:#222;--paper:#fff;--line:#999}
@media (prefers-color-scheme:dark){:root{--ink:#ddd;--paper:#16181c;--line:#666}}
body{font:15px/1.45 system-ui,sans-serif;margin:1.2em auto;max-width:78em;padding:0 1em;color:var(--ink);background:var(--paper)}
main{display:flex;flex-wrap:wrap;gap:1.5em}figure{margin:0;flex:2 1 34em}aside{flex:1 1 20em;min-width:0}
canvas{width:100%;height:30em;cursor:crosshair;border:0;outline-offset:2px}
table{border-collapse:collapse;width:100%}td,th{padding:.1em .5em;text-align:left;font-variant-numeric:tabular-nums;border-bottom:1px solid var(--line);font-weight:normal}
pre{white-space:pre-wrap;overflow-wrap:anywhere;border:1px solid var(--line);padding:.5em;border-radius:4px}
#legend span{display:inline-block;margin-right:1em}#legend i{display:inline-block;width:.8em;height:.8em;margin-right:.3em}
</style></head><body><h1></h1>
<p><label>Colour: <select></select></label> <span id="legend"></span></p>
<main><figure><canvas tabindex="0" aria-label="the cases of the sweep; arrow keys go from case to case"></canvas></figure>
<aside aria-live="polite"><p>A click on a cell tells its case.</p></aside></main>
<script type="application/json" id="data">)page";

inline constexpr const char* kSweepPageScript = R"page(</script>
<script>
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const numbers = text => new Float64Array(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
for (const c of data.columns) c.values = numbers(c.data);
const cells = data.cells ? numbers(data.cells) : null;
const column = name => data.columns.find(c => c.name === name);
const canvas = document.querySelector("canvas"), select = document.querySelector("select"), aside = document.querySelector("aside");
const words = ["#0072b2","#d55e00","#009e73","#cc79a7","#e69f00","#56b4e9","#999999","#f0e442"];
const scale = ["#440154","#482878","#3e4989","#31688e","#26828e","#1f9e89","#35b779","#6ece58","#b5de2b","#fde725"];
const x = column(data.axes[0].name), y = data.axes[1] && column(data.axes[1].name), count = x.values.length;
let shown = column(data.shown), picked = -1;
document.querySelector("h1").textContent = data.title;
for (const c of data.columns) select.append(new Option(c.label, c.name, false, c.name === data.shown));

const range = values => {
  let least = Infinity, greatest = -Infinity;
  for (const v of values) if (Number.isFinite(v)) { if (v < least) least = v; if (v > greatest) greatest = v; }
  return least < greatest ? [least, greatest] : Number.isFinite(least) ? [least - .5, least + .5] : [0, 1];
};
const mix = (a, b, t) => "#" + [1, 3, 5].map(k => Math.round(parseInt(a.slice(k, k + 2), 16) * (1 - t) + parseInt(b.slice(k, k + 2), 16) * t).toString(16).padStart(2, "0")).join("");
const colour = (v, [least, greatest]) => {
  if (shown.words.length) return words[v % words.length];
  if (!Number.isFinite(v)) return null;
  const at = (v - least) / (greatest - least) * (scale.length - 1), k = Math.min(Math.floor(at), scale.length - 2);
  return mix(scale[k], scale[k + 1], at - k);
};
const text = (c, k) => c.words.length ? c.words[c.values[k]] : String(c.values[k]);
const brief = v => String(Number(v.toPrecision(4)));

// The frame of the picture in pixels, and the ranges of its axes.
const frame = () => {
  const w = canvas.clientWidth, h = canvas.clientHeight;
  let xs, ys;
  if (cells) {
    xs = [Infinity, -Infinity], ys = [Infinity, -Infinity];
    for (let k = 0; k < cells.length; k += 4) {
      xs = [Math.min(xs[0], cells[k]), Math.max(xs[1], cells[k + 1])];
      ys = [Math.min(ys[0], cells[k + 2]), Math.max(ys[1], cells[k + 3])];
    }
  } else {
    xs = range(x.values), ys = shown.words.length ? [-.5, shown.words.length - .5] : range(shown.values);
  }
  const f = {left: 64, right: w - 12, top: 8, bottom: h - 44, xs, ys};
  f.x = v => f.left + (v - xs[0]) / (xs[1] - xs[0]) * (f.right - f.left);
  f.y = v => f.bottom - (v - ys[0]) / (ys[1] - ys[0]) * (f.bottom - f.top);
  f.box = k => cells ? [f.x(cells[4 * k]), f.y(cells[4 * k + 3]), f.x(cells[4 * k + 1]), f.y(cells[4 * k + 2])]
    : [f.x(x.values[k]) - 3, f.y(shown.values[k]) - 3, f.x(x.values[k]) + 3, f.y(shown.values[k]) + 3];
  return f;
};
const ticks = ([a, b]) => {
  const raw = (b - a) / 9, power = 10 ** Math.floor(Math.log10(raw)), step = power * [1, 2, 5, 10].find(d => d * power >= raw);
  const list = [];
  for (let v = Math.ceil(a / step) * step; v <= b + step * 1e-9; v += step) list.push(Math.abs(v) < step * 1e-9 ? 0 : v);
  return list;
};
function draw() {
  const ratio = devicePixelRatio || 1, g = canvas.getContext("2d"), f = frame(), values = range(shown.values);
  canvas.width = canvas.clientWidth * ratio, canvas.height = canvas.clientHeight * ratio;
  g.scale(ratio, ratio);
  const ink = getComputedStyle(document.body).color;
  for (let k = 0; k < count; ++k) {
    const paint = colour(shown.values[k], values);
    if (!paint) continue;
    const [a, b, c, d] = f.box(k);
    g.fillStyle = paint;
    g.fillRect(a, b, Math.max(c - a, .5) + .3, Math.max(d - b, .5) + .3);
  }
  g.strokeStyle = g.fillStyle = ink;
  g.strokeRect(f.left, f.top, f.right - f.left, f.bottom - f.top);
  g.font = "12px system-ui, sans-serif";
  g.textAlign = "center";
  for (const v of ticks(f.xs)) { g.fillRect(f.x(v), f.bottom, 1, 4); g.fillText(brief(v), f.x(v), f.bottom + 16); }
  g.fillText(data.axes[0].label, (f.left + f.right) / 2, f.bottom + 36);
  g.textAlign = "right";
  if (!cells && shown.words.length) shown.words.forEach((word, k) => g.fillText(word, f.left - 7, f.y(k) + 4));
  else for (const v of ticks(f.ys)) { g.fillRect(f.left - 4, f.y(v), 4, 1); g.fillText(brief(v), f.left - 7, f.y(v) + 4); }
  g.save(); g.translate(12, (f.top + f.bottom) / 2); g.rotate(-Math.PI / 2); g.textAlign = "center";
  g.fillText(data.axes[1] ? data.axes[1].label : shown.label, 0, 0); g.restore();
  if (picked >= 0) { const [a, b, c, d] = f.box(picked); g.lineWidth = 2; g.strokeRect(a, b, c - a, d - b); }
  const legend = document.getElementById("legend");
  legend.replaceChildren(...(shown.words.length ? shown.words.map((word, k) => entry(words[k % words.length], word || "none"))
    : [entry(scale[0], brief(values[0])), entry(scale[9], brief(values[1]))]));
}
function entry(paint, word) {
  const span = document.createElement("span"), box = document.createElement("i");
  box.style.background = paint;
  span.append(box, word);
  return span;
}
// A word for a shell.
const quoted = word => /^[\w=.,+\-/:]*$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";
function command(k) {
  let line = data.command;
  const scenario = data.columns.find(c => c.name === "case_name");
  if (scenario) line += " --case " + quoted(text(scenario, k));
  for (const name of data.varied) {
    const plain = name.replace("(0)", ""), primes = plain.split("'").length - 1, c = column(name);
    const option = plain === name ? "set" : ["q", "qdot", "qddot", "qdddot"][primes];
    line += ` --${option} ` + quoted(plain.replaceAll("'", "") + "=" + text(c, k));
  }
  return line + ` -o case-${column("case").values[k]}.html`;
}
function pick(k) {
  picked = k;
  draw();
  if (k < 0) return;
  const table = document.createElement("table"), head = document.createElement("h2");
  head.textContent = "Case " + column("case").values[k];
  for (const c of data.columns) {
    const row = table.insertRow(), name = document.createElement("th");
    name.scope = "row"; name.textContent = c.label;
    row.append(name); row.insertCell().textContent = text(c, k);
  }
  aside.replaceChildren(head, table);
  if (!data.command) return;
  const line = document.createElement("pre"), button = document.createElement("button"), told = document.createElement("p");
  line.textContent = command(k);
  button.textContent = "Copy the command of its motion";
  button.onclick = () => {
    const done = () => { button.textContent = "Copied"; };
    if (navigator.clipboard) navigator.clipboard.writeText(line.textContent).then(done, () => getSelection().selectAllChildren(line));
    else getSelection().selectAllChildren(line);
  };
  aside.append(line, button);
  if (/ model\.toml\b/.test(data.command)) {
    const link = document.createElement("a");
    link.href = "data:text/plain;charset=utf-8," + encodeURIComponent(data.model);
    link.download = "model.toml"; link.textContent = "model.toml";
    told.append("The command needs the model: ", link);
    aside.append(told);
  }
}
canvas.onclick = event => {
  const f = frame(), at = canvas.getBoundingClientRect(), px = event.clientX - at.left, py = event.clientY - at.top;
  let found = -1;
  for (let k = count - 1; k >= 0 && found < 0; --k) {
    const [a, b, c, d] = f.box(k);
    if (px >= a && px <= c && py >= b && py <= d) found = k;
  }
  pick(found);
};
canvas.onkeydown = event => {
  const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
  if (!step) return;
  event.preventDefault();
  pick((picked + step + count) % count);
};
select.onchange = () => { shown = column(select.value); draw(); };
new ResizeObserver(draw).observe(canvas);
</script>
</body></html>
)page";

}  // namespace anholon::cli
