// The section "The accuracy that speed costs": drawn from the JSON in #stability-data, which `aaresolve stability` measured.
"use strict";
(() => {
  const study = JSON.parse(document.getElementById("stability-data").textContent);
  const inRun = new Set(JSON.parse(document.getElementById("data").textContent).run.methods.map((m) => m.text));
  const measured = new Set(study.methods.map((m) => m.method));
  // Those of the run, or all where none of it was measured.
  const shared = study.methods.filter((m) => inRun.has(m.method)), rows = shared.length ? shared : study.methods;
  const two = (v) => (v == null ? "–" : !Number.isFinite(value(v)) ? fixed(v, 0) : value(v) === 0 ? "0" : value(v) >= 1000 ? value(v).toFixed(0) : Number(value(v).toPrecision(2)).toString());
  const some = (get) => rows.some((m) => get(m) != null);

  const deviation = (title, key) => some((m) => m[key]) && { title, better: "low", get: (m) => (m[key] ? value(m[key].max) : null), show: (m) => two(m[key]?.max),
    small: (m) => m[key] && [`rms ${two(m[key].rms)}`, `${two(m[key].ulp)} ulp`, m[key].notFinite ? `${m[key].notFinite} not finite` : null] };
  // Three histories in one cell: 32-bit, 16-bit, 8-bit.
  const settling = (title, key, show) => some((m) => m.settling) && { title, better: "low", get: (m) => (m.settling ? Math.max(...Object.values(m.settling).map((s) => Math.abs(value(s[key])))) : null),
    show: (m) => (m.settling ? show(m.settling["32f"][key]) : "–"),
    small: (m) => m.settling && [["16f", "16-bit"], ["8", "8-bit"]].map(([bits, name]) => m.settling[bits] && `${name} ${show(m.settling[bits][key])}`) };
  const columns = [
    deviation("Float lanes, most", "float"), deviation("16-bit history", "history16"), deviation("8-bit history", "history8"),
    deviation("GPU exact", "gpuExact"), deviation("GPU fast", "gpuFast"),
    { title: "Light of 10⁻⁶ to 10⁶", better: "low", get: (m) => value(m.wideLight[m.wideLight.bound.of === "value" ? "ofValue" : "ofLargest"]),
      show: (m) => two(m.wideLight[m.wideLight.bound.of === "value" ? "ofValue" : "ofLargest"]), small: (m) => (m.wideLight.bound.of === "value" ? null : "of the largest around") },
    { title: "1 ulp becomes", better: "low", get: (m) => value(m.amplification.largest), show: (m) => two(m.amplification.largest) + " ulp",
      small: (m) => `rms ${two(m.amplification.rms[0])}, last ${two(m.amplification.rms.at(-1))}` },
    { title: "Ties", better: "low", get: (m) => m.ties.share, show: (m) => (m.ties.share ? two(100 * m.ties.share) + " %" : "0") },
    settling("Stall, codes", "stallCodes", (v) => fixed(v, 2)), settling("Banding, codes", "bandingCodes", (v) => fixed(v, 2)), settling("Drift", "drift", two),
    some((m) => m.recovery) && { title: "Recovers after, frames", better: "low", get: (m) => (m.recovery ? m.recovery.frames ?? Infinity : null),
      show: (m) => (m.recovery ? m.recovery.frames ?? "> " + m.recovery.tried : "–") },
  ].filter(Boolean);

  const missing = [...inRun].filter((text) => !measured.has(text)), { material, device } = study;
  const table = element("table", { id: "stability-figures" });
  document.getElementById("price").after(element("section", { id: "stability", "aria-labelledby": "stability-title" },
    element("h2", { id: "stability-title" }, "The accuracy that speed costs"),
    element("p", { class: "quiet" }, `Measured by “aaresolve stability” on ${material.words.replaceAll("`", "")}, ${material.resolution.join(" × ")}, ${material.frames} frames. ` +
      "Differences are from the same method in double, by max(1, value); ulp: units in the last place of float, within which 99 % of the values are."),
    element("div", { class: "scroll", tabindex: "0", role: "region", "aria-labelledby": "stability-title" }, table),
    element("p", { class: "quiet" }, "1 ulp becomes: the most that a change of every input value by one unit in the last place makes of the output, over all frames. Ties: pixels that jump when the input moves by 10⁻⁶ of itself. " +
      "Stall: what a history still misses of a step of 8 codes after 256 frames at rest; banding: steps on a slow gradient, in 8-bit codes; drift: relative change of the mean at rest; recovers: frames after a pixel of 10⁶ until nothing is left of it. " +
      (device ? `Shaders ran on ${device.name}${device.kind === "cpu" ? " (software)" : ""}. ` : `Shaders were left out: ${study.noDevice}. `) +
      (study.complete ? "" : "The measurement was interrupted. ") +
      (shared.length === 0 ? "None of this run’s methods was measured with its parameters; these are others." : missing.length ? `Not measured: ${missing.join(", ")}.` : ""))));
  sortableTable(table, rows.map((_, k) => k), columns, (k) => rows[k], (m) => [...breakable(m.method), element("small", {}, m.title)]);
  tellOfMoreColumns(table.closest(".scroll"));
})();
