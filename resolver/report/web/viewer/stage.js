// The stage: panes on one canvas, all at the same place and magnification, with labels over them.
"use strict";
const viewerStage = (root, { state, set }, paint, pictures, data, names) => {
  const GAP = 2; // CSS px between panes
  const canvas = root.querySelector("canvas"), context = canvas.getContext("2d", { alpha: false, colorSpace: "srgb" });
  const labels = root.querySelector(".labels"), bar = root.querySelector(".wipe-bar");
  // Every pixel must be as large as the next, or edges look rougher than they are: from 1:1 on, whole device pixels.
  const whole = (zoom) => (zoom >= 1 ? Math.floor(zoom) : zoom);
  let panes = [], width = 0, height = 0, dpr = 1;

  // The size of what is shown: a slice has its own.
  const size = () => {
    const { window: [, , w, h], frames } = data.views[state.view];
    if (state.kind === "xt") return [w, frames.length * paint.thickness(state.view, "xt")];
    if (state.kind === "yt") return [frames.length * paint.thickness(state.view, "yt"), h];
    return [w, h];
  };
  const second = () => (state.shown.length < 2 ? state.current : state.second === state.current ? (state.current + 1) % state.shown.length : state.second);
  // Places in `shown`, by pane; the wipe has two in one.
  const occupants = () => (state.mode === "side" ? state.shown.map((_, k) => [k]) : state.mode === "wipe" ? [[state.current, second()]] : [[state.current]]);

  const layOut = () => {
    dpr = window.devicePixelRatio || 1;
    const full = document.fullscreenElement === root, inside = occupants(), n = inside.length, [w, h] = size();
    const W = root.clientWidth, most = full ? window.innerHeight : Math.max(260, Math.min(window.innerHeight * 0.72, W * 1.3));
    let best = { zoom: 0, columns: 1 };
    for (let columns = 1; columns <= n; columns++) {
      const rows = Math.ceil(n / columns);
      const zoom = whole(Math.min(((W - GAP * (columns - 1)) / columns / w) * dpr, ((most - GAP * (rows - 1)) / rows / h) * dpr));
      if (zoom >= best.zoom * 0.99) best = { zoom, columns }; // rather beside than below each other
    }
    const rows = Math.ceil(n / best.columns), paneWidth = (W - GAP * (best.columns - 1)) / best.columns;
    height = full ? most : Math.round(Math.min(most, rows * Math.max((best.zoom * h) / dpr, 120) + GAP * (rows - 1)));
    width = W;
    const paneHeight = (height - GAP * (rows - 1)) / rows;
    panes = inside.map((places, k) => ({ places, left: (k % best.columns) * (paneWidth + GAP), top: Math.floor(k / best.columns) * (paneHeight + GAP), width: paneWidth, height: paneHeight }));
    root.style.setProperty("--stage-height", height + "px");
    const [cw, ch] = [Math.round(width * dpr), Math.round(height * dpr)];
    if (canvas.width !== cw || canvas.height !== ch) [canvas.width, canvas.height] = [cw, ch];
  };
  const fitZoom = () => {
    const [w, h] = size(), p = panes[0];
    return whole(Math.min((p.width * dpr + 0.5) / w, (p.height * dpr + 0.5) / h));
  };
  // Device px per picture px, and the picture's place in the middle of a pane.
  const camera = () => {
    const [w, h] = size();
    return state.zoom == null ? { zoom: fitZoom(), x: w / 2, y: h / 2 } : { zoom: shown(state.zoom), x: state.x, y: state.y };
  };
  const shown = (zoom) => (zoom >= 0.75 ? Math.max(1, Math.round(zoom)) : zoom);
  // Where the picture's corner lies in a pane, device px.
  const origin = (pane) => {
    const { zoom, x, y } = camera();
    return [Math.round((pane.left + pane.width / 2) * dpr - x * zoom), Math.round((pane.top + pane.height / 2) * dpr - y * zoom)];
  };
  const paneAt = (clientX, clientY) => {
    const box = canvas.getBoundingClientRect(), px = clientX - box.left, py = clientY - box.top;
    const pane = panes.find((p) => px >= p.left && px < p.left + p.width && py >= p.top && py < p.top + p.height);
    return pane ? { pane, px, py } : null;
  };
  // The picture's place under a point of the page; outside the picture it lies beyond its size.
  const placeAt = (clientX, clientY, of) => {
    const at = of ? { pane: of } : paneAt(clientX, clientY);
    if (!at) return null;
    const box = canvas.getBoundingClientRect(), [ox, oy] = origin(at.pane), { zoom } = camera();
    return { pane: at.pane, x: ((clientX - box.left) * dpr - ox) / zoom, y: ((clientY - box.top) * dpr - oy) / zoom };
  };
  const zoomTo = (zoom, at) => { // `at`: {pane, x, y} that stays where it is
    const now = camera(), [w, h] = size();
    zoom = Math.min(256, Math.max(Math.min(fitZoom(), 1) / 2, zoom));
    const next = shown(zoom);
    const focus = at ?? { x: now.x, y: now.y };
    const keep = (f, c, most) => Math.min(most, Math.max(0, f + ((c - f) * now.zoom) / next));
    set({ zoom, x: keep(focus.x, now.x, w), y: keep(focus.y, now.y, h) });
  };
  const panBy = (dx, dy) => { // device px
    const { zoom, x, y } = camera(), [w, h] = size();
    set({ zoom: state.zoom ?? zoom, x: Math.min(w, Math.max(0, x - dx / zoom)), y: Math.min(h, Math.max(0, y - dy / zoom)) });
  };
  // A rectangle of the picture in the middle, as large as fits with some room around.
  const jump = ([x, y, w, h]) => {
    const p = panes[0], exact = Math.min((p.width * dpr) / w, (p.height * dpr) / h) * 0.8;
    set({ zoom: whole(exact), x: x + w / 2, y: y + h / 2 });
  };

  const what = (place) => ({ view: state.view, kind: state.kind, source: state.shown[place], against: state.against, frame: state.frame, ev: state.ev, row: state.row, column: state.column });

  // ---- drawing ----
  let waiting = false;
  const draw = () => {
    layOut();
    context.fillStyle = "#2b2b2b";
    context.fillRect(0, 0, canvas.width, canvas.height);
    const began = performance.now();
    let late = false;
    for (const pane of panes) {
      const box = [pane.left, pane.top, pane.width, pane.height].map((v) => Math.round(v * dpr));
      pane.places.forEach((place, side) => {
        // The first picture that is not there is made at once; more of them when the time is up, after this one is seen.
        const w = what(place);
        if (!paint.ready(w) && performance.now() - began > 40) { late = true; return; }
        const picture = paint.canvas(w);
        const [x, y, bw, bh] = box, cut = x + Math.round(bw * state.wipe);
        context.save();
        context.beginPath();
        if (pane.places.length < 2) context.rect(x, y, bw, bh);
        else if (side === 0) context.rect(x, y, cut - x, bh);
        else context.rect(cut, y, x + bw - cut, bh);
        context.clip();
        if (picture) drawPicture(picture, pane, box);
        else say(pane, side, paint.kinds[state.kind].against || state.kind === "flicker" ? "no reference in this frame" : "no such picture in this frame");
        drawMarks(pane);
        context.restore();
      });
    }
    drawLabels();
    if (late && !waiting) {
      waiting = true;
      setTimeout(() => { waiting = false; draw(); });
    }
    root.toggleAttribute("data-waiting", late);
  };
  const drawPicture = (picture, pane, [x, y, w, h]) => {
    const { zoom } = camera(), [ox, oy] = origin(pane);
    // Only the part in sight, in whole picture pixels: exact at every magnification.
    const x0 = Math.max(0, Math.floor((x - ox) / zoom)), y0 = Math.max(0, Math.floor((y - oy) / zoom));
    const x1 = Math.min(picture.width, Math.ceil((x + w - ox) / zoom)), y1 = Math.min(picture.height, Math.ceil((y + h - oy) / zoom));
    if (x1 <= x0 || y1 <= y0) return;
    context.imageSmoothingEnabled = zoom < 1;
    context.imageSmoothingQuality = "high";
    const left = ox + x0 * zoom, top = oy + y0 * zoom;
    context.drawImage(picture, x0, y0, x1 - x0, y1 - y0, left, top, (x1 - x0) * zoom, (y1 - y0) * zoom);
  };
  const say = (pane, side, text) => {
    context.fillStyle = "#d0d0d0";
    context.font = `${14 * dpr}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.fillText(text, (pane.left + pane.width * (pane.places.length < 2 ? 0.5 : side ? 0.75 : 0.25)) * dpr, (pane.top + pane.height / 2) * dpr);
  };
  const drawMarks = (pane) => {
    const { zoom } = camera(), [ox, oy] = origin(pane);
    const frame = (x, y, w, h, dashed) => { // white on black, so that it is seen on everything
      for (const [colour, offset] of [["#000", 0], ["#fff", 1]]) {
        context.lineWidth = Math.max(1, Math.round(dpr));
        context.strokeStyle = colour;
        context.setLineDash(dashed ? [4 * dpr, 4 * dpr] : []);
        context.lineDashOffset = offset * 4 * dpr;
        const o = dashed ? 0 : offset * context.lineWidth;
        context.strokeRect(ox + x * zoom - 0.5 - o, oy + y * zoom - 0.5 - o, w * zoom + 1 + 2 * o, h * zoom + 1 + 2 * o);
      }
      context.setLineDash([]);
    };
    if (paint.kinds[state.kind].slice) return;
    if (zoom / dpr >= 36) drawNumbers(pane, ox, oy, zoom);
    if (state.region) frame(...state.region, true);
    if (state.pin) frame(state.pin[0], state.pin[1], 1, 1, false);
  };
  // Codes in the pixels themselves, where they are large enough to hold them.
  const drawNumbers = (pane, ox, oy, zoom) => {
    if (state.kind !== "picture" || pane.places.length > 1) return;
    const picture = pictures.get(state.view, state.shown[pane.places[0]], state.frame);
    if (!picture) return;
    const codes = pictures.exposed(picture, state.ev), px = Math.min(12 * dpr, zoom / 4);
    context.font = `${px}px ui-monospace, "DejaVu Sans Mono", monospace`;
    context.textAlign = "center";
    const x0 = Math.max(0, Math.floor((pane.left * dpr - ox) / zoom)), x1 = Math.min(picture.w, Math.ceil(((pane.left + pane.width) * dpr - ox) / zoom));
    const y0 = Math.max(0, Math.floor((pane.top * dpr - oy) / zoom)), y1 = Math.min(picture.h, Math.ceil(((pane.top + pane.height) * dpr - oy) / zoom));
    for (let y = y0; y < y1; y++)
      for (let x = x0; x < x1; x++) {
        const k = 3 * (y * picture.w + x), light = 0.299 * codes[k] + 0.587 * codes[k + 1] + 0.114 * codes[k + 2] > 128;
        context.fillStyle = light ? "#000" : "#fff";
        for (let c = 0; c < 3; c++) context.fillText(codes[k + c], ox + (x + 0.5) * zoom, oy + (y + 0.5) * zoom + (c - 0.65) * px * 1.15);
      }
  };

  // ---- labels: a number to press, the method's colour, its name to change it, its figure ----
  let made = "";
  const drawLabels = () => {
    const wanted = JSON.stringify([panes.map((p) => p.places), state.shown]);
    if (wanted !== made) {
      made = wanted;
      labels.replaceChildren(...panes.flatMap((pane) => pane.places.map((place) => {
        const select = element("select", { "aria-label": `Picture ${place + 1}`, title: `${names.of(state.shown[place])}; another picture in this place` }, ...names.options(state.shown[place]));
        select.value = state.shown[place];
        select.addEventListener("change", () => {
          const shown = state.shown.slice(), other = shown.indexOf(select.value);
          if (other >= 0) shown[other] = shown[place]; // there already: they change places
          shown[place] = select.value;
          set({ shown });
          root.focus({ preventScroll: true });
        });
        return element("div", { class: "label" }, element("b", {}, String(place + 1)), element("i", { style: `background: ${names.colour(state.shown[place])}` }), select, element("span", { class: "figure" }));
      })));
    }
    let k = 0;
    for (const pane of panes)
      pane.places.forEach((place, side) => {
        const label = labels.children[k++], half = pane.places.length > 1;
        // In shares of the stage, which on paper has another width than on the screen.
        const across = (px) => `calc(${(100 * px) / width}% + 4px)`;
        label.style.maxWidth = `calc(${(100 * (half ? pane.width / 2 : pane.width)) / width}% - 8px)`;
        label.style.top = `calc(${(100 * pane.top) / height}% + 4px)`;
        if (half && side) { label.style.left = "auto"; label.style.right = across(width - pane.left - pane.width); }
        else { label.style.right = "auto"; label.style.left = across(pane.left); }
        const text = names.figure(what(place));
        if (label.lastChild.textContent !== text) label.lastChild.textContent = text;
      });
    const wiping = panes[0]?.places.length > 1;
    bar.hidden = !wiping;
    if (wiping) {
      bar.style.left = panes[0].left + panes[0].width * state.wipe + "px";
      bar.setAttribute("aria-valuenow", Math.round(state.wipe * 100));
    }
    // At rest a finger scrolls the page; what is magnified moves under it.
    canvas.style.touchAction = state.zoom == null ? "pan-y" : "none";
  };
  return { draw, layOut, size, camera, fitZoom, placeAt, paneAt, zoomTo, panBy, jump, second, panes: () => panes, dpr: () => dpr, what };
};
