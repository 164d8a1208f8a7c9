# SPDX-License-Identifier: MIT
"""The pages of docs/results: each asks its questions of the runs, and the figures write the answers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import outcomes
from figures import Difference, Run, across, kendall_tau, number, setup, signed, verdict
from page import Page, code


def _setup(run: Run) -> str:
    return setup(run, min(run.mse(m) for m in run.methods), "here")


def _ranking(run: Run, over_time: bool = True) -> tuple[list[str], list[list[str]]]:
    """All methods by error, with the interval of the gain and whether each differs from the one before it."""
    head = ["method", "PSNR dB", "over noaa, dB", "95 %", "from the row above", "SSIM"]
    flicker = over_time and any(run.temporal(m, "flickerStatic") is not None for m in run.methods)
    if flicker:
        head += ["flicker, 8-bit codes"]
    rows, before = [], None
    for text in run.best_first():
        gain = run.gain(text)
        step = (
            ""
            if before is None
            else ("resolved" if run.gain(before, text).resolved else "not resolved")
        )
        row = [code(text), f"{run.psnr(text):.2f}"]
        row += ["", ""] if text == "noaa" else [signed(gain.db), gain.interval]
        row += [step, f"{run.methods[text]['pooled']['ssimLuma']:.5f}"]
        if flicker:
            row.append(_figure(run.temporal(text, "flickerStatic")))
        rows.append(row)
        before = text
    return head, rows


def _figure(value: float | None, digits: int = 3) -> str:
    return "–" if value is None else f"{value:.{digits}g}"


FXAA, SMAA = "fxaa1:preset=5", "smaa1x:preset=ULTRA"  # as [Oliveros 2018] compares them

# --- the index ---


@dataclass
class Study:
    """Runs by shot: in our protocol and in that of the theses; hard_edges step by step; and what became of the published
    tables."""

    runs: dict[str, Run]
    thesis: dict[str, Run]
    steps: dict[str, Run]
    tables: dict[str, outcomes.Outcome]

    def talk(self) -> dict[str, float]:
        """Gains that [Reshetov 2012] states, dB."""
        rows = (
            self.tables["reshetov-quality"].experiment.published
            if "reshetov-quality" in self.tables
            else {}
        )
        return {name: row[0] for name, row in rows.items() if name != "columns"}

    def table_of(self, shot: str) -> outcomes.Outcome | None:
        """The published table that shows a shot's scene."""
        for o in self.tables.values():
            e = o.experiment
            if e.kind == "table" and e.shots["main"] == shot and "No AA" in o.named():
                return o
        return None

    def published_gains(self, shot: str) -> dict[str, float]:
        """PSNR over no anti-aliasing by our methods, dB, of the table that shows the shot's scene; empty: none does."""
        o = self.table_of(shot)
        if o is None:
            return {}
        base = o.published("No AA", "psnr")
        return {o.text(n): o.published(n, "psnr") - base for n in o.named() if n != "No AA"}


def headlines(study: Study) -> list[str]:
    """The main questions, each answered over all scenes."""
    runs, thesis = study.runs, study.thesis
    moving = [
        n
        for n in (
            "moving_sphere",
            "hairball_rotating",
            "wires",
            "synth_moving",
            "synth_thin_motion",
        )
        if n in runs
    ]
    static = [n for n in ("hard_edges", "hairball", "hairball_unlit", "flowers_close") if n in runs]
    sampled = [n for n in ("hard_edges", "hairball") if n in runs]
    ghost = lambda a, b: lambda r: r.over_time(a, b, "ghost")  # noqa: E731
    gain = lambda a, b: lambda r: r.gain(a, b)  # noqa: E731
    box = lambda r: min(
        (m for m in BOXES if m in r), key=lambda m: r.temporal(m, "ghostMse")
    )  # noqa: E731
    filled = lambda m: lambda r: r.over_time(
        f"accumReject+fill={m}", "accumReject", "rejected"
    )  # noqa: E731
    rest = [n for n in static if n in thesis]
    headline = [
        ("Is `master` better than no anti-aliasing (published: yes)?", gain("master", "noaa")),
        (
            "Is `uncharted`, sharpened as published, better than no anti-aliasing (published: no)?",
            gain("uncharted", "noaa"),
        ),
        (
            "Is `master` better than FXAA (published: yes)?",
            gain("master", FXAA),
        ),
        (
            "Is `master` better than SMAA (published: yes)?",
            gain("master", SMAA),
        ),
        ("Is `master` better than `unchartedNorm`?", gain("master", "unchartedNorm")),
        ("Does un-jittering help `master`?", gain("master", "master:unjitter=off")),
    ]
    answers = [
        f"At rest, {which}: {question} {_over_scenes(rest, r, ask)}"
        for which, r in (("the thesis's question", thesis), ("ours", runs))
        for question, ask in headline
    ]
    asked = [
        ("Does `master` ghost less than `unchartedNorm` (published: yes)?", moving, ghost("master", "unchartedNorm")),
        ("Does identity ghost less than the best colour box?", moving, lambda r: r.over_time("accumReject", box(r), "ghost")),
        ("Does a fill by SMAA help where history was rejected?", moving, filled("smaa1x")),
        ("And by FXAA?", moving, filled("fxaa311")),
        ("And by RSAA?", [n for n in moving if "accumReject+fill=rsaa" in runs[n]], filled("rsaa")),
        ("Are the corrected weights of `raptor` better than the printed ones?", moving, gain("raptor", "raptor:lumaDiff=printed")),
        ("Is RSAA with 8 sub-samples better than MSAA with 8?", sampled, gain("rsaa", "msaa")),
        ("Is it better than MLAA?", sampled, gain("rsaa", "mlaa")),
    ]  # fmt: skip
    return answers + [
        f"{question} {_over_scenes(scenes, runs, ask)}" for question, scenes, ask in asked if scenes
    ]


def _over_scenes(scenes: list[str], runs: dict[str, Run], ask) -> str:
    found: dict[str, list[str]] = {"Yes": [], "No": [], "Not resolved": []}
    for name in scenes:
        d = ask(runs[name])
        if d is not None:
            answer = "Not resolved" if not d.resolved else "Yes" if d.db > 0 else "No"
            found[answer].append(f"{name} ({signed(d.db)} dB)")
    return " ".join(
        f"**{answer}** on {', '.join(where)}." for answer, where in found.items() if where
    )


# --- 1: static protocol ---------------------------------------------------------------------------------------------

THESIS_QUESTION = (
    "**The thesis's question**: displayed values (no gamma anywhere: truth, methods and metrics work on the same values in [0,1]), a "
    "full history (ten jitter periods before the judged frame), 8-bit images: `run --display identity --history full --quantise 8`."
)
OUR_QUESTION = (
    "**Ours**, stricter: light is averaged before it is encoded, in the truth as in a camera, and the history begins with the first of "
    "sixteen frames."
)


def static_page(study: Study) -> Page:
    run, thesis = study.runs["hard_edges"], study.thesis["hard_edges"]
    page = Page("At rest: sixteen frames of hard_edges, two questions")
    page.say(
        "The protocol of the Oliveros thesis: jittered frames of a scene at rest, the last one is judged.",
        _setup(run),
    )
    page.points([THESIS_QUESTION, OUR_QUESTION])
    theirs = study.published_gains("hard_edges")
    page.heading("Gain over no anti-aliasing, dB")
    page.table(
        ["method", "published", "the thesis's question", "95 %", "ours", "95 %"],
        [
            [code(text), signed(theirs[text]) if text in theirs else "–",
             signed(thesis.gain(text).db), thesis.gain(text).interval, signed(run.gain(text).db), run.gain(text).interval]
            for text in [*theirs, "unchartedNorm", "unchartedNoSharpen", "master:unjitter=off"]
        ],
    )  # fmt: skip
    page.say(
        "The thesis's question: "
        + " ".join(_order(thesis, theirs, study.table_of("hard_edges").by_parts))
    )
    page.say("Ours: " + " ".join(_order(run, theirs)))
    page.heading("What each step of the protocol does")
    page.say("Gain over no anti-aliasing in the same protocol, dB.")
    methods = [m for m in next(iter(study.steps.values())).methods if m != "noaa"]
    page.table(
        ["protocol", *(code(m) for m in methods)],
        [[what, *(_short(step.gain(m)) for m in methods)] for what, step in study.steps.items()],
    )
    page.heading("Questions")
    page.points(
        answer
        for which, r in (("the thesis's question", thesis), ("ours", run))
        for answer in _static_answers(study, which, r)
    )
    page.points(
        [
            "Does the test of object ids serve `accumReject` at rest (ours)? "
            + verdict(run.gain("accumReject", "accumReject:objectIds=off"))
            + " A jittered sample beside a thin part shows another object now and then, and the history is dropped."
            * (run.gain("accumReject", "accumReject:objectIds=off").db < 0),
            "Is the first frame's lasting weight a large part of the error from frame 0 (ours)? Averaging the first frames evenly instead: "
            + verdict(run.gain("unchartedNoSharpen:warmup=ramp", "unchartedNoSharpen")),
        ]
    )
    page.heading("What each part of master does")
    thesis = study.table_of("hard_edges").by_parts()
    parts = [m for m in thesis.methods if m.startswith("master:")]
    page.table(
        ["variant", "the thesis's question: PSNR dB", "against `master`", "ours: PSNR dB", "against `master`"],
        [[code("master"), f"{thesis.psnr('master'):.2f}", "", f"{run.psnr('master'):.2f}", ""]]
        + [[code(m), f"{thesis.psnr(m):.2f}", str(thesis.gain(m, "master")),
            *([f"{run.psnr(m):.2f}", str(run.gain(m, "master"))] if m in run else ["–", "–"])] for m in parts],
    )  # fmt: skip
    page.heading("All methods, our question")
    page.table(*_ranking(run))
    page.say(
        "Flicker is the mean standard deviation of a pixel's brightness over the frames after the warm-up. Methods without",
        "history read the same centre-sampled picture in every frame of a static shot, so theirs is 0.",
    )
    return page


def _short(d: Difference) -> str:
    return signed(d.db) + ("" if d.resolved else " (n. r.)")


def _static_answers(study: Study, which: str, run: Run) -> list[str]:
    """What the sharpen filter and un-jittering are worth, and whether master beats the baseline: of one protocol."""
    total = run.psnr("master") - run.psnr("uncharted")
    sharpen = run.psnr("unchartedNorm") - run.psnr("uncharted")
    paper = study.tables["oliveros-5.1"] if "oliveros-5.1" in study.tables else None
    paper_share = ""
    if paper:
        at = lambda name: paper.published(name, "psnr")  # noqa: E731
        part = (at("Uncharted 4.17") - at("Uncharted 3.1")) / (
            at("Master 4.17") - at("Uncharted 3.1")
        )
        paper_share = f" Published (table 5.1, another scene): {100 * part:.0f} %."
    share = (
        f"{100 * sharpen / total:.0f} % ({sharpen:.2f} of {total:.2f} dB)" if total > 0
        else f"all of it and more: the normalised filter alone gains {sharpen:.2f} dB, `master` {total:.2f} dB"
    )  # fmt: skip
    return [
        f"What share of `master`'s lead over `uncharted` is the sharpen filter ({which})? {share}."
        + paper_share,
        f"Is un-jittering the current frame worth it ({which})? {verdict(run.gain('master', 'master:unjitter=off'))}",
        f"Is `master` better than the baseline with the same filter, `unchartedNorm` ({which})? "
        + verdict(run.gain("master", "unchartedNorm")),
        f"Does the normalised sharpen filter help the baseline ({which})? "
        + verdict(run.gain("unchartedNorm", "unchartedNoSharpen")),
    ]


def _order(run: Run, theirs: dict[str, float], parts: Callable[[], Run] | None = None) -> list[str]:
    """Pairs of published methods whose order differs here, and what the figures say of the reason; ``parts`` gives the
    run with the parts of `master` switched off, where that is another one."""
    names = sorted(theirs, key=lambda n: -theirs[n])
    swapped, unsure, agree = [], [], 0
    for i, first in enumerate(names):
        for second in names[i + 1 :]:
            d = run.gain(first, second)
            if not d.resolved:
                unsure.append(f"{code(first)} and {code(second)}")
            elif d.db < 0:
                swapped.append(f"{code(first)} before {code(second)} (here {signed(d.db)} dB)")
            else:
                agree += 1
    tau = kendall_tau([0.0, *(theirs[n] for n in names)], [0.0, *(run.gain(n).db for n in names)])
    sentences = [
        f"Kendall's τ of the order, no anti-aliasing among them: {signed(tau)}; "
        f"{agree} of {len(names) * (len(names) - 1) // 2} pairs of methods keep the published order."
    ]
    if swapped:
        sentences.append("Published, but not here: " + "; ".join(swapped) + ".")
        if any(s.startswith("`master") for s in swapped):
            sentences.append(outcomes.why_master_falls_behind(parts() if parts else run))
    if unsure:
        sentences.append("Not resolved: " + "; ".join(unsure) + ".")
    return sentences


# --- 2: motion ------------------------------------------------------------------------------------------------------

BOXES = (
    "unchartedNoSharpen", "inside", "karis", "salvi", "falcor", "donut", "raptor:sharpen=0", "master:sharpen=none",
)  # fmt: skip


def motion_page(runs: dict[str, Run]) -> Page:
    page = Page("In motion: ghosts, flicker, and what fills the gaps")
    page.say(
        "Ghosts are judged where a surface came into view at most 16 frames ago: `ghost MSE` is the mean squared error there,",
        "`age` the share of the stale colour that is left so many frames later. Flicker follows each surface along its true",
        "motion and counts what changes beyond what the truth changes, in 8-bit codes. ± are 95 % intervals over blocks of",
        "consecutive frames; differences are paired frame by frame.",
    )
    for name in (
        "moving_sphere",
        "hairball_rotating",
        "wires",
        "synth_moving",
        "synth_thin_motion",
    ):
        if name not in runs:
            continue
        run = runs[name]
        page.heading(name)
        page.say(_setup(run))
        page.points(_motion_answers(run))
        if name == "moving_sphere":
            page.picture(
                "moving_sphere.jpg",
                "Contact sheet of moving_sphere: last frame, magnified details, error maps",
            )
        page.table(*_motion_table(run))
    return page


def _motion_answers(run: Run) -> list[str]:
    ghost = lambda a, b: verdict(run.over_time(a, b, "ghost"), "less", "more")  # noqa: E731
    by_ghost = lambda names: min(names, key=lambda m: run.temporal(m, "ghostMse"))  # noqa: E731
    box = by_ghost([m for m in BOXES if m in run])
    answers = [
        "Does `master` ghost less than `unchartedNorm` (published: yes)? " + ghost("master", "unchartedNorm"),
        "And when neither sharpens? " + ghost("master:sharpen=none", "unchartedNoSharpen"),
        f"Does identity (`accumReject`: object ids and expected depth, no colour box) ghost less than the best colour box, "
        f"{code(box)}? " + ghost("accumReject", box),
        _stale(run, "accumReject", box),
        "Is it nearer to the truth over the whole picture, too? " + verdict(run.gain("accumReject", box)),
        "Do object ids matter beside depth? " + ghost("accumReject", "accumReject:objectIds=off")
        + " Does depth beside object ids? " + ghost("accumReject", "accumReject:depthTest=off"),
    ]  # fmt: skip
    share = run.methods["accumReject"].get("rejected", {}).get("share")
    for fill in ("smaa1x", "fxaa311", "rsaa"):
        filled = f"accumReject+fill={fill}"
        if filled in run:
            answers.append(
                f"Does filling with `{fill}` help exactly where history was rejected ({100 * share:.2f} % of the pixels)? "
                + verdict(run.over_time(filled, "accumReject", "rejected"))
                + f" Over the whole picture: {run.gain(filled, 'accumReject')}."
            )
    answers.append(
        "Are the corrected weights of `raptor` better than the printed ones? "
        + verdict(run.gain("raptor", "raptor:lumaDiff=printed"))
        + " Do they ghost less? " + ghost("raptor", "raptor:lumaDiff=printed")
        + " Flicker less? " + verdict(run.over_time("raptor", "raptor:lumaDiff=printed", "flicker"), "less", "more")
    )  # fmt: skip
    return answers


def _stale(run: Run, identity: str, box: str) -> str:
    """How much of the colour that was there before is left one frame after a surface came into view."""
    left = {m: (run.temporal(m, "ghostFraction") or [math.nan])[0] for m in (identity, box)}
    if not all(abs(v) < 1 for v in left.values()):
        return "How much of the old colour is left cannot be said here: it hardly differs from the new one."
    less = abs(left[identity]) < abs(left[box])
    ghosts = run.over_time(identity, box, "ghost")
    text = (
        f"Stale colour left one frame after a surface came into view: {code(identity)} {signed(left[identity])}, "
        f"{code(box)} {signed(left[box])}."
    )
    if less and ghosts is not None and ghosts.resolved and ghosts.db < 0:
        text += " So identity forgets the old colour better, and its larger error there is of another kind."
    return text


def _motion_table(run: Run) -> tuple[list[str], list[list[str]]]:
    head = [
        "method",
        "PSNR dB",
        "over noaa, dB",
        "flicker ±",
        "ghost MSE ± (10⁻⁶)",
        "× noaa",
        "age 1",
        "age 4",
        "age 8",
    ]
    rows = []
    for text in run.best_first():
        fraction = run.temporal(text, "ghostFraction") or []  # empty or zeros: no truth before
        age = (
            lambda a: signed(fraction[a - 1]).lstrip("+") if len(fraction) >= a else "–"
        )  # noqa: E731
        gain = run.gain(text)
        rows.append(
            [code(text), f"{run.psnr(text):.2f}", "" if text == "noaa" else signed(gain.db) + ("" if gain.resolved else " (not resolved)"),
             _with_error(run.temporal(text, "flickerMoving"), run.temporal(text, "flickerError"), 1.0),
             _with_error(run.temporal(text, "ghostMse"), run.temporal(text, "ghostMseError"), 1e6),
             _figure(run.temporal(text, "ghostExcess")), age(1), age(4), age(8)]
        )  # fmt: skip
    return head, rows


def _with_error(value: float | None, error: float | None, scale: float) -> str:
    if value is None:
        return "–"
    digits = 0 if value * scale >= 100 else 2
    text = f"{value * scale:.{digits}f}"
    return text if error is None else f"{text} ± {error * scale:.{digits}f}"


# --- 3: geometry ----------------------------------------------------------------------------------------------------


def geometry_page(runs: dict[str, Run], talk: dict[str, float] | None = None) -> Page:
    """`talk`: gains that [Reshetov 2012] states, by name, dB."""
    page = Page("Geometry-aware methods: how many sub-samples, and what they must know")
    page.say(
        "All at the pixel centre, no history. Sub-sample patterns are those of Direct3D. Shots with another number of",
        "sub-samples are other shots of the same scene and truth, so they are compared tile by tile as well.",
    )
    for name in ("hard_edges", "hairball"):
        if name not in runs:
            continue
        run = runs[name]
        by_s = {8: run} | {s: runs[f"{name}.s{s}"] for s in (2, 4, 16) if f"{name}.s{s}" in runs}
        page.heading(name)
        page.say(_setup(run))
        page.points(_geometry_answers(run, by_s, talk or {}))
        if name == "hairball":
            page.picture(
                "hairball.jpg",
                "Contact sheet of the hairball: MLAA, RSAA, MSAA and methods with history",
            )
        methods = sorted({m for r in by_s.values() for m in r.methods if m.split(":")[0] in
                          {"msaa", "csaa", "dmsaa", "sraa", "sbaa", "rsaa", "deaa"}}, key=lambda m: (-run.psnr(m) if m in run else 0, m))  # fmt: skip
        page.say("PSNR gain over `noaa`, dB, by sub-samples per pixel:")
        page.table(
            ["method", *(f"S = {s}" for s in sorted(by_s))],
            [
                [
                    code(m),
                    *(signed(by_s[s].gain(m).db) if m in by_s[s] else "–" for s in sorted(by_s)),
                ]
                for m in methods
            ],
        )
        plain = [
            m
            for m in ("mlaa", "smaa1x:preset=ULTRA", "fxaa311:preset=39", "gbaa", "gpaa", "d2e")
            if m in run
        ]
        page.say(
            "For comparison, without sub-samples: "
            + ", ".join(f"{code(m)} {signed(run.gain(m).db)} dB" for m in plain)
            + "."
        )
    return page


def _geometry_answers(run: Run, by_s: dict[int, Run], talk: dict[str, float]) -> list[str]:
    answers = [
        f"Is SADP with tuning better than {what}? " + verdict(run.gain("rsaa", variant))
        for what, variant in (
            ("depth alone", "rsaa:measure=depth"), ("normals alone", "rsaa:measure=normal"), ("SADP untuned", "rsaa:tuning=off"),
            ("depth alone, not told apart by object id", "rsaa:measure=depth,ids=off"),
            ("normals alone, not told apart by object id", "rsaa:measure=normal,ids=off"),
            ("a table learned from half-planes alone", "rsaa:training=halfPlanes"),
        )
        if variant in run
    ]  # fmt: skip
    for s in (4, 16):
        if s in by_s:
            answers.append(
                f"Are 8 sub-samples better than {s}? "
                + verdict(across(run, "rsaa", by_s[s], "rsaa"))
            )
    for s in sorted(by_s):
        if "rsaa" in by_s[s]:
            answers.append(
                f"Is RSAA better than MSAA of {s} sub-samples? "
                + verdict(by_s[s].gain("rsaa", "msaa"))
            )
    answers.append("Is RSAA better than MLAA? " + verdict(run.gain("rsaa", "mlaa")))
    answers += _against_the_talk(run, by_s, talk) if talk else []
    return answers


def _against_the_talk(run: Run, by_s: dict[int, Run], talk: dict[str, float]) -> list[str]:
    """The talk's three figures against ours, in words that depend on the intervals."""

    def compare(what: str, claim: float, ours: Difference) -> str:
        inside = ours.low <= claim <= ours.high
        relation = "agrees" if inside else "is above" if ours.db > claim else "is below"
        return f"The talk says {what}: {signed(claim, 0)} dB. Ours {relation}: {ours}."

    answers = [
        compare("RSAA with 8 sub-samples gains", talk["RSAA"], run.gain("rsaa")),
        compare("MLAA gains", talk["MLAA"], run.gain("mlaa")),
    ]
    if 4 in by_s:
        answers.append(
            compare(
                "4 sub-samples instead of 8 change",
                talk["RSAA of 4"] - talk["RSAA"],
                across(by_s[4], "rsaa", run, "rsaa"),
            )
        )
    if "msaa" in run:
        ceiling = run.gain("msaa")
        bound = run.gain("msaa", "rsaa")
        answers.append(
            f"The reason is the scene: MSAA of the same samples, which knows every surface in the pixel, gains {ceiling.db:.2f} dB here"
            + (
                f", {bound.db:.2f} dB more than RSAA, which can fetch only what some pixel's centre shows."
                if bound.resolved and bound.db > 0
                else f", {-bound.db:.2f} dB less than RSAA: the edges are isolated, where learned offsets beat plain coverage."
                if bound.resolved
                else ", which cannot be told from RSAA."
            )
        )
    return answers


# --- 4, 5: angles, published -------------------------------------------------------------------------------------


def angles_page(study: dict) -> Page:
    degrees = study["degrees"]
    page = Page(f"Half-planes at {len(degrees)} angles")
    page.say(
        "PSNR gain over no anti-aliasing on analytic half-planes, whose truth is exact, so without error bars. Mirrored, turned:",
        "the largest difference of the gain between an edge and its mirror image or quarter turn; 0 = the method treats them",
        "alike.",
    )
    rows = []
    for m in sorted(study["methods"], key=lambda m: -number(m["pooledGainDb"])):
        gains = [number(g) for g in m["gainDb"]]
        least, most = min(range(len(gains)), key=gains.__getitem__), max(
            range(len(gains)), key=gains.__getitem__
        )
        rows.append(
            [code(m["text"]), signed(number(m["pooledGainDb"])), f"{signed(gains[least])} at {degrees[least]:.0f}°",
             f"{signed(gains[most])} at {degrees[most]:.0f}°", f"{number(m['mirrorDb']):.3f}", f"{number(m['turnDb']):.3f}",
             m["subsamples"] or "–"]
        )  # fmt: skip
    page.table(
        ["method", "gain, dB", "least", "most", "mirrored, dB", "turned, dB", "sub-samples"], rows
    )
    return page


def spaces_page(study: Study) -> Page:
    runs = study.runs
    page = Page("The thesis's question beside ours")
    page.points([THESIS_QUESTION, OUR_QUESTION])
    rows, notes = [], []
    for shot, run in study.thesis.items():
        theirs = study.published_gains(shot)
        if not theirs or shot not in runs:
            continue
        texts = [*theirs, "unchartedNorm"]
        rows.append([shot, "published", *(signed(theirs[t]) if t in theirs else "" for t in texts)])
        in_parts = study.table_of(shot).by_parts
        for which, r, parts in (
            ("the thesis's question", run, in_parts),
            ("ours", runs[shot], None),
        ):
            rows.append(["", which, *(_short(r.gain(t)) for t in texts)])
            notes.append(f"**{shot}**, {which}: " + " ".join(_order(r, theirs, parts)))
    if rows:
        page.heading("PSNR gain over no anti-aliasing, dB")
        page.table(["scene", "question", *(code(t) for t in texts)], rows)
        page.say("n. r.: not resolved from no anti-aliasing.")
        page.points(notes)
    if {"hard_edges.t2msaa", "hard_edges.s2", "hard_edges.s4"} <= set(study.thesis):
        page.heading("T2MSAA lies between 2x and 4x MSAA [Stejmar n.d.]")
        page.say(
            "Its samples are those that it asks for: two per pixel, moved between frames by 0.25, 0.1875 or 0.125 px. The answer depends on",
            "the space in which samples are averaged, so every space is shown; both sides of a pair in different spaces is no comparison.",
        )
        page.points(_t2msaa_answers(study))
    return page


def _t2msaa_answers(study: Study) -> list[str]:
    spaces = [
        ("one displayed space (samples, truth and metric)", study.thesis, "t2msaa", "msaa"),
        (
            "linear light (samples and truth; the metric encodes)",
            study.runs,
            "t2msaa:space=linear",
            "msaa",
        ),
        (
            "encoded samples against a truth in linear light",
            study.runs,
            "t2msaa",
            "msaa:space=encoded",
        ),
        ("two different spaces: encoded T2MSAA, linear MSAA", study.runs, "t2msaa", "msaa"),
    ]
    answers = []
    for space, runs, temporal, spatial in spaces:
        for shot, offset in (("t2msaa", "0.25"), ("t2msaa1875", "0.1875"), ("t2msaa125", "0.125")):
            t2, s2, s4 = (runs[f"hard_edges.{n}"] for n in (shot, "s2", "s4"))
            answers.append(
                f"In {space}, moved by {offset} px: better than MSAA of 2? {verdict(across(t2, temporal, s2, spatial))} "
                f"Worse than MSAA of 4? {verdict(across(s4, spatial, t2, temporal), 'worse', 'better')}"
            )
    return answers


def scenes_page(runs: dict[str, Run]) -> Page:
    page = Page("Every method on every static scene")
    page.say(
        "Sorted by PSNR. `from the row above`: whether the difference exceeds the truth's noise and a bootstrap over tiles."
    )
    for name in ("hard_edges", "hairball", "hairball_unlit", "flowers_close"):
        if name not in runs:
            continue
        page.heading(name)
        page.say(_setup(runs[name]))
        if name != "hard_edges":
            page.table(*_ranking(runs[name]))
            continue
        page.say(
            "All shots of the scene together; other patterns and jitters are other shots with the same truth."
        )
        rows = []
        for shot, run in runs.items():
            if shot.split(".")[0] == name:
                rows += [(m, shot, run) for m in run.methods if m != "noaa" or shot == name]
        rows.sort(key=lambda r: r[2].mse(r[0]))
        page.table(
            ["method", "shot", "PSNR dB", "over noaa, dB", "95 %"],
            [[code(m), shot, f"{run.psnr(m):.2f}", signed(run.gain(m).db), run.gain(m).interval]
             for m, shot, run in rows],
        )  # fmt: skip
    return page
