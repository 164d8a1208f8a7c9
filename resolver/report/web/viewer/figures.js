// Under the stage: the exact values of every method at a pixel, and the figures of a region.
"use strict";
const viewerFigures = (values, regionBox, store, pictures, names, kinds) => {
  const { state, set } = store;
  const signed = (v) => (v > 0 ? "+" : v < 0 ? "−" : "±") + Math.abs(v);
  const short = (v) => (v === 0 ? "0" : Math.abs(v) >= 1e-4 ? Number(v.toPrecision(4)).toString() : v.toExponential(2).replace("-", "−"));
  const mark = (source) => element("i", { class: "mark", style: `background: ${names.colour(source)}` });

  // ---- values ----
  let due = 0;
  const drawValues = () => {
    const at = state.pin ?? state.hover, slice = kinds[state.kind].slice;
    const hint = values.querySelector(".hint"), list = values.querySelector(".list");
    if (!at || slice) {
      hint.textContent = slice ? "A slice shows one line of the picture in every frame; leave it with P for pixel values."
        : "Point at a pixel for the exact values of every method there; a click keeps it, arrow keys move it.";
      list.replaceChildren();
      return;
    }
    const [x, y] = at, [vx, vy] = names.window(), all = state.values === "all" ? names.all : state.shown;
    const reference = pictures.get(state.view, state.against, state.frame);
    const k = reference && 3 * (y * reference.w + x);
    hint.textContent = `Pixel ${x + vx}, ${y + vy}, frame ${state.frame}: R G B as 8-bit codes` + (names.floats ? " and linear light" : "") +
      `, difference from ${names.of(state.against)}` + (state.pin ? " (kept; Escape lets go)" : "");
    // Those not unpacked yet follow after the pointer has come to rest.
    const rows = [], later = [];
    for (const source of all) {
      if (!pictures.has(state.view, source, state.frame)) continue;
      if (!pictures.ready(state.view, source, state.frame) && later.push(source)) {
        rows.push(element("li", { "data-source": source }, mark(source), element("b", {}, names.of(source)), "…"));
        continue;
      }
      const p = pictures.get(state.view, source, state.frame), i = 3 * (y * p.w + x), c = p.codes.subarray(i, i + 3);
      const patch = element("i", { class: "patch", style: `background: rgb(${[...c]})` });
      const item = element("li", { "data-source": source, class: state.shown.includes(source) ? "shown" : null }, mark(source), element("b", {}, names.of(source)), patch,
        element("code", {}, [...c].map((v) => String(v).padStart(3, "\u2007")).join(" ")));
      if (p.linear) item.append(element("code", { class: "linear" }, [...p.linear.subarray(i, i + 3)].map(short).join(" ")));
      if (reference && source !== state.against)
        item.append(element("code", { class: "off" }, [0, 1, 2].map((d) => signed(c[d] - reference.codes[k + d]).padStart(4, "\u2007")).join(" ")));
      rows.push(item);
    }
    list.replaceChildren(...rows);
    if (later.length) {
      clearTimeout(due);
      due = setTimeout(() => {
        const began = performance.now();
        for (const source of later) { // some at a time: the page stays alive
          pictures.get(state.view, source, state.frame);
          if (performance.now() - began > 60) break;
        }
        drawValues();
      }, 60);
    }
  };
  const toggle = values.querySelector("button");
  toggle.addEventListener("click", () => set({ values: state.values === "all" ? "shown" : "all" }));

  // ---- region ----
  let regionRows = [], regionDue = 0;
  const drawRegion = () => {
    const { region, view, frame, against } = state;
    regionBox.hidden = !region;
    regionRows = [];
    if (!region) return;
    const [vx, vy] = names.window(), [x, y, w, h] = region, reference = pictures.get(view, against, frame);
    regionBox.querySelector("h3").textContent = `Region of ${w} × ${h} px at ${x + vx}, ${y + vy}, frame ${frame}`;
    const body = regionBox.querySelector("tbody"), note = regionBox.querySelector(".note");
    if (!reference) {
      body.replaceChildren();
      note.textContent = "No reference in this frame to hold them against.";
      return;
    }
    const there = names.all.filter((source) => source !== against && pictures.has(view, source, frame)), began = performance.now();
    for (const source of there) { // some at a time: the page stays alive
      if (performance.now() - began > 60 && !pictures.ready(view, source, frame)) {
        note.textContent = "Unpacking the pictures …";
        clearTimeout(regionDue);
        regionDue = setTimeout(drawRegion);
        return;
      }
      pictures.get(view, source, frame);
    }
    for (const source of there) {
      const mse = viewerMeasure.mse(pictures.get(view, source, frame), reference, region);
      regionRows.push({ source, name: names.of(source), mse, psnr: viewerMeasure.psnr(mse) });
    }
    regionRows.sort((a, b) => a.mse - b.mse);
    const plain = regionRows.find((r) => r.source === names.noaa), best = Math.max(...regionRows.map((r) => (Number.isFinite(r.psnr) ? r.psnr : 0)));
    body.replaceChildren(...regionRows.map((r) => element("tr", { "data-source": r.source, class: state.shown.includes(r.source) ? "shown" : null },
      element("th", { scope: "row" }, mark(r.source), ...breakable(r.name)),
      element("td", {}, Number.isFinite(r.psnr) ? r.psnr.toFixed(2) : "Inf"),
      element("td", {}, plain && r !== plain && Number.isFinite(r.psnr - plain.psnr) ? (r.psnr >= plain.psnr ? "+" : "−") + Math.abs(r.psnr - plain.psnr).toFixed(2) : "–"),
      element("td", {}, short(r.mse * 1e6)),
      element("td", { class: "bar" }, element("span", { style: `width: ${Number.isFinite(r.psnr) ? Math.max(0, (100 * r.psnr) / best) : 100}%; background: ${names.colour(r.source)}` })))));
    note.textContent = `Against ${names.of(against)}, from the ${names.floats ? "values of the EXR files" : "8-bit codes that are shown"}` +
      (names.floats ? "." : ": their rounding is worth an MSE of about 2.6 · 10⁻⁶, so that from 50 dB on a report --hdr is finer.");
  };
  regionBox.querySelector(".copy").addEventListener("click", () => {
    const text = ["method,psnr,mse", ...regionRows.map((r) => `${/[",]/.test(r.name) ? `"${r.name}"` : r.name},${r.psnr},${r.mse}`)].join("\n") + "\n";
    names.copy(text, "The region's figures are in the clipboard as CSV.");
  });
  regionBox.querySelector(".close").addEventListener("click", () => set({ region: null }));
  return { drawValues, drawRegion, rows: () => regionRows };
};
