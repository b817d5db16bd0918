// The map of a sweep: cells or points of its cases, and the numbers of the case that is picked. Of the page that
// `anholon plot` writes and of the studio.
//
// anholon_map(root, data, host) builds it in `root` and returns {pick(row), row_of(number), motion}: `motion` is an element
// below the map that is the host's. host.picked(number, row) is told of each case that is picked. host.has(number) says
// whether there is a motion of a case; without it there is one of each.
"use strict";
function anholon_map(root, data, host) {
  const numbers = text => new Float64Array(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
  for (const c of data.columns) c.values = numbers(c.data);
  const cells = data.cells ? numbers(data.cells) : null;
  const column = name => data.columns.find(c => c.name === name);
  const words = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#999999", "#f0e442"];
  const scale = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"];
  const x = column(data.axes[0].name), y = data.axes[1] && column(data.axes[1].name), count = x.values.length;
  const cases = column("case").values, has = host.has ? k => host.has(cases[k]) : () => true;
  let shown = column(data.shown), picked = -1;
  const places = in_places();
  let summaries = places.map(summary);

  const element = (tag, attributes, ...children) => {
    const e = document.createElement(tag);
    for (const name in attributes) e.setAttribute(name, attributes[name]);
    e.append(...children);
    return e;
  };
  const select = element("select", {}), legend = element("span", {class: "legend"});
  for (const c of data.columns) select.append(new Option(c.label, c.name, false, c.name === data.shown));
  const number = element("input", {type: "number", min: 0, step: 1, inputmode: "numeric"});
  const canvas = element("canvas", {tabindex: 0, role: "application",
    "aria-label": "The cases of the sweep. Arrow keys go to the case beside, page up and page down in the order of the cases."});
  const about = element("div", {class: "about", "aria-live": "polite"}, element("p", {}, host.invitation));
  const motion = element("div", {class: "motion-of-case"});
  root.append(
    element("p", {class: "map-bar"}, element("label", {}, "Colour: ", select), element("label", {}, "Case: ", number), legend),
    element("div", {class: "map"}, element("figure", {}, canvas), about), motion);

  // The rows of the cases that lie in one cell, for each cell; points are by themselves.
  function in_places() {
    if (!cells) return Array.from({length: count}, (_, k) => [k]);
    const found = new Map();
    for (let k = 0; k < count; ++k) {
      const corners = cells.slice(4 * k, 4 * k + 4).join(), rows = found.get(corners);
      if (rows) rows.push(k); else found.set(corners, [k]);
    }
    return [...found.values()];
  }
  // What the colour of a cell shows: the mean of the numbers, or the most frequent word, of its cases.
  function summary(rows) {
    const values = rows.map(k => shown.values[k]).filter(Number.isFinite);
    if (!values.length) return NaN;
    if (!shown.words.length) return values.reduce((a, b) => a + b, 0) / values.length;
    const times = new Map();
    for (const v of values) times.set(v, (times.get(v) || 0) + 1);
    return [...times].reduce((best, one) => one[1] > best[1] || one[1] === best[1] && one[0] < best[0] ? one : best)[0];
  }

  const range = values => {
    let least = Infinity, greatest = -Infinity;
    for (const v of values) if (Number.isFinite(v)) { if (v < least) least = v; if (v > greatest) greatest = v; }
    return least < greatest ? [least, greatest] : Number.isFinite(least) ? [least - .5, least + .5] : [0, 1];
  };
  const mix = (a, b, t) => "#" + [1, 3, 5].map(k => Math.round(parseInt(a.slice(k, k + 2), 16) * (1 - t)
    + parseInt(b.slice(k, k + 2), 16) * t).toString(16).padStart(2, "0")).join("");
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
      // Points at the ends of the axes are seen as a whole.
      const wider = ([a, b]) => [a - .03 * (b - a), b + .03 * (b - a)];
      xs = wider(range(x.values)), ys = shown.words.length ? [-.5, shown.words.length - .5] : wider(range(shown.values));
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
  const entry = (paint, word) => {
    const box = element("i", {});
    box.style.background = paint;
    return element("span", {}, box, word);
  };

  function draw() {
    const ratio = devicePixelRatio || 1, g = canvas.getContext("2d"), f = frame(), values = range(summaries);
    canvas.width = canvas.clientWidth * ratio, canvas.height = canvas.clientHeight * ratio;
    g.scale(ratio, ratio);
    const ink = getComputedStyle(document.body).color;
    for (let n = 0; n < places.length; ++n) {
      const paint = colour(summaries[n], values);
      if (!paint) continue;
      const [a, b, c, d] = f.box(places[n][0]);
      g.fillStyle = paint;
      g.fillRect(a, b, Math.max(c - a, .5) + .3, Math.max(d - b, .5) + .3);
    }
    if (host.has) draw_marks(g, f);
    g.strokeStyle = g.fillStyle = ink;
    g.strokeRect(f.left, f.top, f.right - f.left, f.bottom - f.top);
    draw_axes(g, f);
    if (picked >= 0) {
      const [a, b, c, d] = f.box(picked);
      g.lineWidth = 2;
      g.strokeRect(a, b, c - a, d - b);
    }
    legend.replaceChildren(...(shown.words.length ? shown.words.map((word, k) => entry(words[k % words.length], word || "none"))
      : [entry(scale[0], brief(values[0])), entry(scale[9], brief(values[1]))]));
  }
  // A dot in each cell whose motion is in the page.
  function draw_marks(g, f) {
    for (let k = 0; k < count; ++k) {
      if (!has(k)) continue;
      const [a, b, c, d] = f.box(k);
      g.beginPath();
      g.arc((a + c) / 2, (b + d) / 2, 3, 0, 2 * Math.PI);
      g.fillStyle = "#fff", g.strokeStyle = "#000", g.lineWidth = 1;
      g.fill(), g.stroke();
    }
  }
  function draw_axes(g, f) {
    g.font = "12px system-ui, sans-serif";
    g.textAlign = "center";
    for (const v of ticks(f.xs)) { g.fillRect(f.x(v), f.bottom, 1, 4); g.fillText(brief(v), f.x(v), f.bottom + 16); }
    g.fillText(data.axes[0].label, (f.left + f.right) / 2, f.bottom + 36);
    g.textAlign = "right";
    if (!cells && shown.words.length) shown.words.forEach((word, k) => g.fillText(word, f.left - 7, f.y(k) + 4));
    else for (const v of ticks(f.ys)) { g.fillRect(f.left - 4, f.y(v), 4, 1); g.fillText(brief(v), f.left - 7, f.y(v) + 4); }
    g.save();
    g.translate(12, (f.top + f.bottom) / 2);
    g.rotate(-Math.PI / 2);
    g.textAlign = "center";
    g.fillText(data.axes[1] ? data.axes[1].label : shown.label, 0, 0);
    g.restore();
  }

  // A word for a shell.
  const quoted = word => /^[\w=.,+\-/:]*$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";
  function command(k) {
    // No command computes the motion of one mode.
    if (!data.command) return "python3 -c " + quoted(`import anholon; anholon.open_sweep(${JSON.stringify(data.folder)}).run(${cases[k]}).page("case-${cases[k]}.html")`);
    let line = data.command;
    for (const name of data.varied) {
      const plain = name.replace("(0)", ""), primes = plain.split("'").length - 1, c = column(name);
      if (c.words.length) { line += " --case " + quoted(text(c, k)); continue; }
      const option = plain === name ? "set" : ["q", "qdot", "qddot", "qdddot"][primes];
      line += ` --${option} ` + quoted(plain.replaceAll("'", "") + "=" + text(c, k));
    }
    return line + ` -o case-${cases[k]}.html`;
  }
  function table_of(k) {
    const table = document.createElement("table");
    for (const c of data.columns) {
      const row = table.insertRow();
      row.append(element("th", {scope: "row"}, c.label));
      row.insertCell().textContent = text(c, k);
    }
    return table;
  }
  // Of a cell that holds several cases: how many, what its colour shows, and a way to each of them.
  const colour_told = element("p", {class: "note"});
  function tell_colour() {
    const n = picked < 0 ? -1 : places.findIndex(rows => rows.includes(picked));
    const many = n >= 0 && places[n].length > 1 && Number.isFinite(summaries[n]);
    colour_told.textContent = !many ? "" : shown.words.length ? `The colour shows the most frequent word: ${shown.words[summaries[n]] || "none"}.`
      : `The colour shows the mean of ${shown.label}: ${brief(summaries[n])}.`;
  }
  function tell_place(row) {
    const rows = places.find(list => list.includes(row)), most = 20;
    if (rows.length < 2) return;
    const at = rows.indexOf(row), from = Math.max(0, Math.min(at - most / 2, rows.length - most)), listed = rows.slice(from, from + most);
    const button = (k, word, name) => {
      const b = element("button", {type: "button", "aria-label": name, ...(k === row ? {"aria-current": "true"} : {}), ...(k === undefined ? {disabled: ""} : {})}, word);
      b.onclick = () => { pick(k); about.querySelector("[aria-current]")?.focus(); };
      return b;
    };
    about.append(element("p", {class: "place"}, `${rows.length} cases lie in this cell: `, button(rows[at - 1], "‹", "The case before"), from > 0 ? " … " : " ",
      ...listed.flatMap(k => [button(k, String(cases[k]), `Case ${cases[k]}`), " "]), from + most < rows.length ? "… " : "", button(rows[at + 1], "›", "The case after")), colour_told);
    tell_colour();
  }
  function tell_command(k) {
    const line = element("pre", {class: "command"}, command(k)), button = element("button", {type: "button"}, "Copy the command of its motion");
    button.onclick = () => {
      const done = () => { button.textContent = "Copied"; };
      if (navigator.clipboard) navigator.clipboard.writeText(line.textContent).then(done, () => getSelection().selectAllChildren(line));
      else getSelection().selectAllChildren(line);
    };
    about.append(line, button);
    if (!/ model\.toml\b/.test(data.command)) return;
    about.append(element("p", {}, "The command needs the model: ",
      element("a", {href: "data:text/plain;charset=utf-8," + encodeURIComponent(data.model), download: "model.toml"}, "model.toml")));
  }

  const middle_of = (f, k) => { const [a, b, c, d] = f.box(k); return [(a + c) / 2, (b + d) / 2]; };
  // The row beside another one in the direction of a key, by the places in the picture; -1 if there is none within 45°.
  function beside(row, [right, down]) {
    const f = frame(), [px, py] = middle_of(f, row);
    let found = -1, least = Infinity;
    for (let k = 0; k < count; ++k) {
      const [qx, qy] = middle_of(f, k), along = (qx - px) * right + (qy - py) * down;
      const across = Math.abs((qx - px) * down) + Math.abs((qy - py) * right), far = along + 3 * across;
      if (k !== row && has(k) && along > .01 && across <= along && far < least) least = far, found = k;
    }
    return found;
  }
  // The row next to another one that has a motion.
  function nearest(row) {
    const f = frame(), [px, py] = middle_of(f, row);
    let found = -1, least = Infinity;
    for (let k = 0; k < count; ++k) {
      if (!has(k)) continue;
      const [qx, qy] = middle_of(f, k), far = (px - qx) ** 2 + (py - qy) ** 2;
      if (far < least) least = far, found = k;
    }
    return found;
  }
  function pick(row) {
    const wanted = row, others = row >= 0 && !has(row);
    if (others) row = nearest(row);
    picked = row;
    draw();
    if (row < 0) return;
    number.value = cases[row];
    about.replaceChildren(element("h2", {}, "Case " + cases[row]));
    if (others) {
      about.append(element("p", {class: "note"}, `The page holds no motion of case ${cases[wanted]}; that of case ${cases[row]} is next to it.`),
        element("details", {}, element("summary", {}, `The numbers of case ${cases[wanted]}`), table_of(wanted)));
    }
    tell_place(row);
    about.append(table_of(row));
    if (data.command || data.folder) tell_command(row);
    host.picked(cases[row], row);
  }
  function row_of(n) { return cases.indexOf(n); }

  canvas.onclick = event => {
    const f = frame(), at = canvas.getBoundingClientRect(), px = event.clientX - at.left, py = event.clientY - at.top;
    // What is drawn last lies on top. Beside small cells the nearest one within 12 pixels is meant.
    let found = places.findLast(([k]) => {
      const [a, b, c, d] = f.box(k);
      return px >= a && px <= c && py >= b && py <= d;
    });
    for (let n = 0, least = 12, inside = found; !inside && n < places.length; ++n) {
      const [cx, cy] = middle_of(f, places[n][0]), far = Math.hypot(px - cx, py - cy);
      if (far <= least) least = far, found = places[n];
    }
    if (found) pick(found.find(has) ?? found[0]);
  };
  canvas.onkeydown = event => {
    const step = {PageDown: 1, PageUp: -1}[event.key];
    const way = {ArrowRight: [1, 0], ArrowDown: [0, 1], ArrowLeft: [-1, 0], ArrowUp: [0, -1]}[event.key];
    if (!step && !way) return;
    event.preventDefault();
    if (way && picked >= 0) {
      const k = beside(picked, way);
      if (k >= 0) pick(k);
      return;
    }
    if (way) return pick(nearest(0));
    let k = picked < 0 && step < 0 ? 0 : picked;
    for (let n = 0; n < count; ++n) {
      k = (k + step + count) % count;
      if (has(k)) return pick(k);
    }
  };
  number.onchange = () => {
    const row = row_of(Number(number.value));
    if (number.value === "") return;
    if (row >= 0) return pick(row);
    picked = -1;
    draw();
    motion.replaceChildren();
    about.replaceChildren(element("p", {class: "warning", role: "alert"}, `The map shows no case ${number.value}. `
      + `Its cases have the numbers ${cases.reduce((a, b) => Math.min(a, b))} to ${cases.reduce((a, b) => Math.max(a, b))}.`));
    if (host.unknown) host.unknown(Number(number.value));
  };
  select.onchange = () => {
    shown = column(select.value);
    summaries = places.map(summary);
    tell_colour();
    draw();
  };
  new ResizeObserver(draw).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  new MutationObserver(draw).observe(document.documentElement, {attributes: true, attributeFilter: ["data-theme"]});
  return {pick, row_of, motion};
}
