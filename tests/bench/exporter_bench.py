# SPDX-License-Identifier: GPL-3.0-or-later
"""CPU seconds of a frame's main pass, of K sub-samples by multi-view, of K separate renders, and of whole frames.

    blender -b --factory-startup --python-exit-code 9 -P tests/bench/exporter_bench.py -- [--pattern d3d8]
        [--resolution 480x270] [--triangles 200000] [--rounds 7] [--animated]

User + system time of the Blender process. A round runs each of them twice in a row and times the second: as in a long
export, what stays between frames stays: all geometry where the camera alone moves. With --animated every ball moves
from one frame to the next, and Cycles takes the scene in anew. The seconds are the least of the rounds, the ratios the
median of the rounds' own ratios, so that a busy machine slows both sides alike.

Renders include reading them back and bringing them to the arrays that the exporter writes. What sub-samples cost is a
main pass with them less one without: Cycles transfers the geometry again when the override material comes and when it
goes, and the latter shows in the main pass. The fresh main pass takes the scene in anew, as Blender does unless it is
told to keep it (use_persistent_data), which the exporter does tell it. A frame is all that the exporter does for it, to
the file on disk.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from exporter_scene import make_scene  # noqa: E402

from aa_resolve.command_line import build_parser, settings_from  # noqa: E402
from aa_resolve.export import Exporter  # noqa: E402
from aa_resolve.passes import subsamples  # noqa: E402
from aa_resolve.passes.albedo import unlit_albedo  # noqa: E402
from aa_resolve.passes.exposure import Exposure  # noqa: E402
from aa_resolve.passes.geometry import ids_of  # noqa: E402
from aa_resolve.passes.table import passes_named  # noqa: E402
from aa_resolve.progress import Progress  # noqa: E402


_LAST = 4  # frame; the bench stays between its neighbours


def cpu_seconds(work) -> float:
    """User + system seconds of this process and its threads for one call."""
    before = resource.getrusage(resource.RUSAGE_SELF)
    work()
    after = resource.getrusage(resource.RUSAGE_SELF)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(prog="exporter_bench.py")
    parser.add_argument("--pattern", default="d3d8")
    parser.add_argument("--resolution", default="480x270")
    parser.add_argument("--triangles", type=int, default=200_000)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--animated", action="store_true", help="all balls move in every frame")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    triangles = make_scene(options.triangles, options.animated, _LAST)
    arguments = build_parser().parse_args(
        [
            "--out", "unused", "--frames", f"2-{_LAST - 1}", "--passes", "albedo,depth,normal,object,motion,subsamples",
            "--subsamples", options.pattern, "--resolution", options.resolution, "--truth-frames", "none",
        ]
    )  # fmt: skip
    scene = bpy.context.scene
    progress = Progress(False)
    exporter = Exporter(scene, settings_from(arguments, scene), progress, "bench")
    exporter.prepare()
    plan = exporter.plan
    pictures = exporter.pictures
    every = {"albedo", "depth", "normal", "object", "motion"}
    number = 2
    file = os.path.join(bpy.app.tempdir, "frame.exr")

    def main_pass(passes: set[str], offset: tuple[float, float] = (0.0, 0.0)) -> None:
        exposure = Exposure(plan, pictures.stage, number, offset, passes_named(passes))
        if "albedo" in passes:
            unlit_albedo(exposure.main)
        if "motion" in passes:
            exposure.main.get("Vector")
        exposure.main.get("Depth"), exposure.main.get("Normal"), ids_of(exposure)

    def multi_view() -> None:
        views = pictures.stage.views(number, plan.positions)
        views.aim(plan.frame, bpy.context.evaluated_depsgraph_get(), (0.0, 0.0))
        layers = subsamples.render_geometry(plan, views, subsamples.Subsamples.cycles)[0]
        for name in views.names:
            layers.get("Depth", name), layers.get("Normal", name), plan.ids.resolve(layers, name)

    def separately() -> None:
        for place in plan.positions:
            main_pass({"depth", "normal", "object"}, place)

    def frame(passes: set[str]) -> None:
        plan.passes_of["frames"] = passes
        pictures.frame("frames", number, file)

    def fresh() -> None:
        scene.render.use_persistent_data = False
        main_pass(every)
        scene.render.use_persistent_data = True

    count = len(plan.positions)
    works = {
        "main": lambda: main_pass(every),
        "plain": lambda: main_pass(every - {"albedo"}),
        "lean": lambda: main_pass({"depth", "normal", "object"}),
        "main+": lambda: (main_pass(every), multi_view()),
        "plain+": lambda: (main_pass(every - {"albedo"}), multi_view()),
        "lean+": lambda: (main_pass({"depth", "normal", "object"}), multi_view()),
        "separate": separately,
        "fresh": fresh,
        "frame": lambda: frame(every),
        "frame+": lambda: frame(every | {"subsamples"}),
    }
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(options.rounds):
        for name, work in works.items():
            work()  # brings Cycles to where the frame before would have left it
            if options.animated:
                number = _LAST + 1 - number
                pictures.stage.go_to(number)
            seconds[name].append(cpu_seconds(work))
    added = {
        name: [both - one for both, one in zip(seconds[f"{name}+"], seconds[name])]
        for name in ("main", "plain", "lean", "frame")
    }

    def line(text: str, values: list[float], base: str, what: str) -> str:
        ratio = statistics.median(v / one for v, one in zip(values, seconds[base]))
        return f"{text:26s} {min(values):7.3f} CPU s {ratio:6.2f} x {base:6s} {what}"

    width, height = options.resolution.split("x")
    moving = "all balls move" if options.animated else "the camera alone moves"
    for text in (
        f"{triangles} triangles, {width} x {height}, {moving}, "
        f"{options.rounds} rounds: least seconds, median ratios",
        line("main pass", seconds["main"], "main", "colour, albedo, depth, normal, object ids, motion"),
        line("plain main pass", seconds["plain"], "main", "the same without albedo"),
        line("lean main pass", seconds["lean"], "main", "colour, depth, normal, object ids"),
        line(f"{count} sub-samples", added["main"], "main", "depth, normal, object ids: multi-view, override"),
        line("", added["plain"], "plain", "the same beside the plain main pass"),
        line("", added["lean"], "lean", "the same beside the lean main pass"),
        line(f"{count} separate renders", seconds["separate"], "main", "of the lean main pass"),
        line("", seconds["separate"], "plain", "the same beside the plain main pass"),
        line("fresh main pass", seconds["fresh"], "main", "nothing kept between frames, as Blender does by default"),
        line(f"{count} sub-samples", added["main"], "fresh", "beside the fresh main pass"),
        line(f"{count} separate renders", seconds["separate"], "fresh", "the same beside the fresh main pass"),
        line("frame", seconds["frame"], "frame", "main pass, packed and written"),
        line(f"{count} sub-samples in a frame", added["frame"], "frame", "added to it: mask, packing and writing too"),
    ):  # fmt: skip
        progress.say("bench", text)


main()
