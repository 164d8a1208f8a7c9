# SPDX-License-Identifier: GPL-3.0-or-later
"""The large scenes, atrium, village and collision: what is in them, how it moves, and that each is built the same twice."""

from __future__ import annotations

import argparse
import hashlib
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support import ROOT, bpy, main, np  # noqa: E402
from mathutils import Vector  # noqa: E402

sys.path.insert(0, os.path.join(ROOT, "scenes"))
import atrium  # noqa: E402
import collision  # noqa: E402
import village  # noqa: E402


def build(module, **wishes) -> bpy.types.Scene:
    module.build(argparse.Namespace(resolution=(480, 270), **wishes))
    bpy.context.view_layer.update()
    return bpy.context.scene


def triangles(scene) -> int:
    return sum(
        len(face.vertices) - 2
        for thing in scene.objects
        if thing.type == "MESH"
        for face in thing.data.polygons
    )


def mesh_digest(scene) -> str:
    """Of every object's place, vertices, faces and uv."""
    digest = hashlib.sha256()
    for thing in sorted(scene.objects, key=lambda thing: thing.name):
        digest.update(thing.name.encode() + np.array(thing.matrix_world, np.float32).tobytes())
        if thing.type != "MESH":
            continue
        mesh = thing.data
        positions = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", positions)
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        digest.update(positions.tobytes() + corners.tobytes())
        for layer in mesh.uv_layers:
            uv = np.empty(2 * len(mesh.loops), np.float32)
            layer.data.foreach_get("uv", uv)
            digest.update(uv.tobytes())
    return digest.hexdigest()


def at_frame(scene, frame: int, name: str):
    scene.frame_set(frame)
    return scene.objects[name].matrix_world.copy()


def view_corners(scene) -> list[Vector]:
    """Directions through the picture's four corners."""
    camera = scene.camera
    turn = camera.matrix_world.to_3x3()
    return [(turn @ Vector(corner)).normalized() for corner in camera.data.view_frame(scene=scene)]


def test_atrium_has_its_parts_and_rests():
    scene = build(atrium, flying=False)
    names = {thing.name for thing in scene.objects}
    for name in (
        "Column",
        "Upper Column",
        "Arcade North",
        "Banner North 1",
        "Curtain South 2",
        "Sun",
    ):
        assert name in names, name
    columns = [name for name in names if name.startswith("Column")]
    assert len(columns) == 2 * (atrium.LONG - 1) + 2 * (atrium.SHORT - 1), len(columns)
    assert (scene.frame_start, scene.frame_end) == (1, 100)
    assert 100_000 <= triangles(scene) <= 400_000, triangles(scene)
    assert at_frame(scene, 1, "Sphere") == at_frame(scene, 100, "Sphere")


def test_the_sphere_covers_the_view_once():
    scene = build(atrium, flying=True)
    eye, corners = scene.camera.matrix_world.translation, view_corners(scene)
    radius = max(vertex.co.length for vertex in scene.objects["Sphere"].data.vertices)
    inner = 0.98 * radius  # a sphere of flat faces covers a little less than a round one
    covered = []
    for frame in range(1, 101):
        way = at_frame(scene, frame, "Sphere").translation - eye
        assert way.length > radius + scene.camera.data.clip_start, (frame, way.length)
        reach = math.asin(inner / way.length)
        covered.append(all(way.angle(corner) < reach for corner in corners))
    frames = [frame for frame, whole in enumerate(covered, 1) if whole]
    assert atrium.COVER_FRAME in frames, frames
    assert frames == list(range(frames[0], frames[-1] + 1)) and len(frames) < 12, frames
    assert not covered[0] and not covered[99]


def test_village_has_its_parts_and_moves():
    scene = build(village, view="overview")
    names = {thing.name for thing in scene.objects}
    for name in ("Cobbles", "Stairs", "Poles", "Wires", "Window Bars", "Skeleton", "Roofs"):
        assert name in names, name
    assert sum(name.startswith("House ") for name in names) == len(village.HOUSES)
    assert (scene.frame_start, scene.frame_end) == (1, 100)
    assert 100_000 <= triangles(scene) <= 400_000, triangles(scene)
    for name in ("Skeleton", "Sphere Red", "Sphere Green"):
        assert at_frame(scene, 1, name) != at_frame(scene, 2, name), name


def test_balls_meet_and_burst():
    """Whole until they touch, as the spheres' own shards; afterwards apart, and each cloud in the other's place."""
    scene = build(collision)
    places = {}
    for frame in (1, collision.TOUCH, 48, collision.FRAMES):
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for name in ("Left Ball", "Right Ball"):
            ball = scene.objects[name].evaluated_get(graph)
            points = [ball.matrix_world @ vertex.co for vertex in ball.data.vertices]
            places[name, frame] = points
    for name, side in (("Left Ball", -1.0), ("Right Ball", 1.0)):
        for frame, apart in ((1, collision.START), (collision.TOUCH, collision.RADIUS)):
            centre = Vector((side * apart, 0.0, collision.HEIGHT))
            for point in places[name, frame]:
                assert abs((point - centre).length - collision.RADIUS) < 1e-3, (name, frame)
    left, right = places["Left Ball", 48], places["Right Ball", 48]
    assert max(point.x for point in left) > 0.5 and min(point.x for point in right) < -0.5
    ends = places["Left Ball", collision.FRAMES]
    away = sum((point - Vector((0.0, 0.0, collision.HEIGHT))).length > 5.0 for point in ends)
    assert away > 0.6 * len(ends), away / len(ends)


def test_every_view_is_another():
    places = set()
    for view in village.VIEWS:
        scene = build(village, view=view)
        places.add(tuple(round(v, 4) for row in scene.camera.matrix_world for v in row))
    assert len(places) == 4, places


def test_builds_are_the_same_twice():
    for module, wishes in (
        (atrium, {"flying": True}),
        (village, {"view": "wires"}),
        (collision, {}),
    ):
        first, second = (mesh_digest(build(module, **wishes)) for _ in range(2))
        assert first == second, module.__name__


if __name__ == "__main__":
    main(
        test_atrium_has_its_parts_and_rests,
        test_the_sphere_covers_the_view_once,
        test_village_has_its_parts_and_moves,
        test_balls_meet_and_burst,
        test_every_view_is_another,
        test_builds_are_the_same_twice,
    )
