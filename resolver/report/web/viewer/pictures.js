// The pictures of the page: {w, h, codes, values, linear?, displayReferred?} of a view, a frame and a source, unpacked
// when they are asked for and kept while there is room. A source is "truth" or a method's index.
"use strict";
const viewerPictures = (data, run) => {
  const ROOM = 600e6; // bytes of unpacked pictures, about a hundred of 1920 x 1080
  const display = run.run.display;
  const srgb = display.transfer !== "identity";
  const decodedOf = (v) => (!srgb ? v : v <= 0.04045 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4));
  const encodedOf = (v) => (!srgb ? v : v <= 0.0031308 ? 12.92 * v : 1.055 * Math.pow(v, 1 / 2.4) - 0.055);
  const clamped = (v) => (v > 0 ? (v < 1 ? v : 1) : 0); // NaN is 0
  const notNegative = (v) => (v > 0 ? v : 0);
  const toneMapped = (x) => {
    x = Math.min(x, 1e15);
    return display.toneMap === "reinhard" ? x / (1 + x) : display.toneMap === "aces" ? (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14) : x;
  };
  // What the program's display makes of linear light; a picture that is display-referred needs the transfer alone.
  const shownOf = (x, displayReferred) => encodedOf(clamped(displayReferred ? clamped(x) : toneMapped(notNegative(x * 2 ** display.exposureEv))));

  // The code of linear light: how many of the program's 255 thresholds it reaches.
  const thresholds = (data.thresholds ?? []).map((list) => Float64Array.from(list, (t) => (t === "Inf" ? Infinity : t)));
  const codeOf = (x, steps) => {
    let low = 0, high = 255;
    while (low < high) {
      const mid = (low + high) >> 1;
      if (x >= steps[mid]) low = mid + 1; else high = mid;
    }
    return low;
  };

  // Array.from() with a function takes ten times as long.
  const mapped = (Kind, from, of) => {
    const to = new Kind(from.length);
    for (let i = 0; i < to.length; i++) to[i] = of(from[i]);
    return to;
  };
  const unit = Float64Array.from({ length: 256 }, (_, c) => c / 255);

  const entries = data.views.map((view) => {
    const byPicture = new Map();
    for (const [frame, source, guess, displayReferred, fromFrame, fromSource] of view.pictures) {
      const name = (s) => (s < 0 ? "truth" : String(s));
      byPicture.set(frame + "/" + name(source), { guess, displayReferred, from: fromFrame == null ? null : [fromFrame, name(fromSource)] });
    }
    return byPicture;
  });

  const kept = new Map(); // the least recently used first
  let bytes = 0;
  const keep = (key, value, size) => {
    kept.set(key, { value, size });
    bytes += size;
    for (const [oldest, { size: freed }] of kept) {
      if (bytes <= ROOM || oldest === key) break;
      kept.delete(oldest);
      bytes -= freed;
    }
    return value;
  };
  const found = (key) => {
    const entry = kept.get(key);
    if (!entry) return null;
    kept.delete(key);
    kept.set(key, entry);
    return entry.value;
  };

  // A static shot's truth is of every frame. Null: this frame has none.
  const frameOf = (view, source, frame) => {
    if (entries[view].has(frame + "/" + source)) return frame;
    if (source === "truth" && run.shot.static) return data.views[view].frames.find((f) => entries[view].has(f + "/truth")) ?? null;
    return null;
  };
  const has = (view, source, frame) => frameOf(view, source, frame) !== null;

  const wordsOf = (view, source, frame) => {
    const key = `words/${view}/${frame}/${source}`, there = found(key);
    if (there) return there;
    const entry = entries[view].get(frame + "/" + source), [, , w, h] = data.views[view].window;
    const other = entry.from && wordsOf(view, entry.from[1], entry.from[0]);
    const text = document.getElementById(`picture-${view}-${frame}-${source}`).textContent;
    const words = viewerCodec.words(viewerCodec.bytesOf(text), w, h, data.floats ? 32 : 8, other, entry.guess === 1);
    return keep(key, words, words.byteLength);
  };
  const get = (view, source, frame) => {
    frame = frameOf(view, source, frame);
    if (frame === null) return null;
    const key = `picture/${view}/${frame}/${source}`, there = found(key);
    if (there) return there;
    const [, , w, h] = data.views[view].window, words = wordsOf(view, source, frame), n = w * h;
    const displayReferred = Boolean(entries[view].get(frame + "/" + source).displayReferred);
    const picture = { w, h, displayReferred };
    if (data.floats) {
      picture.linear = viewerCodec.floats(words, n);
      picture.codes = mapped(Uint8Array, picture.linear, (x) => codeOf(x, thresholds[displayReferred ? 1 : 0]));
    } else picture.codes = viewerCodec.codes(words, n);
    // Encoded values, made when a figure asks for them.
    Object.defineProperty(picture, "values", { configurable: true, get() {
      const exact = picture.linear && run.run.quantiseBits !== 8;
      const values = exact ? mapped(Float64Array, picture.linear, (x) => shownOf(x, displayReferred)) : mapped(Float64Array, picture.codes, (c) => unit[c]);
      Object.defineProperty(picture, "values", { value: values });
      return values;
    } });
    return keep(key, picture, n * 3 * (data.floats ? 13 : 9));
  };

  // Codes of a picture at another exposure, `ev` stops brighter. Without floats what was clipped stays white.
  const exposed = (picture, ev) => {
    if (ev === 0) return picture.codes;
    const gain = 2 ** ev;
    if (picture.linear) {
      const steps = thresholds[picture.displayReferred ? 1 : 0];
      return mapped(Uint8Array, picture.linear, (x) => codeOf(x * gain, steps));
    }
    const table = Uint8Array.from({ length: 256 }, (_, c) => Math.floor(255 * encodedOf(clamped(decodedOf(c / 255) * gain)) + 0.5));
    return mapped(Uint8Array, picture.codes, (c) => table[c]);
  };
  // Any result that is expensive, by its key.
  const remembered = (key, sizeOf, make) => found(key) ?? keep(key, ...((v) => [v, sizeOf(v)])(make()));
  return { has, get, exposed, remembered, ready: (view, source, frame) => kept.has(`picture/${view}/${frameOf(view, source, frame)}/${source}`) };
};
