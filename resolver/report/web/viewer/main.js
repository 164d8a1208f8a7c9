// Puts the viewer together from the JSON in #data and the packed pictures behind it.
"use strict";
(() => {
  const page = JSON.parse(document.getElementById("data").textContent), { run, order, viewer: data } = page;
  const section = document.getElementById("viewer"), details = document.getElementById("crops");
  if (!data.views.length) {
    details.parentElement.hidden = true;
    return;
  }
  section.hidden = false;
  section.style.setProperty("--error-ramp", page.errorColours.filter((_, k, all) => k % 15 === 0 || k === all.length - 1).map((c) => `rgb(${c})`).join(", "));
  const methods = run.methods, standIn = run.run.reference;
  const root = document.getElementById("stage"), said = document.getElementById("said");
  const pictures = viewerPictures(data, run);
  const paint = viewerPaint(pictures, data, run, page);
  const last = (view) => data.views[view].frames.at(-1);
  const withTruth = data.views[0].frames.some((f) => pictures.has(0, "truth", f));
  const noaa = methods.findIndex((m) => m.id === "noaa");

  // ---- names ----
  const all = [...(withTruth ? ["truth"] : []), ...order.map(String)];
  const of = (source) => (source === "truth" ? (standIn ? `reference: ${standIn}` : "ground truth") : methods[Number(source)].text);
  const best = order.find((i) => i !== noaa && methods[i].pooled) ?? order.find((i) => i !== noaa);
  const unique = (list) => [...new Set(list.filter((s) => s != null && all.includes(String(s))).map(String))];
  // The best of each family but the reference's, best first: what differs in kind is worth a look beside each other.
  const bestOfKind = [...new Set(order.filter((i) => i !== noaa).map((i) => methods[i].family))].map((f) => order.find((i) => i !== noaa && methods[i].family === f));
  const families = [...new Set(methods.map((m) => m.family))];
  const reference = withTruth ? "truth" : noaa >= 0 ? String(noaa) : all[0];
  const decibels = (v) => (v === "Inf" ? "identical" : Number.isFinite(v) ? v.toFixed(2) + " dB" : "");
  const looks = methodLooks(methods.map((m) => m.id));
  // The tables pool all frames; what stands on a picture is of this one.
  const ofFrame = (what) => (judgedFrames > 1 ? `frame ${what.frame}: ` : "");
  const judgedFrames = Math.max(0, ...methods.map((m) => m.frames.filter((f) => f.metrics).length));
  const figure = (what) => {
    const kind = paint.kinds[what.kind];
    if (kind.slice || !pictures.has(what.view, what.source, what.frame)) return "";
    if (kind.mean) {
      if (!paint.ready(what)) return "";
      const mean = paint.meanOf(what);
      return mean == null ? "" : (kind.overTime ? "" : ofFrame(what)) + `${kind.mean} ${what.kind === "ssim" ? mean.toFixed(4) : Number(mean.toPrecision(3))}`;
    }
    if (what.source === "truth" || what.kind !== "picture") return "";
    const psnr = decibels(methods[Number(what.source)].frames.find((f) => f.frame === what.frame)?.metrics?.psnr);
    return psnr && ofFrame(what) + psnr;
  };
  const names = {
    all, of, figure, noaa: noaa >= 0 ? String(noaa) : null, floats: data.floats, still: run.shot.static, others: all.length > 1,
    colour: (source) => (source === "truth" ? methodColour("truth") : looks[Number(source)].colour),
    note: (source) => (source === "truth" ? (standIn ? "a method of this run, in the truth's place" : "what the figures are against") : methods[Number(source)].title),
    options: () => all.map((s) => element("option", { value: s }, of(s))),
    window: () => data.views[store.state.view].window,
    part: (k) => { const [x, y, w, h] = data.views[k].window; return `${w} × ${h} px at ${x}, ${y}`; },
    sets: {
      "Truth, none, best": unique([withTruth ? "truth" : null, noaa >= 0 ? noaa : null, best]),
      "Best of each family": unique([withTruth ? "truth" : null, noaa >= 0 ? noaa : null, ...bestOfKind]),
      ...Object.fromEntries(families.map((f) => [f[0].toUpperCase() + f.slice(1), unique([withTruth ? "truth" : null, ...order.filter((i) => methods[i].family === f && i !== noaa)])]).filter(([, shown]) => shown.length > (withTruth ? 2 : 1))),
      "Nine best": unique([withTruth ? "truth" : null, ...order]),
    },
    copy: async (text, done) => {
      try { await navigator.clipboard.writeText(text); said.textContent = done; } catch { said.textContent = "The browser keeps the clipboard shut; here it is: " + text; }
    },
    link: () => {
      const hash = link.write(store.state);
      history.replaceState(null, "", hash);
      names.copy(location.href, "The link is in the clipboard and in the address.");
    },
    save: () => saved(),
  };
  const link = viewerLink(of, (name) => all.find((s) => of(s) === name));

  // ---- state: a link's, or the last frame's truth, no anti-aliasing and the best two; where there is little room, a wipe ----
  const narrow = matchMedia("(max-width: 600px)").matches;
  const four = unique([withTruth ? "truth" : null, noaa >= 0 ? noaa : null, ...bestOfKind.slice(0, 2), ...order]).slice(0, 4);
  const start = { view: 0, frame: last(0), shown: narrow ? unique([noaa >= 0 ? noaa : null, best, withTruth ? "truth" : null, ...order]).slice(0, 3) : four, current: 0, second: 1, mode: narrow && all.length > 1 ? "wipe" : "side", kind: "picture", against: reference, zoom: null, x: 0, y: 0, ev: 0,
    wipe: 0.5, pin: null, hover: null, region: null, row: null, column: null, tool: "pan", fps: run.shot.static ? 8 : 12, hz: 2, values: "all" };
  const kindsThere = Object.keys(paint.kinds).filter((k) => !paint.kinds[k].slice && !(paint.kinds[k].against && all.length < 2));
  const fromLink = link.read(location.hash, { views: data.views, kinds: kindsThere });
  const store = viewerState({ ...start, ...fromLink });
  const { state, set } = store;
  if (state.current >= state.shown.length) state.current = 0;

  const stage = viewerStage(root, store, paint, pictures, data, names);
  const controls = viewerControls(section, root, store, stage, paint, pictures, data, names);
  const figures = viewerFigures(document.getElementById("values"), document.getElementById("region-figures"), store, pictures, names, paint.kinds);
  viewerInput(section, root, store, stage, controls);
  const jump = (view, frame, place, source) => {
    controls.play(false);
    if (state.view !== view) controls.goTo(view, frame);
    const [vx, vy] = data.views[view].window;
    const shown = state.shown.includes(source) || state.shown.length === MOST_SHOWN ? state.shown : [...state.shown, source];
    set({ frame, shown, ...(paint.kinds[state.kind].slice ? { kind: "picture" } : {}) });
    stage.jump([place[0] - vx, place[1] - vy, place[2], place[3]]);
    section.scrollIntoView({ block: "start" });
    root.focus({ preventScroll: true });
  };
  const crops = viewerCrops(section.querySelector(".thumbs"), details, store, pictures, paint, data, names, jump);

  // ---- what changes is drawn once per frame of the screen ----
  let due = null;
  const drawDue = () => {
    const keys = due;
    due = null;
    if (keys.has("mode")) controls.blink();
    const touches = (...of) => of.some((k) => keys.has(k));
    if (touches("view", "frame", "shown", "current", "second", "mode", "kind", "against", "zoom", "x", "y", "ev", "wipe", "pin", "region", "row", "column", "size")) stage.draw();
    controls.draw();
    if (touches("view", "frame", "shown", "kind", "against", "pin", "hover", "values")) figures.drawValues();
    if (touches("view", "frame", "shown", "against", "region")) figures.drawRegion();
    if (touches("view", "frame")) crops.draw();
    section.querySelector("#values button").textContent = state.values === "all" ? "Only the pictures shown" : "All methods";
  };
  const ask = (keys) => {
    if (due) keys.forEach((k) => due.add(k));
    else {
      due = new Set(keys);
      requestAnimationFrame(drawDue);
    }
  };
  store.listen(ask);
  new ResizeObserver(() => ask(["size"])).observe(root);
  document.addEventListener("fullscreenchange", () => ask(["size"]));
  window.addEventListener("beforeprint", () => { stage.draw(); crops.all(); });
  ask(["view", "mode"]);

  const notes = [];
  const { window: [x, y, w, h] } = data.views[0], [W, H] = run.shot.resolution;
  if (data.views.length === 1 && (w < W || h < H)) notes.push(`The part of the picture at ${x}, ${y} (${w} × ${h} px) where the methods differ most.`);
  if (data.leftOut.length) notes.push(`Frames ${data.leftOut[0]} to ${data.leftOut.at(-1)} are left out to keep this file small (report --embed-limit).`);
  if (!data.floats) notes.push("Pictures are the displayed 8-bit codes; what is brighter than white was clipped (report --hdr keeps it).");
  said.textContent = notes.join(" ");

  // What is shown as a file: the stage at its own pixels, labels drawn in.
  function saved() {
    stage.draw();
    const from = root.querySelector("canvas"), copy = element("canvas", { width: from.width, height: from.height }), pen = copy.getContext("2d");
    pen.drawImage(from, 0, 0);
    const scale = from.width / root.clientWidth, box = root.getBoundingClientRect();
    pen.font = `600 ${13 * scale}px system-ui, sans-serif`;
    pen.textBaseline = "middle";
    root.querySelectorAll(".label").forEach((label) => {
      const b = label.getBoundingClientRect(), select = label.querySelector("select");
      const text = [select.selectedOptions[0].textContent, label.lastChild.textContent].filter(Boolean).join("  ");
      pen.fillStyle = "rgba(0, 0, 0, .75)";
      pen.fillRect((b.left - box.left) * scale, (b.top - box.top) * scale, pen.measureText(text).width + 12 * scale, 24 * scale);
      pen.fillStyle = "#fff";
      pen.fillText(text, (b.left - box.left + 6) * scale, (b.top - box.top + 12) * scale);
    });
    copy.toBlob((blob) => {
      const a = element("a", { href: URL.createObjectURL(blob), download: `${run.shot.name}-frame${state.frame}.png` });
      a.click();
      setTimeout(() => URL.revokeObjectURL(a.href), 10000);
    });
  }
  // For scripts and tests: what is shown, how to change it, and the pictures behind it.
  window.aaViewer = { state, set, stage, paint, pictures, figures, names, data, idle: () => due === null && !root.hasAttribute("data-waiting") };
})();
