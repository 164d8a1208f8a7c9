// The page of several runs: everything is drawn from the JSON in #data, which `aaresolve report RUN RUN...` wrote.
"use strict";
(() => {
  const { words, runs, figures, rows, against } = JSON.parse(document.getElementById("data").textContent);
  const $ = (id) => document.getElementById(id);
  const range = (i) => (i ? `${signed(i[0])} to ${signed(i[1])}` : null);
  const headOf = (row) => [row.text, element("small", {}, row.title)];
  const all = rows.map((_, i) => i);

  $("subtitle").textContent = runs.map((r) => r.name).join(", ");
  $("words").append(...words.map((w) => element("li", {}, w)));

  // ---- mean over scenes ----
  const holdsZero = (i) => i && value(i[0]) <= 0 && value(i[1]) >= 0;
  const median = (list) => { const v = list.filter((x) => x > 0).sort((a, b) => a - b); return v.length ? (v[(v.length - 1) >> 1] + v[v.length >> 1]) / 2 : null; };
  const time = (row) => median(row.cells.map((c) => c?.nsPerPixel));
  const averaged = all.filter((i) => rows[i].mean != null);
  sortableTable($("mean"), all, [
    { title: "Mean gain over noaa, dB", better: "high", get: (r) => value(r.mean), show: (r) => (r.mean == null ? "–" : signed(r.mean)),
      tone: (r) => (r.mean == null ? "" : value(r.mean) >= 0 ? "better" : "worse"),
      small: (r) => (r.mean == null ? null : [range(r.ofThese) ?? "no interval", holdsZero(r.ofThese) ? "not resolved" : null]) },
    { title: "Scenes like these, dB", better: "high", get: (r) => (r.ofSuch ? value(r.ofSuch[0]) : null), show: (r) => range(r.ofSuch) ?? "–",
      small: (r) => (holdsZero(r.ofSuch) ? "not resolved" : null) },
    { title: "Worst and best scene, dB", better: "high", get: (r) => (r.scenes ? value(r.least) : null), show: (r) => (r.scenes ? `${signed(r.least)} to ${signed(r.most)}` : "–") },
    { title: "Mean rank", better: "low", get: (r) => r.rank, show: (r) => (r.rank == null ? "–" : fixed(r.rank, 1)) },
    { title: "Scenes", better: "high", get: (r) => r.scenes, show: (r) => String(r.scenes), small: (r) => (r.infinite ? `and ${r.infinite} without error` : null) },
    { title: "Time, ns/px", better: "low", get: time },
  ], (i) => rows[i], headOf);
  $("mean-note").textContent = "Scenes differ in how hard they are, so differences to no anti-aliasing are averaged, in dB, and never PSNR itself. Under the mean: its 95 % interval over these scenes, from the intervals of each. " +
    "“Scenes like these”: the interval for other scenes of the kind, by how the gains scatter from scene to scene; from four scenes up. A scene in which a method equals the truth has an infinite gain and is counted apart. Of several runs of one scene the last counts. Time: median over the runs.";
  let chart = null;
  const drawChart = () => {
    chart?.destroy();
    dressCharts();
    $("gains").closest("figure").hidden = !averaged.length;
    if (!averaged.length) return;
    chart = barChart($("gains"), { labels: averaged.map((i) => rows[i].text), values: averaged.map((i) => value(rows[i].mean)),
      colours: averaged.map((i) => (holdsZero(rows[i].ofThese) ? css("--quiet") : methodColour(rows[i].id))), axisTitle: "dB",
      tip: (v, k) => `${signed(v)} dB, ${range(rows[averaged[k]].ofThese) ?? "no interval"}`,
      intervalOf: (k) => rows[averaged[k]].ofThese?.map(value) ?? null });
  };
  drawChart();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawChart);

  // ---- scene by scene ----
  const cellOf = (row, k) => row.cells[k];
  const gain = { name: "gain", title: "Gain over noaa, dB", better: "high", note: "Below each gain: its 95 % interval, why it is not resolved where it is not, and the method’s place by MSE in that run." };
  const rest = [{ name: "flicker", title: "Flicker, 8-bit codes", better: "low", form: "significant" }, { name: "ghosts", title: "Ghosts, × noaa", better: "low", form: "significant" },
    { name: "nsPerPixel", title: "Time, ns/px", better: "low", form: "significant" }];
  const choices = [gain, ...figures, ...rest].filter((f) => rows.some((r) => r.cells.some((c) => c && c[f.name] != null)));
  $("figure").append(...choices.map((f) => element("option", { value: f.name }, f.title)));
  const columnOf = (f, k) => f === gain
    ? { title: runs[k].name, better: "high", get: (r) => (cellOf(r, k)?.gain ? value(cellOf(r, k).gain.gain) : null),
        show: (r) => { const c = cellOf(r, k); return c?.gain ? signed(c.gain.gain) : c?.reference ? "reference" : "–"; },
        tone: (r) => { const g = cellOf(r, k)?.gain; return !g || !g.resolved ? "" : value(g.gain) >= 0 ? "better" : "worse"; },
        small: (r) => { const c = cellOf(r, k); return c && [doubt(c.gain), c.rank ? `place ${c.rank}` : null].flat(); } }
    : { title: runs[k].name, better: f.better, get: (r) => value(cellOf(r, k)?.[f.name]), show: (r) => inForm(f, cellOf(r, k)?.[f.name]) };
  const drawScenes = () => {
    const f = choices.find((c) => c.name === $("figure").value);
    if (!f) { $("scenes-section").hidden = true; return; }
    sortableTable($("scenes"), all, runs.map((_, k) => columnOf(f, k)), (i) => rows[i], headOf);
    $("scenes-note").textContent = f.note ?? "";
  };
  $("figure").addEventListener("change", drawScenes);
  drawScenes();

  // ---- run against run ----
  $("against-section").hidden = !against.length;
  $("against").append(...against.map((a) => {
    const table = element("table");
    sortableTable(table, a.changes.map((_, i) => i), [
      { title: "PSNR before, dB", better: "high", get: (c) => value(c.psnrBefore), show: (c) => fixed(c.psnrBefore, 2) },
      { title: "after, dB", better: "high", get: (c) => value(c.psnrAfter), show: (c) => fixed(c.psnrAfter, 2) },
      { title: "Change, dB", better: "high", get: (c) => value(c.comparison.gain), show: (c) => (c.comparison.why === "equal" ? "equal" : signed(c.comparison.gain)),
        tone: (c) => (!c.comparison.resolved ? "" : value(c.comparison.gain) >= 0 ? "better" : "worse"), small: (c) => (c.comparison.why === "equal" ? null : doubt(c.comparison)) },
      { title: "Time before, ns/px", better: "low", get: (c) => c.nsPerPixelBefore || null },
      { title: "after, ns/px", better: "low", get: (c) => c.nsPerPixelAfter || null,
        small: (c) => (c.nsPerPixelBefore > 0 && c.nsPerPixelAfter > 0 ? "× " + (c.nsPerPixelAfter / c.nsPerPixelBefore).toPrecision(3) : null) },
    ], (i) => a.changes[i], (c) => [c.text]);
    const notes = [...a.differences, a.onlyBefore.length ? "only before: " + a.onlyBefore.join(", ") : null, a.onlyAfter.length ? "only after: " + a.onlyAfter.join(", ") : null].filter(Boolean);
    return element("div", {}, element("h3", {}, `${runs[a.after].name} against ${runs[a.before].name}`),
      element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": `${runs[a.after].name} against ${runs[a.before].name}` }, table),
      notes.length ? element("p", { class: "quiet" }, "What else differs: " + notes.join("; ") + ".") : null);
  }));

  // ---- what was run ----
  $("runs").append(...runs.flatMap((r) => [element("dt", {}, r.name),
    element("dd", {}, `${r.line}; ${r.frames} frame${r.frames === 1 ? "" : "s"} judged; ${r.protocol}; AA Resolve ${r.program}`)]));
})();
