// The page of several runs: everything is drawn from the JSON in #data, which `aaresolve report RUN RUN...` wrote.
"use strict";
(() => {
  const { words, runs, figures, rows, against } = JSON.parse(document.getElementById("data").textContent);
  const $ = (id) => document.getElementById(id);
  const range = (i) => (i ? intervalText({ low: i[0], high: i[1] }) : null);
  const headOf = (row) => [...breakable(row.text), element("small", {}, row.title)];
  const headOfRun = (r) => (r.report ? element("a", { href: r.report.split("/").map(encodeURIComponent).join("/") }, r.name) : r.name);
  const shots = [...new Set(runs.map((r) => r.shot))], oneScene = shots.length === 1;
  // What gains are over has none; among them it stands where they turn negative, by 0 dB.
  const isBaseline = (r) => r.id === "noaa" && r.mean == null;
  const scenesOf = (r) => (isBaseline(r) ? new Set(runs.filter((_, k) => r.cells[k]?.rank).map((run) => run.shot)).size : r.scenes);
  const gainOf = (r) => (isBaseline(r) ? 0 : value(r.mean?.gain));
  const all = rows.map((_, i) => i).filter((i) => !isBaseline(rows[i]));
  const baseline = rows.findIndex(isBaseline);
  if (baseline >= 0) {
    const after = all.findIndex((i) => rows[i].mean == null || value(rows[i].mean.gain) < 0 || rows[i].scenes + rows[i].infinite < scenesOf(rows[baseline]));
    all.splice(after < 0 ? all.length : after, 0, baseline);
  }

  $("title").textContent = oneScene ? `Runs of ${shots[0]}` : "Methods over scenes";
  $("subtitle").append(...runs.flatMap((r, k) => [k ? ", " : "", headOfRun(r)]));
  $("words").append(...words.map((w) => element("li", {}, w)));

  // ---- mean over scenes ----
  const resolved = (i) => Boolean(i) && (value(i[0]) > 0 || value(i[1]) < 0);
  const median = (list) => { const v = list.filter((x) => x > 0).sort((a, b) => a - b); return v.length ? (v[(v.length - 1) >> 1] + v[v.length >> 1]) / 2 : null; };
  const time = (row) => median(row.cells.map((c) => c?.nsPerPixel));
  const averaged = all.filter((i) => rows[i].mean != null);
  const mean = sortableTable($("mean"), all, [
    { title: oneScene ? "Gain over noaa, dB" : "Mean gain over noaa, dB", better: "high", about: "PSNR less that of noaa, which has no anti-aliasing; below it the 95 % interval. Coloured where it is resolved",
      get: gainOf, show: (r) => (isBaseline(r) ? "0" : r.mean == null ? "–" : signed(r.mean.gain)), tone: (r) => gainTone(r.mean?.gain, r.mean?.resolved),
      small: (r) => (isBaseline(r) ? "what gains are over" : doubt(r.mean)) },
    { title: "Scenes like these, dB", better: "high", about: "interval of the mean gain over other scenes of the kind, by how the gains scatter from scene to scene; from four scenes up",
      get: (r) => (r.ofSuch ? value(r.ofSuch[0]) : null), show: (r) => range(r.ofSuch) ?? "–", small: (r) => (r.ofSuch && !resolved(r.ofSuch) ? "not resolved" : null) },
    !oneScene && { title: "Worst and best scene, dB", about: "the least and the largest gain", better: "high", get: (r) => (r.scenes ? value(r.least) : null), show: (r) => (r.scenes ? `${signed(r.least)} to ${signed(r.most)}` : "–") },
    { title: oneScene ? "Rank" : "Mean rank", better: "low", about: "place by MSE among the methods of a run" + (oneScene ? "" : ", mean over the scenes"), get: (r) => r.rank, show: (r) => (r.rank == null ? "–" : fixed(r.rank, oneScene ? 0 : 1)) },
    !oneScene && { title: "Scenes", better: "high", about: "how many scenes the mean is of", get: scenesOf, show: (r) => String(scenesOf(r)), small: (r) => (r.infinite ? `and ${r.infinite} without error` : null) },
    { title: "Time, ns/px", better: "low", about: "processor time of the method alone per pixel, median over the runs", get: time },
  ], (i) => rows[i], headOf);
  $("mean").closest(".scroll").after(columnNotes(mean));
  $("mean-title").textContent = oneScene ? "Gain over no anti-aliasing" : "Mean over the scenes";
  $("scenes-title").textContent = oneScene ? "Run by run" : "Scene by scene";
  $("gains-title").textContent = (oneScene ? "Gain" : "Mean gain") + " over no anti-aliasing, dB";
  $("mean-note").textContent = oneScene ? "All runs are of one scene: of a method that several of them have the last counts that knows its gain, and nothing is said of other scenes." : "Scenes differ in how hard they are, so differences to no anti-aliasing are averaged, in dB, and never PSNR itself. Under the mean: its 95 % interval over these scenes, from the intervals of each. " +
    (mean.some((c) => c.title.startsWith("Scenes like")) ? "“Scenes like these”: the interval for other scenes of the kind, by how the gains scatter from scene to scene. " : "From four scenes up a second interval says what other scenes of the kind would give. ") + "A scene in which a method equals the truth has an infinite gain and is counted apart. Of several runs of one scene the last counts that knows the gain. Time: median over the runs.";
  const looks = methodLooks(rows.map((r) => r.id));
  let chart = null;
  const drawChart = () => {
    chart?.destroy();
    dressCharts();
    $("gains").closest("figure").hidden = !averaged.length;
    if (!averaged.length) return;
    chart = barChart($("gains"), { labels: averaged.map((i) => rows[i].text), values: averaged.map((i) => value(rows[i].mean.gain)),
      colours: averaged.map((i) => (rows[i].mean.resolved ? looks[i].colour : css("--quiet"))), axisTitle: "dB",
      tip: (v, k) => [`${signed(v)} dB`, ...doubt(rows[averaged[k]].mean).filter(Boolean)].join(", "),
      intervalOf: (k) => { const m = rows[averaged[k]].mean, ends = [m.low, m.high].map(value); return ends.some(Number.isFinite) ? ends : null; } });
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
    ? { title: runs[k].name, keep: true, better: "high", get: (r) => (cellOf(r, k)?.gain ? value(cellOf(r, k).gain.gain) : null),
        show: (r) => { const c = cellOf(r, k); return c?.gain ? signed(c.gain.gain) : c?.reference ? "reference" : "–"; },
        tone: (r) => gainTone(cellOf(r, k)?.gain?.gain, cellOf(r, k)?.gain?.resolved),
        small: (r) => { const c = cellOf(r, k); return c && [doubt(c.gain), c.rank ? `place ${c.rank}` : null].flat(); } }
    : { title: runs[k].name, keep: true, better: f.better, get: (r) => value(cellOf(r, k)?.[f.name]), show: (r) => inForm(f, cellOf(r, k)?.[f.name]) };
  const drawScenes = () => {
    const f = choices.find((c) => c.name === $("figure").value);
    if (!f) { $("scenes-section").hidden = true; return; }
    sortableTable($("scenes"), all, runs.map((_, k) => columnOf(f, k)), (i) => rows[i], headOf);
    $("scenes-note").textContent = f.note ?? (f.about ? f.about[0].toUpperCase() + f.about.slice(1) + "." : "");
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
        tone: (c) => gainTone(c.comparison.gain, c.comparison.resolved), small: (c) => (c.comparison.why === "equal" ? null : doubt(c.comparison)) },
      { title: "Time before, ns/px", better: "low", get: (c) => c.nsPerPixelBefore || null },
      { title: "after, ns/px", better: "low", get: (c) => c.nsPerPixelAfter || null,
        small: (c) => (c.nsPerPixelBefore > 0 && c.nsPerPixelAfter > 0 ? "× " + (c.nsPerPixelAfter / c.nsPerPixelBefore).toPrecision(3) : null) },
    ], (i) => a.changes[i], (c) => breakable(c.text));
    const notes = [...a.differences, a.onlyBefore.length ? "only before: " + a.onlyBefore.join(", ") : null, a.onlyAfter.length ? "only after: " + a.onlyAfter.join(", ") : null].filter(Boolean);
    return element("div", {}, element("h3", {}, `${runs[a.after].name} against ${runs[a.before].name}`),
      element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": `${runs[a.after].name} against ${runs[a.before].name}` }, table),
      notes.length ? element("p", { class: "quiet" }, "What else differs: " + notes.join("; ") + ".") : null);
  }));

  // ---- what was run ----
  $("runs").append(...runs.flatMap((r) => [element("dt", {}, headOfRun(r)),
    element("dd", {}, `${r.line}; ${r.frames} frame${r.frames === 1 ? "" : "s"} judged; ${r.protocol}; AA Resolve ${r.program}`)]));
  document.querySelectorAll(".scroll").forEach(tellOfMoreColumns);
})();
