# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an exported frame's processor time goes, stage by stage, and what settings of the libraries below change of it.

    blender -b --factory-startup --python-exit-code 9 -P tests/bench/exporter_stages.py -- [--resolution 480x270]
        [--triangles 200000] [--rounds 5]

Stages are those of the exporter's own stopwatch, told in processor time of all threads instead of the clock's. Each
setting is tried in rounds, by turns with the exporter's own, so that both see the same machine; medians. A setting that
halved a stage would be the exporter's own by now, or there is a reason beside it here why it is not.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import time
import types
from collections.abc import Callable

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from exporter_scene import make_scene  # noqa: E402

from aa_resolve import exr  # noqa: E402
from aa_resolve.command_line import build_parser, settings_from  # noqa: E402
from aa_resolve.export import Exporter  # noqa: E402
from aa_resolve.passes import exposure  # noqa: E402
from aa_resolve.progress import Progress  # noqa: E402

NUMBER = 2  # a frame between its neighbours
PASSES = "albedo,depth,normal,object,motion,subsamples"


def set_level(level: int) -> Callable[[], None]:
    def change() -> None:
        exr._ZLIB_LEVEL = level

    return change


def main() -> None:
    parser = argparse.ArgumentParser(prog="exporter_stages.py")
    parser.add_argument("--resolution", default="480x270")
    parser.add_argument("--triangles", type=int, default=200_000)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    triangles = make_scene(options.triangles, False, 4)
    words = ["--out", "unused", "--frames", "2-3", "--passes", PASSES, "--subsamples", "d3d8"]
    words += ["--resolution", options.resolution, "--truth-frames", "none"]
    scene, progress = bpy.context.scene, Progress(False)
    exporter = Exporter(
        scene, settings_from(build_parser().parse_args(words), scene), progress, "bench"
    )
    exporter.prepare()
    exposure.time = types.SimpleNamespace(perf_counter=time.process_time)
    file = os.path.join(bpy.app.tempdir, "frame.exr")
    level = exr._ZLIB_LEVEL
    cycles, render = scene.cycles, scene.render
    bvh = cycles.debug_bvh_type
    other_bvh = "STATIC_BVH" if bvh != "STATIC_BVH" else "DYNAMIC_BVH"

    def put(owner: object, name: str, value: object) -> Callable[[], None]:
        return lambda: setattr(owner, name, value)

    tries: dict[str, tuple[Callable[[], None], Callable[[], None]]] = {
        "as it is": (lambda: None, lambda: None),
        "deflate level 1": (set_level(1), set_level(level)),
        "deflate level 0": (set_level(0), set_level(level)),
        f"{other_bvh} for {bvh}": (put(cycles, "debug_bvh_type", other_bvh), put(cycles, "debug_bvh_type", bvh)),
        "one tile": (put(cycles, "use_auto_tile", False), put(cycles, "use_auto_tile", cycles.use_auto_tile)),
        "no light tree": _light_tree(cycles),
        "nothing kept between frames": (put(render, "use_persistent_data", False), put(render, "use_persistent_data", True)),
    }  # fmt: skip
    spent: dict[str, list[dict[str, float]]] = {name: [] for name in tries}
    for _ in range(options.rounds):
        for name, (change, back) in tries.items():
            change()
            exporter.pictures.frame("frames", NUMBER, file)
            spent[name].append(exporter.pictures.frame("frames", NUMBER, file).seconds)
            back()
    base = medians(spent["as it is"])
    whole = sum(base.values())
    progress.say(
        "bench",
        f"{triangles} triangles, {options.resolution}, {options.rounds} rounds, median CPU s of a frame",
    )
    for stage, seconds in sorted(base.items(), key=lambda s: -s[1]):
        progress.say("bench", f"{stage:16s} {seconds:7.3f} s {100 * seconds / whole:5.1f} %")
    for name, rounds in spent.items():
        found = medians(rounds)
        ratios = ", ".join(f"{s} {found[s] / base[s]:.2f}" for s in base if base[s] > 0.02 * whole)
        progress.say("bench", f"{name:28s} frame {sum(found.values()) / whole:.2f} x ({ratios})")


def _light_tree(cycles: object) -> tuple[Callable[[], None], Callable[[], None]]:
    if not hasattr(cycles, "use_light_tree"):  # before Blender 3.5
        return (lambda: None, lambda: None)
    kept = cycles.use_light_tree
    return (
        lambda: setattr(cycles, "use_light_tree", not kept),
        lambda: setattr(cycles, "use_light_tree", kept),
    )


def medians(rounds: list[dict[str, float]]) -> dict[str, float]:
    return {stage: statistics.median(r[stage] for r in rounds) for stage in rounds[0]}


main()
