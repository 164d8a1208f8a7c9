# SPDX-License-Identifier: GPL-3.0-or-later
"""CPU seconds of a frame's main pass, of K sub-samples by multi-view and of K separate renders.

    blender -b --factory-startup --python-exit-code 9 -P tests/bench/exporter_bench.py -- [--pattern d3d8]
        [--resolution 480 270] [--triangles 200000] [--repeats 3]

User + system time of the Blender process, the least of the repeats. A benchmark, not a test: a busy machine changes
its figures, though less their ratios.
"""

from __future__ import annotations

import argparse
import math
import os
import resource
import sys

import bpy
import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "blender_addon"))

from aa_resolve import headless, picture, rendering, sample_part  # noqa: E402
from aa_resolve.export import Exporter  # noqa: E402
from aa_resolve.report import Reporter  # noqa: E402


def sphere(rings: int, sides: int) -> bpy.types.Mesh:
    """A ball of about 2 * rings * sides triangles, smooth."""
    angle = np.arange(sides) * math.tau / sides
    height = np.arange(1, rings) * math.pi / rings
    points = [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]
    points += [
        (math.sin(h) * math.cos(a), math.sin(h) * math.sin(a), math.cos(h)) for h in height for a in angle
    ]

    def at(ring: int, side: int) -> int:
        return 2 + ring * sides + side % sides

    faces = []
    for side in range(sides):
        faces.append((0, at(0, side), at(0, side + 1)))
        faces.append((1, at(rings - 2, side + 1), at(rings - 2, side)))
        faces += [
            (at(r, side), at(r + 1, side), at(r + 1, side + 1), at(r, side + 1)) for r in range(rings - 2)
        ]
    mesh = bpy.data.meshes.new("Ball")
    mesh.from_pydata(points, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    return mesh


def make_scene(triangles: int) -> int:
    """25 balls on a floor in the sun, no cut-outs; returns the number of triangles."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    side = max(4, int(math.sqrt(triangles / 25 / 2)))
    count = 0
    for index in range(25):
        mesh = sphere(side, side)
        mesh.calc_loop_triangles()
        count += len(mesh.loop_triangles)
        material = bpy.data.materials.new(f"Colour {index}")
        material.use_nodes = True
        colour = (index % 5 / 5 + 0.1, index // 5 / 5 + 0.1, 0.4, 1.0)
        material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
        mesh.materials.append(material)
        item = bpy.data.objects.new(f"Ball {index}", mesh)
        item.location = (index % 5 * 2.2 - 4.4, index // 5 * 2.2 - 4.4, 1.0)
        scene.collection.objects.link(item)
    floor = bpy.data.meshes.new("Floor")
    floor.from_pydata([(-30, -30, 0), (30, -30, 0), (30, 30, 0), (-30, 30, 0)], [], [(0, 1, 2, 3)])
    scene.collection.objects.link(bpy.data.objects.new("Floor", floor))
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler = (0.6, 0.2, 0.3)
    scene.collection.objects.link(sun)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (0.0, -15.0, 7.0), (1.15, 0.0, 0.0)
    camera.keyframe_insert("location", frame=1)  # it moves, so that the main pass has motion vectors
    camera.location.x = 2.0
    camera.keyframe_insert("location", frame=11)
    scene.collection.objects.link(camera)
    scene.camera = camera
    return count


def cpu_seconds(work) -> float:
    """User + system seconds of this process and its threads for one call."""
    before = resource.getrusage(resource.RUSAGE_SELF)
    work()
    after = resource.getrusage(resource.RUSAGE_SELF)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(prog="exporter_bench.py")
    parser.add_argument("--pattern", default="d3d8")
    parser.add_argument("--resolution", nargs=2, default=["480", "270"])
    parser.add_argument("--triangles", type=int, default=200_000)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    triangles = make_scene(options.triangles)
    arguments = headless.build_parser().parse_args(
        [
            "--out", "unused", "--frames", "2-3", "--passes", "depth,normal,object,motion,subsamples",
            "--subsamples", options.pattern, "--resolution", *options.resolution, "--truth-frames", "none",
        ]
    )  # fmt: skip
    scene = bpy.context.scene
    reporter = Reporter(False)
    exporter = Exporter(scene, headless.settings_from(arguments, scene), reporter, "bench")
    exporter.prepare()
    plan = exporter.plan
    pictures = picture.Pictures(plan)
    passes = plan.passes_of["frames"]
    pictures._go_to(2)
    rendering.sample_points(scene, 1)

    def main_pass() -> None:
        pictures._aim(2, (0.0, 0.0))
        pictures._render_lights(plan.cycles_passes(passes))

    def multi_view() -> None:
        sample_part.render(plan, pictures._views(2), passes, (0.0, 0.0))

    def separately() -> None:
        for place in plan.positions:
            pictures._aim(2, place)
            pictures._render_lights(plan.cycles_passes({"depth", "normal", "object"}))

    count = len(plan.positions)
    least = {}
    for name, work in (
        ("main pass", main_pass),
        (f"{count} sub-samples, multi-view with override", multi_view),
        (f"{count} separate renders", separately),
    ):
        work()  # the first one also builds what stays
        least[name] = min(cpu_seconds(work) for _ in range(options.repeats))
    width, height = options.resolution
    lines = [f"{triangles} triangles, {width} x {height}, least of {options.repeats}"]
    one = least["main pass"]
    lines += [f"{name:42s} {value:7.3f} CPU s  {value / one:5.2f} x main" for name, value in least.items()]
    for line in lines:
        reporter.say("bench", line)


main()
