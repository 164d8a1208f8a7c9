// The report's page: everything is drawn from the JSON in #data, which `aaresolve report` wrote. No network, no storage.
"use strict";
(() => {
  const { run, order, words, protocol, space, reference, region, figures, advice, publishedMemory: published } = JSON.parse(document.getElementById("data").textContent);
  const $ = (id) => document.getElementById(id);
  const methods = run.methods;
  const standIn = run.run.reference;  // the method that the others are held against; undefined: the truth
  const measured = (m) => m.frames.filter((f) => f.metrics);

  // ---- numbers ----
  const millionths = (v) => { const n = value(v) * 1e6; return Number.isFinite(n) ? (n >= 1000 ? n.toFixed(0) : Number(n.toPrecision(3)).toString()) : fixed(v, 0); };
  const psnr = (mse) => (mse > 0 ? -10 * Math.log10(mse) : Infinity);

  // ---- header and words ----
  $("shot").textContent = run.shot.name;
  $("subtitle").textContent = "Anti-aliasing methods" + (methods.some((m) => m.pooled) ? " against " + reference : "") + ", " + run.shot.resolution.join(" × ") + ", " +
    (run.shot.static ? "static" : "moving") + " shot" + (methods.some((m) => m.pooled) ? "" : " without ground truth");
  $("words").append(...words.map((w) => element("li", {}, ...breakable(w))));
  // The sentences name the first pairs that are not told apart; here are all, of each method the others.
  const whys = [["truthNoise", "The truth’s noise hides it"], ["varies", "Now one is better, now the other"], ["tooSmall", "Too little picture to judge"], ["equal", "The same picture but for rounding"]]
    .filter(([why]) => run.pairs.some((p) => !p.resolved && p.unresolved === why));
  const unresolvedPairs = run.pairs.filter((p) => !p.resolved);
  if (unresolvedPairs.length) {
    const box = $("unresolved-pairs"), others = (i, why) => order.filter((k) => unresolvedPairs.some((p) => p.unresolved === why && ((p.indices[0] === i && p.indices[1] === k) || (p.indices[0] === k && p.indices[1] === i))));
    box.hidden = false;
    box.querySelector("summary").textContent = `All pairs that are not told apart: ${unresolvedPairs.length} of ${run.pairs.length}`;
    box.addEventListener("toggle", () => { // thousands of names are made only for whoever asks
      const table = box.querySelector("table");
      if (table.childElementCount) return;
      table.append(element("thead", {}, element("tr", {}, ...["Method", ...whys.map(([, words]) => words)].map((w) => element("th", { scope: "col" }, w)))),
        element("tbody", {}, ...order.filter((i) => unresolvedPairs.some((p) => p.indices.includes(i))).map((i) => element("tr", {}, element("th", { scope: "row" }, ...breakable(methods[i].text)),
          ...whys.map(([why]) => element("td", {}, others(i, why).map((k) => methods[k].text).join(", ") || "–"))))));
    });
  }
  $("advice").append(...advice.map((w) => element("li", {}, ...breakable(w))));
  $("advice-box").hidden = !advice.length;
  $("version").textContent = run.run.program;

  // ---- the table of figures ----
  const size = run.shot.resolution.join("\u00a0×\u00a0"), pixels = run.shot.resolution[0] * run.shot.resolution[1];
  const perPixel = (m, seconds) => seconds * 1e9 / pixels;
  const megabytes = (bytes) => (bytes / 1e6).toFixed(2);
  const pair = (a, b) => run.pairs.find((p) => (p.indices[0] === a && p.indices[1] === b) || (p.indices[0] === b && p.indices[1] === a));
  const noaa = methods.findIndex((m) => m.id === "noaa");
  // The comparison of a with b, whichever way round it was stored: gains are positive where a is nearer to the truth.
  const compared = (a, b) => {
    const p = a !== b && a >= 0 && b >= 0 && pair(a, b);
    if (!p) return null;
    const turned = p.indices[0] !== a, of = (key) => (turned ? -value(p[key]) : value(p[key]));
    const low = of(turned ? "gainHigh95" : "gainLow95"), high = of(turned ? "gainLow95" : "gainHigh95");
    return { gain: of("gainDb"), low, high, resolved: p.resolved, why: p.unresolved };
  };
  const pooled = (key) => (m) => (m.pooled ? value(m.pooled[key]) : null);
  const has = (key) => methods.some((m) => m.pooled && m.pooled[key] != null);
  // The graphics device that ran the methods or was timed beside the processor. Software is never shown as a card.
  const device = run.run.device;
  const onDevice = device && `ms ${device.kind === "cpu" ? "in software" : "on the GPU"} (${device.name})`;
  const deviceMs = (m) => (m.deviceSecondsMedian == null ? null : m.deviceSecondsMedian * 1000);
  const columns = [
    { title: "PSNR, dB", better: "high", about: "peak signal to noise: how near the pixels are to " + reference + ", pooled over the judged frames", get: pooled("psnr"), show: (m) => (m.pooled ? fixed(m.pooled.psnr, 2) : m.text === standIn ? "reference" : "–"),
      // What the truth's own noise takes off the MSE: the PSNR lies between the two.
      small: (m) => (m.pooled && m.pooled.mseCorrected > 0 && m.pooled.mseCorrected < value(m.pooled.mse)
        ? "to " + fixed(psnr(m.pooled.mseCorrected), 2) : null) },
    { title: "Over noaa, dB", better: "high", about: "PSNR less that of noaa, which has no anti-aliasing; below it the 95 % interval. Coloured where it is resolved", get: pooled("gainDb"), show: (m) => (m.pooled && m.pooled.gainDb != null && m.id !== "noaa" ? signed(m.pooled.gainDb) : "–"),
      tone: (m, i) => (m.id === "noaa" ? "" : gainTone(m.pooled?.gainDb, compared(i, noaa)?.resolved)),
      small: (m, i) => doubt(compared(i, noaa)) },
    { title: "To the next better, dB", about: "PSNR less that of the method with the next higher PSNR; below it the 95 % interval of this difference", get: (m, i) => { const g = toNext(i); return g ? g.gain : null; },
      show: (m, i) => { const g = toNext(i); return g ? signed(g.gain) : "–"; },
      small: (m, i) => doubt(toNext(i)?.doubt) },
    // Every other figure of the program's table that this run holds.
    ...figures.map((f) => has(f.name) && { title: f.title, better: f.better, get: pooled(f.name),
      about: f.about + (f.spread ? "; below it its quartiles over the picture" : "") + (methods.some((m) => m.pooled && m.pooled[f.name] == null) ? "; –: has no value for this method" : ""),
      show: (m) => inForm(f, m.pooled?.[f.name]),
      small: f.spread && ((m) => (m.pooled?.[f.spread[0]] == null ? null : f.spread.map((name) => Number(value(m.pooled[name]).toPrecision(2))).join(" · "))) }),
    { title: "MSE, 10⁻⁶", better: "low", about: "mean squared error, of which PSNR is the logarithm" + (run.truth.noiseMse > 0 ? "; ±: by how much the truth’s own noise can change it" : ""), get: pooled("mse"), show: (m) => (m.pooled ? millionths(m.pooled.mse) : "–"),
      small: () => (run.truth.noiseMse > 0 ? "± " + millionths(run.truth.noiseMse) : null) },
    { title: "SNR, dB", better: "high", about: "signal to noise: as PSNR, but against the truth’s own mean square in place of full white", get: pooled("snr"), show: (m) => (m.pooled ? fixed(m.pooled.snr, 2) : "–") },
    methods.some((m) => m.nsPerPixel > 0) && { title: "Time, ns/px", better: "low", about: "processor time of the method alone, all threads together, per pixel; below it the quartiles over the frames", get: (m) => m.nsPerPixel || null,
      show: (m) => (m.nsPerPixel > 0 ? short(m.nsPerPixel) : "–"), small: (m) => (m.timings > 1 ? `${short(perPixel(m, m.secondsLow))} to ${short(perPixel(m, m.secondsHigh))}` : "measured once") },
    device && { title: onDevice, better: "low", about: "by the device’s own clock, without transfers", get: deviceMs, show: (m) => (deviceMs(m) == null ? "–" : short(deviceMs(m))) },
    { title: "State, MB", better: "low", about: "memory that the method keeps between frames and works in, at this picture’s size", get: (m) => m.stateBytes, show: (m) => megabytes(m.stateBytes) },
  ].filter(Boolean);
  const ranked = methods.map((m, i) => i).filter((i) => methods[i].pooled).sort((a, b) => value(methods[a].pooled.mse) - value(methods[b].pooled.mse));
  function toNext(i) {
    const place = ranked.indexOf(i);
    if (place < 1) return null;
    const p = pair(i, ranked[place - 1]);
    const held = p && compared(i, ranked[place - 1]);
    return { gain: held?.why === "equal" ? 0 : value(methods[i].pooled.psnr) - value(methods[ranked[place - 1]].pooled.psnr), doubt: held };
  }
  const methodTable = (table, shown, columns) => sortableTable(table, shown, columns, (i) => methods[i], (m) => [...breakable(m.text), element("small", {}, m.title)]);
  const told = (table, columns) => table.closest(".scroll").after(columnNotes(columns));
  told($("figures"), methodTable($("figures"), order, columns));
  const judgedFrames = methods.find((m) => m.pooled)?.pooled.frames ?? 0;
  $("figures-note").textContent = judgedFrames
    ? `Figures of ${space}${region ? `, of the region of ${region} alone` : ""}, pooled over ${judgedFrames} frame${judgedFrames > 1 ? "s" : ""} with ${standIn ? "images of " + reference : "ground truth"}: the mean squared error is averaged, never the decibels. ` +
      (order.some((i) => columns[0].small(methods[i])) ? "Under a PSNR, “to”: what it is once the truth’s own noise is taken off. " : "") + "Under a gain stands its 95 % interval, for pictures like this one and an exact truth; where it holds 0 the gain is not resolved, and the table says why: " +
      "most of the doubt is the truth’s noise (more samples help), or the difference varies over the picture (more pictures help), or the picture is too small to judge, or both are the same picture but for rounding." +
      (figures.some((f) => f.spread) ? " Under FLIP: 1st quartile, median and 3rd quartile, weighted by the error." : "") +
      " Time: processor time of all threads; below it the quartiles over frames." + (run.run.load?.busy ? " The machine was busy." : "")
    : "This run has no ground truth, so only times are known.";

  // ---- over time ----
  const time = (i) => methods[i].temporal || {};
  // The stale colour is known only where the frame before has truth, too, and no age is older than the shot.
  const oldest = Math.max(0, ...methods.map((m) => (m.temporal?.ghostFraction ?? []).findLastIndex((v) => v !== 0) + 1));
  for (const m of methods) if (m.temporal?.ghostFraction) {
    m.temporal.ghostFraction.length = Math.min(m.temporal.ghostFraction.length, oldest);
    if (!oldest) {
      delete m.temporal.ghostFraction;
      delete m.temporal.ghostHalfLifeFrames;
    }
  }
  const timed = order.filter((i) => methods[i].temporal);
  const flickerOf = (i) => value(run.shot.static ? time(i).flickerStatic : time(i).flickerMoving);
  const flickerError = (i) => (run.shot.static ? null : time(i).flickerError);
  const judgedHave = (key) => timed.some((i) => time(i)[key] != null);
  const timeColumn = (title, key, digits, about, more = {}) => judgedHave(key) && { title, better: "low", about, get: (m) => (m.temporal ? value(m.temporal[key]) : null),
    show: (m) => (m.temporal && m.temporal[key] != null ? (digits == null ? short(m.temporal[key]) : fixed(m.temporal[key], digits)) : "–"), ...more };
  const plusMinus = (key) => (m) => (m.temporal && m.temporal[key] > 0 ? "± " + Number(m.temporal[key].toPrecision(2)) : null);
  // Against noaa, over time: "fewer dB" reads better as a factor.
  const versusNoaa = (key) => (m, i) => { const p = i !== noaa && noaa >= 0 && pair(i, noaa); return p && p[key] && !p[key].resolved ? "not resolved from noaa" : null; };
  const ghostAt = (age) => age <= oldest && { title: `Stale at age ${age}`, better: "low",
    about: `share of the colour seen before that is left ${age === 1 ? "in the first frame" : `${age} frames`} after a surface came into view: 1 all of it, 0 none, below 0 the picture lies beyond the truth, on the side away from the old colour`,
    get: (m) => (m.temporal && m.temporal.ghostFraction ? m.temporal.ghostFraction[age - 1] ?? null : null),
    show: (m) => (m.temporal && m.temporal.ghostFraction && m.temporal.ghostFraction[age - 1] != null ? minus(fixed(m.temporal.ghostFraction[age - 1], 2)) : "–") };
  const lasting = (t) => t.ghostFraction && Math.max(...t.ghostFraction.slice(0, 3)) > 0.05;
  const timeColumns = [
    timeColumn("Flicker at rest", "flickerStatic", 3, "mean standard deviation of a pixel’s brightness over time, 8-bit codes"),
    timeColumn("Flicker in motion", "flickerMoving", 3, "root mean square of what changes along the motion beyond what the truth changes, 8-bit codes; ±: 95 % interval", { small: plusMinus("flickerError") }),
    timeColumn("Ghost MSE, 10⁻⁶", "ghostMse", null, "mean squared error where a surface came into view at most 16 frames ago; ±: 95 % interval", { show: (m) => (m.temporal && m.temporal.ghostMse != null ? millionths(m.temporal.ghostMse) : "–"),
      small: (m) => (m.temporal && m.temporal.ghostMseError > 0 ? "± " + millionths(m.temporal.ghostMseError) : null) }),
    timeColumn("Ghosts, × noaa", "ghostExcess", 2, "that error as a multiple of the one without anti-aliasing at the same places; above 1 it drags old colour", { small: versusNoaa("ghost") }),
    ghostAt(1), ghostAt(4), ghostAt(16),
    timeColumn("Half-life, frames", "ghostHalfLifeFrames", 1, "after how many frames half of a ghost is gone; –: no ghost to speak of", { show: (m) => (m.temporal && m.temporal.ghostHalfLifeFrames != null && lasting(m.temporal) ? fixed(m.temporal.ghostHalfLifeFrames, 1) : "–") }),
    timeColumn("tPSNR, dB", "tPsnr", 2, "PSNR pooled over these frames alone, without those in which histories fill", { better: "high" }),
    timeColumn("Converged after, frames", "convergenceFrames", 0, "from which frame on PSNR stays within 0.5 dB of its last value"),
  ].filter(Boolean);
  // Without truth most of it is not known, of a moving shot nothing.
  const judged = timed.filter((i) => timeColumns.some((c) => c.get(methods[i], i) != null));
  $("time").hidden = !judged.length;
  if (judged.length) {
    const there = methodTable($("time-figures"), judged, timeColumns), has = (start) => there.some((c) => c.title.startsWith(start));
    told($("time-figures"), there);
    const subjects = [["Flicker", "flicker"], ["Ghost", "ghosts"], ["Converged", "convergence"]].filter(([start]) => has(start)).map(([, words]) => words);
    $("time-title").textContent = "Over time" + (subjects.length ? ": " + subjects.join(", ").replace(/, ([^,]*)$/, " and $1") : "");
    const t = time(judged[0]);
    $("time-note").textContent = `Over ${t.frames} frames, after ${t.warmupFrames} that each history needs to fill. Flicker is in 8-bit codes: 1 is one step of 255. ` +
      (run.shot.static
        ? "Nothing moves here, so whatever changes from frame to frame is flicker: the mean standard deviation of a pixel's brightness. The truth has 0."
        : "Flicker in motion follows each surface and counts what changes beyond what the truth changes. Ghosts are the errors where a surface came into view at most 16 frames ago; “× noaa” compares them with the same places without anti-aliasing. ± is a 95 % interval over blocks of frames.");
    $("flicker-title").textContent = run.shot.static ? "Flicker of a scene at rest: shorter is steadier" : "Flicker along the motion: shorter is steadier";
    $("flicker-note").textContent = (run.shot.static ? "Mean standard deviation over time, 8-bit codes." : "Root mean square of the change that the truth does not have, 8-bit codes; whiskers: 95 % interval.") +
      (run.shot.static
        ? " Methods without history read the same picture in every frame of a scene at rest, so they do not flicker here; in motion they do."
        : " A spatial method flickers when edges step from pixel to pixel; a heavy history hardly flickers, but blurs and lags.");
    $("flicker").closest("figure").classList.toggle("wide", !judgedHave("ghostFraction"));
    $("frames-title").textContent = run.shot.static ? "Convergence: PSNR against the frame number" : "PSNR of every frame";
    $("frames-note").textContent = (run.shot.static
      ? "A method with history gets better from frame to frame until its history is full; “converged” is the frame from which it stays within 0.5 dB of its last value."
      : "A dip means that something came into view or moved fast.");
  }

  // ---- the price in full ----
  // Render seconds by pass group: what has no group of its own comes with the colour's render.
  const renderSeconds = run.shot.renderSeconds || {};
  const priceOf = (i) => {
    const m = methods[i], centre = m.sampling === "centre" && renderSeconds["centre.color"] != null ? "centre." : "";
    const groups = new Set(["color", ...m.passes.map((p) => (p.startsWith("subsample") ? "subsamples" : p))]);
    if (renderSeconds[centre + "color"] == null) return null;
    const render = [...groups].reduce((sum, g) => sum + (renderSeconds[centre + g] ?? 0), 0);
    return { render, all: render + (m.secondsMedian || (m.deviceSecondsMedian ?? 0)) };
  };
  const S = run.shot.subSamples || 0;
  const passBytes = (m) => (!m.inputBytes ? null : m.inputBytes - (m.passes.includes("color") ? 12 * pixels : 0));
  // Inputs, written picture and state, beyond those of a method that hands the picture on.
  const bytesOf = (m) => (m.inputBytes ?? 0) + (m.targetBytes ?? 0) + m.stateBytes;
  const beyondNoaa = (m) => bytesOf(m) - bytesOf(methods[noaa]);
  // Borders and what a method keeps whatever the size are not to be scaled: these are of this size alone.
  const memory = (title, about, get, more = {}) => ({ title: `${title} at ${size}, MB`, better: "low", about, get, show: (m) => (get(m) == null ? "–" : megabytes(get(m))), ...more });
  const publishedMemory = (m) => published[m.id]?.megabytes ?? null;
  told($("price-figures"), methodTable($("price-figures"), order, [
    { title: "Passes, s per frame", better: "low", about: "render time of colour and of every pass that the method reads", get: (m, i) => priceOf(i)?.render ?? null },
    methods.some((m) => m.nsPerPixel > 0) && { title: "Method, ms per frame", better: "low", about: "processor time of the method alone", get: (m) => m.secondsMedian * 1000 || null },
    device && { title: "Method, " + onDevice, better: "low", about: "the method alone, by the device’s own clock", get: deviceMs },
    memory("Kept", "history and working memory of the method", (m) => m.stateBytes),
    memory("Passes", "what the method reads beside colour, in 32-bit floats" + (S ? ` with ${S} sub-samples per pixel` : "") + "; below it all that it reads", passBytes, { small: (m) => m.passes.join(", ") }),
    noaa >= 0 && memory("All beyond noaa", "passes with colour, the written picture and what is kept, less those of noaa", beyondNoaa),
    { title: "Published extra at 1920 × 1080, MB", better: "low", about: "extra memory of a GPU implementation as its authors state it, in MB of 2²⁰ bytes where others here are of 10⁶" + (Object.keys(published).length ? " (" + [...new Set(Object.values(published).map((p) => p.source))].join(", ") + ")" : "") +
      ", which packs its buffers more tightly and counts its render targets; –: none is published", get: publishedMemory, show: (m) => (publishedMemory(m) == null ? "–" : publishedMemory(m).toFixed(1)) },
  ].filter(Boolean)));
  $("price-note").textContent = Object.keys(renderSeconds).length ? "" : "This shot does not say how long its passes took to render, so their time is not in the table; shots that the add-on exports say it.";

  // ---- charts ----
  const looks = methodLooks(methods.map((m) => m.id));
  const colourOf = (i) => looks[i].colour;
  window.aaLooks = new Map(methods.map((m, i) => [m.text, looks[i]])); // for what is drawn after this
  let charts = [];
  const drawn = new Map(); // rows that a chart of lines shows, kept when it is drawn anew
  // Names beside points, each where it covers least: another name, a point, what lies beyond the axes.
  const namesOfPoints = (datasets) => ({
    id: "names",
    afterDatasetsDraw: (chart) => {
      const pen = chart.ctx, area = chart.chartArea, high = 14;
      const boxes = chart.data.datasets.flatMap((d, k) => (d.pointRadius > 0 ? chart.getDatasetMeta(k).data.map((p) => ({ x: p.x - 7, y: p.y - 7, w: 14, h: 14 })) : []));
      const common = (a, b) => Math.max(0, Math.min(a.x + a.w, b.x + b.w) - Math.max(a.x, b.x)) * Math.max(0, Math.min(a.y + a.h, b.y + b.h) - Math.max(a.y, b.y));
      const whole = { x: area.left, y: area.top, w: area.right - area.left, h: area.bottom - area.top };
      pen.save();
      pen.font = `600 12px ${Chart.defaults.font.family}`;
      pen.textBaseline = "top";
      pen.lineJoin = "round";
      chart.names = [];
      for (const k of datasets) {
        const [p] = chart.getDatasetMeta(k).data, text = chart.data.datasets[k].label, lines = [inLines(text, Math.min(220, 0.45 * whole.w), pen.font)].flat();
        const w = Math.max(...lines.map((line) => pen.measureText(line).width)), h = high * lines.length;
        const offers = [[-w / 2, -11 - h], [11, -h / 2], [-11 - w, -h / 2], [-w / 2, 10], [4, -11 - h], [-4 - w, -11 - h], [4, 10], [-4 - w, 10], [-w / 2, -26 - h], [-w / 2, 25]];
        const cost = (b) => 5 * (b.w * b.h - common(b, whole)) + 3 * chart.names.reduce((s, n) => s + common(b, n), 0) + boxes.reduce((s, o) => s + common(b, o), 0);
        const best = offers.map(([dx, dy]) => ({ text, x: p.x + dx, y: p.y + dy, w, h })).reduce((a, b) => (cost(b) < cost(a) ? b : a));
        chart.names.push(best);
        // No name is cut, even where there is no room beside its point.
        const x = Math.max(0, Math.min(best.x, chart.width - w)), y = Math.max(0, Math.min(best.y, chart.height - h));
        lines.forEach((line, n) => {
          pen.lineWidth = 4;
          pen.strokeStyle = css("--panel");
          pen.strokeText(line, x, y + n * high);
          pen.fillStyle = css("--ink");
          pen.fillText(line, x, y + n * high);
        });
      }
      pen.restore();
    },
  });
  const drawCharts = () => {
    charts.forEach((c) => c.destroy());
    charts = [];
    dressCharts();
    const finite = (v) => (Number.isFinite(value(v)) ? value(v) : null);
    const shown = order.filter((i) => methods[i].pooled && finite(methods[i].pooled.psnr) !== null);
    const show = (id, config) => {
      charts.push(new Chart($(id), config));
      return charts.at(-1);
    };
    $("charts").hidden = !shown.length;
    // Cost against accuracy, for each of the costs that the run holds. The line joins the methods that no other one
    // beats in both: whoever is below and right of it costs more than one that is better.
    const front = (priced, costOf) => {
      let best = -Infinity;
      return priced.slice().sort((a, b) => costOf(a) - costOf(b) || value(methods[b].pooled.psnr) - value(methods[a].pooled.psnr))
        .filter((i) => value(methods[i].pooled.psnr) > best && ((best = value(methods[i].pooled.psnr)), true));
    };
    const scatter = (id, costOf, axisTitle, unit) => {
      const priced = shown.filter((i) => costOf(i) > 0);
      $(id).closest("figure").hidden = !priced.length;
      if (!priced.length) return;
      const point = (i) => ({ x: costOf(i), y: value(methods[i].pooled.psnr) }), best = front(priced, costOf);
      const steps = best.flatMap((i, k) => (k ? [{ x: costOf(i), y: value(methods[best[k - 1]].pooled.psnr) }, point(i)] : [point(i)]));
      show(id, {
        type: "scatter",
        data: { datasets: [...priced.map((i) => ({ label: methods[i].text, data: [point(i)],
          pointRadius: best.includes(i) ? 8 : 6, pointHoverRadius: 9, ...markerOptions(looks[i]) })),
          { label: "best for its cost", data: steps, showLine: true, borderColor: css("--quiet"), borderWidth: 1.5, borderDash: [4, 3], pointRadius: 0, pointHoverRadius: 0, pointHitRadius: 0, pointStyle: "line" }] },
        options: { scales: { x: logarithmicAxis(axisTitle + " (logarithmic)", priced.map(costOf)), y: axis("PSNR, dB", { grace: "8%" }) },
          plugins: { ...legendBelow({ usePointStyle: true }),
            tooltip: { callbacks: { label: (t) => tipLines(t, `${t.dataset.label}: ${t.parsed.x.toPrecision(3)} ${unit}, ${t.parsed.y.toFixed(2)} dB`) } } } },
        plugins: [namesOfPoints(best.map((i) => priced.indexOf(i)))],
      });
    };
    scatter("scatter", (i) => methods[i].nsPerPixel, "processor time, ns per pixel", "ns/px");
    if (device) {
      $("device-title").textContent = device.kind === "cpu" ? "Shaders in software against accuracy" : "GPU time against accuracy: up and left is better";
      $("device-note").textContent = `${device.name}, ${device.precision}; by the device's own clock, without transfers.` +
        (device.kind === "cpu" ? " Software on the processor, which checks the shaders: these are no card's times." : "");
      scatter("device-scatter", (i) => deviceMs(methods[i]), onDevice, "ms");
    }
    const bars = (id, indices, get, axisTitle, colour, tip, errorOf, intervalOf) => {
      $(id).closest("figure").hidden = !indices.length;
      if (!indices.length) return;
      charts.push(barChart($(id), { labels: indices.map((i) => methods[i].text), values: indices.map(get), colours: indices.map(colour), axisTitle,
        tip: (v, k) => tip(v, indices[k]),
        intervalOf: intervalOf ? (k) => intervalOf(indices[k]) : errorOf && ((k) => { const e = errorOf(indices[k]), v = get(indices[k]); return e > 0 ? [Math.max(0, v - e), v + e] : null; }) }));
    };
    bars("gain", order.filter((i) => i !== noaa && methods[i].pooled && methods[i].pooled.gainDb != null && finite(methods[i].pooled.gainDb) !== null),
      (i) => methods[i].pooled.gainDb, "dB",
      (i) => { const c = compared(i, noaa); return c && !c.resolved ? css("--quiet") : methods[i].pooled.gainDb >= 0 ? css("--better") : css("--worse"); },
      (v, i) => `${signed(v)} dB` + [doubt(compared(i, noaa))].flat().filter(Boolean).map((s) => `, ${s}`).join(""), null,
      (i) => { const c = compared(i, noaa); return c && c.why !== "tooSmall" && c.why !== "equal" && c.low != null && !Number.isNaN(c.low) ? [c.low, c.high] : null; });
    // Lines of many methods: a few are drawn and named; which, is chosen under the chart.
    const kLines = 8;
    const lines = (id, indices, labels, dataOf, xTitle, yAxis, tip, preferred = indices.slice(0, kLines)) => {
      const figure = $(id).closest("figure");
      figure.hidden = !indices.length;
      if (!indices.length) return;
      const few = new Set([...preferred, ...indices.filter((i) => i === noaa)]);
      if (!drawn.has(id)) drawn.set(id, new Set(few));
      const now = drawn.get(id);
      const chart = show(id, {
        type: "line",
        data: { labels, datasets: indices.map((i) => ({ label: methods[i].text, data: dataOf(i), hidden: !now.has(i), borderDash: looks[i].dash, borderWidth: 2, pointRadius: labels.length > 40 ? 0 : 3, spanGaps: true, ...markerOptions(looks[i]) })) },
        options: { interaction: { mode: "index", intersect: false }, scales: { x: axis(xTitle), y: yAxis },
          plugins: { ...legendBelow({ usePointStyle: true, filter: (item) => !item.hidden, onClick: (_, item) => choose((i) => i !== indices[item.datasetIndex] && now.has(i)) }),
            tooltip: { itemSort: (a, b) => b.parsed.y - a.parsed.y, callbacks: { label: (t) => tipLines(t, `${t.dataset.label}: ${tip(t.parsed.y)}`) } } } },
      });
      figure.querySelector("details.lines")?.remove();
      if (indices.length < 2) return;
      const boxes = indices.map((i) => Object.assign(element("input", { type: "checkbox" }), { checked: now.has(i) })), head = element("summary");
      const choose = (wanted) => {
        now.clear();
        indices.forEach((i, k) => {
          if ((boxes[k].checked = wanted(i, k))) now.add(i);
        });
        indices.forEach((i, k) => chart.setDatasetVisibility(k, now.has(i)));
        chart.update();
        say();
      };
      const say = () => (head.textContent = now.size === indices.length ? `All ${indices.length} methods are drawn; choose some` : `${now.size} of ${indices.length} methods are drawn; choose others`);
      boxes.forEach((box) => box.addEventListener("change", () => choose((_, k) => boxes[k].checked)));
      const button = (text, wanted) => Object.assign(element("button", { type: "button" }, text), { onclick: () => choose(wanted) });
      say();
      figure.append(element("details", { class: "lines" }, head, element("p", {}, button("These few", (i) => few.has(i)), " ", button("All", () => true), " ", button("None", () => false)),
        element("div", { class: "choices" }, ...indices.map((i, k) => element("label", {}, boxes[k], element("i", { style: `background: ${colourOf(i)}` }), methods[i].text)))));
    };
    const numbers = [...new Set(methods.flatMap((m) => measured(m).map((f) => f.frame)))].sort((a, b) => a - b);
    lines("frames", numbers.length > 1 ? order.filter((i) => measured(methods[i]).length) : [], numbers, (i) => {
      const byFrame = new Map(measured(methods[i]).map((f) => [f.frame, finite(f.metrics.psnr)]));
      return numbers.map((n) => byFrame.get(n) ?? null);
    }, "frame", axis("PSNR, dB", { grace: "5%" }), (v) => v.toFixed(2) + " dB");
    bars("flicker", judged.filter((i) => (run.shot.static ? flickerOf(i) > 0 : flickerOf(i) != null)).sort((a, b) => flickerOf(a) - flickerOf(b)), flickerOf, "8-bit codes",
      (i) => (i === noaa ? css("--quiet") : css("--accent")), (v, i) => `${v.toPrecision(3)}${flickerError(i) ? " ± " + flickerError(i).toPrecision(2) : ""} codes`, flickerError);
    const ages = Math.max(0, ...judged.map((i) => (time(i).ghostFraction || []).length));
    const ghosting = ages ? judged.filter((i) => time(i).ghostFraction).sort((a, b) => value(time(a).ghostMse) - value(time(b).ghostMse)) : [];
    const withHistory = ghosting.filter((i) => methods[i].family === "temporal"); // the least and the worst of them
    lines("ghost", ghosting, Array.from({ length: ages }, (_, k) => k + 1), (i) => time(i).ghostFraction, "age, frames", axis("share of the stale colour left"),
      (v) => v.toFixed(3), [...withHistory.slice(0, kLines / 2), ...withHistory.slice(-kLines / 2)]);
    scatter("price-scatter", (i) => priceOf(i)?.all ?? 0, "seconds per frame: passes and method", "s");
  };
  drawCharts();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawCharts);

  // ---- what was run ----
  const facts = [
    ["Shot", `${run.shot.name}, ${run.shot.resolution.join(" × ")}, ${run.shot.static ? "static" : "moving"}`],
    ["Jitter", run.shot.jitter.period > 1
      ? `${run.shot.jitter.sequence}, from index ${run.shot.jitter.start}, period ${run.shot.jitter.period}; mean of a block ` +
        `(${run.shot.jitter.meanPx.map((v) => v.toFixed(4)).join(", ")}) px, ${run.shot.jitter.centred ? "centred" : "not centred"}`
      : "none"],
    ["Truth", standIn ? `not used: ${standIn}, a method of this run, stands in for it` : Object.keys(run.truth.images).length || run.truth.noiseMse != null
      ? (run.truth.samplesPerHalf > 0 ? `two halves of ${run.truth.samplesPerHalf} samples per pixel` : "exact coverage") +
        `, ${run.truth.filter} filter ${run.truth.filterWidthPx} px` +
        (run.truth.noiseMse > 0 ? `; its own noise is an MSE of ${short(run.truth.noiseMse)} (${fixed(psnr(run.truth.noiseMse), 2)} dB)` : "")
      : "none"],
    ["Protocol", protocol + (run.run.warmUpFrames ? `; ${run.run.warmUpFrames} frames ran before the first judged one` : "")],
    ["Display", `exposure ${run.run.display.exposureEv} EV, tone map ${run.run.display.toneMap}, ` +
      (run.run.display.transfer === "identity" ? "clamped values shown as they are" : "sRGB")],
    run.run.shownOn && ["JOD as seen on", `${run.run.shownOn.words}; ${short(run.run.shownOn.framesPerSecond)} frames per second`],
    run.run.flipPixelsPerDegree && ["FLIP as seen at", `${short(run.run.flipPixelsPerDegree)} pixels per degree`],
    run.truth.clipped && ["Truth clipped", `${run.truth.clipped.pixels} of ${run.truth.clipped.of} pixels exceed the display`],
    ["Machine", `${run.run.machine}, ${run.run.instructionSet}, ${run.run.threads} thread${run.run.threads > 1 ? "s" : ""}, precision ${run.run.precision}`],
    run.run.load && ["Machine's load", `${run.run.load.before.toFixed(2)} of ${run.run.load.processors} processors before the run` +
      (run.run.load.waitedShare != null ? `; methods waited for one ${(100 * run.run.load.waitedShare).toFixed(0)} % of their time` : "")],
    ["Program", `AA Resolve ${run.run.program}`],
    ["Input repaired", Object.entries(run.run.sanitised).filter(([, n]) => n > 0).map(([what, n]) => `${what} ${n}`).join(", ") || "nothing"],
    run.shot.renderSeconds && ["Render time per frame", Object.entries(run.shot.renderSeconds).map(([what, s]) => `${what} ${short(s)} s`).join(", ")],
  ].filter(Boolean);
  $("run").append(...facts.flatMap(([name, text]) => [element("dt", {}, name), element("dd", {}, text)]));
  $("parameters").append(
    element("thead", {}, element("tr", {}, ...["Method", "Parameters", "Passes read", "Source"].map((t) => element("th", { scope: "col" }, t)))),
    element("tbody", {}, ...order.map((i) => {
      const m = methods[i];
      return element("tr", {}, element("th", { scope: "row" }, ...breakable(m.text)),
        element("td", {}, Object.entries(m.parameters).map(([k, v]) => `${k} = ${v}`).join(", ") || "none"),
        element("td", {}, m.passes.join(", ")), element("td", {}, m.source));
    })));
  document.querySelectorAll(".scroll").forEach(tellOfMoreColumns);
})();
