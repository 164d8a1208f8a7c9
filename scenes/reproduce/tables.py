# SPDX-License-Identifier: MIT
"""Pages of the published tables: each table beside ours in its own form, and how far both agree."""

from __future__ import annotations

import math

import outcomes
from figures import setup, signed
from outcomes import FAILS, HOLDS, UNRESOLVED, Outcome, Verdict
from page import Page, code

_HEADS = {
    "mse": "MSE", "rmse": "RMSD", "psnr": "PSNR", "snr": "SNR", "ssimLuma": "SSIM", "fmagMse": "Fourier MSE", "ms": "ms",
    "ms above": "ms above no AA", "MB": "MB", "gain": "gain, dB",
}  # fmt: skip


def source_page(
    title: str, found: list[Outcome], pictures: dict[str, str], charts: dict[str, str]
) -> Page:
    """All tables of one source."""
    page = Page(title)
    said = {}
    for o in found:
        if o.experiment.protocol.says and o.experiment.protocol.says not in said:
            said[o.experiment.protocol.says] = True
            page.say(o.experiment.protocol.says)
    page.say("A cell reads *published / ours*.")
    for o in found:
        e = o.experiment
        page.heading(f"{e.table}: {e.title}")
        page.say(e.says, _setup(o))
        if e.key in pictures:
            shown = ", ".join(e.crop.get("of", ()) or o.named() or e.methods)
            page.picture(pictures[e.key], f"{e.title}: {shown}")
        _BODY[e.kind](page, o)
        if e.key in charts:
            what = (
                "differences to the reference in the Fourier domain"
                if e.kind == "fourier"
                else "over the frames"
            )
            page.picture(charts[e.key], f"{e.title}: {what}")
        if o.taus and len(o.named()) > 1:
            page.say(
                "Kendall's τ of the order: "
                + "; ".join(f"{_HEADS.get(k, k)} {signed(v)}" for k, v in o.taus.items())
                + "."
            )
        page.points(claim_lines(o))
    return page


def _setup(o: Outcome) -> str:
    """Size, frames and how good the truth is."""
    run = o.run or next(iter(o.parts.values()), None)
    if run is None:
        return ""
    return setup(
        run, None if o.experiment.kind == "reference size" else o.smallest_error, "in the table"
    )


def claim_lines(o: Outcome) -> list[str]:
    return [claim_line(v) for v in o.verdicts]


def claim_line(v: Verdict) -> str:
    return " ".join([f"{v.claim.says}: **{v.answer}**. {_sentence(v.figures)}", *v.reasons])


def _sentence(text: str) -> str:
    return text if not text or text.endswith(".") else text + "."


def _cell(theirs: float | None, ours: float | None, digits: int) -> str:
    show = (
        lambda v: "–" if v is None else "Inf" if math.isinf(v) else f"{v:.{digits}f}"
    )  # noqa: E731
    return f"{show(theirs)} / {show(ours)}"


_DIGITS = {
    "mse": 2,
    "rmse": 2,
    "psnr": 2,
    "snr": 2,
    "ssimLuma": 4,
    "fmagMse": 4,
    "ms": 2,
    "ms above": 2,
    "MB": 1,
}


def _table(page: Page, o: Outcome) -> None:
    e = o.experiment
    columns = [c for c in e.published["columns"] if c != "gain"]
    base = o.published("No AA", "psnr") if "No AA" in o.named() and "psnr" in columns else None
    rows = []
    for name, text in e.methods.items():
        if text not in o.run:
            continue
        listed = name in e.published
        row = [f"{name} ({code(text)})"]
        for column in columns:
            row.append(
                _cell(
                    o.published(name, column) if listed else None,
                    o.by_name.get(name, {}).get(column),
                    _DIGITS[column],
                )
            )
        gain = o.gain(name)
        theirs = None
        if listed and "gain" in e.published["columns"]:
            theirs = o.published(name, "gain")
        elif listed and base is not None:
            theirs = o.published(name, "psnr") - base
        row.append("–" if theirs is None else signed(theirs))
        row += [signed(gain.db), gain.interval] if text != "noaa" else ["", ""]
        rows.append(row)
    for text in ("unchartedNorm", "unchartedNoSharpen", "master:unjitter=off"):
        if text in o.run and text not in e.methods.values():
            gain = o.run.gain(text)
            ours = outcomes.pooled(o.run, text, e.protocol.codes)
            rows.append([code(text), *(_cell(None, ours[c], _DIGITS[c]) for c in columns), "–", signed(gain.db),
                         gain.interval])  # fmt: skip
    page.table(
        ["method", *(_HEADS[c] for c in columns), "gain, published", "gain, ours", "95 %"], rows
    )
    signs = _other_signs(o)
    if signs:
        page.points(signs)


def _other_signs(o: Outcome) -> list[str]:
    """Methods that stand on the other side of no anti-aliasing than published, and what a stop of headroom changes."""
    if "psnr" not in o.experiment.published["columns"] or "No AA" not in o.named():
        return []
    lines = []
    for name in o.named():
        theirs = o.published(name, "psnr") - o.published("No AA", "psnr")
        ours = o.gain(name)
        if theirs * ours.db >= 0:
            continue
        line = f"{name} has the other sign: {signed(theirs)} dB published, {ours} here."
        line = " ".join([line, *outcomes.in_headroom(o, name)])
        lines.append(line)
    return lines


def _ghosts(page: Page, o: Outcome) -> None:
    e, rows = o.experiment, []
    for figure in ("mse", "psnr", "snr", "ssimLuma"):
        for name in o.named():
            theirs, ours = e.published[name].get(figure), outcomes.extremes(o, name, figure)
            show = lambda v: f"{v:.{_DIGITS[figure]}f}".replace("inf", "Inf")  # noqa: E731
            both = [f"{show(t)} / {show(u)}" for t, u in zip(theirs[:3], ours[:3])]
            rows.append(
                [
                    f"{_HEADS[figure]}, {name}",
                    *both,
                    f"{theirs[3]:g}, {theirs[4]:g} / {ours[3]}, {ours[4]}",
                ]
            )
    page.table(["figure", "best", "worst", "mean", "frames of best, worst"], rows)
    more = [n for n in e.methods if n not in e.published]
    rows = []
    for label, text in [
        *((n, o.text(n)) for n in more),
        ("", "unchartedNorm"),
        ("", "master:sharpen=none"),
    ]:
        if text in o.run:
            pooled = outcomes.pooled(o.run, text, e.protocol.codes)
            rows.append(
                [
                    f"{label} ({code(text)})" if label else code(text),
                    f"{pooled['mse']:.2f}",
                    f"{pooled['psnr']:.2f}",
                    f"{pooled['ssimLuma']:.4f}",
                ]
            )
    page.say("Beside them, ours alone: mean MSE, pooled PSNR and mean SSIM.")
    page.table(["method", "MSE", "PSNR", "SSIM"], rows)
    filters = o.run.gain("master", "unchartedNorm") if "unchartedNorm" in o.run else None
    page.say(
        f"Master over Uncharted, MSE pooled: {o.gain('Master', 'Uncharted')}; published "
        f"{signed(10 * math.log10(e.published['Uncharted']['mse'][2] / e.published['Master']['mse'][2]))} dB. "
        + (f"Over the same filter, `unchartedNorm`: {filters}." if filters else ""),
    )


def _reference_size(page: Page, o: Outcome) -> None:
    e, rows = o.experiment, []
    few, many = list(o.by_name)[0], list(o.by_name)[-1]
    for row, theirs in e.published.items():
        if row == "columns":
            continue
        ours = (o.by_name[few][row], o.by_name[many][row])
        digits = 5 if row.startswith("ssim") else 3
        change = lambda a, b: 100 * abs(a / b - 1)  # noqa: E731
        rows.append([row.replace(row.split()[0], _HEADS[row.split()[0]]), *(_cell(t, u, digits) for t, u in zip(theirs, ours)),
                     f"{change(*theirs):.3f} / {change(*ours):.3f}"])  # fmt: skip
    page.table(["figure", f"{few} samples", f"{many} samples", "relative change, %"], rows)


def _fourier(page: Page, o: Outcome) -> None:
    e = o.experiment
    reference = e.protocol.reference
    base = ("No AA" in o.named(), o.by_name.get("No AA", {}).get("fmagMse"))
    rows = []
    for name in [*o.named(), reference]:
        theirs = o.published(name, "fmagMse") if name in e.published else None
        ours, true = o.by_name.get(name, {}).get("fmagMse"), o.other[name]["fmagMse"]
        share = lambda v, b: "–" if v is None or not b else f"{v / b:.2f}"  # noqa: E731
        published_base = o.published("No AA", "fmagMse") if base[0] else None
        rows.append([
            f"{name} ({code(o.text(name))})", "–" if theirs is None else f"{theirs:.4f}",
            "–" if ours is None else f"{1e6 * ours:.2f}", f"{share(theirs, published_base)} / {share(ours, base[1])}",
            f"{1e6 * true:.2f}", f"{o.other[name]['psnr']:.2f}",
            *(f"{1e6 * v:.0f}" for v in o.places[1].get(name, (0.0, 0.0))),
        ])  # fmt: skip
    page.table(
        [
            "method",
            "published",
            f"ours against {reference}, × 10⁻⁶",
            "over no AA, published / ours",
            "ours against the truth, × 10⁻⁶",
            "PSNR against the truth",
            "squared error at edges, × 10⁻⁶",
            "elsewhere",
        ],
        rows,
    )
    page.say(
        f"Squared errors are against {reference}; edges, where it differs from no anti-aliasing, are {100 * o.places[0]:.0f} % of the pixels."
    )
    page.say(
        "In the pictures of the Fourier domain frequency 0 is in the centre; from dark to bright the difference's magnitude grows from",
        "10⁻⁴ to 1, logarithmically.",
    )


def _cost(page: Page, o: Outcome) -> None:
    e = o.experiment
    columns = e.published["columns"]
    rows = [
        [
            f"{n} ({code(o.text(n))})",
            *(_cell(o.published(n, c), o.by_name[n][c], _DIGITS[c]) for c in columns),
        ]
        for n in o.named()
    ]
    page.table(["method", *(_HEADS[c] for c in columns)], rows)


def _options(page: Page, o: Outcome) -> None:
    page.table(
        ["claim", "with", "without", *o.parts],
        [
            [v.claim.says, code(v.claim.of["with"]), code(v.claim.of["without"]),
             *(_short(outcomes.of_option(run, v.claim.of)) for run in o.parts.values())]
            for v in o.verdicts
        ],
    )  # fmt: skip
    page.say("Decibels by which the option helps; n. r.: not resolved.")


def _short(d) -> str:
    return "–" if d is None else signed(d.db) + ("" if d.resolved else " (n. r.)")


def _series(page: Page, o: Outcome) -> None:
    first, last = o.experiment.moment
    rows = []
    for name, text in o.experiment.methods.items():
        if text == "noaa":
            continue
        inside, outside = outcomes.moment(o, name)
        mean = lambda values: signed(sum(values) / len(values))  # noqa: E731
        rows.append([f"{name} ({code(text)})", mean(outside), mean(inside), signed(min(inside))])
    page.table(
        ["method", "before and after", f"in frames {first} to {last}", "least in them"], rows
    )
    page.say("Mean gain over no anti-aliasing, dB.")


def _rates(page: Page, o: Outcome) -> None:
    sorts = list(
        dict.fromkeys(k for row in o.by_name.values() for k in row if k not in ("bytes", "history"))
    )
    rows = []
    for name, row in o.by_name.items():
        cells = [f"{row[k]:.0f}" if k in row else "" for k in sorts]
        rows.append(
            [
                f"{name} ({code(o.text(name))})",
                *cells,
                "yes" if row["history"] else "",
                f"{row['bytes']:.0f}",
            ]
        )
    page.table(["method", *sorts, "history", "bytes read per pixel"], rows)


def _variants(page: Page, o: Outcome) -> None:
    e = o.experiment
    rows = []
    for own, run in o.parts.items():
        row = [f"{own} ({code(' '.join(e.says_of.get(own, ())) or 'as Cycles')})"]
        for text in e.methods.values():
            flicker = run.temporal(text, "flickerStatic")
            row.append(f"{run.psnr(text):.2f}" + (f" ({flicker:.2g})" if flicker else ""))
        rows.append(row)
    page.table(["textures", *(f"{n} ({code(t)})" for n, t in e.methods.items())], rows)
    page.say("PSNR, dB; in brackets flicker over the frames at rest, 8-bit codes.")


def _codes(page: Page, o: Outcome) -> None:
    rows = []
    for row in o.experiment.rows:
        ours = o.by_name[row["name"]]
        words = " ".join([row["method"], *row.get("flags", ())])
        rows.append(
            [f"{row['name']} ({code(words)}, {row['write'].upper()})", f"{ours['banding']:.3f}", f"{ours['grain']:.3f}",
             f"{ours['psnr']:.2f}"]
        )  # fmt: skip
    page.table(["picture", "banding", "grain", "PSNR, dB"], rows)
    page.say(
        "Banding and grain: error on slow gradients, RMS in 8-bit codes, what a Gaussian of 4 px keeps and what it takes away.",
        "PSNR is over the whole picture.",
    )


_BODY = {
    "variants": _variants, "codes": _codes,
    "series": _series, "rates": _rates,
    "table": _table, "ghosts": _ghosts, "reference size": _reference_size, "fourier": _fourier, "cost": _cost,
    "options": _options,
}  # fmt: skip


def agreement_page(found: list[Outcome], pages: dict[str, str]) -> Page:
    """Over all tables: ranks, claims, and what stands behind each."""
    page = Page("How far the sources' tables show here")
    page.say(
        "Every published table that we run, the order of its methods against ours (Kendall's τ: 1 = the same order, 0 = none),",
        "and every claim of its text: it holds, does not hold, or is not resolved by our figures. The reasons follow from runs with a part switched off.",
    )
    count = {
        a: sum(v.answer == a for o in found for v in o.verdicts)
        for a in (HOLDS, "holds on some", FAILS, UNRESOLVED)
    }
    page.say(
        ", ".join(
            f"{n} {'claims' if i == 0 else ''} **{a}**".replace("  ", " ")
            for i, (a, n) in enumerate(count.items())
        )
        + "."
    )
    rows = []
    for o in found:
        e = o.experiment
        main = next(iter(o.taus.items()), None) if len(o.named()) > 1 else None
        share = o.noise_share
        tally = [sum(v.answer == a for v in o.verdicts) for a in (HOLDS, FAILS, UNRESOLVED)]
        rows.append([
            f"[{e.source}, {e.table}]({pages[e.source]}#{anchor(f'{e.table}: {e.title}')}): {e.title}",
            f"{signed(main[1])} ({_HEADS.get(main[0], main[0])})" if main else "–",
            "–" if share is None else f"{share:.2g} %" + ("" if share <= 1 else " (!)"),
            *map(str, tally),
        ])  # fmt: skip
    page.table(["table", "τ", "truth's error", HOLDS, FAILS, UNRESOLVED], rows)
    for o in found:
        e = o.experiment
        if o.verdicts:
            page.heading(f"{e.source}, {e.table}: {e.title}")
            page.points(claim_lines(o))
    return page


def anchor(heading: str) -> str:
    """As the pages' headings are addressed."""
    kept = "".join(c for c in heading.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")
