// The page of a survey's scores: everything is drawn from the JSON in #data, which `aaresolve survey score` wrote.
"use strict";
(() => {
  const { scores, pictures } = JSON.parse(document.getElementById("data").textContent);
  const $ = (id) => document.getElementById(id);
  const number = (v, digits = 2) => (v == null ? "–" : typeof v === "string" ? v : v.toFixed(digits).replace("-", "−"));
  const short = (v) => (v == null ? "–" : typeof v === "string" ? v : String(Number(v.toPrecision(4))).replace("-", "−"));
  const percent = (v) => (100 * v).toFixed(1) + " %";
  const isShare = (set) => set.score === "share of wins";
  const scoreText = (set, v) => (isShare(set) ? percent(v) : number(v));
  const interval = (e, show) => (e && e.low95 != null ? `${show(e.low95)} to ${show(e.high95)}` : "no interval");
  const people = (n) => `${n} participant${n === 1 ? "" : "s"}`;
  const plural = (list) => (list.length > 1 ? "s " : " ") + list.join(", ");
  const nameOf = (set) => "Question" + plural(set.questions);

  // ---- header and words ----
  $("survey").textContent = scores.title;
  $("subtitle").textContent = `${people(scores.participants)}, ${scores.sets.reduce((n, s) => n + s.questions.length, 0)} questions; survey ${scores.survey}`;
  $("words").append(...scores.notes.map((n) => element("li", { class: "unresolved" }, n[0].toUpperCase() + n.slice(1) + ".")),
    ...scores.sets.map((set) => {
      const [best, second] = set.pictures;
      const told = (p) => (p.resolved ? "told apart" : "not resolved");
      return element("li", {}, `${nameOf(set)} (${set.shot}): ${best.method} is best, ${scoreText(set, best.score.value)}` +
        (best.score.low95 != null ? ` (${interval(best.score, (v) => scoreText(set, v))})` : "") +
        (second ? `; next ${second.method}, ${scoreText(set, second.score.value)}: ${told(second)}.` : "."));
    }));

  // ---- a set ----
  const rankHues = ["#0072b2", "#56b4e9", "#b8b8b8", "#e69f00", "#d55e00"]; // [Okabe 2008], best to worst
  const chartCanvas = (label) => element("canvas", { role: "img", "aria-label": label + "; the same figures are in the table below" });
  const figure = (caption, canvas, note, wide) => element("figure", { class: wide ? "wide" : null }, element("figcaption", {}, caption), element("div", { class: "chart" }, canvas),
    note ? element("p", { class: "quiet" }, note) : null);
  const table = (heads, rows) => [element("thead", {}, element("tr", {}, ...heads.map((h) => element("th", { scope: "col" }, h)))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((cell, k) => {
      const [text, small] = Array.isArray(cell) ? cell : [cell];
      return element(k ? "td" : "th", { scope: k ? null : "row" }, ...breakable(text), small ? element("small", { class: small === "not resolved" ? "unresolved" : null }, small) : null);
    }))))];
  const figureNames = (set) => {
    const names = new Map();
    for (const of of ["shown", "run"]) for (const p of set.pictures) for (const name of Object.keys(p[of])) {
      const a = set.agreement.find((x) => x.figure === name && x.of === of);
      if (a) names.set(of + "." + name, { of, name, title: `${a.title}, ${of}` });
    }
    return [...names.values()];
  };
  const drawers = [];
  const counted = (set) => set.kind !== "pair";
  $("sets").append(...scores.sets.map((set, s) => {
    const labels = set.pictures.map((p) => p.method), id = "set-" + s;
    const scoreCanvas = chartCanvas("Score of every method"), shareCanvas = chartCanvas("Shares of every method");
    const ranks = counted(set) ? set.pictures[0].counts.map((_, r) => r + 1) : [];
    drawers.push(() => {
      const whiskers = (k) => { const e = set.pictures[k].score; return e.low95 != null ? [e.low95, e.high95] : null; };
      const drawn = [barChart(scoreCanvas, { labels, values: set.pictures.map((p) => p.score.value), colours: set.pictures.map((p) => (p.toNextBetter && !p.resolved ? css("--quiet") : css("--accent"))),
        axisTitle: set.score, tip: (v, k) => `${scoreText(set, v)}, ${interval(set.pictures[k].score, (x) => scoreText(set, x))}`, intervalOf: whiskers,
        range: set.kind === "rank" ? { min: 1, max: ranks.length } : set.kind === "rating" ? { min: 1, max: 5 } : isShare(set) ? { min: 0, max: 1 } : {} })];
      if (counted(set)) {
        const rows = namedRows(shareCanvas, labels, 90);
        const hueOf = (r) => rankHues[Math.round((set.kind === "rank" ? r : ranks.length - 1 - r) * (rankHues.length - 1) / Math.max(1, ranks.length - 1))];
        drawn.push(new Chart(shareCanvas, { type: "bar",
          data: { labels, datasets: ranks.map((r, k) => ({ label: set.kind + " " + r, data: set.pictures.map((p) => 100 * p.shares[k]), backgroundColor: hueOf(k), maxBarThickness: 18 })) },
          options: { indexAxis: "y", scales: { x: axis("% of participants", { stacked: true, max: 100 }), y: { stacked: true, ticks: rows.ticks } },
            onResize: rows.onResize,
            plugins: { legend: { position: "bottom", labels: { boxWidth: 10, boxHeight: 10 } }, tooltip: { callbacks: { label: (t) => `${t.dataset.label}: ${t.parsed.x.toFixed(1)} %` } } } } }));
      }
      return drawn;
    });
    const names = figureNames(set);
    const heads = ["Method", set.score[0].toUpperCase() + set.score.slice(1), "To the next better", ...(counted(set) ? ranks.map((r) => `${set.kind} ${r}`) : ["Won"]), ...names.map((n) => n.title)];
    const rows = set.pictures.map((p) => [p.method, [scoreText(set, p.score.value), interval(p.score, (v) => scoreText(set, v))],
      p.toNextBetter ? [scoreText(set, p.toNextBetter.value), p.resolved ? null : "not resolved"] : "–",
      ...(counted(set) ? p.counts.map((c, r) => [percent(p.shares[r]), `${c}`]) : [[percent(p.winShare.value), `${p.won} of ${p.asked}` + (isShare(set) ? "" : `; by Wilson ${interval(p.winShare, percent)}`)]]),
      ...names.map((n) => short(p[n.of][n.name]))]);
    const facts = [set.run, set.frames.length > 1 ? `frames ${set.frames[0]} to ${set.frames.at(-1)}, played` : `frame ${set.frames[0]}`,
      `${set.region[2]} × ${set.region[3]} px at ${set.region[0]}, ${set.region[1]}` + (set.zoom > 1 ? `, × ${set.zoom}` : ""), `median ${number(set.secondsMedian, 0)} s`];
    if (set.kendallW != null) facts.push(`participants agree with each other: Kendall's W ${number(set.kendallW)} of 1`);
    if (set.meanRankByPlace) facts.push("mean rank by place on the screen: " + set.meanRankByPlace.map((v, k) => `${String.fromCharCode(65 + k)} ${number(v)}`).join(", "));
    const strip = set.pictures.filter((p) => pictures[p.code]).map((p, k) => element("figure", {}, element("img", { src: pictures[p.code], alt: p.method, width: set.region[2] * set.zoom, height: set.region[3] * set.zoom }),
      element("figcaption", {}, `${k + 1}. ${p.method}: ${scoreText(set, p.score.value)}`)));
    return element("section", { id, "aria-labelledby": id + "-title" }, element("h2", { id: id + "-title" }, nameOf(set) + ": " + set.shot),
      set.text ? element("p", {}, "“" + set.text + "”") : null,
      element("p", { class: "quiet" }, facts.join("; ") + "."),
      strip.length ? element("div", { class: "strip scroll", tabindex: "0", role: "region", "aria-label": "Pictures, best first" }, ...strip) : null,
      element("div", { class: "charts below" },
        figure(set.kind === "rank" ? "Score: shorter is better" : "Score: longer is better", scoreCanvas, `Whiskers: 95 %, ${isShare(set) ? "by Wilson" : "over participants"}. Grey: not resolved from the one above.`, !counted(set)),
        counted(set) ? figure("What participants gave", shareCanvas) : null),
      element("div", { class: "scroll below", tabindex: "0", role: "region", "aria-labelledby": id + "-title" }, element("table", {}, ...table(heads, rows))),
      element("details", {}, element("summary", {}, "Two by two"), element("div", { class: "scroll below" }, element("table", {}, ...table(["First", "Second", "Prefer the first", "95 %, Wilson"],
        set.pairs.map((p) => [p.first, p.second, percent(p.firstWins.value), interval(p.firstWins, percent)]))))));
  }));

  // ---- agreement ----
  const title = (a) => `${a.title}, ${a.of}`;
  const known = scores.agreement.filter((a) => a.kendallTau);
  $("agreement").hidden = !known.length;
  if (known.length) {
    drawers.push(() => [barChart($("taus"), { labels: known.map(title), values: known.map((a) => a.kendallTau.value), colours: known.map((a) => (a.kendallTau.value < 0 ? css("--worse") : css("--better"))),
      axisTitle: "Kendall's τ", tip: (v, k) => `τ ${number(v)}, ${interval(known[k].kendallTau, number)}; ${known[k].pairs} pairs`, range: { min: -1, max: 1 },
      intervalOf: (k) => { const e = known[k].kendallTau; return e.low95 != null ? [e.low95, e.high95] : null; } })]);
    const estimate = (e) => (e ? [number(e.value), interval(e, number)] : "–");
    const rows = (where, list) => list.filter((a) => a.kendallTau).map((a) => [title(a), where, String(a.pairs), estimate(a.kendallTau), estimate(a.spearmanRho)]);
    $("agreements").append(...table(["Metric", "Questions", "Pairs", "Kendall’s τ", "Spearman’s ρ"],
      [...rows("all", scores.agreement), ...scores.sets.flatMap((set) => rows(set.questions.join(", "), set.agreement))]));
  }
  document.querySelectorAll(".scroll:not(.strip)").forEach(tellOfMoreColumns);
  let charts = [];
  const draw = () => {
    charts.forEach((c) => c.destroy());
    dressCharts();
    charts = drawers.flatMap((d) => d());
  };
  draw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
})();
