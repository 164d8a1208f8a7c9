// Where the methods differ most: thumbnails beside the stage and, further down, every method's detail; each leads there.
"use strict";
const viewerCrops = (strip, details, store, pictures, paint, data, names, jump) => {
  const { state } = store;
  const viewOf = ([x, y]) => data.views.findIndex(({ window: [vx, vy, w, h] }) => x >= vx && y >= vy && x < vx + w && y < vy + h);
  const cut = (source, view, frame, [x, y, w, h]) => {
    const picture = pictures.get(view, source, frame), [vx, vy] = data.views[view].window;
    if (!picture) return null;
    const codes = new Uint8Array(3 * w * h);
    for (let j = 0; j < h; j++) {
      const from = 3 * ((y - vy + j) * picture.w + x - vx);
      codes.set(picture.codes.subarray(from, from + 3 * w), 3 * j * w);
    }
    return paint.ofCodes(w, h, codes);
  };
  const button = (source, view, frame, place, label, caption) => {
    const canvas = cut(source, view, frame, place);
    if (!canvas) return null;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", label);
    const b = element("button", { type: "button", class: "crop", title: "Show this place in the viewer" }, canvas, caption && element("span", {}, ...breakable(caption)));
    b.addEventListener("click", () => jump(view, frame, place, source));
    return b;
  };
  const nearest = () => data.places.reduce((best, p) => (Math.abs(p.frame - state.frame) < Math.abs(best.frame - state.frame) ? p : best), data.places[0]);
  let drawn = null;
  // As the frame changes; while it plays they stay.
  const draw = () => {
    const places = nearest();
    if (!places || drawn === places) return;
    drawn = places;
    const reference = pictures.has(0, "truth", places.frame) ? "truth" : names.all[0];
    strip.replaceChildren(...places.windows.map((place, k) => button(reference, viewOf(place), places.frame, place, `Place ${k + 1}, at ${place[0]}, ${place[1]}`)).filter(Boolean));
    strip.parentElement.hidden = !places.windows.length;
    details.parentElement.hidden = !places.windows.length;
    details.replaceChildren();
    inSight.unobserve(details);
    inSight.observe(details); // all methods of the frame are unpacked only where one looks
  };
  const drawDetails = () => {
    const { frame, windows } = drawn;
    details.replaceChildren(...windows.map((place) => {
      const view = viewOf(place), row = element("div", { class: "crop-row" });
      const sources = names.all.filter((s) => pictures.has(view, s, frame));
      const some = (from) => { // some at a time: the page stays alive
        const began = performance.now();
        while (from < sources.length && performance.now() - began < 60) {
          const s = sources[from++], b = button(s, view, frame, place, `${names.of(s)}, detail at ${place[0]}, ${place[1]}`, names.of(s));
          if (b) row.append(b);
        }
        if (from < sources.length) setTimeout(() => some(from));
      };
      some(0);
      return element("div", {}, element("h3", {}, `Frame ${frame}, ${place[2]} × ${place[3]} px at ${place[0]}, ${place[1]}`), row);
    }));
  };
  const inSight = new IntersectionObserver((entries) => {
    if (!drawn || details.childElementCount || !entries.some((e) => e.isIntersecting)) return;
    drawDetails();
  }, { rootMargin: "400px" });
  const all = () => { if (drawn && !details.childElementCount) drawDetails(); };
  return { draw, all };
};
