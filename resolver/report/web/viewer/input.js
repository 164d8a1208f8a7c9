// Mouse, pen, fingers and keys on the stage.
"use strict";
const viewerInput = (section, root, store, stage, actions) => {
  const { state, set } = store, canvas = root.querySelector("canvas"), bar = root.querySelector(".wipe-bar");
  const pixelAt = (at) => {
    const [w, h] = stage.size(), x = Math.floor(at?.x ?? -1), y = Math.floor(at?.y ?? -1);
    return x >= 0 && y >= 0 && x < w && y < h ? [x, y] : null;
  };
  const CLICK = 4; // px that a click may move

  // ---- pointers: one pans, draws a region (Shift, or the tool), or clicks; two pinch ----
  const down = new Map();
  let gesture = null;
  const startRegion = (e) => {
    const at = stage.placeAt(e.clientX, e.clientY);
    return at && { kind: "region", pane: at.pane, from: [at.x, at.y] };
  };
  const between = () => {
    const [a, b] = [...down.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y) };
  };
  canvas.addEventListener("pointerdown", (e) => {
    if (e.button > 1) return;
    root.focus({ preventScroll: true });
    canvas.setPointerCapture(e.pointerId);
    down.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (down.size === 2) gesture = { kind: "pinch", ...between() };
    else if (down.size === 1)
      gesture = ((e.shiftKey || state.tool === "region") && !actions.isSlice() && startRegion(e)) || { kind: "press", x: e.clientX, y: e.clientY, type: e.pointerType };
  });
  canvas.addEventListener("pointermove", (e) => {
    const pointer = down.get(e.pointerId);
    if (!pointer) {
      set({ hover: pixelAt(stage.placeAt(e.clientX, e.clientY)) });
      return;
    }
    const [dx, dy] = [e.clientX - pointer.x, e.clientY - pointer.y];
    if (gesture?.kind === "press" && Math.hypot(e.clientX - gesture.x, e.clientY - gesture.y) > CLICK) gesture = { kind: "pan", type: e.pointerType };
    if (gesture?.kind === "press") return;
    Object.assign(pointer, { x: e.clientX, y: e.clientY });
    if (gesture?.kind === "pinch" && down.size === 2) {
      const now = between(), at = stage.placeAt(now.x, now.y) ?? undefined;
      stage.panBy((now.x - gesture.x) * stage.dpr(), (now.y - gesture.y) * stage.dpr());
      if (gesture.apart > 0) stage.zoomTo(((state.zoom ?? stage.camera().zoom) * now.apart) / gesture.apart, at);
      gesture = { kind: "pinch", ...now };
    } else if (gesture?.kind === "pan") {
      if (state.zoom != null || gesture.type !== "touch") stage.panBy(dx * stage.dpr(), dy * stage.dpr());
    } else if (gesture?.kind === "region") {
      const at = stage.placeAt(e.clientX, e.clientY, gesture.pane), [w, h] = stage.size();
      const clamp = (v, most) => Math.min(most, Math.max(0, v));
      const x0 = Math.floor(clamp(Math.min(at.x, gesture.from[0]), w - 1)), y0 = Math.floor(clamp(Math.min(at.y, gesture.from[1]), h - 1));
      const x1 = Math.ceil(clamp(Math.max(at.x, gesture.from[0]), w)), y1 = Math.ceil(clamp(Math.max(at.y, gesture.from[1]), h));
      const region = [x0, y0, Math.max(1, x1 - x0), Math.max(1, y1 - y0)];
      if (String(region) !== String(state.region)) set({ region });
    }
  });
  const up = (e) => {
    if (!down.delete(e.pointerId)) return;
    if (gesture?.kind === "press" && e.type === "pointerup") {
      const pixel = pixelAt(stage.placeAt(e.clientX, e.clientY));
      set({ pin: pixel && String(pixel) !== String(state.pin) ? pixel : null });
    }
    if (gesture?.kind === "region") set({ tool: "pan" });
    gesture = down.size === 1 ? { kind: "pan", type: e.pointerType } : null;
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => { if (!down.size) set({ hover: null }); });
  canvas.addEventListener("dblclick", (e) => stage.zoomTo(stage.camera().zoom * 2, stage.placeAt(e.clientX, e.clientY) ?? undefined));
  canvas.addEventListener("wheel", (e) => {
    // A picture that fits cannot shrink: then the page scrolls on.
    if (e.deltaY > 0 && state.zoom == null && !e.ctrlKey && document.fullscreenElement !== root) return;
    e.preventDefault();
    const lines = e.deltaMode === 1 ? 32 : e.deltaMode === 2 ? 400 : 1;
    const zoom = (state.zoom ?? stage.camera().zoom) * 2 ** (-e.deltaY * lines / 240);
    if (zoom <= stage.fitZoom() * 0.999) set({ zoom: null });
    else stage.zoomTo(zoom, stage.placeAt(e.clientX, e.clientY) ?? undefined);
  }, { passive: false });

  // ---- the wipe's bar ----
  const wipeTo = (clientX) => {
    const pane = stage.panes()[0], box = canvas.getBoundingClientRect();
    set({ wipe: Math.min(1, Math.max(0, (clientX - box.left - pane.left) / pane.width)) });
  };
  bar.addEventListener("pointerdown", (e) => { bar.setPointerCapture(e.pointerId); e.preventDefault(); bar.focus({ preventScroll: true }); });
  bar.addEventListener("pointermove", (e) => { if (bar.hasPointerCapture(e.pointerId)) wipeTo(e.clientX); });
  bar.addEventListener("keydown", (e) => {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[e.key];
    if (!step) return;
    e.preventDefault();
    e.stopPropagation();
    set({ wipe: Math.min(1, Math.max(0, state.wipe + step)) });
  });

  // ---- keys: letters and digits wherever nothing else takes them, those that scroll only within the viewer ----
  const arrows = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const inSight = () => { const box = section.getBoundingClientRect(); return box.bottom > 0 && box.top < window.innerHeight; };
  document.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || e.defaultPrevented) return;
    const on = e.target, within = section.contains(on), free = on === document.body || on === document.documentElement;
    if (on.closest?.("input:not([type=range]):not([type=checkbox]), select, textarea, dialog")) return;
    if (!within && !(free && inSight())) return;
    const widget = on.closest?.("button, input, summary, a"), key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
    if (arrows[key]) {
      if (!within || widget) return;
      const [x, y] = arrows[key];
      if (state.pin && !actions.isSlice()) {
        const [w, h] = stage.size();
        set({ pin: [Math.min(w - 1, Math.max(0, state.pin[0] - x)), Math.min(h - 1, Math.max(0, state.pin[1] - y))] });
      } else {
        const pane = stage.panes()[0], step = e.shiftKey ? stage.camera().zoom : (Math.min(pane.width, pane.height) * stage.dpr()) / 8;
        stage.panBy(x * step, y * step);
      }
    } else if ([" ", "Enter", "Home", "End"].includes(key)) {
      if (!within || widget || !actions.key(key, e)) return;
    } else if (!actions.key(key, e)) return;
    e.preventDefault();
  });
  return { pixelAt };
};
