# SPDX-License-Identifier: GPL-3.0-or-later
"""Edge distances against the analytic line, and GBAA built from them against the truth."""

from __future__ import annotations

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

NONE = 0.5


def exported(*options: str) -> tuple[dict, np.ndarray, np.ndarray, str]:
    out = os.path.join(t.temporary_folder(), "shot")
    shot = t.export(out, "--frames", "1", "--passes", "edges,object", *options)
    path = os.path.join(out, "frames/000001.exr")
    edges = t.stacked(t.read_part(path, "edges"), "edge.X edge.Y").astype(np.float64)
    return shot, edges, t.read_part(path, "object")["id"], out


def test_half_planes() -> None:
    """A plane that ends at a line of known slope, seen orthographically: one pixel is one metre."""
    for degrees in (3, 27, 44, 46, 71, 88, 113, 178):
        scene = t.new_scene(32, 24)
        camera = t.add_camera(scene, (0, -10, 0), (0, 0, 0))
        camera.data.type, camera.data.ortho_scale = "ORTHO", 32.0
        angle = math.radians(degrees)
        along = np.array((math.cos(angle), 0, math.sin(angle)))
        inward = np.array((-math.sin(angle), 0, math.cos(angle)))
        through = np.array((0.3, 0, -0.2))
        corners = [
            through - 90 * along,
            through + 90 * along,
            through + 90 * along + 180 * inward,
            through - 90 * along + 180 * inward,
        ]
        mesh = bpy.data.meshes.new("Half")
        mesh.from_pydata([tuple(corner) for corner in corners], [], [(0, 1, 2, 3)])
        t.add_object(scene, "Half", mesh)
        shot, edges, ids, _ = exported("--truth-frames", "none")
        jitter = shot["frames"][0]["jitter"]
        assert jitter[1] != 0.0
        # The line in pixels: points (x, y) with normal . (point - origin) = 0, y down.
        normal = np.array((-math.sin(angle), -math.cos(angle)))
        origin = np.array((16 + through[0], 12 - through[2]))
        x, y = np.meshgrid(np.arange(32) + 0.5 + jitter[0], np.arange(24) + 0.5 + jitter[1])
        value = normal[0] * (x - origin[0]) + normal[1] * (y - origin[1])
        major = 0 if abs(normal[0]) > abs(normal[1]) else 1
        expected = -value / normal[major]
        near = (ids > 0) & (np.abs(expected) < 20)
        assert near.sum() > 100
        assert np.abs(edges[near][:, major] - expected[near]).max() < 1e-4, degrees
        assert (edges[near][:, 1 - major] == NONE).all(), degrees
        assert (edges[ids == 0] == NONE).all(), "background has no edge"
        assert "pixels_without_edges" not in shot["frames"][0]


def test_inner_edges_are_no_edges() -> None:
    """A wall of many coplanar quads: only its outline counts, no diagonal and no joint."""
    scene = t.new_scene(48, 32)
    t.add_camera(scene, (0, -8, 0), (0, 0, 0), 60)
    count = 9
    points = [(x / 4 - 1, 0, z / 4 - 1) for x in range(count) for z in range(count)]
    faces = [
        (x * count + z, (x + 1) * count + z, (x + 1) * count + z + 1, x * count + z + 1)
        for x in range(count - 1)
        for z in range(count - 1)
    ]
    mesh = bpy.data.meshes.new("Wall")
    mesh.from_pydata(points, [], faces)
    t.add_object(scene, "Wall", mesh)
    _, edges, ids, _ = exported("--truth-frames", "none", "--jitter", "none")
    inside = ids > 0
    for _ in range(3):
        inner = inside.copy()
        inner[1:-1, 1:-1] &= (
            inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
        )
        inside = inner
    assert (
        inside.sum() > 20 and np.abs(edges[inside]).min() >= NONE
    ), "no edge within a pixel, deep inside"


def gbaa(color: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """GBAA's own part [Persson 2011]: one bilinear fetch beside the sample."""
    height, width = color.shape[:2]
    shift = np.where(np.abs(edges) < 0.5, np.where(edges >= 0, 0.5, -0.5) - edges, 0.0)
    y, x = np.mgrid[0:height, 0:width]
    x, y = x + shift[..., 0], y + shift[..., 1]
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - left)[..., None], (y - top)[..., None]

    def at(row, column):
        return color[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]

    upper = at(top, left) * (1 - fx) + at(top, left + 1) * fx
    return upper * (1 - fy) + (at(top + 1, left) * (1 - fx) + at(top + 1, left + 1) * fx) * fy


def test_gbaa_comes_closer_to_the_truth() -> None:
    """On perspective cubes, some of them instances; with the signs flipped it must get worse."""
    scene = t.new_scene(96, 54)
    t.add_camera(scene)
    t.add_sun(scene)
    random = np.random.default_rng(5)
    for index in range(6):
        item = t.add_object(
            scene,
            f"Cube {index}",
            None,
            (index - 2.5, 0, random.uniform(0, 1)),
            random.uniform(0, 3, 3),
        )
        item.data.materials.append(t.diffuse(f"Colour {index}", random.uniform(0.2, 0.9, 3)))
    collection = bpy.data.collections.new("Source")
    part = bpy.data.objects.new("Part", t.cube_mesh("Part", 0.8))
    part.data.materials.append(t.diffuse("Part", (0.9, 0.3, 0.2)))
    collection.objects.link(part)
    for index in range(2):
        empty = bpy.data.objects.new(f"Instance {index}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location, empty.rotation_euler = (2 * index - 1, -1.5, 1.4), (0.4, 0.3, 0.5 + index)
        scene.collection.objects.link(empty)
    shot, edges, ids, out = exported("--jitter", "none", "--truth-samples", "64")
    assert sum(" of Instance" in name for name in shot["objects"].values()) == 2
    color = t.stacked(t.read_part(os.path.join(out, "frames/000001.exr"), "color"), "R G B").astype(
        np.float64
    )
    truth = (
        sum(
            t.stacked(t.read_part(os.path.join(out, "truth/000001.exr"), half), "R G B")
            for half in "ab"
        )
        / 2.0
    )

    def error(picture: np.ndarray) -> float:
        return float(((picture - truth) ** 2).mean())

    assert shot["frames"][0].get("pixels_without_edges", 0) <= 0.002 * ids.size
    better = error(gbaa(color, edges)) / error(color)
    assert (
        better < 0.7
    ), better  # the neighbours' edges, which GBAA reads too, would bring as much again
    flipped = np.where(edges == NONE, NONE, -edges)
    # Away from the edge lies more of the same surface: no gain.
    assert error(gbaa(color, flipped)) > 0.95 * error(color), "the sign matters"


def test_triangles_that_pass_the_eye() -> None:
    """A floor that runs under and behind the camera needs no clipping."""
    scene = t.new_scene(48, 32)
    t.add_camera(scene, (0, -8, 1), (0, 0, 0.4))
    mesh = bpy.data.meshes.new("Floor")
    mesh.from_pydata([(-40, -40, 0), (40, -40, 0), (40, 5, 0), (-40, 5, 0)], [], [(0, 1, 2, 3)])
    t.add_object(scene, "Floor", mesh)
    shot, edges, ids, _ = exported("--truth-frames", "none", "--jitter", "none")
    assert "pixels_without_edges" not in shot["frames"][0]
    top = np.argmax(ids > 0, axis=0)
    distance = edges[top, np.arange(48), 1]
    assert (distance < 0).all() and (
        distance > -1
    ).all(), "the far edge lies less than a pixel above its first row"
    assert np.ptp(top + 0.5 + distance) < 1e-3, "and is one straight line"


if __name__ == "__main__":
    t.main(
        test_half_planes,
        test_inner_edges_are_no_edges,
        test_gbaa_comes_closer_to_the_truth,
        test_triangles_that_pass_the_eye,
    )
