// What the report, the survey and its scores share: elements of the page, colours and bars with whiskers.
"use strict";
const element = (name, attributes = {}, ...children) => {
  const e = document.createElement(name);
  for (const [key, v] of Object.entries(attributes)) if (v != null) e.setAttribute(key, v);
  e.append(...children.filter((c) => c != null));
  return e;
};
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
// A name that may be broken where a word of it ends: unchartedNo|Sharpen, smaa1x:|preset=|HIGH.
const partsOf = (name) => name.split(/(?<=[a-z0-9])(?=[A-Z])|(?<=[:,=_])|(?<=\+)(?=[a-z])/); // and never a number from its sign
const breakable = (name) => partsOf(name).flatMap((part, k) => (k ? [element("wbr"), part] : [part]));
// A table wider than the window says so while there is more to its right.
const tellOfMoreColumns = (box) => {
  const hint = element("p", { class: "more-columns quiet", "aria-hidden": "true", hidden: "" }, "More columns: scroll sideways →");
  box.before(hint);
  const look = () => {
    hint.hidden = box.scrollWidth <= box.clientWidth + 1;
    hint.classList.toggle("seen", box.scrollLeft + box.clientWidth >= box.scrollWidth - 2);
  };
  box.addEventListener("scroll", look, { passive: true });
  const watch = new ResizeObserver(look);
  watch.observe(box);
  if (box.firstElementChild) watch.observe(box.firstElementChild);
};

// ---- one method, one look in every page: it follows from the method's id, never from its rank ----
// Twelve hues in two lightnesses, each at least 3:1 against the light panel and against the dark one.
const methodColours = ["#c13f6c", "#eb648f", "#c5432a", "#ee694e", "#a35f05", "#d57d05", "#866d04", "#af8f07", "#5f7904", "#7e9e07", "#008143", "#06a85a",
  "#037d71", "#08a494", "#077a8d", "#0da0b8", "#0275b3", "#0499e9", "#5465d4", "#7489fc", "#8a55c5", "#ad79ed", "#ad47a0", "#d46cc5"];
const plainColour = "#7f7f7f";
// Chart.js's names and a turn in degrees; the last two are of lines alone.
const methodMarkers = [["circle", 0], ["rect", 0], ["triangle", 0], ["rectRot", 0], ["triangle", 180], ["crossRot", 0], ["star", 0]];
// FNV-1a with a last mix.
const hashOf = (id) => {
  let v = 4694;
  for (const c of new TextEncoder().encode(id)) v = Math.imul(v ^ c, 16777619) >>> 0;
  v = Math.imul(v ^ (v >>> 15), 0x2c1b3c6d) >>> 0;
  return (v ^ (v >>> 12)) >>> 0;
};
// `id` is a method's id; "truth" is ink and noaa is grey, as nothing else is.
const methodColour = (id) => (id === "truth" ? css("--ink") : id === "noaa" ? plainColour : methodColours[hashOf(id) % methodColours.length]);
// The looks of a page's rows, by their ids: no two of them have both colour and marker in common. A method has its own
// colour while that is free, or the one nearest to it; whoever comes first in the alphabet keeps it, so that a method
// looks alike in reports of other runs. Rows of one method (other parameters) share its colour; marker and dash tell
// them apart.
const methodLooks = (ids) => {
  const colours = methodColours.length, hues = colours / 2, markers = methodMarkers.length;
  const ring = (a, b) => Math.min((a - b + hues) % hues, (b - a + hues) % hues);
  const apart = (a, b) => 2 * ring(a >> 1, b >> 1) + ((a ^ b) & 1);
  const near = (c) => methodColours.map((_, k) => k).sort((a, b) => apart(a, c) - apart(b, c) || a - b);
  const own = new Map();
  for (const id of [...new Set(ids)].filter((i) => i !== "noaa").sort()) {
    const want = hashOf(id) % colours, others = [...own.values()];
    own.set(id, near(want).find((c) => !others.includes(c)) ?? want);
  }
  const nth = ids.map((id, i) => ids.slice(0, i).filter((o) => o === id).length), taken = [], looks = [];
  const byRow = ids.map((_, i) => i).sort((a, b) => nth[a] - nth[b] || (ids[a] < ids[b] ? -1 : ids[a] > ids[b] ? 1 : 0));
  for (const i of byRow) {
    const start = (hashOf(ids[i]) >>> 8) + nth[i], dash = methodDash(nth[i]);
    const inTurn = methodMarkers.map((_, k) => (start + k) % markers);
    let colour = plainColour, marker = nth[i] % markers;
    if (own.has(ids[i])) {
      const c = own.get(ids[i]), offers = near(c).flatMap((k) => inTurn.map((m) => [k, m]));
      const free = [1, 0].map((far) => offers.find(([k, m]) => k === c && !taken.some(([l, n]) => ring(l >> 1, k >> 1) <= far && n === m))).find(Boolean)
        ?? offers.find(([k, m]) => !taken.some(([l, n]) => l === k && n === m)) ?? offers[0];
      taken.push(free);
      colour = methodColours[free[0]];
      marker = free[1];
    }
    looks[i] = { colour, marker: methodMarkers[marker][0], turn: methodMarkers[marker][1], dash };
  }
  return looks;
};
// As Chart.js asks for it; a marker of lines needs thicker ones to be seen.
const markerOptions = ({ colour, marker, turn }) => ({ backgroundColor: colour, borderColor: colour, pointBackgroundColor: colour, pointBorderColor: colour, pointStyle: marker, pointRotation: turn,
  pointBorderWidth: ["crossRot", "star"].includes(marker) ? 2.5 : 1 });
// The id in a method's text: smaa1x:preset=HIGH+sharpen=xu.
const methodIn = (text) => text.split(/[:+]/)[0];
const methodDash = (nth = 0) => [[], [6, 3], [2, 2], [8, 3, 2, 3]][nth % 4];

// ---- charts, on pages that have Chart.js ----
const dressCharts = () => {
  Chart.register(namesBelow);
  Chart.defaults.color = css("--quiet");
  Chart.defaults.borderColor = css("--line");
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  Chart.defaults.animation = false;
  Chart.defaults.maintainAspectRatio = false;
};
// A name in lines that are `most` px wide at most, broken where `breakable` breaks it; as one text where it fits.
const inLines = (name, most, font = `12px ${Chart.defaults.font.family}`) => {
  const pen = (inLines.pen ??= document.createElement("canvas").getContext("2d"));
  pen.font = font;
  const lines = [""], fits = (text) => pen.measureText(text).width <= most;
  for (const part of partsOf(name).flatMap((p) => (fits(p) ? [p] : [...p])))
    if (lines.at(-1) && !fits(lines.at(-1) + part)) lines.push(part);
    else lines[lines.length - 1] += part;
  return lines.length > 1 ? lines : name;
};
// A legend below the chart, of the page's own text: names break as in tables, where Chart.js cuts them. As options of
// Chart.js's plugins; `labels` and `onClick` as for its own legend, which still makes the items.
const legendBelow = ({ shown = true, onClick, ...labels } = {}) => ({ legend: { display: false, labels, ...(onClick && { onClick }) }, namesBelow: { shown } });
const namesBelow = {
  id: "namesBelow",
  afterUpdate(chart, _, { shown }) {
    if (!shown) return;
    const { legend } = chart, box = chart.canvas.parentElement, focused = box.nextElementSibling?.querySelector(":focus")?.textContent;
    if (!box.nextElementSibling?.classList.contains("legend")) box.after(element("div", { class: "legend" }));
    box.nextElementSibling.replaceChildren(...legend.legendItems.map((item) => {
      const button = element("button", { type: "button", class: item.hidden ? "off" : null }, legendSign(item, legend.options.labels.usePointStyle), element("span", {}, ...breakable(item.text)));
      button.onclick = (e) => legend.options.onClick.call(legend, e, item, legend);
      if (item.text === focused) setTimeout(() => button.focus());
      return button;
    }));
  },
};
// The marker of a legend's item or a piece of its line.
const legendSign = ({ fillStyle, strokeStyle, lineWidth, lineDash, pointStyle, rotation }, ofPoints) => {
  const scale = window.devicePixelRatio || 1, [width, height] = [18, 14], canvas = element("canvas", { width: width * scale, height: height * scale });
  const pen = canvas.getContext("2d");
  pen.scale(scale, scale);
  Object.assign(pen, { fillStyle, strokeStyle, lineWidth: ofPoints ? lineWidth : 2 });
  if (ofPoints && pointStyle !== "line") Chart.helpers.drawPoint(pen, { pointStyle, rotation, radius: 4.5, borderWidth: lineWidth }, width / 2, height / 2);
  else {
    pen.setLineDash(lineDash ?? []);
    pen.moveTo(0, height / 2);
    pen.lineTo(width, height / 2);
    pen.stroke();
  }
  return canvas;
};
const axis = (text, more = {}) => ({ title: { display: Boolean(text), text }, ...more, ticks: { maxRotation: 0, autoSkipPadding: 12, ...more.ticks } });
// A logarithmic axis that holds all `values` with room at both ends, its ticks at 1, 2 and 5 of each decade.
const logarithmicAxis = (text, values, more = {}) => {
  const min = Math.min(...values) / 1.3, max = Math.max(...values) * 1.3;
  return axis(text, { type: "logarithmic", bounds: "data", min, max, ...more,
    ticks: { autoSkip: false, callback: (v) => Number(v.toPrecision(3)).toString() },
    afterBuildTicks: (scale) => {
      const few = [];
      for (let p = Math.floor(Math.log10(min)); p <= Math.log10(max); p++) for (const m of [1, 2, 5]) few.push(m * 10 ** p);
      const inside = few.filter((v) => v >= min && v <= max);
      // Many decades: the powers of ten alone; less than one step: both ends.
      scale.ticks = (inside.length > 12 ? inside.filter((_, k) => few.indexOf(inside[k]) % 3 === 0) : inside.length > 1 ? inside : [min * 1.3, max / 1.3]).map((v) => ({ value: v }));
    } });
};
// What a tooltip says of item `t`, never wider than its chart.
const tipLines = (t, text) => inLines(text, t.chart.width - 60);
// Horizontal bars named at their left: a name takes two fifths of the chart at most, and all bars stand as far apart as
// the longest one asks for. The box grows with them, `more` px beyond.
const namedRows = (canvas, labels, more = 60) => {
  const nameOf = (k, width) => inLines(labels[k], 0.4 * width - 12);
  const fit = (width) => {
    const lines = Math.max(1, ...labels.map((_, k) => [nameOf(k, width)].flat().length));
    canvas.parentElement.style.height = Math.max(160, more + (8 + 14 * lines) * labels.length) + "px";
  };
  fit(canvas.parentElement.clientWidth);
  return { ticks: { autoSkip: false, callback(k) { return nameOf(k, this.chart.width); } }, onResize: (_, { width }) => width > 0 && fit(width) };  // not where it is out of sight
};
// Horizontal bars, as tall as their number asks for; whiskers from intervalOf(k), [from, to] or null; an end
// without end goes to the chart's border.
const barChart = (canvas, { labels, values, colours, axisTitle, tip, intervalOf, range = {} }) => {
  const rows = namedRows(canvas, labels);
  const ends = intervalOf ? labels.flatMap((_, k) => intervalOf(k) ?? []).filter(Number.isFinite) : [];  // the whiskers stay within the chart
  const whole = ends.length ? { suggestedMin: Math.min(...ends), suggestedMax: Math.max(...ends), ...range } : range;
  return new Chart(canvas, {
    type: "bar",
    data: { labels, datasets: [{ data: values, backgroundColor: colours, maxBarThickness: 18 }] },
    options: { indexAxis: "y", scales: { x: axis(axisTitle, whole), y: { ticks: rows.ticks } },
      onResize: rows.onResize,
      plugins: { legend: { display: false }, tooltip: { callbacks: { title: ([t]) => tipLines(t, t.label), label: (t) => tipLines(t, tip(t.parsed.x, t.dataIndex)) } } } },
    plugins: intervalOf ? [{
      afterDatasetsDraw: (chart) => {
        const pen = chart.ctx;
        pen.save();
        pen.beginPath();
        chart.getDatasetMeta(0).data.forEach((bar, k) => {
          const interval = intervalOf(k);
          if (!interval) return;
          const border = (x) => (x > 0 ? chart.chartArea.right : chart.chartArea.left);
          const [from, to] = interval.map((x) => (Number.isFinite(x) ? chart.scales.x.getPixelForValue(x) : border(x)));
          pen.moveTo(from, bar.y); pen.lineTo(to, bar.y);
          [from, to].forEach((x, k) => { if (Number.isFinite(interval[k])) { pen.moveTo(x, bar.y - 4); pen.lineTo(x, bar.y + 4); } });
        });
        for (const [colour, width] of [["--panel", 4], ["--ink", 1.5]]) { // seen on bars of every colour
          pen.strokeStyle = css(colour);
          pen.lineWidth = width;
          pen.stroke();
        }
        pen.restore();
      } }] : [],
  });
};
