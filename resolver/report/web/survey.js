// The survey's page. It knows pictures by codes alone: which method is behind a code stands in the key, not here. Every
// participant has a seed, from which the order of questions and pictures follows; answers stay in this browser until
// they are saved.
"use strict";
(() => {
  const survey = JSON.parse(document.getElementById("data").textContent);
  const $ = (id) => document.getElementById(id);
  const letterOf = (place) => String.fromCharCode(65 + place);
  const bestRating = 5;

  // ---- who answers: a seed, and what was answered, kept in this browser ----
  const shelf = "aaresolve-survey-" + survey.survey;
  let kept = true; // whether this browser keeps anything at all
  const fresh = () => {
    const [high, low, seed] = crypto.getRandomValues(new Uint32Array(3));
    const hex = (v) => v.toString(16).padStart(8, "0");
    return { participant: hex(high) + hex(low), seed, started: new Date().toISOString(), at: -1, given: {}, seconds: {}, remarks: "" };
  };
  const load = () => {
    try {
      const state = JSON.parse(localStorage.getItem(shelf));
      return state && state.participant ? state : null;
    } catch {
      return null;
    }
  };
  const keep = () => {
    try {
      localStorage.setItem(shelf, JSON.stringify(state));
    } catch {
      kept = false;
    }
  };

  // ---- the order that follows from a seed: PCG32 [O'Neill 2014], seeded with its state ----
  const orderOf = (seed) => {
    const mask = (1n << 64n) - 1n;
    let word = BigInt(seed);
    const next = () => {
      word = (word * 6364136223846793005n + 1442695040888963407n) & mask;
      const shifted = Number((((word >> 18n) ^ word) >> 27n) & 0xffffffffn), turn = Number(word >> 59n);
      return ((shifted >>> turn) | (shifted << ((32 - turn) & 31))) >>> 0;
    };
    const below = (bound) => Math.floor((next() / 4294967296) * bound);
    const shuffled = (list) => {
      const all = list.slice();
      for (let i = all.length - 1; i > 0; i--) {
        const k = below(i + 1);
        [all[i], all[k]] = [all[k], all[i]];
      }
      return all;
    };
    next();
    const pictures = Object.fromEntries(survey.questions.map((q) => [q.id, shuffled(q.pictures)]));
    const played = (q) => survey.images[q.pictures[0]].length > 1;
    // Stills first: who has seen a picture move judges its still otherwise.
    return { questions: [...shuffled(survey.questions.filter((q) => !played(q))), ...shuffled(survey.questions.filter(played))], pictures };
  };
  let state = load() ?? fresh(), order = orderOf(state.seed);
  const resumed = Object.keys(state.given).length > 0;

  // ---- pixels: a pixel of a picture is a whole number of the screen's ----
  const pixelsPerPixel = (zoom) => (zoom * Math.max(1, Math.round(devicePixelRatio))) / devicePixelRatio;
  const images = new Map();
  const imagesOf = (code) => {
    if (!images.has(code))
      images.set(code, Promise.all(survey.images[code].map(async (url) => {
        const image = new Image();
        image.src = url;
        await image.decode();
        return image;
      })));
    return images.get(code);
  };

  // ---- a question on the screen ----
  let q = null, panes = [], current = 0, scroll = [0, 0], shownSince = 0, playing = false, clock = 0;
  const wide = () => {
    const width = q.size[0] * pixelsPerPixel(q.zoom) + 24;
    return document.body.clientWidth >= 2 * width;
  };
  const isOneAtATime = () => document.querySelector("#views input:checked").value === "one";
  const given = () => (state.given[q.id] ??= {});
  const places = () => order.pictures[q.id];

  const resize = () => {
    if (!q) return;
    const scale = pixelsPerPixel(q.zoom);
    for (const pane of panes) {
      pane.picture.style.width = q.size[0] * scale + "px";
      pane.picture.style.height = q.size[1] * scale + "px";
    }
  };
  const draw = () => {
    const one = isOneAtATime();
    panes.forEach((pane, k) => {
      pane.figure.hidden = one && k !== current;
      pane.port.scrollLeft = scroll[0];
      pane.port.scrollTop = scroll[1];
      pane.tab.setAttribute("aria-pressed", String(k === current));
      pane.row?.classList.toggle("current", k === current);
    });
    $("tabs").hidden = panes.length < 2;
  };
  const select = (k) => {
    const { port, figure } = panes[current];
    if (!figure.hidden) scroll = [port.scrollLeft, port.scrollTop]; // its event may still be on its way
    current = k;
    draw();
    if (!isOneAtATime()) panes[k].figure.scrollIntoView({ block: "nearest", inline: "nearest" });
  };
  const paneOf = (code, k) => {
    const played = survey.images[code].length > 1;
    const picture = played
      ? element("canvas", { width: q.size[0], height: q.size[1], role: "img", "aria-label": "Picture " + letterOf(k) + ", moving" })
      : element("img", { src: survey.images[code][0], alt: "Picture " + letterOf(k), draggable: "false" });
    const port = element("div", { class: "window", tabindex: "0", role: "group", "aria-label": `Picture ${letterOf(k)}; scroll to see all of it` }, picture);
    const pane = { code, picture, port, figure: element("figure", { "data-picture": code }, element("figcaption", { "aria-hidden": "true" }, letterOf(k)), port),
      tab: Object.assign(element("button", { type: "button", "aria-label": "Show picture " + letterOf(k) }, letterOf(k)), { onclick: () => select(k) }) };
    // All pictures show the same place.
    port.addEventListener("scroll", () => {
      if (pane.figure.hidden || (port.scrollLeft === scroll[0] && port.scrollTop === scroll[1])) return;
      scroll = [port.scrollLeft, port.scrollTop];
      for (const other of panes) if (other !== pane) [other.port.scrollLeft, other.port.scrollTop] = scroll;
    });
    port.addEventListener("click", () => { if (!isOneAtATime()) select(k); });
    // A mouse drags the picture; fingers scroll it.
    let grip = null;
    port.addEventListener("pointerdown", (event) => {
      if (event.pointerType !== "mouse" || event.button !== 0) return;
      grip = [event.clientX + port.scrollLeft, event.clientY + port.scrollTop];
      port.setPointerCapture(event.pointerId);
    });
    port.addEventListener("pointermove", (event) => { if (grip) port.scrollTo(grip[0] - event.clientX, grip[1] - event.clientY); });
    for (const end of ["pointerup", "pointercancel"]) port.addEventListener(end, () => { grip = null; });
    if (played) imagesOf(code).then((all) => { pane.frames = all; drawFrame(pane); });
    return pane;
  };
  const drawFrame = (pane) => {
    if (!pane.frames) return;
    const frame = pane.frames[Math.floor(clock * q.framesPerSecond) % pane.frames.length];
    if (pane.drawn === frame) return;
    pane.drawn = frame;
    pane.picture.getContext("2d").drawImage(frame, 0, 0);
  };
  let lastTick = 0;
  const tick = (now) => {
    // All start together, once all are there.
    if (q && playing && panes.every((p) => p.frames)) {
      clock += Math.min(0.25, Math.max(0, now - lastTick) / 1000);
      panes.forEach(drawFrame);
    }
    lastTick = now;
    if (playing) requestAnimationFrame(tick);
  };
  const play = (on) => {
    const started = on && !playing;
    playing = on;
    $("play").textContent = on ? "Pause" : "Play";
    if (started) { lastTick = performance.now(); requestAnimationFrame(tick); }
  };

  // ---- answers ----
  const words = {
    rank: (n) => `Rank the pictures from 1, the best, to ${n}, the worst. Every rank is given once.`,
    pair: () => "Which picture is better?",
    rating: (n) => (n > 1 ? "Rate each picture for itself, from 1 (bad) to 5 (excellent)." : "Rate the picture, from 1 (bad) to 5 (excellent)."),
  };
  const choice = (group, value, text, label, checked, change) => {
    const input = element("input", { type: "radio", name: group, value, "aria-label": label });
    input.checked = checked;
    input.addEventListener("change", change);
    return element("label", { class: "choice" }, input, element("span", { "aria-hidden": "true" }, text));
  };
  const markRows = () => panes.forEach((pane) => {
    for (const input of pane.row?.querySelectorAll("input") ?? []) input.checked = Number(input.value) === given()[pane.code];
  });
  const rankIt = (code, rank) => {
    const all = given(), before = all[code], n = places().length;
    const other = places().find((c) => c !== code && all[c] === rank);
    all[code] = rank;
    if (other) {
      if (before) all[other] = before;
      else delete all[other];
    }
    const open = places().filter((c) => !all[c]);
    if (open.length === 1) all[open[0]] = Array.from({ length: n }, (_, r) => r + 1).find((r) => !Object.values(all).includes(r));
    markRows();
  };
  const answerIt = (code, value) => {
    if (q.kind === "rank") rankIt(code, value);
    else if (q.kind === "rating") { given()[code] = value; markRows(); }
    else {
      given().better = code;
      for (const input of $("answer").querySelectorAll("input")) input.checked = input.value === String(places().indexOf(code) + 1);
    }
    keep();
    say();
  };
  const missing = () => (q.kind === "pair" ? (given().better ? [] : places()) : places().filter((c) => !given()[c]));
  const say = (wanting = false) => {
    const open = missing(), letters = (codes) => codes.map((c) => letterOf(places().indexOf(c))).join(", ");
    $("said").classList.toggle("wanting", wanting);
    $("said").textContent = !open.length
      ? q.kind === "rank" ? "Best to worst: " + letters(places().slice().sort((a, b) => given()[a] - given()[b])) + "." : q.kind === "pair" ? `Picture ${letters([given().better])} is better.` : "Rated."
      : wanting ? (q.kind === "pair" ? "Choose the better picture first." : `A ${q.kind === "rank" ? "rank" : "rating"} of ${letters(open)} is still missing.`) : "";
  };
  const form = () => {
    const most = q.kind === "rank" ? places().length : bestRating;
    if (q.kind === "pair") {
      const choices = places().map((code, k) => choice("better", k + 1, letterOf(k), `Picture ${letterOf(k)} is better`, given().better === code, () => answerIt(code)));
      return [element("fieldset", { class: "row" }, element("legend", { class: "unseen" }, "The better picture"), element("div", { class: "choices" }, ...choices))];
    }
    const ends = element("div", { class: "ends", "aria-hidden": "true" }, ...(q.kind === "rank" ? ["best", "worst"] : ["bad", "excellent"]).map((t) => element("span", {}, t)));
    const word = (v) => (q.kind === "rank" ? (v === 1 ? "1, best" : v === most ? `${v}, worst` : v) : (v === 1 ? "1, bad" : v === most ? `${v}, excellent` : v));
    return [ends, ...panes.map((pane, k) => {
      const choices = Array.from({ length: most }, (_, r) => choice(pane.code, r + 1, String(r + 1), `Picture ${letterOf(k)}: ${word(r + 1)}`, given()[pane.code] === r + 1,
        () => answerIt(pane.code, r + 1)));
      pane.row = element("fieldset", { class: "row" }, element("legend", {}, element("span", { class: "unseen" }, q.kind === "rank" ? "Rank of picture " : "Rating of picture "), letterOf(k)),
        element("div", { class: "choices" }, ...choices));
      pane.row.addEventListener("focusin", () => select(k));
      pane.row.addEventListener("pointerdown", () => select(k));
      return pane.row;
    })];
  };

  // ---- going through ----
  const count = order.questions.length;
  const time = () => { // spent on the question that is left
    if (q && shownSince) state.seconds[q.id] = (state.seconds[q.id] ?? 0) + (performance.now() - shownSince) / 1000;
    shownSince = document.visibilityState === "visible" ? performance.now() : 0;
  };
  document.addEventListener("visibilitychange", () => { time(); keep(); });
  const showQuestion = () => {
    q = order.questions[state.at];
    const played = survey.images[q.pictures[0]].length > 1;
    clock = 0, current = 0, scroll = [0, 0];
    panes = places().map(paneOf);
    $("question-title").textContent = `Question ${state.at + 1} of ${count}`;
    $("question-text").textContent = words[q.kind](places().length) + (q.text ? " " + q.text : "");
    $("tabs").replaceChildren(...panes.map((p) => p.tab));
    $("pictures").replaceChildren(...panes.map((p) => p.figure));
    $("views").hidden = panes.length < 2;
    document.querySelector(`#views input[value="${wide() ? "all" : "one"}"]`).checked = true;
    $("answer").replaceChildren(...form());
    $("pictures").style.setProperty("--rows", $("answer").querySelectorAll(".row").length);
    $("next").textContent = state.at + 1 < count ? "Next" : "Finish";
    const most = q.kind === "rank" ? panes.length : q.kind === "pair" ? 2 : bestRating;
    const keys = [panes.length > 1 && ["A – " + letterOf(panes.length - 1), "show this picture"],
      [`1 – ${most}`, q.kind === "pair" ? "1: A is better, 2: B is better" : `the ${q.kind} of the picture that is shown`],
      played && ["Space", "play, pause"], ["Enter", "next question"]].filter(Boolean);
    $("key-list").replaceChildren(...keys.flatMap(([key, what]) => [element("dt", {}, key), element("dd", {}, what)]));
    $("play").hidden = !played;
    resize();
    draw();
    say();
    play(played && !matchMedia("(prefers-reduced-motion: reduce)").matches);
  };
  const show = (focus = true) => {
    time();
    const part = state.at < 0 ? "welcome" : state.at < count ? "question" : "end";
    q = null;
    play(false);
    for (const id of ["welcome", "question", "end"]) $(id).hidden = id !== part;
    if (part === "question") showQuestion();
    if (part === "end") $("answers").textContent = $("answers").value = answers();
    $("survey-title").hidden = part === "welcome";
    $("progress").max = count;
    $("progress").value = Math.max(0, state.at);
    $("progress").setAttribute("aria-valuetext", `${Math.max(0, state.at)} of ${count}`);
    keep();
    if (focus) { $(part + "-title").focus({ preventScroll: true }); scrollTo(0, 0); }
  };
  const go = (to) => { time(); state.at = to; show(); };
  const next = () => {
    if (missing().length) { say(true); return; }
    if (state.at + 1 >= count) state.finished = new Date().toISOString();
    go(state.at + 1);
  };

  // ---- the end ----
  const answers = () => JSON.stringify({
    format: "aaresolve-survey-answers", version: 1, survey: survey.survey, participant: state.participant, seed: state.seed, started: state.started, finished: state.finished,
    screen: { width: screen.width, height: screen.height, devicePixelRatio }, remarks: state.remarks,
    answers: order.questions.map((question) => {
      const shown = order.pictures[question.id], own = state.given[question.id];
      return { question: question.id, shown,
        ...(question.kind === "pair" ? { better: own.better } : { [question.kind === "rank" ? "ranks" : "ratings"]: Object.fromEntries(shown.map((c) => [c, own[c]])) }),
        seconds: Math.round((state.seconds[question.id] ?? 0) * 10) / 10 };
    }),
  }, null, 1);
  const fileName = () => `answers-${survey.survey}-${state.participant}.json`;
  $("save").addEventListener("click", () => {
    const link = element("a", { href: URL.createObjectURL(new Blob([answers() + "\n"], { type: "application/json" })), download: fileName() });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    $("saved").textContent = "Saved as " + fileName() + ". Please send that file.";
  });
  $("copy").addEventListener("click", async () => {
    $("answers").select();
    try {
      await navigator.clipboard.writeText($("answers").value);
    } catch {
      document.execCommand("copy"); // where a page from disk has no clipboard of its own
    }
    $("saved").textContent = "Copied.";
  });
  $("remarks").value = state.remarks;
  $("remarks").addEventListener("input", () => {
    state.remarks = $("remarks").value;
    $("answers").textContent = $("answers").value = answers();
    keep();
  });
  $("another").addEventListener("click", () => { $("another-sure").hidden = false; $("another-no").focus(); });
  $("another-no").addEventListener("click", () => { $("another-sure").hidden = true; $("save").focus(); });
  $("another-yes").addEventListener("click", () => {
    q = null;
    state = fresh(), order = orderOf(state.seed);
    $("remarks").value = "", $("saved").textContent = "", $("another-sure").hidden = true, $("resume").hidden = true;
    show();
  });

  // ---- the frame around it ----
  $("survey-title").textContent = $("welcome-title").textContent = survey.title;
  $("intro").append(...survey.intro.split("\n").filter(Boolean).map((line) => element("p", {}, line)));
  const minutes = Math.max(1, Math.round(count * 0.75));
  $("how").append(...[
    `${count} question${count > 1 ? "s" : ""}, about ${minutes} minute${minutes > 1 ? "s" : ""}. Look at all pictures of a question before you answer.`,
    "Pictures are called A, B, C ...; the letters and their order are by chance and differ from question to question.",
    "They are shown pixel by pixel. Where one is larger than its window, drag or scroll: the others follow to the same place.",
    "Your answers stay in this browser until you save them at the end; you may close the page and go on later. They hold no name.",
  ].map((t) => element("li", {}, t)));
  $("begin").addEventListener("click", () => go(0));
  $("back").addEventListener("click", () => go(state.at - 1));
  $("next").addEventListener("click", next);
  $("change").addEventListener("click", () => go(count - 1));
  $("play").addEventListener("click", () => play(!playing));
  $("answer").addEventListener("submit", (event) => event.preventDefault());
  for (const input of document.querySelectorAll("#views input")) input.addEventListener("change", draw);
  addEventListener("resize", resize);
  addEventListener("keydown", (event) => {
    if (!q || event.ctrlKey || event.altKey || event.metaKey) return;
    const place = event.key.length === 1 ? event.key.toUpperCase().charCodeAt(0) - 65 : -1, digit = Number(event.key);
    const most = q.kind === "rank" ? panes.length : q.kind === "pair" ? 2 : bestRating;
    const onControl = event.target.closest?.("button, input, summary");
    if (place >= 0 && place < panes.length) select(place);
    else if (digit >= 1 && digit <= most) answerIt(places()[q.kind === "pair" ? digit - 1 : current], digit);
    else if (event.key === "Enter" && !event.target.closest?.("button, summary")) next();
    else if (event.key === " " && !onControl && !$("play").hidden) play(!playing);
    else return;
    event.preventDefault();
  });
  keep();
  if (!kept) $("how").append(element("li", {}, "This browser keeps nothing between visits: please answer in one go."));
  if (resumed) {
    $("resume").hidden = false;
    $("resume").textContent = "Your answers so far were kept.";
  }
  show(false);
})();
