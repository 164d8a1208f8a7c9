# SPDX-License-Identifier: MIT
"""Renders the study's scenes, runs the minimum study set on each, and writes docs/results.

usage: reproduce.py PROGRAM OUT DOCS [--quick] [--only SHOT ...]

Resumable: finished frames are kept. --quick renders fewer frames and samples. --only renders and runs some shots and
writes the pages for which that suffices.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path

import studies

from catalogue import (
    ANGLES, HEADROOM_FLAGS, HEADROOM_METHODS, PICTURES, SHOTS, STEP_METHODS, STEPS, THESIS_FLAGS,
)  # fmt: skip
from figures import Run
from page import Page
from shots import ROOT, Shot, Workshop, make


def methods_of(shot: Shot, shop: Workshop) -> list[str]:
    return [m for m in shot.methods.split() if shop.serves(m)]


def run_methods(
    folder: Path, what: str, methods: str, shop: Workshop, flags: tuple[str, ...] = ()
) -> Run:
    """Methods on a shot, in a protocol of `flags`; repeated only when shot, program or list have changed."""
    out = folder.parent / f"{folder.name}.{what}"
    texts = [m for m in methods.split() if shop.serves(m)]
    newest = max((folder / "shot.json").stat().st_mtime, shop.program.stat().st_mtime)
    results = out / "results.json"
    if not results.exists() or results.stat().st_mtime < newest or list(Run(out).methods) != texts:
        command: list[object] = [
            shop.program,
            "run",
            folder,
            "-o",
            out,
            "--write",
            "none",
            "-q",
            *flags,
        ]
        for m in texts:
            command += ["-m", m]
        shop.run(f"{what}.{folder.name}", command)
    return Run(out)


def picture(name: str, shot: Shot, methods: list[str], docs: Path, shop: Workshop) -> None:
    """A contact sheet as a small JPEG beside the pages; OpenImageIO's Python writes it, which Blender needs anyway."""
    folder = shop.folder(shot)
    out = folder.parent / f"{folder.name}.sheet"
    command: list[object] = [shop.program, "run", folder, "-o", out, "--write", "exr", "-q"]
    for m in methods:
        command += ["-m", m]
    shop.run(f"sheet.{shot.name}", command)
    shop.run(f"sheet.{shot.name}", [shop.program, "sheet", out, "-o", out / "sheet.png"])
    docs.mkdir(parents=True, exist_ok=True)
    shop.run(
        f"sheet.{shot.name}",
        ["/usr/bin/python3", "-c", _JPEG, out / "sheet.png", docs / f"{name}.jpg"],
    )


# Shrinks to 1280 px wide and takes the best quality below 280 kB.
_JPEG = """
import os, sys
import OpenImageIO as oiio
sheet = oiio.ImageBuf(sys.argv[1])
spec = sheet.spec()
width = min(spec.width, 1280)
small = oiio.ImageBufAlgo.resize(sheet, "lanczos3", 0, oiio.ROI(0, width, 0, spec.height * width // spec.width, 0, 1, 0, 3))
for quality in range(90, 20, -5):
    small.specmod().attribute("Compression", f"jpeg:{quality}")
    small.write(sys.argv[2], "uint8")
    if os.path.getsize(sys.argv[2]) < 280_000:
        break
"""


def bench(shop: Workshop, runs: dict[str, Run]) -> Page:
    """Times on one thread: at 1080p on a scene that moves, in the short form on small frames that are there anyway."""
    shot = SHOTS["hard_edges" if shop.quick else "moving_sphere_1080p"]
    command: list[object] = [
        shop.program,
        "bench",
        "-j",
        1,
        "--json",
        "--repeats",
        3,
        "--frames",
        3,
    ]
    command += ["--shot", make(SHOTS, shot, shop)]
    for m in methods_of(shot, shop):
        command += ["-m", m]
    where = f"{shot.size[0]} × {shot.size[1]}, rendered frames of {shot.scene}"
    if runs:
        made = next(iter(runs.values())).data["run"]
        where += f", {made['machine']} ({made['instructionSet']})"
    return studies.speed_page(json.loads(shop.run("bench", command)), where, shot.size)


def angles(shop: Workshop) -> Page | None:
    """Half-planes of every direction, where the program has the command for it."""
    if "angles" not in shop.run("help", [shop.program, "--help"]):
        return None
    command: list[object] = [shop.program, "angles", "--json"]
    for m in ANGLES.split():
        command += ["-m", m] if shop.serves(m) else []
    return studies.angles_page(json.loads(shop.run("angles", command)))


def write_pages(
    study: studies.Study, speed: Page | None, by_angle: Page | None, docs: Path
) -> list[str]:
    """Every page whose runs are there; returns the index's lines."""
    runs = study.runs
    wanted = [
        ("static.md", {"hard_edges"}, lambda: studies.static_page(study), "the thesis's protocol and ours, step by step; the parts of `master`"),
        ("motion.md", {"moving_sphere"}, lambda: studies.motion_page(runs), "ghosts, flicker, identity against colour boxes, hybrid fill, printed weights"),
        ("geometry.md", {"hard_edges"}, lambda: studies.geometry_page(runs), "RSAA's variants and numbers of sub-samples, against MSAA and MLAA"),
        ("published.md", {"hard_edges"}, lambda: studies.published_page(study), "the published gains beside ours, in both protocols"),
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
    parser.add_argument("--quick", action="store_true", help="fewer frames and samples")
    parser.add_argument("--only", nargs="+", metavar="SHOT", help=f"of {', '.join(SHOTS)}")
    parser.add_argument("--blender", default=os.environ.get("BLENDER", "blender"))
    parser.add_argument("--no-bench", action="store_true", help="leave the timing out")
    a = parser.parse_args(argv)
    started = time.monotonic()
    shop = Workshop(a.program.resolve(), a.blender, a.out.resolve(), a.quick)
    shop.out.mkdir(parents=True, exist_ok=True)
    addon = json.loads((ROOT / "blender_addon/aa_resolve/methods.json").read_text())
    program = json.loads(shop.run("list", [shop.program, "list", "--json"]))
    shop.known = {m["id"] for m in program["methods"]} & {m["id"] for m in addon["methods"]}
    unknown = set(a.only or ()) - set(SHOTS)
    if unknown:
        parser.error(f"--only: no shot {sorted(unknown)[0]}; known: {', '.join(SHOTS)}")

    sequences = (ROOT / "blender_addon/aa_resolve/jitter.py").read_text()
    runs: dict[str, Run] = {}
    thesis: dict[str, Run] = {}  # the same shots in the protocol of the theses
    headroom: dict[str, Run] = {}
    for name, shot in SHOTS.items():
        if f'"{shot.jitter}"' not in sequences:
            print(
                f"  shot {name}: left out, the exporter does not know the jitter {shot.jitter}",
                flush=True,
            )
            continue
        if (
            a.only
            and name not in a.only
            and SHOTS[name].name not in {SHOTS[o].truth_of for o in a.only}
        ):
            continue
        if not shot.truth:
            continue
        folder = make(SHOTS, shot, shop)
        runs[name] = run_methods(folder, "run", shot.methods, shop)
        if shot.thesis:
            thesis[name] = run_methods(folder, "thesis", shot.thesis, shop, THESIS_FLAGS)
        if "master" in shot.thesis.split():
            headroom[name] = run_methods(folder, "headroom", HEADROOM_METHODS, shop, HEADROOM_FLAGS)
    steps: dict[str, Run] = {}
    if "hard_edges" in thesis:
        folder = shop.folder(SHOTS["hard_edges"])
        for i, (what, flags) in enumerate(STEPS.items()):
            steps[what] = run_methods(folder, f"step{i}", STEP_METHODS, shop, flags)
    study = studies.Study(runs, thesis, steps, headroom)
    for name, (shot_name, methods) in PICTURES.items():
        if shot_name in runs:
            picture(
                name,
                SHOTS[shot_name],
                [m for m in methods.split() if m in runs[shot_name]],
                a.docs,
                shop,
            )
    speed = None if a.no_bench else bench(shop, runs)
    index = write_pages(study, speed, angles(shop), a.docs)
    page = Page("Results")
    page.say(
        "Written by `make reproduce` from its own renders; every sentence follows from the figures.",
        "This is the short form (`QUICK=1`): fewer frames and samples." if a.quick else "",
    )
    if runs:
        page.heading("In short")
        page.points(studies.headlines(study))
        page.heading("Pages")
    page.points(index)
    page.say(
        "How to read them: gains are decibels of PSNR over no anti-aliasing on display-encoded values (in the thesis's question on",
        "displayed values without gamma), where 3 dB is half the squared error; intervals are 95 %; *not resolved* means that the difference is within the truth's own noise or",
        "depends on the part of the picture.",
    )
    if runs:
        made = next(iter(runs.values())).data["run"]
        page.say(
            f"Made with aaresolve {made['program']} on {made['machine']} ({made['instructionSet']})."
        )
    page.write(a.docs / "README.md")
    print(f"{a.docs / 'README.md'}: {len(index)} pages, {time.monotonic() - started:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
