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
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import experiments
import outcomes
import studies
import tables

from catalogue import (
    ANGLES, COSTS, DISPLAYED, OTHER_COSTS, PICTURES, SHOTS, STEP_METHODS, STEPS,
)  # fmt: skip
from chart import write_svg
from figures import Run, number
from page import Page
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


def together(jobs: list[Callable[[], object]], shop: Workshop) -> list:
    """What the jobs give, in their order. As many run at once as there are processors, each call of the program on its
    share of them: much of a run is reading files, which takes one."""
    processors = os.cpu_count() or 1
    at_once = max(1, min(processors, len(jobs)))
    shop.threads = max(1, processors // at_once)
    try:
        with ThreadPoolExecutor(at_once) as pool:
            return list(pool.map(lambda job: job(), jobs))
    finally:
        shop.threads = 0


def picture(
    name: str, folder: Path, texts: list[str], docs: Path, shop: Workshop, flags: tuple[str, ...] = (), frame: int = 0,
    run: Run | None = None,
) -> str:  # fmt: skip
    """A contact sheet as a small JPEG beside the pages; OpenImageIO's Python writes it, which Blender needs anyway.
    Of a long shot the frames up to `frame`; `run`: one that has written these methods' pictures already. Returns the
    file's name."""
    some = ("--frames", f"{max(1, frame - 15)}-{frame}") if frame else ()
    if run is None:
        run = run_methods(folder, f"sheet.{name}", texts, shop, (*flags, *some), write="exr")
    else:
        run = run.with_methods_alone(texts, folder.parent / f"{folder.name}.shown.{name}")
    sheet = run.folder / "sheet.png"
    shop.run(f"sheet.{name}", [shop.program, "sheet", run.folder, "-o", sheet])
    docs.mkdir(parents=True, exist_ok=True)
    shop.run(
        f"sheet.{name}",
        ["/usr/bin/python3", "-c", _JPEG_WRITER + _JPEG, sheet, docs / f"{name}.jpg"],
    )
    return f"{name}.jpg"


def mosaic(name: str, pictures: dict[str, Path], docs: Path, shop: Workshop) -> str:
    """Small pictures with their names in rows of four, as one JPEG. Returns the file's name."""
    docs.mkdir(parents=True, exist_ok=True)
    words = [w for label, path in pictures.items() for w in (label, path)]
    shop.run(
        f"mosaic.{name}",
        ["/usr/bin/python3", "-c", _JPEG_WRITER + _MOSAIC, docs / f"{name}.jpg", *words],
    )
    return f"{name}.jpg"


def crops(o: outcomes.Outcome, docs: Path, shop: Workshop) -> str:
    """What the experiment's `crop` names of every picture, as one JPEG. Returns the file's name."""
    docs.mkdir(parents=True, exist_ok=True)
    key, crop, flags = o.experiment.key, o.experiment.crop, o.experiment.protocol.flags
    exposure = flags[flags.index("--exposure") + 1] if "--exposure" in flags else "0"
    shown = {name: o.pictures[name] for name in crop.get("of", o.pictures)}
    shop.run(
        f"crops.{key}",
        ["/usr/bin/python3", "-c", _JPEG_WRITER + _CROPS, docs / f"{key}.jpg", json.dumps(crop["box"])]
        + [exposure, json.dumps(crop.get("stretched", False))]
        + [w for label, path in shown.items() for w in (label, path)],
    )  # fmt: skip
    return f"{key}.jpg"


# For Blender's Python: `save` takes the best quality below 280 kB.
_JPEG_WRITER = """
import json, os, sys
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


# Crops of pictures, each pixel a square. EXR files hold linear light, before the exposure unless they say that they are
# displayed already. Stretched: each channel from the least to the largest value that the first picture has.
_CROPS = """
import numpy as np
out, box, exposure, stretched = sys.argv[1], *map(json.loads, sys.argv[2:5])
labels, paths = sys.argv[5::2], sys.argv[6::2]
parts = []
for path in paths:
    picture = oiio.ImageBuf(path)
    pixels = picture.get_pixels(oiio.FLOAT)[:, :, :3]
    if path.endswith(".exr"):
        shown = picture.spec().getattribute("aaresolve:displayReferred")
        light = np.clip(pixels * 2.0 ** (0 if shown else exposure), 0, 1)
        pixels = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    h, w = pixels.shape[:2]
    x, y = int(box[0] * w), int(box[1] * h)
    parts.append(pixels[y : y + int(box[3] * h), x : x + int(box[2] * w)])
low, high = (f(parts[0], axis=(0, 1)) for f in (np.min, np.max)) if stretched else (0, 1)
times = max(1, 300 // parts[0].shape[1])
cut = [np.clip((p - low) / (high - low), 0, 1) for p in parts]
cut = [np.repeat(np.repeat(p, times, 0), times, 1).astype(np.float32) for p in cut]
columns = min(4, len(cut))
height, width = cut[0].shape[:2]
rows = -(-len(cut) // columns)
sheet = oiio.ImageBuf(oiio.ImageSpec(columns * (width + 6), rows * (height + 26), 3, "uint8"))
oiio.ImageBufAlgo.fill(sheet, (0.12, 0.12, 0.12))
for n, (label, pixels) in enumerate(zip(labels, cut)):
    x, y = n % columns * (width + 6), n // columns * (height + 26)
    small = oiio.ImageBuf(oiio.ImageSpec(width, height, 3, "float"))
    small.set_pixels(oiio.ROI(0, width, 0, height, 0, 1, 0, 3), np.ascontiguousarray(pixels))
    oiio.ImageBufAlgo.paste(sheet, x, y + 22, 0, 0, small)
    oiio.ImageBufAlgo.render_text(sheet, x + 4, y + 17, label, 13, "DejaVuSans", (0.9, 0.9, 0.9))
save(sheet, out)
"""


# Shrinks to 1280 px wide.
_JPEG = """
sheet = oiio.ImageBuf(sys.argv[1])
spec = sheet.spec()
width = min(spec.width, 1280)
small = oiio.ImageBufAlgo.resize(sheet, "triangle", 0, oiio.ROI(0, width, 0, spec.height * width // spec.width, 0, 1, 0, 3))
save(small, sys.argv[2])
"""


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
    measured = lambda e: outcomes.measured(e, SHOTS, shop)  # noqa: E731
    apart = [e for e in chosen.values() if e.kind != "cost"]
    made = together([lambda e=e: measured(e) for e in apart], shop)
    made += [
        measured(e) for e in chosen.values() if e.kind == "cost"
    ]  # times are of a quiet machine
    by_key = {o.experiment.key: o for o in made}
    found: dict[str, outcomes.Outcome] = {}
    for key in chosen:
        o = found[key] = outcomes.judged(by_key[key], found)
        print(f"  table {key}: {len(o.verdicts)} claims", flush=True)
    pictures: dict[str, str] = {}
    charts: dict[str, str] = {}
    jobs, seen = [], {}
    for key, o in found.items():
        draw = _PICTURE.get(o.experiment.kind)
        if draw is None:
            continue
        folder, texts, run, frame = draw(o)
        # Another table's picture of the same shot, methods and protocol is this one's.
        same = (folder, *texts, *o.experiment.protocol.flags, frame)
        pictures[key] = f"{seen.setdefault(same, key)}.jpg"
        if seen[same] == key:
            jobs.append(
                lambda key=key, o=o, folder=folder, texts=texts, run=run, frame=frame: picture(
                    key, folder, texts, docs, shop, o.experiment.protocol.flags, frame, run
                )
            )
    for key, o in found.items():
        if o.experiment.kind == "fourier":
            jobs.append(lambda key=key, o=o: mosaic(f"{key}.fourier", o.spectra, docs, shop))
            charts[key] = f"{key}.fourier.jpg"
        elif o.experiment.crop:
            jobs.append(lambda o=o: crops(o, docs, shop))
            pictures[key] = f"{key}.jpg"
        elif o.experiment.kind in _CURVES:
            title, first, series = _CURVES[o.experiment.kind](o)
            write_svg(docs / f"{key}.svg", series, title, "dB", first)
            charts[key] = f"{key}.svg"
    together(jobs, shop)
    return found, pictures, charts


def _texts(o: outcomes.Outcome) -> list[str]:
    """Those of the table that its main shot serves."""
    e = o.experiment
    named = [t for n, t in e.methods.items() if e.protocol.shots.get(n, "main") == "main"]
    return list(dict.fromkeys(named))


def _worst_frame(o: outcomes.Outcome) -> int:
    """The frame with the largest error of the last published method, counted from 1."""
    return outcomes.extremes(o, o.named()[-1], "mse")[4] + 1


# By kind: the shot's folder, the methods, the run that has their pictures, and the frame of a long shot.
_PICTURE = {
    "table": lambda o: (o.folders["main"], _texts(o), o.run, 0),
    "fourier": lambda o: (o.folders["main"], _texts(o), o.run, 0),
    "ghosts": lambda o: (o.folders["main"], _texts(o), None, _worst_frame(o)),
    "series": lambda o: (o.folders["main"], _texts(o), None, sum(o.experiment.moment) // 2),
}


def _psnr_over_frames(o: outcomes.Outcome) -> tuple[str, int, dict[str, list[float]]]:
    frames = lambda n: o.run.methods[o.text(n)]["frames"]  # noqa: E731
    series = {n: [number(f["metrics"]["psnr"]) for f in frames(n)] for n in o.experiment.methods}
    return f"{o.experiment.title}: PSNR over the frames", 0, series


def _gain_over_frames(o: outcomes.Outcome) -> tuple[str, int, dict[str, list[float]]]:
    names = [n for n in o.experiment.methods if n != "No AA"]
    series = {n: list(outcomes.gains_over_time(o, n).values()) for n in names}
    first = o.run.data["methods"][0]["frames"][0]["frame"]
    return f"{o.experiment.title}: PSNR over no anti-aliasing", first, series


_CURVES = {"ghosts": _psnr_over_frames, "series": _gain_over_frames}  # title, first frame, series


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


def write_pages(study: studies.Study, by_angle: Page | None, docs: Path) -> list[str]:
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
    if (docs / "speed.md").exists():  # of `make speed`
        index.append(
            "[speed.md](speed.md): ns per pixel in every instruction set, memory, and the fast form against double"
        )
    if (docs / "growth.md").exists():  # of `make growth`
        index.append(
            "[growth.md](growth.md): time and memory from 480 x 270 to 8K, from 16 frames to 10,000, on one thread and two"
        )
    if (docs / "whole-run.md").exists():  # of tests/bench/whole_run.py
        index.append("[whole-run.md](whole-run.md): what a run of 20 methods costs")
    if (docs / "farm-costs.md").exists():  # of `make farm-costs`
        index.append("[farm-costs.md](farm-costs.md): core hours of the full study, scene by scene")
    if (docs / "peers.md").exists():  # of `make peers`
        index.append("[peers.md](peers.md): SMAA, FLIP and SSIM beside those of others")
    if (docs / "stability.md").exists():  # of `make docs`
        index.append(
            "[stability.md](stability.md): the accuracy that speed costs, of every method at its defaults"
        )
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
    shop.temporal = {m["id"] for m in program["methods"] if m["temporal"]}
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

    folders = {name: make(SHOTS, SHOTS[name], shop) for name in shots}
    studied = [n for n in shots if SHOTS[n].methods and SHOTS[n].truth and (not only or n in only)]
    made = together(
        [lambda n=n: run_methods(folders[n], "run", methods_of(SHOTS[n], shop), shop) for n in studied],
        shop,
    )  # fmt: skip
    runs: dict[str, Run] = dict(zip(studied, made))
    found, pictures, charts = run_experiments(chosen, shop, docs)
    study = studies.Study(runs, *displayed(found, shop), found)
    jobs = []
    for name, (shot_name, methods) in PICTURES.items():
        if shot_name in runs:
            texts = [m for m in methods.split() if m in runs[shot_name]]
            jobs.append(lambda n=name, f=folders[shot_name], t=texts: picture(n, f, t, docs, shop))
    together(jobs, shop)
    index = write_tables(found, pictures, charts, docs)
    if only:
        for file in sorted(docs.glob("*.md")):
            print(file)
        return 0
    index += write_pages(study, angles(shop), docs)
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
) -> tuple[dict[str, Run], dict[str, Run]]:
    """Runs in the protocol of [Oliveros 2018]: by shot; and hard_edges step by step."""
    thesis = {
        o.experiment.shots["main"]: o.run
        for o in found.values()
        if o.experiment.kind == "table" and "master" in o.experiment.methods.values()
    }
    if "hard_edges" not in thesis:
        return thesis, {}
    wanted = [
        (name, "thesis", texts, STEPS["the same as 8-bit images"])
        for name, texts in DISPLAYED.items()
        if (shop.folder(SHOTS[name]) / "shot.json").exists()
    ]
    steps = [("hard_edges", f"step{i}", STEP_METHODS, f) for i, f in enumerate(STEPS.values())]
    made = together(
        [
            lambda shot=shot, what=what, texts=texts, flags=flags: run_methods(
                shop.folder(SHOTS[shot]), what, texts.split(), shop, flags
            )
            for shot, what, texts, flags in [*wanted, *steps]
        ],
        shop,
    )
    thesis.update((shot, run) for (shot, *_), run in zip(wanted, made))
    return thesis, dict(zip(STEPS, made[len(wanted) :]))


def write_index(study: studies.Study, index: list[str], form: str, docs: Path) -> None:
    page = Page("Results")
    page.say(
        "Written by `make reproduce` from its own renders; every sentence follows from the figures.",
        {
            "quick": "This is the short form (`QUICK=1`). Its limits: pictures of 480 × 270, of the tables that move 240 × 135, where the "
            "sources have 1600 × 900 and 1920 × 1080, so that edges are a larger share of them; truth of 12 to 64 samples per half, whose "
            "own error stands with every table, and in bold where it exceeds 1 % of the smallest error that is ranked.",
            "full": "This is the full form (`FULL=1`): tables at their published sizes.",
            "whole": "Pictures of 480 × 270, where the sources have 1600 × 900 and 1920 × 1080, so that edges are a larger share of them and "
            "fewer differences are told from chance; `FULL=1` renders the tables at their published sizes. The truth's own error stands with "
            "every table, and in bold where it exceeds 1 % of the smallest error that is ranked.",
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
        "depends on the part of the picture; *no interval*: its errors sit in too few places of the picture for one.",
    )
    if study.runs:
        made = next(iter(study.runs.values())).data["run"]
        page.say(
            f"Made with aaresolve {made['program']} on {made['machine']} ({made['instructionSet']})."
        )
    page.write(docs / "README.md")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
