// The section "Edges by direction": drawn from the JSON in #angles-data, which `aaresolve angles` measured.
"use strict";
(() => {
  const study = JSON.parse(document.getElementById("angles-data").textContent);
  const number = (v, digits = 2) => (Number.isFinite(v) ? v.toFixed(digits).replace("-", "−") : "–");
  const extreme = (m, better) => m.gainDb.reduce((best, v, k) => (best < 0 || better(v, m.gainDb[best]) ? k : best), -1);
  const at = (m, k) => `${number(m.gainDb[k])} at ${number(study.degrees[k], 1)}°`;

  const canvas = element("canvas", { id: "angles", role: "img", "aria-label": "PSNR gain of every method by the direction of the edge; pooled figures are in the table below" });
  const heads = ["Method", "Gain, dB", "Least", "Most", "Mirrored, dB", "Quarter turn, dB", "Sub-samples"];
  const table = element("table", {}, element("thead", {}, element("tr", {}, ...heads.map((h) => element("th", { scope: "col" }, h)))),
    element("tbody", {}, ...study.methods.map((m) => element("tr", {}, element("th", { scope: "row" }, ...breakable(m.text), element("small", {}, m.title)),
      ...[number(m.pooledGainDb), at(m, extreme(m, (a, b) => a < b)), at(m, extreme(m, (a, b) => a > b)), number(m.mirrorDb), number(m.turnDb), m.subsamples || "none"]
        .map((t) => element("td", {}, t))))));
  const section = element("section", { "aria-labelledby": "angles-title" }, element("h2", { id: "angles-title" }, "Edges by direction"),
    element("p", { class: "quiet" }, `One straight edge per picture, ${study.degrees.length} directions, ${study.offsets} sub-pixel offsets each, against its exact area: ` +
      `PSNR over no anti-aliasing. “Mirrored” and “quarter turn” are the largest differences of the gain between directions that a symmetric method treats alike.`),
    element("div", { class: "charts" }, element("figure", { class: "wide" }, element("figcaption", {}, "Gain by the direction of the edge’s normal; click a name to hide it"), element("div", { class: "chart" }, canvas))),
    element("div", { class: "scroll", tabindex: "0", role: "region", "aria-labelledby": "angles-title" }, table));
  document.getElementById("details").before(section);
  tellOfMoreColumns(table.closest(".scroll"));

  // As in the charts of the run, where the method is one of it.
  const own = methodLooks(study.methods.map((m) => methodIn(m.text))), looks = study.methods.map((m, i) => window.aaLooks?.get(m.text) ?? own[i]);
  let chart;
  const draw = () => {
    if (chart) chart.destroy();
    chart = new Chart(canvas, {
      type: "line",
      data: { datasets: study.methods.map((m, i) => ({ label: m.text, data: m.gainDb.map((y, k) => ({ x: study.degrees[k], y })), borderColor: looks[i].colour, backgroundColor: looks[i].colour,
        borderDash: looks[i].dash, borderWidth: 2, pointRadius: 0, pointHitRadius: 8 })) },
      options: { animation: false, maintainAspectRatio: false, interaction: { mode: "nearest", axis: "x", intersect: false },
        scales: { x: { type: "linear", min: 0, max: 360, ticks: { stepSize: 45 }, title: { display: true, text: "direction, degrees" } }, y: { title: { display: true, text: "gain, dB" } } },
        plugins: { ...legendBelow(), tooltip: { callbacks: { title: (t) => `${number(t[0].parsed.x, 1)}°`, label: (t) => tipLines(t, `${t.dataset.label}: ${number(t.parsed.y)} dB`) } } } },
    });
  };
  draw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => setTimeout(draw));
})();
