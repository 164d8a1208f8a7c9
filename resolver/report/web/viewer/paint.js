// Pictures and maps as canvases of their own size, one per picture, drawn by writing codes: nothing between the code and
// the screen's pixel manages colours, scales or blends. What a map shows, how it is scaled and what its mean is called
// stand in one table.
"use strict";
const viewerPaint = (pictures, data, run, { errorScale, errorColours, space }) => {
  const ROOM = 400e6; // bytes of canvases
  const FLICKER_SCALE = 16; // codes, lightest at gain 1

  // The scale's end shrinks as the gain (the exposure) grows.
  const end = (v, ev) => Number((v / 2 ** ev).toPrecision(3)).toString();
  const kinds = {
    picture: { name: "Picture", key: "p" },
    signed: { name: "Difference, signed", key: "d", against: true, scale: (ev) => ({ from: "−" + end(errorScale, ev), middle: "0", to: "+" + end(errorScale, ev), ramp: "grey", of: `difference per channel of ${space} 0 to 1` }) },
    absolute: { name: "Difference, absolute", key: "a", against: true, scale: (ev) => ({ from: "0", to: "≥ " + end(errorScale, ev), ramp: "grey", of: `absolute difference per channel of ${space} 0 to 1` }) },
    error: { name: "Error", key: "e", against: true, mean: "RMSE", scale: (ev) => ({ from: "0", to: "≥ " + end(errorScale, ev), ramp: "error", of: `error per pixel of ${space} 0 to 1, RMS over R, G, B` }) },
    ssim: { name: "SSIM map", key: "m", against: true, heavy: true, mean: "SSIM", scale: (ev) => ({ from: "1", to: "≤ " + end(2 ** ev - 1, ev), ramp: "error", of: "structural similarity of luma, 1 = alike" }) },
    flip: { name: "FLIP map", key: "l", against: true, heavy: true, mean: "FLIP", scale: (ev) => ({ from: "0", to: (ev > 0 ? "≥ " : "") + end(1, ev), ramp: "error", of: "LDR-FLIP at 67 pixels per degree" }) },
    flicker: { name: "Flicker map", key: "k", heavy: true, overTime: true, mean: "flicker", scale: (ev) => ({ from: "0", to: "≥ " + end(FLICKER_SCALE, ev), ramp: "error",
      of: run.shot.static ? "standard deviation of luma over all frames, 8-bit codes" : "steps of luma from frame to frame that the reference does not make at the same pixel, RMS over all frames, 8-bit codes" }) },
    xt: { name: "Slice x–t", key: "x", heavy: true, overTime: true, slice: true },
    yt: { name: "Slice y–t", key: "y", heavy: true, overTime: true, slice: true },
  };

  const little = new Uint8Array(new Uint32Array([1]).buffer)[0] === 1;
  const opaque = (r, g, b) => (little ? (0xff000000 | (b << 16) | (g << 8) | r) >>> 0 : ((r << 24) | (g << 16) | (b << 8) | 0xff) >>> 0);
  const ramp = Uint32Array.from(errorColours, ([r, g, b]) => opaque(r, g, b));
  const canvasOf = (w, h, fill) => {
    const canvas = document.createElement("canvas");
    canvas.width = w;
    canvas.height = h;
    const image = new ImageData(w, h);
    fill(new Uint32Array(image.data.buffer));
    canvas.getContext("2d", { colorSpace: "srgb" }).putImageData(image, 0, 0);
    return canvas;
  };
  const ofCodes = (w, h, codes) => canvasOf(w, h, (out) => {
    for (let i = 0, k = 0; i < out.length; i++, k += 3) out[i] = opaque(codes[k], codes[k + 1], codes[k + 2]);
  });
  const ofMap = (map, at) => canvasOf(map.w, map.h, (out) => {
    const last = ramp.length - 1;
    for (let i = 0; i < out.length; i++) out[i] = ramp[Math.min(last, Math.max(0, Math.round(at(map.values[i]) * last)))];
  });

  // ---- maps, remembered whatever the gain ----
  const mapOf = ({ view, kind, source, against, frame }) => {
    const key = ["map", kind, view, source, against, kinds[kind].overTime ? "all" : frame].join("/");
    return pictures.remembered(key, (m) => (m ? m.values.byteLength : 0), () => {
      if (kind === "flicker") {
        // As the program does: without the first frames, in which a history fills.
        const late = run.methods[0].frames[run.methods.find((m) => m.temporal)?.temporal.warmupFrames ?? 0]?.frame ?? -Infinity;
        const frames = data.views[view].frames.filter((f) => f >= late && pictures.has(view, source, f));
        const judged = run.shot.static ? frames : frames.filter((f) => pictures.has(view, against, f));
        if (judged.length < 2) return null;
        return viewerMeasure.flicker(judged.map((f) => pictures.get(view, source, f)), run.shot.static ? null : judged.map((f) => pictures.get(view, against, f)));
      }
      const test = pictures.get(view, source, frame), reference = pictures.get(view, against, frame);
      if (!test || !reference) return null;
      if (kind === "error") return viewerMeasure.rms(test, reference);
      if (kind === "ssim") return viewerMeasure.ssim(test, reference);
      const seen = (s, picture) => pictures.remembered(["seen", view, s, frame].join("/"), () => picture.w * picture.h * 40, () => viewerFlip.seen(picture));
      return viewerFlip.map(test.w, test.h, seen(source, test), seen(against, reference));
    });
  };
  // What the label says of a map: its mean under its name.
  const meanOf = (what, area) => {
    const kind = kinds[what.kind];
    if (!kind.mean) return null;
    if (what.kind === "error") {
      const test = pictures.get(what.view, what.source, what.frame), reference = pictures.get(what.view, what.against, what.frame);
      return test && reference && Math.sqrt(viewerMeasure.mse(test, reference, area));
    }
    const map = mapOf(what);
    return map && viewerMeasure.meanOf(map, area);
  };

  // ---- slices: one row or column of every frame, each frame thick enough for the eye ----
  const thickness = (view, kind) => {
    const [, , w, h] = data.views[view].window;
    return Math.max(1, Math.round((kind === "xt" ? h : w) / data.views[view].frames.length));
  };
  const slice = ({ view, kind, source, ev, row, column }) => {
    const { frames, window: [, , w, h] } = data.views[view], thick = thickness(view, kind);
    const shown = frames.map((f) => { const p = pictures.get(view, source, f); return p && { w, codes: p.codes, picture: p }; });
    const codes = new Map(shown.filter(Boolean).map((s) => [s, pictures.exposed(s.picture, ev)]));
    const long = frames.length * thick, [cw, ch] = kind === "xt" ? [w, long] : [long, h];
    return canvasOf(cw, ch, (out) => {
      for (let y = 0; y < ch; y++)
        for (let x = 0; x < cw; x++) {
          const from = shown[Math.floor((kind === "xt" ? y : x) / thick)];
          if (!from) { out[y * cw + x] = opaque(64, 64, 64); continue; }
          const k = 3 * (kind === "xt" ? row * w + x : y * w + column), c = codes.get(from);
          out[y * cw + x] = opaque(c[k], c[k + 1], c[k + 2]);
        }
    });
  };

  const paint = (what) => {
    const { kind, view, source, against, frame, ev } = what;
    if (kinds[kind].slice) return slice(what);
    const gain = 2 ** ev;
    if (kind === "picture") {
      const picture = pictures.get(view, source, frame);
      return picture && ofCodes(picture.w, picture.h, pictures.exposed(picture, ev));
    }
    if (kind === "signed" || kind === "absolute") {
      const test = pictures.get(view, source, frame), reference = pictures.get(view, against, frame);
      if (!test || !reference) return null;
      const t = test.values, r = reference.values, codes = new Uint8ClampedArray(t.length), f = (255 * gain) / errorScale;
      if (kind === "absolute") for (let i = 0; i < codes.length; i++) codes[i] = Math.abs(t[i] - r[i]) * f;
      else for (let i = 0; i < codes.length; i++) codes[i] = 127.5 + (t[i] - r[i]) * f * 0.5;
      return ofCodes(test.w, test.h, codes);
    }
    const map = mapOf(what);
    if (!map) return null;
    return ofMap(map, kind === "ssim" ? (v) => (1 - v) * gain : kind === "flip" ? (v) => v * gain : kind === "flicker" ? (v) => (v * gain) / FLICKER_SCALE : (v) => (v * gain) / errorScale);
  };

  const kept = new Map();
  let bytes = 0;
  const keyOf = (w) => [w.kind, w.view, w.source, kinds[w.kind].against || w.kind === "flicker" ? w.against : "", kinds[w.kind].overTime ? "" : w.frame, w.ev,
    w.kind === "xt" ? w.row : w.kind === "yt" ? w.column : ""].join("/");
  const ready = (what) => kept.has(keyOf(what));
  // Null: there is nothing to show (no truth in this frame).
  const canvas = (what) => {
    const key = keyOf(what);
    let entry = kept.get(key);
    if (entry) kept.delete(key);
    else {
      const made = paint(what);
      entry = { made, size: made ? made.width * made.height * 4 : 0 };
      bytes += entry.size;
    }
    kept.set(key, entry);
    for (const [oldest, { size }] of kept) {
      if (bytes <= ROOM || oldest === key) break;
      kept.delete(oldest);
      bytes -= size;
    }
    return entry.made;
  };
  return { kinds, canvas, ready, meanOf, mapOf, thickness, ofCodes };
};
