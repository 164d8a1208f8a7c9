# SPDX-License-Identifier: MIT
"""Renders the study's scenes, runs the methods on each, holds them against the published tables, and writes docs/results.

usage: reproduce.py PROGRAM OUT DOCS [--quick | --full] [--only NAME ...]

Resumable: what is finished is kept by its content. --quick renders fewer samples, long moving shots smaller; --full
renders the published tables at their published sizes. --only takes names of published tables (scenes/experiments) and
of shots; its pages go to OUT/only.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path

import experiments
import outcomes
import studies
import tables

from catalogue import (
    ANGLES, COSTS, DISPLAYED, HEADROOM_FLAGS, HEADROOM_METHODS, OTHER_COSTS, PICTURES, SHOTS, STEP_METHODS, STEPS,
)  # fmt: skip
from figures import Run, number
from page import Page
from runs import bench as times
from runs import run_methods
from shots import ROOT, Shot, Workshop, is_ready, make, spent_before

# Title and page of the tables of each source.
SOURCES = {
    "Oliveros 2018": ("Tables of the Oliveros thesis, and ours", "oliveros.md"),
    "Stejmar n.d.": ("Tables of the Linköping thesis, and ours", "linkoping.md"),
    "Castorina 2023": ("Options of the Vulkan book, one by one", "book.md"),
    "Reshetov 2012": ("Figures of the talk on resampling, and ours", "resampling.md"),
}


def methods_of(shot: Shot, shop: Workshop) -> list[str]:
    return [m for m in shot.methods.split() if shop.serves(m)]


_made: dict[tuple, str] = {}  # files of contact sheets


def picture(
    name: str, folder: Path, texts: list[str], docs: Path, shop: Workshop, flags: tuple[str, ...] = (), frame: int = 0
) -> str:  # fmt: skip
    """A contact sheet as a small JPEG beside the pages; OpenImageIO's Python writes it, which Blender needs anyway.
    Of a long shot the frames up to `frame`. Returns the file's name."""
    key = (folder, *texts, *flags, frame)
    if key in _made:  # another table's: the same shot, methods and protocol
        return _made[key]
    some = ("--frames", f"{max(1, frame - 15)}-{frame}") if frame else ()
    run = run_methods(folder, f"sheet.{name}", texts, shop, (*flags, *some), write="exr")
    sheet = run.folder / "sheet.png"
    shop.run(f"sheet.{name}", [shop.program, "sheet", run.folder, "-o", sheet])
    docs.mkdir(parents=True, exist_ok=True)
    shop.run(
        f"sheet.{name}",
        ["/usr/bin/python3", "-c", _JPEG_WRITER + _JPEG, sheet, docs / f"{name}.jpg"],
    )
    return _made.setdefault(key, f"{name}.jpg")


def mosaic(name: str, pictures: dict[str, Path], docs: Path, shop: Workshop) -> str:
    """Small pictures with their names in rows of four, as one JPEG. Returns the file's name."""
    docs.mkdir(parents=True, exist_ok=True)
    words = [w for label, path in pictures.items() for w in (label, path)]
    shop.run(
        f"mosaic.{name}",
        ["/usr/bin/python3", "-c", _JPEG_WRITER + _MOSAIC, docs / f"{name}.jpg", *words],
    )
    return f"{name}.jpg"


# For Blender's Python: `save` takes the best quality below 280 kB.
_JPEG_WRITER = """
import os, sys
import OpenImageIO as oiio
def save(picture, path):
    for quality in range(90, 20, -5):
        picture.specmod().attribute("Compression", f"jpeg:{quality}")
        picture.write(path, "uint8")
        if os.path.getsize(path) < 280_000:
            break
"""

_MOSAIC = """
labels, paths = sys.argv[2::2], sys.argv[3::2]
width = 310
small = []
for path in paths:
    whole = oiio.ImageBuf(path)
    roi = oiio.ROI(0, width, 0, whole.spec().height * width // whole.spec().width, 0, 1, 0, 3)
    small.append(oiio.ImageBufAlgo.resize(whole, "box", 0, roi))
height = max(s.spec().height for s in small)
columns = min(4, len(small))
rows = -(-len(small) // columns)
sheet = oiio.ImageBuf(oiio.ImageSpec(columns * (width + 6), rows * (height + 26), 3, "uint8"))
oiio.ImageBufAlgo.fill(sheet, (0.12, 0.12, 0.12))
for n, (label, picture) in enumerate(zip(labels, small)):
    x, y = n % columns * (width + 6), n // columns * (height + 26)
    oiio.ImageBufAlgo.paste(sheet, x, y + 22, 0, 0, picture)
    oiio.ImageBufAlgo.render_text(sheet, x + 4, y + 17, label, 15, "DejaVuSans", (0.9, 0.9, 0.9))
save(sheet, sys.argv[1])
"""


# Shrinks to 1280 px wide.
_JPEG = """
sheet = oiio.ImageBuf(sys.argv[1])
spec = sheet.spec()
width = min(spec.width, 1280)
small = oiio.ImageBufAlgo.resize(sheet, "lanczos3", 0, oiio.ROI(0, width, 0, spec.height * width // spec.width, 0, 1, 0, 3))
save(small, sys.argv[2])
"""


def bench(shop: Workshop, runs: dict[str, Run]) -> Page:
    """Times on one thread: at 1080p on a scene that moves, in the short form on small frames that are there anyway."""
    shot = SHOTS["hard_edges" if shop.form == "quick" else "moving_sphere_1080p"]
    rows = times(make(SHOTS, shot, shop), methods_of(shot, shop), shop)
    where = f"{shot.size[0]} × {shot.size[1]}, rendered frames of {shot.scene}"
    if runs:
        made = next(iter(runs.values())).data["run"]
        where += f", {made['machine']} ({made['instructionSet']})"
    return studies.speed_page(list(rows.values()), where, shot.size)


def angles(shop: Workshop) -> Page | None:
    """Half-planes of every direction, where the program has the command for it."""
    if "angles" not in shop.run("help", [shop.program, "--help"]):
        return None
    command: list[object] = [shop.program, "angles", "--json"]
    for m in ANGLES.split():
        command += ["-m", m] if shop.serves(m) else []
    return studies.angles_page(json.loads(shop.run("angles", command)))


def estimate(names: list[str], shop: Workshop) -> str:
    """How long the shots that are missing will take: by what they took here before, else by their scene."""
    spent, total, missing = spent_before(shop), 0.0, 0
    for name in names:
        shot = SHOTS[name].in_form(shop.form)
        if is_ready(SHOTS[name], shop):
            continue
        missing += 1
        each, sample = COSTS.get(shot.scene, OTHER_COSTS)
        truths = 0 if shot.truth_of or not shot.truth else shot.frames
        if truths and (shot.truth_frames or _is_static(shot)):
            truths = 1
        pixels = shot.size[0] * shot.size[1] / (480 * 270)
        frames = shot.frames * each * (3 if shot.pattern else 1)
        guess = 8 + pixels * (frames + truths * sample * shot.truth_samples)
        total += spent.get(f"{shop.form}.{name}", guess)
    return (
        f"{missing} of {len(names)} shots to render: about {max(1, round(total / 60))} minutes on two idle processors"
        if missing
        else f"all {len(names)} shots are there"
    )


def _is_static(shot: Shot) -> bool:
    moves = {"--rotating", "--flying", "--sway"} & set(shot.variant)
    return not moves and shot.scene not in ("moving_sphere", "wires", "village", "collision")


def run_experiments(
    chosen: dict[str, experiments.Experiment], shop: Workshop, docs: Path
) -> tuple[dict[str, outcomes.Outcome], dict[str, str], dict[str, str]]:
    """Outcomes, pictures and charts by the experiments' keys."""
    found: dict[str, outcomes.Outcome] = {}
    pictures: dict[str, str] = {}
    charts: dict[str, str] = {}
    for key, experiment in chosen.items():
        started = time.monotonic()
        o = found[key] = outcomes.of(experiment, SHOTS, shop, found)
        flags = experiment.protocol.flags
        if "master" in experiment.methods.values() and experiment.kind == "table":
            o.parts["headroom"] = run_methods(
                o.folders["main"], f"{key}.headroom", HEADROOM_METHODS.split(), shop, (*flags, *HEADROOM_FLAGS)
            )  # fmt: skip
        texts = list(dict.fromkeys(experiment.methods.values()))
        if experiment.kind == "table":
            pictures[key] = picture(key, o.folders["main"], texts, docs, shop, flags)
        elif experiment.kind == "ghosts":
            worst = outcomes.extremes(o, o.named()[-1], "mse")[4] + 1
            pictures[key] = picture(key, o.folders["main"], texts, docs, shop, flags, worst)
            series = {
                n: [number(f["metrics"]["psnr"]) for f in o.run.methods[o.text(n)]["frames"]]
                for n in experiment.methods
            }
            tables.write_svg(
                docs / f"{key}.svg", series, f"{experiment.title}: PSNR over the frames", "dB"
            )
            charts[key] = f"{key}.svg"
        elif experiment.kind == "series":
            middle = sum(experiment.moment) // 2
            pictures[key] = picture(key, o.folders["main"], texts, docs, shop, flags, middle)
            series = {
                n: list(outcomes.gains_over_time(o, n).values())
                for n in experiment.methods
                if n != "No AA"
            }
            title = f"{experiment.title}: PSNR over no anti-aliasing"
            tables.write_svg(
                docs / f"{key}.svg",
                series,
                title,
                "dB",
                o.run.data["methods"][0]["frames"][0]["frame"],
            )
            charts[key] = f"{key}.svg"
        elif experiment.kind == "fourier":
            main = [
                t
                for n, t in experiment.methods.items()
                if experiment.protocol.shots.get(n, "main") == "main"
            ]
            pictures[key] = picture(
                key, o.folders["main"], list(dict.fromkeys(main)), docs, shop, flags
            )
            charts[key] = mosaic(f"{key}.fourier", o.spectra, docs, shop)
        print(
            f"  table {key}: {len(o.verdicts)} claims ({time.monotonic() - started:.0f} s)",
            flush=True,
        )
    return found, pictures, charts


def write_tables(
    found: dict[str, outcomes.Outcome], pictures: dict[str, str], charts: dict[str, str], docs: Path
) -> list[str]:  # fmt: skip
    """A page per source and that of the agreement; returns the index's lines."""
    index = []
    for source, (title, file) in SOURCES.items():
        of_source = [o for o in found.values() if o.experiment.source == source]
        if of_source:
            tables.source_page(title, of_source, pictures, charts).write(docs / file)
            index.append(f"[{file}]({file}): {title[0].lower()}{title[1:]}")
    if found:
        pages = {source: file for source, (_, file) in SOURCES.items()}
        tables.agreement_page(list(found.values()), pages).write(docs / "agreement.md")
        index.insert(
            0,
            "[agreement.md](agreement.md): every table and every claim of the sources: what holds here, what does not, and why",
        )
    return index


def write_pages(
    study: studies.Study, speed: Page | None, by_angle: Page | None, docs: Path
) -> list[str]:
    """Every page whose runs are there; returns the index's lines."""
    runs = study.runs
    wanted = [
        ("static.md", {"hard_edges"}, lambda: studies.static_page(study), "the thesis's protocol and ours, step by step; the parts of `master`"),
        ("motion.md", {"moving_sphere"}, lambda: studies.motion_page(runs), "ghosts, flicker, identity against colour boxes, hybrid fill, printed weights"),
        ("geometry.md", {"hard_edges"}, lambda: studies.geometry_page(runs, study.talk()), "RSAA's variants and numbers of sub-samples, against MSAA and MLAA"),
        ("spaces.md", {"hard_edges"}, lambda: studies.spaces_page(study), "the thesis's question beside ours, scene by scene; T2MSAA between 2x and 4x MSAA, space by space"),
        ("scenes.md", {"hard_edges"}, lambda: studies.scenes_page(runs), "every method on every static scene"),
    ]  # fmt: skip
    index = []
    for name, needs, build, what in wanted:
        if needs <= set(runs):
            build().write(docs / name)
            index.append(f"[{name}]({name}): {what}")
    if by_angle:
        by_angle.write(docs / "angles.md")
        index.append("[angles.md](angles.md): gain on straight edges by their direction")
    if speed:
        speed.write(docs / "speed.md")
        index.append("[speed.md](speed.md): ns per pixel, memory, and the fast form against double")
    return index


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("out", type=Path, help="shots and runs; may be deleted at any time")
    parser.add_argument("docs", type=Path, help="folder of the pages")
    parser.add_argument(
        "--quick",
        dest="form",
        action="store_const",
        const="quick",
        default="whole",
        help="fewer samples",
    )
    parser.add_argument(
        "--full",
        dest="form",
        action="store_const",
        const="full",
        help="tables at their published sizes",
    )
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help="published tables and shots; --list shows them"
    )
    parser.add_argument(
        "--list", action="store_true", help="the names that --only takes, and what is missing"
    )
    parser.add_argument("--blender", default=os.environ.get("BLENDER", "blender"))
    parser.add_argument("--no-bench", action="store_true", help="leave the timing out")
    a = parser.parse_args(argv)
    started = time.monotonic()
    try:
        known = experiments.load(SHOTS)
    except experiments.BadExperiment as error:
        print(f"error: {error}", file=sys.stderr)
        return 3
    shop = Workshop(a.program.resolve(), a.blender, a.out.resolve(), a.form)
    shop.out.mkdir(parents=True, exist_ok=True)
    addon = json.loads((ROOT / "blender_addon/aa_resolve/methods.json").read_text())
    program = json.loads(shop.run("list", [shop.program, "list", "--json"]))
    shop.known = {m["id"] for m in program["methods"]} & {m["id"] for m in addon["methods"]}
    only = a.only or []
    for name in only:
        if name not in known and name not in SHOTS:
            parser.error(
                f"--only: no table or shot '{name}'; tables: {', '.join(known)}; shots: {', '.join(SHOTS)}"
            )
    chosen = {k: e for k, e in known.items() if not only or k in only}
    shots = needed_shots(only, chosen, SHOTS)
    if a.list:
        for key, e in known.items():
            print(f"{key:20} {e.label} {e.title}: {', '.join([*e.shots.values(), *e.on])}")
    print(estimate(shots, shop), flush=True)
    if a.list:
        return 0
    docs = shop.out / "only" if only else a.docs

    runs: dict[str, Run] = {}
    for name in shots:
        folder = make(SHOTS, SHOTS[name], shop)
        if SHOTS[name].methods and SHOTS[name].truth and (not only or name in only):
            runs[name] = run_methods(folder, "run", methods_of(SHOTS[name], shop), shop)
    found, pictures, charts = run_experiments(chosen, shop, docs)
    study = studies.Study(runs, *displayed(found, shop), found)
    for name, (shot_name, methods) in PICTURES.items():
        if shot_name in runs:
            texts = [m for m in methods.split() if m in runs[shot_name]]
            picture(name, shop.folder(SHOTS[shot_name]), texts, docs, shop)
    index = write_tables(found, pictures, charts, docs)
    if only:
        for file in sorted(docs.glob("*.md")):
            print(file)
        return 0
    speed = None if a.no_bench else bench(shop, runs)
    index += write_pages(study, speed, angles(shop), docs)
    write_index(study, index, a.form, docs)
    print(f"{docs / 'README.md'}: {len(index)} pages, {time.monotonic() - started:.0f} s")
    return 0


def needed_shots(
    only: list[str], chosen: dict[str, experiments.Experiment], catalogue: dict[str, Shot]
) -> list[str]:
    """Those that are to be rendered, lenders of truth before their borrowers."""
    wanted = (
        [n for n in only if n in catalogue]
        if only
        else [n for n, s in catalogue.items() if s.methods and s.truth]
    )
    for e in chosen.values():
        wanted += [*e.shots.values(), *e.on]
    lenders = [catalogue[n].truth_of for n in wanted if catalogue[n].truth_of]
    return list(dict.fromkeys([*lenders, *wanted]))


def displayed(
    found: dict[str, outcomes.Outcome], shop: Workshop
) -> tuple[dict[str, Run], dict[str, Run], dict[str, Run]]:
    """Runs in the protocol of [Oliveros 2018]: by shot; hard_edges step by step; one stop darker."""
    thesis, headroom, steps = {}, {}, {}
    for o in found.values():
        if "headroom" in o.parts:
            name = o.experiment.shots["main"]
            thesis[name], headroom[name] = o.run, o.parts["headroom"]
    if "hard_edges" in thesis:
        of = lambda shot, what, texts, flags: run_methods(  # noqa: E731
            shop.folder(SHOTS[shot]), what, texts.split(), shop, flags
        )
        for name, texts in DISPLAYED.items():
            if (shop.folder(SHOTS[name]) / "shot.json").exists():
                thesis[name] = of(name, "thesis", texts, STEPS["the same as 8-bit images"])
        for i, (what, flags) in enumerate(STEPS.items()):
            steps[what] = of("hard_edges", f"step{i}", STEP_METHODS, flags)
    return thesis, steps, headroom


def write_index(study: studies.Study, index: list[str], form: str, docs: Path) -> None:
    page = Page("Results")
    page.say(
        "Written by `make reproduce` from its own renders; every sentence follows from the figures.",
        {
            "quick": "This is the short form (`QUICK=1`): fewer samples, long moving shots smaller.",
            "full": "This is the full form (`FULL=1`): tables at their published sizes.",
            "whole": "",
        }[form],
    )
    if study.runs:
        page.heading("In short")
        page.points(studies.headlines(study))
        page.heading("Pages")
    page.points(index)
    page.say(
        "How to read them: gains are decibels of PSNR over no anti-aliasing on display-encoded values (in the thesis's question on",
        "displayed values without gamma), where 3 dB is half the squared error; intervals are 95 %; *not resolved* means that the difference is within the truth's own noise or",
        "depends on the part of the picture.",
    )
    if study.runs:
        made = next(iter(study.runs.values())).data["run"]
        page.say(
            f"Made with aaresolve {made['program']} on {made['machine']} ({made['instructionSet']})."
        )
    page.write(docs / "README.md")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
