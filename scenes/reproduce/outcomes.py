# SPDX-License-Identifier: MIT
"""What became of a published table: its runs, our figures beside the published ones, and what they say of its claims."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path

import cost
from experiments import Claim, Experiment
from figures import Difference, Run, across, kendall_tau, number, signed
from runs import at_edges_and_elsewhere, bench, compared, run_methods
from shots import Shot, Workshop, make

HOLDS, FAILS, UNRESOLVED = "holds", "does not hold", "not resolved"


@dataclass
class Verdict:
    """What the figures say of one claim."""

    claim: Claim
    answer: str
    figures: str  # in words
    reasons: list[str] = field(default_factory=list)


@dataclass
class Outcome:
    """One table, run."""

    experiment: Experiment
    folders: dict[str, Path]  # of its shots
    run: Run | None = None
    by_name: dict[str, dict[str, float]] = field(default_factory=dict)  # name -> figure -> ours
    other: dict[str, dict[str, float]] = field(default_factory=dict)  # the same, against the truth
    parts: dict[str, Run] = field(default_factory=dict)  # further runs: regions, headroom, shots
    spectra: dict[str, Path] = field(
        default_factory=dict
    )  # pictures of differences in the Fourier domain
    verdicts: list[Verdict] = field(default_factory=list)
    taus: dict[str, float] = field(default_factory=dict)  # figure -> Kendall's tau of the order
    shop: Workshop | None = None
    pictures: dict[str, Path] = field(default_factory=dict)  # by names of rows
    # Share of the pixels at edges, and by name the squared error there and elsewhere, each over all pixels.
    places: tuple[float, dict[str, tuple[float, float]]] = (0.0, {})

    def also(self, name: str, texts: list[str], flags: tuple[str, ...] = ()) -> Run:
        """A further run of the main shot, which only some answers need."""
        if name not in self.parts:
            e = self.experiment
            flags = (*e.protocol.flags, *flags)
            what = f"{e.key}.{name.replace(' ', '_')}"
            self.parts[name] = run_methods(self.folders["main"], what, texts, self.shop, flags)
        return self.parts[name]

    def by_parts(self, region: str = "") -> Run:
        """`master` whole and with each of its parts off or read otherwise."""
        e = self.experiment
        texts = list(dict.fromkeys(["noaa", "master", *e.protocol.beside, *e.protocol.parts]))
        if region:
            return self.also(f"{region}, parts of master", texts, region_flags(self, region))
        return self.also("parts of master", texts)

    def text(self, name: str) -> str:
        return self.experiment.methods[name]

    def gain(self, first: str, second: str = "No AA", part: str = "") -> Difference:
        return (self.parts[part] if part else self.run).gain(self.text(first), self.text(second))

    @property
    def smallest_error(self) -> float | None:
        """MSE of the best method that is ranked; None without such a ranking."""
        if self.run is None:
            return None
        if self.other:  # pictures of several shots, held against one truth
            return min(self.other[n]["mse"] for n in self.named())
        names = self.named() or list(self.experiment.methods)
        return min(self.run.mse(self.text(n)) for n in names if self.text(n) in self.run)

    @property
    def noise_share(self) -> float | None:
        """The truth's own error over the smallest one, in percent; None without a ranking, and of an exact truth."""
        least = self.smallest_error
        return 100.0 * self.run.noise / least if least and self.run.noise > 0 else None

    def named(self) -> list[str]:
        """The names whose figures are published."""
        return [n for n in self.experiment.methods if n in self.experiment.published]

    def published(self, name: str, figure: str) -> float | None:
        """One cell of the published table."""
        columns, row = self.experiment.published["columns"], self.experiment.published[name]
        return row[columns.index(figure)] if figure in columns else None


def of(
    experiment: Experiment, catalogue: dict[str, Shot], shop: Workshop, before: dict[str, "Outcome"]
) -> Outcome:
    """Renders what is missing, runs the methods and answers the claims; `before`: the outcomes so far."""
    return judged(measured(experiment, catalogue, shop), before)


def measured(experiment: Experiment, catalogue: dict[str, Shot], shop: Workshop) -> Outcome:
    """Our figures beside the published ones."""
    folders = {
        own: make(catalogue, catalogue[name], shop) for own, name in experiment.shots.items()
    }
    outcome = Outcome(experiment, folders, shop=shop)
    _FILL[experiment.kind](outcome, catalogue, shop)
    return outcome


def judged(outcome: Outcome, before: dict[str, "Outcome"]) -> Outcome:
    """The same with the answers to its claims; `before`: the outcomes so far."""
    outcome.verdicts += [_verdict(outcome, claim, before) for claim in outcome.experiment.claims]
    for number, verdict in enumerate(outcome.verdicts):
        options = verdict.claim.options
        if verdict.answer == HOLDS:
            continue
        if "else" in options:
            verdict.reasons.append(options["else"])
        if "why" in options:
            verdict.reasons.append(_measured_why(outcome, f"why {number}", options["why"]))
    return outcome


def _measured_why(o: Outcome, name: str, pairs: list[list[str]]) -> str:
    """What variants gain over what they vary: words, the variant, what it varies; on every shot of a table of options."""
    if o.run is not None:
        texts = list(dict.fromkeys(["noaa", *(t for _, *two in pairs for t in two)]))
        runs = {"": o.also(name, texts)}
    else:
        runs = o.parts
    said = []
    for what, varied, base in pairs:
        found = {shot: run.gain(varied, base) for shot, run in runs.items()}
        said.append(f"{what} " + ", ".join(f"{shot} {d}".strip() for shot, d in found.items()))
    return "Measured: " + "; ".join(said) + "."


# --- the kinds ---


def _run_main(o: Outcome, shop: Workshop, names: list[str], write: str = "exr") -> None:
    """All methods on the main shot, in the protocol, and our figures of these names."""
    e = o.experiment
    o.run = run_methods(o.folders["main"], e.key, e.texts(), shop, e.protocol.flags, write)
    for name in names:
        o.by_name[name] = pooled(o.run, o.text(name), e.protocol.codes)


def _table(o: Outcome, _catalogue: dict[str, Shot], shop: Workshop) -> None:
    e, folder = o.experiment, o.folders["main"]
    _run_main(o, shop, o.named())
    for region in e.regions:
        flags = (*e.protocol.flags, *region_flags(o, region))
        what = f"{e.key}.{region.replace(' ', '_')}"
        o.parts[region] = run_methods(folder, what, list(e.methods.values()), shop, flags)
    _rank(o, "psnr")


def region_flags(o: Outcome, region: str) -> tuple[str, ...]:
    """Of `run`, for a part of the picture that the table names."""
    width, height = o.run.data["shot"]["resolution"]
    share = o.experiment.regions[region]
    box = [round(v * s) for v, s in zip(share, (width, height, width, height))]
    return ("--region", ",".join(map(str, box)))


def _ghosts(o: Outcome, catalogue: dict[str, Shot], shop: Workshop) -> None:
    _run_main(o, shop, o.named(), write="none")
    means = [o.experiment.published[n]["mse"][2] for n in o.named()]
    o.taus["mse"] = kendall_tau(means, [o.by_name[n]["mse"] for n in o.named()])


def _reference_size(o: Outcome, _catalogue: dict[str, Shot], shop: Workshop) -> None:
    e = o.experiment
    for own, folder in o.folders.items():
        o.parts[own] = run_methods(folder, e.key, list(e.methods.values()), shop, e.protocol.flags)
        o.by_name[own] = {
            f"{figure} {name}": value
            for name, text in e.methods.items()
            for figure, value in pooled(o.parts[own], text, e.protocol.codes).items()
        }


def _fourier(o: Outcome, _catalogue: dict[str, Shot], shop: Workshop) -> None:
    """Every method's picture of the judged frame against the reference's, and against the truth."""
    e = o.experiment
    pictures: dict[str, Path] = {}
    truth: Path | None = None
    for own, folder in o.folders.items():
        names = [n for n in e.methods if e.protocol.shots.get(n, "main") == own]
        texts = list(dict.fromkeys(["noaa", *(o.text(n) for n in names)]))
        run = run_methods(folder, e.key, texts, shop, e.protocol.flags, write="exr")
        o.parts[own] = run
        for name in names:
            pictures[name] = run.folder / _last_picture(run.methods[o.text(name)])
        if own == "main":
            o.run = run
            truth = (
                run.folder / run.data["truth"]["images"][max(run.data["truth"]["images"], key=int)]
            )
    reference = pictures[e.protocol.reference]
    for name in [*o.named(), e.protocol.reference]:
        o.other[name] = compared(pictures[name], truth, e.key, shop)
        if pictures[name] != reference:
            spectra = (
                o.folders["main"].parent / f"{e.key}.spectra"
            )  # the run may be another table's, too
            spectra.mkdir(exist_ok=True)
            o.spectra[name] = spectra / f"{name.replace(' ', '_')}.png"
            o.by_name[name] = compared(pictures[name], reference, e.key, shop, o.spectra[name])
    o.places = at_edges_and_elsewhere(
        reference, pictures["No AA"], {n: pictures[n] for n in o.named()}, e.key, shop
    )
    _rank(o, "fmagMse")
    o.taus["fmagMse, against the truth"] = _tau(o, "fmagMse", o.other)


def _cost(o: Outcome, _catalogue: dict[str, Shot], shop: Workshop) -> None:
    e = o.experiment
    for own, folder in o.folders.items():
        names = [n for n in e.methods if e.protocol.shots.get(n, "main") == own]
        rows = bench(folder, list(dict.fromkeys(["noaa", *(o.text(n) for n in names)])), shop)
        width, height = json.loads((folder / "shot.json").read_text())["resolution"]
        base = rows["noaa"]
        for name in names:
            o.by_name[name] = cost.figures(rows[o.text(name)], base, width * height)
    for figure in o.experiment.published["columns"]:
        o.taus[figure] = _tau(o, figure, o.by_name)


def _options(o: Outcome, catalogue: dict[str, Shot], shop: Workshop) -> None:
    e = o.experiment
    texts = ["noaa", *(p[k] for p in e.options for k in ("with", "without"))]
    texts += [t for p in e.options for _, *two in p.get("why", ()) for t in two]
    texts = list(dict.fromkeys(texts))
    for name in e.on:
        folder = make(catalogue, catalogue[name], shop)
        o.parts[name] = run_methods(folder, e.key, texts, shop, e.protocol.flags)
    for option in e.options:
        claim = Claim(option["says"], "option", option, option)
        found = {name: of_option(run, option) for name, run in o.parts.items()}
        words = "; ".join(f"{name} {d}" for name, d in found.items() if d)
        o.verdicts.append(Verdict(claim, _over_all([d for d in found.values() if d]), words))


def _series(o: Outcome, _catalogue: dict[str, Shot], shop: Workshop) -> None:
    _run_main(o, shop, list(o.experiment.methods), write="none")


def gains_over_time(o: Outcome, name: str, over: str = "No AA") -> dict[int, float]:
    """PSNR over that of another method in every frame that has truth, dB, by the frame's number."""
    values = lambda text: {  # noqa: E731
        f["frame"]: number(f["metrics"]["psnr"])
        for f in o.run.methods[text]["frames"]
        if f.get("metrics")
    }
    base, own = values(o.text(over)), values(o.text(name))
    return {frame: own[frame] - base[frame] for frame in own}


def _rates(o: Outcome, _catalogue: dict[str, Shot], shop: Workshop) -> None:
    """Samples per pixel and frame of every sort, by the program's own tables of methods and passes."""
    listed = json.loads(shop.run("list", [shop.program, "list", "--json"]))
    passes = {p["name"]: p for p in listed["passes"]}
    methods = {m["id"]: m for m in listed["methods"]}
    for name, text in o.experiment.methods.items():
        method = methods[text.split(":")[0]]
        samples = {p: SUBSAMPLES if passes[p]["perSubSample"] else 1 for p in method["passes"]}
        o.by_name[name] = {
            **samples,
            "bytes": sum(n * passes[p]["bytesPerPixel"] for p, n in samples.items()),
            "history": float(bool(method["temporal"])),
        }


SUBSAMPLES = 8  # per pixel, in the table of rates


def _variants(o: Outcome, _catalogue: dict[str, Shot], shop: Workshop) -> None:
    """The same methods on one scene that was exported in several ways, against one truth."""
    e = o.experiment
    for own, folder in o.folders.items():
        texts = list(e.methods.values())
        o.parts[own] = run_methods(folder, e.key, texts, shop, e.protocol.flags, write="exr")
        o.by_name[own] = {n: o.parts[own].psnr(t) for n, t in e.methods.items()}
        for n, t in e.methods.items():
            o.pictures[f"{own}: {n}"] = o.parts[own].folder / _last_picture(o.parts[own].methods[t])
    o.run = o.parts["main"]


def _of_display(flags: tuple[str, ...]) -> tuple[str, ...]:
    """Those of `run` that say what is displayed, as `compare` takes them."""
    pairs = zip(flags, flags[1:])
    return tuple(w for pair in pairs if pair[0] in ("--exposure", "--display") for w in pair)


def _codes(o: Outcome, catalogue: dict[str, Shot], shop: Workshop) -> None:
    """The written picture of the last frame, row by row, against the truth, which is not rounded."""
    e = o.experiment
    (name,) = e.on
    folder = make(catalogue, catalogue[name], shop)
    for number, row in enumerate(e.rows):
        flags = (*e.protocol.flags, *row.get("flags", ()))
        # Pictures of codes with floats beside them: the truth is written like the pictures, and must not be rounded.
        write = {"png": "exr,png"}.get(row["write"], row["write"])
        run = run_methods(folder, f"{e.key}.{number}", [row["method"]], shop, flags, write)
        images = run.data["truth"]["images"]
        truth = run.folder / images[max(images, key=int)]
        last = run.folder / _last_picture(run.methods[row["method"]])
        picture = last.with_suffix("." + row["write"])
        o.pictures[row["name"]] = picture
        o.by_name[row["name"]] = compared(
            picture,
            truth,
            e.key,
            shop,
            flags=_of_display(e.protocol.flags),
            figures="banding,grain,mse,psnr",
        )
        o.parts[row["name"]] = run
        o.pictures["Truth"] = truth


_FILL = {
    "variants": _variants, "codes": _codes, "series": _series, "rates": _rates,
    "table": _table, "ghosts": _ghosts, "reference size": _reference_size, "fourier": _fourier, "cost": _cost,
    "options": _options,
}  # fmt: skip


def of_option(run: Run, option: dict) -> Difference | None:
    a, b = option["with"], option["without"]
    return run.gain(a, b) if option["figure"] == "gain" else run.over_time(a, b, option["figure"])


def _over_all(found: list[Difference]) -> str:
    """Holds where it holds on every shot that resolves it."""
    clear = [d.db > 0 for d in found if d.resolved]
    if not clear:
        return UNRESOLVED
    return HOLDS if all(clear) else FAILS if not any(clear) else "holds on some"


def pooled(run: Run, text: str, codes: float) -> dict[str, float]:
    """Figures over the judged frames, squared error in the unit of the protocol."""
    found = {k: number(run.methods[text]["pooled"][k]) for k in ("mse", "psnr", "snr", "ssimLuma")}
    mse = found["mse"] * codes * codes
    return {**found, "mse": mse, "rmse": math.sqrt(mse)}


def _last_picture(method: dict) -> str:
    return [f["image"] for f in method["frames"] if f.get("image")][-1]


def _rank(o: Outcome, figure: str) -> None:
    """Of the published order; a table of gains is one of PSNR, less that of no anti-aliasing."""
    if len(o.named()) < 2:
        return
    if figure == "psnr" and "gain" in o.experiment.published["columns"]:
        theirs = [o.published(n, "gain") for n in o.named()]
        o.taus["gain"] = kendall_tau(theirs, [o.gain(n).db for n in o.named()])
    else:
        o.taus[figure] = _tau(o, figure, o.by_name)


def _tau(o: Outcome, figure: str, ours: dict[str, dict[str, float]]) -> float:
    names = [n for n in o.named() if n in ours]
    return kendall_tau([o.published(n, figure) for n in names], [ours[n][figure] for n in names])


# --- claims ---


def _answer(d: Difference) -> str:
    return UNRESOLVED if not d.resolved else HOLDS if d.db > 0 else FAILS


def _verdict(o: Outcome, claim: Claim, before: dict[str, Outcome]) -> Verdict:
    answer, words, reasons = _TESTS[claim.test](o, claim, before)
    return Verdict(claim, answer, words, reasons)


def _better(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    first, second = claim.of
    if o.experiment.kind == "fourier":
        ours = o.other if claim.options.get("reference") == "truth" else o.by_name
        a, b = ours[first]["fmagMse"], ours[second]["fmagMse"]
        answer = HOLDS if a < b else FAILS
        why = [] if answer == HOLDS or ours is o.other else [_by_places(o, first, second)]
        return answer, f"{first} {a:.4g}, {second} {b:.4g}", why
    region = claim.options.get("region", "")
    d = o.gain(first, second, region)
    answer = _answer(d)
    why = reasons(o, first, region) if answer == FAILS else []
    if answer != HOLDS and first == "No AA":
        why += in_headroom(o, second)
    return answer, str(d), why


def _near(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    (first, second), within = claim.of, claim.options["within"]
    d = o.gain(first, second)
    if -within <= d.low and d.high <= within:
        answer = HOLDS
    else:
        answer = FAILS if d.low > within or d.high < -within else UNRESOLVED
    return (
        answer,
        f"{d}; asked is ± {within:g} dB",
        reasons(o, first) if d.db < -within else [],
    )


def _best(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    found = {n: o.gain(claim.of, n) for n in o.named() if n != claim.of}
    closest = min(found, key=lambda n: found[n].db)
    answer = _answer(found[closest])
    return (
        answer,
        f"over the next, {closest}: {found[closest]}",
        reasons(o, claim.of) if answer == FAILS else [],
    )


def _between(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    name, low, high = claim.of
    a, worse, better = (o.by_name[n]["fmagMse"] for n in (name, low, high))
    words = f"{low} {worse:.4g}, {name} {a:.4g}, {high} {better:.4g}"
    answer = HOLDS if better < a < worse else FAILS
    why = []
    if answer == FAILS:
        figures = ", ".join(f"{n} {o.other[n]['fmagMse']:.4g}" for n in (low, name, high))
        why = [f"Against the truth: {figures}.", _by_places(o, name, high)]
    return answer, words, why


def _less_than_half(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    *weak, strong = claim.of
    best = o.gain(strong)
    gains = {n: o.gain(n) for n in weak}
    words = ", ".join(f"{n} {signed(d.db)} dB" for n, d in {**gains, strong: best}.items())
    answer = HOLDS if all(2 * d.db < best.db for d in gains.values()) else FAILS
    return answer, words, [] if answer == HOLDS else reasons(o, strong)


def _more_flicker(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    a, b = (o.run.temporal(o.text(n), "flickerStatic") for n in claim.of)
    if a is None or b is None:
        return UNRESOLVED, "the shot has no figure of flicker", []
    words = f"{claim.of[0]} {a:.3g}, {claim.of[1]} {b:.3g} 8-bit codes"
    return (HOLDS if a > b else FAILS), words, []


def _less_ghost(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    d = o.run.over_time(*(o.text(n) for n in claim.of), "ghost")
    if d is None:
        return UNRESOLVED, "the shot uncovers nothing", []
    return _answer(d), f"{d} less ghost MSE", []


def _exact_at_best(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    lowest = {n: extremes(o, n, "mse")[0] for n in claim.of}
    words = ", ".join(f"{n} {v:.3g}" for n, v in lowest.items()) + " codes² in the best frame"
    return (HOLDS if all(v < 0.01 for v in lowest.values()) else FAILS), words, []


def _change(o: Outcome, figure: str) -> float:
    """Of a figure from the first shot's truth to the last one's, percent."""
    first, last = list(o.by_name)[0], list(o.by_name)[-1]
    return 100 * abs(o.by_name[first][figure] / o.by_name[last][figure] - 1)


def _changes_below(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    rows = [r for r in o.experiment.published if r != "columns"]
    worst = max(rows, key=lambda r: _change(o, r))
    return (
        (HOLDS if _change(o, worst) < claim.of else FAILS),
        f"at most {_change(o, worst):.2g} % ({worst})",
        [],
    )


def _changes_more(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    a, b = (_change(o, f"mse {n}") for n in claim.of)
    return (
        (HOLDS if a > b else FAILS),
        f"MSE of {claim.of[0]} by {a:.2g} %, of {claim.of[1]} by {b:.2g} %",
        [] if a > b else [_same_noise(o, claim.of)],
    )


def _same_noise(o: Outcome, names: list[str]) -> str:
    few, many = list(o.by_name)[0], list(o.by_name)[-1]
    added = [o.by_name[few][f"mse {n}"] - o.by_name[many][f"mse {n}"] for n in names]
    own = [o.by_name[many][f"mse {n}"] for n in names]
    return (
        f"The noise of the smaller truth adds {added[0]:.3g} codes² to {names[0]} and {added[1]:.3g} to {names[1]}, whose errors are "
        f"{own[0]:.4g} and {own[1]:.4g}: of the larger one it is the smaller share. In the thesis both truths are means of the very "
        "positions at which its methods sample."
    )


def _better_than_in(o: Outcome, claim: Claim, before) -> tuple[str, str, list[str]]:
    key, name = claim.of
    if key not in before:
        return UNRESOLVED, f"{key} was not run", []
    a, b = o.by_name[name]["fmagMse"], before[key].by_name[name]["fmagMse"]
    return (
        (HOLDS if a < b else FAILS),
        f"{a:.4g} here, {b:.4g} in {before[key].experiment.label}",
        [],
    )


def _worse_than_still(o: Outcome, claim: Claim, before) -> tuple[str, str, list[str]]:
    key, name = claim.of
    if key not in before:
        return UNRESOLVED, f"{key} was not run", []
    drop = before[key].by_name[name]["psnr"] - o.by_name[name]["psnr"]
    return (HOLDS if drop > claim.options["by"] else FAILS), f"{signed(-drop)} dB", []


def _above_by(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    first, second = claim.of
    low, high = claim.options["from"], claim.options["to"]
    d = o.gain(first, second)
    if low <= d.low and d.high <= high:
        answer = HOLDS
    else:
        answer = FAILS if d.high < low or d.low > high else UNRESOLVED
    return answer, f"{d}; asked is {low:g} to {high:g} dB", []


def _reaches(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    own, least = o.by_name[claim.of], {
        k: v for k, v in claim.options.items() if k in o.by_name[claim.of]
    }
    words = ", ".join(f"{k} {own[k]:.4g} (asked: {v:g})" for k, v in least.items())
    if all(own[k] >= v for k, v in least.items()):
        return HOLDS, words, []
    plain = pooled(o.run, "noaa", o.experiment.protocol.codes)
    figures = ", ".join(f"{k} {plain[k]:.4g}" for k in least)
    gain = o.run.gain(o.text(claim.of))
    return (
        FAILS,
        words,
        [f"No anti-aliasing has {figures} on this picture, over which {claim.of} gains {gain}."],
    )


def _better_shot(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    first, second = claim.of
    text = o.text(claim.options["method"])
    d = across(o.parts[first], text, o.parts[second], text)
    return _answer(d), str(d), []


def _lower(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    first, second = claim.of
    a, b = (o.by_name[n][claim.options["figure"]] for n in claim.of)
    words = f"{first} {a:.3g}, {second} {b:.3g} codes"
    return (HOLDS if a < b else FAILS), words, []


def moment(o: Outcome, name: str) -> tuple[list[float], list[float]]:
    """Gains inside and outside of the moment."""
    first, last = o.experiment.moment
    gains = gains_over_time(o, name)
    inside = [g for f, g in gains.items() if first <= f <= last]
    return inside, [g for f, g in gains.items() if not first <= f <= last]


def _dips(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    first, last = o.experiment.moment
    over = claim.options["over"]
    gains = gains_over_time(o, claim.of, over)
    mean = lambda values: sum(values) / len(values)  # noqa: E731
    before = mean([g for f, g in gains.items() if f < first])
    inside = mean([g for f, g in gains.items() if first <= f <= last])
    words = f"over {over} {signed(before)} dB before, {signed(inside)} dB in the moment"
    return (HOLDS if before - inside > claim.options["by"] else FAILS), words, []


def _above_in_moment(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    (a, _), (b, _) = (moment(o, n) for n in claim.of)
    worst = min(x - y for x, y in zip(a, b))
    mean = sum(a) / len(a) - sum(b) / len(b)
    answer = HOLDS if worst > 0 else FAILS if mean < 0 else "holds on some"
    return (
        answer,
        f"{signed(mean)} dB in the mean, {signed(worst)} dB in the least favourable frame",
        [],
    )


def _costs(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    a, b = (o.by_name[n]["ms"] for n in claim.of)
    low, high = claim.options["times"]
    return (
        (HOLDS if low <= a / b <= high else FAILS),
        f"{a / b:.2g} times ({a:.3g} and {b:.3g} ms)",
        [],
    )


def _cheapest(o: Outcome, claim: Claim, _before) -> tuple[str, str, list[str]]:
    least = min(o.named(), key=lambda n: o.by_name[n]["ms"])
    beside = [n for n in o.by_name if n not in o.named() and n != "No AA"]
    words = f"the cheapest is {least}, {o.by_name[least]['ms']:.3g} ms; {claim.of} {o.by_name[claim.of]['ms']:.3g} ms"
    words += "".join(f"; {n} {o.by_name[n]['ms']:.3g} ms" for n in beside)
    return (HOLDS if least == claim.of else FAILS), words, []


_TESTS = {
    "better_shot": _better_shot, "lower": _lower,
    "better": _better, "near": _near, "best": _best, "between": _between, "less_than_half": _less_than_half,
    "more_flicker": _more_flicker, "less_ghost": _less_ghost, "exact_at_best": _exact_at_best,
    "changes_below": _changes_below, "changes_more": _changes_more, "better_than_in": _better_than_in,
    "dips": _dips, "reaches": _reaches, "above_in_moment": _above_in_moment, "worse_than_still": _worse_than_still, "costs": _costs, "cheapest": _cheapest, "above_by": _above_by,
}  # fmt: skip

# What `master` gains when one of its parts is switched off, or read otherwise.
_PARTS_OF_MASTER = [
    ("sharpening the output", "master:sharpen=none", "master"),
    ("a colour box that is closed where no edge is found", "master:sharpen=none,minAlias=1", "master:sharpen=none"),
    ("the first frame's lasting weight", "master:sharpen=none,warmup=ramp", "master:sharpen=none"),
    ("un-jittering", "master:unjitter=off", "master"),
    ("a feedback of .925 to .979 instead of .88 to .97", "master:kmin=0.88,kmax=0.97", "master"),
    ("its test of depth over time", "master:depthTemporal=off", "master"),
    ("depths in normalised units", "master:depthUnit=world,pastDepth=reprojected", "master"),
]  # fmt: skip


# One stop darker: values end below the display's, so that an overshoot is not clipped there.
_HEADROOM = ("--exposure", "-1")
_SHARPENED = ("noaa", "uncharted", "unchartedNorm", "master")


def in_headroom(o: Outcome, name: str) -> list[str]:
    """What a sharpened method gains where nothing of it is clipped."""
    if o.text(name) not in _SHARPENED or o.text(name) == "noaa":
        return []
    dark = o.also("headroom", list(_SHARPENED), _HEADROOM).gain(o.text(name))
    return [
        f"One stop darker, so that its overshoot is not clipped at the ends of the display, {name} gains {dark}"
        + (": the clipping hides what the sharpening does." if dark.db < 0 else ".")
    ]


def _by_places(o: Outcome, first: str, second: str) -> str:
    """Where the squared error against the reference lies."""
    share, found = o.places
    at = (
        lambda n: f"{n} {1e6 * found[n][0]:.0f} at edges and {1e6 * found[n][1]:.0f} elsewhere"
    )  # noqa: E731
    return (
        f"Squared error × 10⁶ against {o.experiment.protocol.reference}: {at(first)}, {at(second)}. Edges, where the reference differs "
        f"from no anti-aliasing, are {100 * share:.0f} % of the pixels here; within surfaces it is the picture without anti-aliasing."
    )


def reasons(o: Outcome, first: str, region: str = "") -> list[str]:
    """Why a method falls behind another one, as far as runs with its parts switched off can tell."""
    if not o.experiment.protocol.parts or o.text(first) != "master":
        return []
    return [why_master_falls_behind(o.by_parts(region))]


def why_master_falls_behind(run: Run) -> str:
    """Only what the figures resolve counts as a reason."""
    gains = [(what, run.gain(a, b)) for what, a, b in _PARTS_OF_MASTER if a in run and b in run]
    found = sorted((g for g in gains if g[1].resolved and g[1].db > 0.1), key=lambda g: -g[1].db)
    innocent = [what for what, d in gains if not d.resolved or d.db <= 0.1]
    text = "What `master` loses by, each part switched off in turn: " + (
        ", ".join(f"{what} {d}" for what, d in found) or "none of its parts"
    )
    return text + (f"; not by {' or '.join(innocent)}." if innocent else ".")


def extremes(o: Outcome, name: str, figure: str) -> tuple[float, float, float, int, int]:
    """Best, worst and mean of a figure over the frames, and which frames, counted from 0."""
    method = o.run.methods[o.text(name)]
    found = method["overFrames"][figure]
    unit = o.experiment.protocol.codes**2 if figure == "mse" else 1.0
    values = [number(found[k]) * unit for k in ("best", "worst", "mean")]
    first = method["frames"][0]["frame"]
    return (*values, *(found[k] - first for k in ("bestFrame", "worstFrame")))
