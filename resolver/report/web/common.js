// What the report, the survey and its scores share: elements of the page, colours and bars with whiskers.
"use strict";
const element = (name, attributes = {}, ...children) => {
  const e = document.createElement(name);
  for (const [key, v] of Object.entries(attributes)) if (v != null) e.setAttribute(key, v);
  e.append(...children.filter((c) => c != null));
  return e;
};
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
// ---- one method, one look in every page: it follows from the method's id alone, never from its rank ----
// Twelve hues in two lightnesses of OKLCH (0.55 and 0.68), each at least 2.7:1 against the light and the dark ground.
const methodColours = ["#bb3a6d", "#e86494", "#c13e2e", "#ef6856", "#a55d0c", "#dc7d12", "#8a6e08", "#b99313", "#687c02", "#8ca507", "#05893e", "#2eb45c",
  "#158374", "#16b09b", "#018090", "#13abbf", "#0479b2", "#04a2ed", "#4c66d3", "#7190fd", "#8254c4", "#a97cf0", "#a644a0", "#d16cc9"];
const methodMarkers = ["circle", "rect", "triangle", "rectRot", "star", "crossRot", "rectRounded"]; // Chart.js's names
// FNV-1a with a last mix. The start is the one of 60,000 by which the methods share colours least: all 24 are used, none
// by more than three methods, and no two methods have both colour and marker in common.
const hashOf = (id) => {
  let v = 4694;
  for (const c of new TextEncoder().encode(id)) v = Math.imul(v ^ c, 16777619) >>> 0;
  v = Math.imul(v ^ (v >>> 15), 0x2c1b3c6d) >>> 0;
  return (v ^ (v >>> 12)) >>> 0;
};
// `id` is a method's id; "truth" is ink and noaa is grey, as nothing else is.
const methodColour = (id) => (id === "truth" ? css("--ink") : id === "noaa" ? "#7f7f7f" : methodColours[hashOf(id) % methodColours.length]);
// `nth`: the how-manieth row of this id in the run (other parameters); its colour is the same, marker and dash are not.
const methodMarker = (id, nth = 0) => methodMarkers[((hashOf(id) >>> 8) + nth) % methodMarkers.length];
// The id in a method's text: smaa1x:preset=HIGH+sharpen=xu.
const methodIn = (text) => text.split(/[:+]/)[0];
const methodDash = (nth = 0) => [[], [6, 3], [2, 2], [8, 3, 2, 3]][nth % 4];

// ---- charts, on pages that have Chart.js ----
const dressCharts = () => {
  Chart.defaults.color = css("--quiet");
  Chart.defaults.borderColor = css("--line");
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  Chart.defaults.animation = false;
  Chart.defaults.maintainAspectRatio = false;
};
const axis = (text, more = {}) => ({ title: { display: true, text }, ...more });
// Horizontal bars, as tall as their number asks for; whiskers from intervalOf(k), [from, to] or null.
const barChart = (canvas, { labels, values, colours, axisTitle, tip, intervalOf, range = {} }) => {
  canvas.parentElement.style.height = Math.max(160, 60 + 22 * labels.length) + "px";
  const ends = intervalOf ? labels.flatMap((_, k) => intervalOf(k) ?? []) : [];  // the whiskers stay within the chart
  const whole = ends.length ? { suggestedMin: Math.min(...ends), suggestedMax: Math.max(...ends), ...range } : range;
  return new Chart(canvas, {
    type: "bar",
    data: { labels, datasets: [{ data: values, backgroundColor: colours, maxBarThickness: 18 }] },
    options: { indexAxis: "y", scales: { x: axis(axisTitle, whole), y: { ticks: { autoSkip: false } } },
      plugins: { legend: { display: false }, tooltip: { callbacks: { label: (t) => tip(t.parsed.x, t.dataIndex) } } } },
    plugins: intervalOf ? [{
      afterDatasetsDraw: (chart) => {
        const pen = chart.ctx;
        pen.save();
        pen.strokeStyle = css("--ink");
        pen.lineWidth = 1.5;
        pen.beginPath();
        chart.getDatasetMeta(0).data.forEach((bar, k) => {
          const interval = intervalOf(k);
          if (!interval) return;
          const [from, to] = interval.map((x) => chart.scales.x.getPixelForValue(x));
          pen.moveTo(from, bar.y); pen.lineTo(to, bar.y);
          for (const x of [from, to]) { pen.moveTo(x, bar.y - 4); pen.lineTo(x, bar.y + 4); }
        });
        pen.stroke();
        pen.restore();
      } }] : [],
  });
};
