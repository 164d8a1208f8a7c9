// What the report, the survey and its scores share: elements of the page, colours and bars with whiskers.
"use strict";
const element = (name, attributes = {}, ...children) => {
  const e = document.createElement(name);
  for (const [key, v] of Object.entries(attributes)) if (v != null) e.setAttribute(key, v);
  e.append(...children.filter((c) => c != null));
  return e;
};
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const hues = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#b8a800"]; // [Okabe 2008]

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
  return new Chart(canvas, {
    type: "bar",
    data: { labels, datasets: [{ data: values, backgroundColor: colours, maxBarThickness: 18 }] },
    options: { indexAxis: "y", scales: { x: axis(axisTitle, range), y: { ticks: { autoSkip: false } } },
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
