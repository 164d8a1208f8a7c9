// What the viewer shows, in one place. Whoever changes it calls set(); whoever shows it is told what changed.
//   view, frame      which part, which frame
//   shown            sources, one to nine; current and second: places in it, of flip and blink and of the wipe's right side
//   mode             side, flip, wipe, blink
//   kind, against    what is shown (viewerPaint.kinds) and what it is held against
//   zoom, x, y       device pixels per picture pixel, null to fit; the picture's place in the middle of each pane, px
//   ev               exposure in stops; of a map its gain
//   wipe             where the wipe's bar stands, 0 to 1
//   pin, hover       a pixel [x, y]; region [x, y, w, h]
//   row, column      of the slices
"use strict";
const MOST_SHOWN = 9;
const viewerState = (initial) => {
  const state = { ...initial }, listeners = [];
  let changed = null;
  const set = (patch) => {
    const keys = Object.keys(patch).filter((k) => patch[k] !== state[k]);
    if (!keys.length) return;
    Object.assign(state, patch);
    if (changed) { // set() within a listener: told once, after it
      keys.forEach((k) => changed.add(k));
      return;
    }
    changed = new Set(keys);
    while (changed.size) {
      const now = changed;
      changed = new Set();
      listeners.forEach((listener) => listener(now));
    }
    changed = null;
  };
  const listen = (listener) => listeners.push(listener);
  return { state, set, listen };
};

// The state as the part of a link behind #, and back. Sources go by name: a method's text says which it is in every run.
const viewerLink = (names, indexOf) => {
  const rounded = (v) => String(Math.round(v * 100) / 100);
  const write = (s) => {
    const p = new URLSearchParams();
    p.set("shown", s.shown.map(names).join("|"));
    p.set("mode", s.mode);
    if (s.kind !== "picture") p.set("kind", s.kind);
    if (s.against !== "truth") p.set("against", names(s.against));
    p.set("frame", s.frame);
    if (s.view) p.set("part", s.view);
    if (s.zoom) p.set("zoom", [s.zoom, s.x, s.y].map(rounded).join(","));
    if (s.ev) p.set("ev", s.ev);
    if (s.current) p.set("current", s.current + 1);
    if (s.pin) p.set("pixel", s.pin.join(","));
    if (s.region) p.set("region", s.region.join(","));
    return "#view?" + p;
  };
  const numbers = (text, n) => {
    const all = (text ?? "").split(",").map(Number);
    return all.length === n && all.every(Number.isFinite) ? all : null;
  };
  // Only what can be had: a link may come from another report.
  const read = (hash, { views, kinds }) => {
    if (!hash.startsWith("#view?")) return {};
    const p = new URLSearchParams(hash.slice(6)), patch = {};
    const shown = (p.get("shown") ?? "").split("|").map(indexOf).filter((s) => s != null).slice(0, MOST_SHOWN);
    if (shown.length) patch.shown = [...new Set(shown)];
    if (["side", "flip", "wipe", "blink"].includes(p.get("mode"))) patch.mode = p.get("mode");
    if (kinds.includes(p.get("kind"))) patch.kind = p.get("kind");
    const against = indexOf(p.get("against") ?? "");
    if (against != null) patch.against = against;
    const view = Number(p.get("part") ?? 0);
    if (views[view]) {
      patch.view = view;
      if (views[view].frames.includes(Number(p.get("frame")))) patch.frame = Number(p.get("frame"));
      const zoom = numbers(p.get("zoom"), 3), [, , w, h] = views[view].window;
      if (zoom && zoom[0] > 0) Object.assign(patch, { zoom: zoom[0], x: zoom[1], y: zoom[2] });
      const pin = numbers(p.get("pixel"), 2), region = numbers(p.get("region"), 4);
      const inside = (x, y) => Number.isInteger(x) && Number.isInteger(y) && x >= 0 && y >= 0 && x < w && y < h;
      if (pin && inside(...pin)) patch.pin = pin;
      if (region && inside(region[0], region[1]) && region[2] > 0 && region[3] > 0 && inside(region[0] + region[2] - 1, region[1] + region[3] - 1)) patch.region = region;
    }
    if (Number.isFinite(Number(p.get("ev") ?? NaN))) patch.ev = Math.max(-8, Math.min(8, Number(p.get("ev"))));
    const current = Number(p.get("current") ?? 1) - 1;
    if (patch.shown?.[current]) patch.current = current;
    return patch;
  };
  return { write, read };
};
