// The controls above the stage: what is shown and how, the frame and its playback, the chooser, the help.
"use strict";
const viewerControls = (section, root, store, stage, paint, pictures, data, names) => {
  const { state, set } = store, $ = (name) => section.querySelector(`[data-c="${name}"]`);
  const frames = () => data.views[state.view].frames;
  const modes = { side: ["Side by side", "s"], flip: ["Flip", "v"], wipe: ["Wipe", "w"], blink: ["Blink", "b"] };

  // ---- modes ----
  for (const [mode, [name, key]] of Object.entries(modes)) {
    const button = element("button", { type: "button", "data-mode": mode, title: `${name} (${key.toUpperCase()})` }, name);
    button.addEventListener("click", () => set({ mode }));
    $("modes").append(button);
  }
  for (const [kind, { name, key, against, overTime }] of Object.entries(paint.kinds))
    if (!(against && !names.others) && !(overTime && Math.max(...data.views.map((v) => v.frames.length)) < 2))
      $("kind").append(element("option", { value: kind }, `${name} (${key.toUpperCase()})`));
  $("kind").addEventListener("change", () => show($("kind").value));
  $("against").append(...names.options());
  $("against").addEventListener("change", () => set({ against: $("against").value }));
  const show = (kind) => {
    if (![...$("kind").options].some((o) => o.value === kind)) return false;
    const [, , w, h] = data.views[state.view].window, at = state.pin ?? state.hover;
    const patch = { kind };
    if (kind === "xt") patch.row = at && !paint.kinds[state.kind].slice ? at[1] : state.row ?? Math.floor(h / 2);
    if (kind === "yt") patch.column = at && !paint.kinds[state.kind].slice ? at[0] : state.column ?? Math.floor(w / 2);
    // A slice is another plane: what was magnified there says nothing here.
    if (Boolean(paint.kinds[kind].slice) !== Boolean(paint.kinds[state.kind].slice) || paint.kinds[kind].slice) patch.zoom = null;
    set(patch);
    return true;
  };
  $("line").addEventListener("input", () => set(state.kind === "xt" ? { row: Number($("line").value) } : { column: Number($("line").value) }));

  // ---- magnification and exposure ----
  const zoomBy = (factor) => {
    const now = stage.camera().zoom, steps = [1 / 4, 1 / 3, 1 / 2, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128];
    stage.zoomTo(factor > 1 ? steps.find((z) => z > now * 1.01) ?? 128 : steps.findLast((z) => z < now * 0.99) ?? 0.25);
  };
  const one = () => stage.zoomTo(1);
  const fit = () => set({ zoom: null });
  for (const [name, act] of Object.entries({ in: () => zoomBy(2), out: () => zoomBy(0.5), one, fit })) $(name).addEventListener("click", act);
  const expose = (ev) => set({ ev: Math.max(-8, Math.min(8, Math.round(ev * 4) / 4)) });
  $("ev").addEventListener("input", () => expose(Number($("ev").value)));
  $("ev0").addEventListener("click", () => expose(0));

  // ---- frames ----
  let playing = false, nextAt = 0, blinkAt = 0;
  const step = (by) => {
    const all = frames(), at = all.indexOf(state.frame);
    set({ frame: all[(at + by + all.length) % all.length] });
  };
  const play = (on) => {
    if (frames().length < 2) on = false;
    playing = on;
    $("play").textContent = playing ? "Pause" : "Play";
    $("play").setAttribute("aria-pressed", playing);
    nextAt = 0;
    if (playing) requestAnimationFrame(tick);
  };
  // A frame is shown when all its pictures are there, never half of it; what comes next is made ahead.
  const sourcesShown = () => [...new Set(stage.panes().flatMap((p) => p.places))].map((place) => stage.what(place));
  const tick = (now) => {
    const blinking = state.mode === "blink" && state.shown.length > 1;
    if (!playing && !blinking) return;
    if (blinking && now >= blinkAt) {
      if (blinkAt) set({ current: (state.current + 1) % state.shown.length });
      blinkAt = now + 1000 / state.hz;
    }
    if (playing) {
      const all = frames(), next = all[(all.indexOf(state.frame) + 1) % all.length];
      const missing = sourcesShown().map((w) => ({ ...w, frame: next })).find((w) => !paint.ready(w));
      if (missing) paint.canvas(missing);
      else if (now >= nextAt - 2) {
        set({ frame: next });
        nextAt = Math.max(now, nextAt) + 1000 / state.fps;
        if (nextAt < now) nextAt = now;
      }
    }
    requestAnimationFrame(tick);
  };
  const blink = () => { blinkAt = 0; if (state.mode === "blink") requestAnimationFrame(tick); };
  $("play").addEventListener("click", () => play(!playing));
  $("previous").addEventListener("click", () => { play(false); step(-1); });
  $("next").addEventListener("click", () => { play(false); step(1); });
  $("frame").addEventListener("input", () => { play(false); set({ frame: frames()[Number($("frame").value)] }); });
  for (const fps of [1, 2, 4, 8, 12, 24, 30, 60]) $("fps").append(element("option", { value: fps }, `${fps} frames/s`));
  $("fps").addEventListener("change", () => set({ fps: Number($("fps").value) }));
  for (const hz of [1, 2, 3, 5, 8]) $("hz").append(element("option", { value: hz }, `${hz} per second`));
  $("hz").addEventListener("change", () => set({ hz: Number($("hz").value) }));
  data.views.forEach((view, k) => $("part").append(element("option", { value: k }, names.part(k))));
  $("part-label").hidden = data.views.length < 2;
  $("part").addEventListener("change", () => goTo(Number($("part").value)));
  const goTo = (view, frame = state.frame) => {
    const has = data.views[view].frames;
    set({ view, frame: has.includes(frame) ? frame : has[has.length - 1], zoom: null, pin: null, hover: null, region: null, row: null, column: null, ...(paint.kinds[state.kind].slice ? { kind: "picture" } : {}) });
  };

  // ---- which pictures ----
  const chooser = section.querySelector("dialog.choose"), list = chooser.querySelector(".list");
  const drawChooser = () => list.replaceChildren(...names.all.map((source) => {
    const box = element("input", { type: "checkbox", value: source }), at = state.shown.indexOf(source);
    box.checked = at >= 0;
    box.disabled = (at >= 0 && state.shown.length === 1) || (at < 0 && state.shown.length === MOST_SHOWN);
    box.addEventListener("change", () => {
      const shown = box.checked ? [...state.shown, source] : state.shown.filter((s) => s !== source);
      set({ shown, current: Math.min(state.current, shown.length - 1), second: Math.min(state.second, shown.length - 1) });
      drawChooser();
      list.querySelector(`input[value="${source}"]`).focus();
    });
    return element("label", {}, box, element("i", { style: `background: ${names.colour(source)}` }), element("span", {}, names.of(source), element("small", {}, names.note(source))), element("b", {}, at >= 0 ? String(at + 1) : ""));
  }));
  const choose = () => { drawChooser(); chooser.showModal(); };
  $("choose").addEventListener("click", choose);
  for (const [name, shown] of Object.entries(names.sets)) {
    if (shown.length < 2) continue;
    const button = element("button", { type: "button" }, name);
    button.addEventListener("click", () => { set({ shown: shown.slice(0, MOST_SHOWN), current: 0, second: 1 }); drawChooser(); });
    chooser.querySelector(".sets").append(button);
  }
  const help = section.querySelector("dialog.help");
  $("help").addEventListener("click", () => help.showModal());
  for (const dialog of [chooser, help]) {
    dialog.querySelector(".close").addEventListener("click", () => dialog.close());
    dialog.addEventListener("click", (e) => { if (e.target === dialog) dialog.close(); });
    dialog.addEventListener("close", () => root.focus({ preventScroll: true }));
  }

  // ---- the rest ----
  const fullScreen = () => (document.fullscreenElement ? document.exitFullscreen() : root.requestFullscreen?.());
  $("full").addEventListener("click", fullScreen);
  $("region").addEventListener("click", () => set({ tool: state.tool === "region" ? "pan" : "region" }));
  $("save").addEventListener("click", () => names.save());
  $("link").addEventListener("click", () => names.link());

  // A picture's place by its number: in the wipe it comes to the right side, with Shift to the left; elsewhere it is flipped to.
  const pick = (place, left) => {
    if (place >= state.shown.length) return false;
    if (state.mode === "wipe" && !left) {
      if (place === state.current) set({ current: stage.second(), second: place });
      else set({ second: place });
    } else set({ current: place, ...(state.mode === "wipe" ? {} : { mode: "flip" }) });
    return true;
  };
  const kindByKey = Object.fromEntries(Object.entries(paint.kinds).map(([kind, { key }]) => [key, kind]));
  const modeByKey = Object.fromEntries(Object.entries(modes).map(([mode, [, key]]) => [key, mode]));
  const key = (k, e) => {
    const digit = /^Digit([1-9])$/.exec(e.code)?.[1] ?? (/^[1-9]$/.test(k) ? k : null);
    if (digit) return pick(Number(digit) - 1, e.shiftKey);
    if (modeByKey[k]) { set({ mode: modeByKey[k] }); return true; }
    if (kindByKey[k]) return show(kindByKey[k]);
    const acts = {
      " ": () => play(!playing), ",": () => { play(false); step(-1); }, ".": () => { play(false); step(1); },
      Home: () => set({ frame: frames()[0] }), End: () => set({ frame: frames().at(-1) }),
      "+": () => zoomBy(2), "=": () => zoomBy(2), "-": () => zoomBy(0.5), "0": fit, f: fit, o: one, "[": () => expose(state.ev - 0.5), "]": () => expose(state.ev + 0.5), "\\": () => expose(0),
      r: () => set({ tool: state.tool === "region" ? "pan" : "region" }), c: choose, u: fullScreen, "?": () => help.showModal(),
      Enter: () => { const at = state.pin ? null : state.hover ?? [Math.floor(stage.camera().x), Math.floor(stage.camera().y)]; set({ pin: at }); },
      Escape: () => (state.tool === "region" ? set({ tool: "pan" }) : state.pin ? set({ pin: null }) : set({ region: null })),
    };
    if (!acts[k]) return false;
    acts[k]();
    return true;
  };

  const scaleBox = section.querySelector(".scale");
  const draw = () => {
    for (const button of $("modes").children) button.setAttribute("aria-pressed", button.dataset.mode === state.mode);
    const kind = paint.kinds[state.kind], all = frames();
    $("kind").value = state.kind;
    $("against").value = state.against;
    // Everything is held against something: pixel values and regions, too.
    $("line-label").hidden = !kind.slice;
    if (kind.slice) {
      const [vx, vy, w, h] = data.views[state.view].window, along = state.kind === "xt";
      $("line").max = (along ? h : w) - 1;
      $("line").value = along ? state.row : state.column;
      $("line-label").firstChild.textContent = `${along ? "Row" : "Column"} ${along ? state.row + vy : state.column + vx} `;
    }
    $("hz-label").hidden = state.mode !== "blink";
    $("hz").value = state.hz;
    const { zoom } = stage.camera();
    $("zoom").textContent = zoom === 1 ? "1:1" : "× " + (zoom < 1 ? zoom.toFixed(2) : Number(zoom.toPrecision(3)));
    $("ev").value = state.ev;
    $("ev-value").textContent = (state.ev > 0 ? "+" : state.ev < 0 ? "−" : "±") + Math.abs(state.ev) + " EV";
    $("ev-name").textContent = kind.scale ? "Gain" : "Exposure";
    $("frames").hidden = all.length < 2;
    $("frame").max = all.length - 1;
    $("frame").value = all.indexOf(state.frame);
    $("frame").setAttribute("aria-valuetext", `frame ${state.frame}`);
    $("frame-number").textContent = `frame ${state.frame}, ${all.indexOf(state.frame) + 1} of ${all.length}`;
    $("fps").value = state.fps;
    $("part").value = state.view;
    $("region").setAttribute("aria-pressed", state.tool === "region");
    root.dataset.tool = state.tool;
    const scale = kind.scale?.(state.ev);
    scaleBox.hidden = !scale;
    if (scale) {
      scaleBox.querySelector(".from").textContent = scale.from;
      scaleBox.querySelector(".middle").textContent = scale.middle ?? "";
      scaleBox.querySelector(".to").textContent = scale.to;
      scaleBox.querySelector(".of").textContent = scale.of + (kind.against || state.kind === "flicker" && !names.still ? `, against ${names.of(state.against)}` : "");
      scaleBox.dataset.ramp = scale.ramp;
    }
  };
  return { draw, key, blink, goTo, isSlice: () => Boolean(paint.kinds[state.kind].slice), play, playing: () => playing };
};
