# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of edges for GPAA: the very lines that projection gives, clipped, in order, and in the agreed form."""

from __future__ import annotations

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

NAMES = "x0 y0 z0 x1 y1 z1"
MARGIN = 4.0


def exported(*options: str) -> tuple[np.ndarray, dict, str]:
    """Segments of frame 1 (N x 6), shot.json and the frame's path."""
    out = os.path.join(t.temporary_folder(), "shot")
    shot = t.export(
        out, "--frames", "1", "--truth-frames", "none", "--passes", "segments", *options
    )
    path = os.path.join(out, "frames/000001.exr")
    entries = t.stacked(t.read_part(path, "segments"), NAMES).reshape(-1, 6)
    used = entries[:, 2] > 0
    assert (entries[~used] == 0).all() and used[: used.sum()].all(), "zeros at the end only"
    return entries[used].astype(np.float64), shot, path


def rounded(segments: np.ndarray) -> set[tuple]:
    """Segments as a set of pairs of ends, to 1e-3 px, whatever their direction."""
    ends = np.round(segments[:, [0, 1, 3, 4]], 3) + 0.0
    return {tuple(sorted(((row[0], row[1]), (row[2], row[3])))) for row in ends.tolist()}


def mesh_of(points, faces, name: str = "Mesh"):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    mesh.update()
    return mesh


def test_cube() -> None:
    """A flat-shaded cube shows all of its 12 edges as creases; positions and depths are those of its corners."""
    for kind in ("PERSP", "ORTHO"):
        scene = t.new_scene(64, 36)
        camera = t.add_camera(scene, (2, -8, 3), (0, 0, 0))
        camera.data.type, camera.data.ortho_scale = kind, 6.0
        item = t.add_object(scene, "Cube", None, (0, 0, 0), (0.2, 0.3, 0.5))
        bpy.context.view_layer.update()
        projection = t.Projection(camera, 64, 36)
        corners = np.array([item.matrix_world @ v.co for v in item.data.vertices], np.float64)
        places = projection.project(corners)
        depth = -(corners @ projection.to_view[:3, :3].T + projection.to_view[:3, 3])[:, 2]
        expected = set()
        for edge in item.data.edges:
            a, b = places[edge.vertices[0]], places[edge.vertices[1]]
            expected.add(tuple(sorted((tuple(np.round(a, 3)), tuple(np.round(b, 3))))))
        found, shot, _ = exported()
        assert shot["frames"][0]["jitter"] != [0.0, 0.0], "and the jitter does not move them"
        assert len(found) == 12 and rounded(found) == expected, (kind, rounded(found) ^ expected)
        for x, y, z in np.concatenate([found[:, :3], found[:, 3:]]):
            nearest = np.hypot(places[:, 0] - x, places[:, 1] - y).argmin()
            assert abs(depth[nearest] - z) < 1e-5 * z, (kind, depth[nearest], z)


def test_kinds_of_edges() -> None:
    """Coplanar neighbours have no edge between them, other materials have; a smooth cylinder shows its outline only."""
    scene = t.new_scene(64, 36)
    t.add_camera(scene, (0, -8, 0), (0, 0, 0))
    points = [(x, 0, z) for x in (-1, 0, 1) for z in (-1, 1)]
    wall = mesh_of(points, [(0, 2, 3, 1), (2, 4, 5, 3)])
    item = t.add_object(scene, "Wall", wall)
    assert len(exported()[0]) == 6, "the outline: the joint of two coplanar faces is no edge"

    scene = t.new_scene(64, 36)
    t.add_camera(scene, (0, -8, 0), (0, 0, 0))
    wall = mesh_of(points, [(0, 2, 3, 1), (2, 4, 5, 3)])
    item = t.add_object(scene, "Wall", wall)
    for name in "AB":
        item.data.materials.append(t.diffuse(name, (0.5, 0.5, 0.5)))
    item.data.polygons[1].material_index = 1
    assert len(exported()[0]) == 7, "where the material changes there is one"

    scene = t.new_scene(64, 36)
    t.add_camera(scene, (0, -8, 0), (0, 0, 0))
    split = [
        (x, 0, z) for x in (-1, 0, 0, 1) for z in (-1, 1)
    ]  # as importers leave seams of textures
    t.add_object(scene, "Wall", mesh_of(split, [(0, 2, 3, 1), (4, 6, 7, 5)]))
    assert len(exported()[0]) == 6, "vertices at one place are one"

    def cylinder(smooth: bool, auto_smooth: float = 0.0, split: bool = False, custom: str = ""):
        scene = t.new_scene(64, 36)
        t.add_camera(scene, (0, -8, 0), (0, 0, 0))
        sides = 24
        ring = [
            (math.cos(k * math.tau / sides), math.sin(k * math.tau / sides)) for k in range(sides)
        ]
        points = [(x, y, z) for z in (-1.5, 1.5) for x, y in ring]
        faces = [(k, (k + 1) % sides, sides + (k + 1) % sides, sides + k) for k in range(sides)]
        if split:  # every face with vertices of its own, as importers leave seams
            points = [points[corner] for face in faces for corner in face]
            faces = [tuple(range(first, first + 4)) for first in range(0, len(points), 4)]
        mesh = mesh_of(points, faces)  # open at both ends
        mesh.polygons.foreach_set("use_smooth", [smooth] * sides)
        if auto_smooth:
            t.smooth_by_angle(mesh, auto_smooth)
        if custom:
            normals = [
                mesh.polygons[loop // 4].normal
                if custom == "flat"
                else (*mesh.vertices[vertex].co[:2], 0.0)
                for loop, vertex in enumerate(loop.vertex_index for loop in mesh.loops)
            ]
            if hasattr(mesh, "use_auto_smooth"):  # before 4.1 they count only with it
                mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
            mesh.normals_split_custom_set(normals)
        t.add_object(scene, "Cylinder", mesh)
        return exported()[0]

    found = cylinder(True)
    upright = found[np.abs(found[:, 0] - found[:, 3]) < 1e-3]
    assert len(upright) == 2 and np.ptp(upright[:, 0]) > 5, "two silhouettes"
    assert len(found) == 2 + 2 * 24, "and the open ends"
    assert len(cylinder(False)) == 24 + 2 * 24, "flat faces: every joint is a crease"
    assert len(cylinder(True, math.radians(10))) == 24 + 2 * 24, "15 degrees are beyond 10"
    assert len(cylinder(True, math.radians(20))) == 2 + 2 * 24
    assert len(cylinder(True, custom="flat")) == 24 + 2 * 24, "custom normals break the shading"
    assert len(cylinder(True, split=True)) == 24 + 2 * 24, "vertices of their own break it, too"
    assert len(cylinder(True, split=True, custom="round")) == 2 + 2 * 24, "or hide seams"


def test_clipping() -> None:
    """A floor that runs under and behind the camera: clipped to the near plane and to the extended picture."""
    for kind in ("PERSP", "ORTHO"):
        scene = t.new_scene(48, 32)
        camera = t.add_camera(scene, (0, -8, 1), (0, 0, 0.4))
        camera.data.type, camera.data.ortho_scale = kind, 6.0
        points = [(-2, -40, 0), (1, -40, 0), (1, 5, 0), (-2, 5, 0)]
        t.add_object(scene, "Floor", mesh_of(points, [(0, 1, 2, 3)]))
        projection = t.Projection(camera, 48, 32)
        found, _, _ = exported()
        assert len(found) == 3, found  # the near side lies behind the camera
        for x, y, z in np.concatenate([found[:, :3], found[:, 3:]]):
            assert -MARGIN - 1e-3 <= x <= 48 + MARGIN + 1e-3, x
            assert -MARGIN - 1e-3 <= y <= 32 + MARGIN + 1e-3, y
            assert z >= 0.1 - 1e-6, z
            point = projection.unproject(np.array([x]), np.array([y]), np.array([z]))[0]
            assert abs(point[2]) < 1e-4, "still on the floor"
            sides = (abs(point[0] + 2), abs(point[0] - 1), abs(point[1] - 5))
            assert min(sides) < 1e-4, "and on one of its sides"
        ends = found[:, [0, 1, 3, 4]].reshape(-1, 2)
        border = np.array(((-MARGIN, -MARGIN), (48 + MARGIN, 32 + MARGIN)))
        cut = np.isclose(ends[:, None, :], border, atol=1e-3).any(axis=(1, 2))
        near = np.isclose(found[:, [2, 5]], 0.1)
        assert (cut.sum(), near.sum()) == ((2, 0) if kind == "PERSP" else (0, 2)), (cut, near)


def test_form_and_order() -> None:
    """4096 entries a line, the rest zeros, beside parts of the picture's size; far to near; the same bytes each time."""

    def make():
        scene = t.new_scene(32, 18)
        t.add_camera(scene, (0, -8, 0), (0, 0, 0))
        points, faces = [], []
        for k in range(1500):  # separate small quads: 4 edges each
            x, z, y = k % 50 * 0.08 - 2, k // 50 * 0.07 - 1, k * 0.001
            base = len(points)
            points += [(x, y, z), (x + 0.05, y, z), (x + 0.05, y, z + 0.04), (x, y, z + 0.04)]
            faces.append((base, base + 1, base + 2, base + 3))
        t.add_object(scene, "Confetti", mesh_of(points, faces))

    make()
    found, shot, path = exported("--passes", "segments,depth")
    assert len(found) == 6000, len(found)
    source = t.oiio.ImageInput.open(path)
    assert t.part_names(path) == ["color", "depth", "segments"]
    for index, (width, height) in enumerate(((32, 18), (32, 18), (4096, 2))):
        source.seek_subimage(index, 0)
        spec = source.spec()
        assert (spec.width, spec.height, spec.x, spec.y) == (width, height, 0, 0), index
        assert (spec.full_width, spec.full_height) == (32, 18), "one display window"
    assert str(source.spec().format) == "float"
    mean = (found[:, 2] + found[:, 5]) / 2
    assert (np.diff(mean) <= 1e-6).all() and np.ptp(mean) > 1, "far to near"
    assert (found[:, 0] <= found[:, 3]).all(), "left end first"
    with open(path, "rb") as file:
        first = file.read()
    make()
    _, _, path = exported("--passes", "segments,depth")
    with open(path, "rb") as file:
        assert file.read() == first
    entry = shot["frames"][0]
    assert entry["bytes"]["segments"] > 0 and entry["render_seconds"]["segments"] > 0

    scene = t.new_scene(32, 18)
    t.add_camera(scene)
    found, _, path = exported()
    assert found.shape == (0, 6), "nothing is there"
    part = t.read_part(path, "segments")
    assert all(plane.shape == (1, 1) and plane[0, 0] == 0 for plane in part.values())


def test_instances_modifiers_and_what_is_hidden() -> None:
    """Every instance has its edges, modifiers are applied, hidden objects have none."""
    scene = t.new_scene(64, 36)
    t.add_camera(scene)
    collection = bpy.data.collections.new("Source")
    collection.objects.link(bpy.data.objects.new("Part", t.cube_mesh("Part", 0.6)))
    for index in range(3):
        empty = bpy.data.objects.new(f"Instance {index}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location, empty.scale = (index - 1.0, 0, 0.6), (1, 1, (-1) ** index)
        scene.collection.objects.link(empty)
    t.add_object(scene, "Hidden", None, (0, -2, 0.5)).hide_render = True
    assert len(exported()[0]) == 3 * 12
    scene = t.new_scene(64, 36)
    t.add_camera(scene)
    item = t.add_object(scene, "Row", t.cube_mesh("Row", 0.5), (-1, 0, 0.5))
    array = item.modifiers.new("Array", "ARRAY")
    array.count, array.relative_offset_displace = 3, (1.5, 0, 0)
    assert len(exported()[0]) == 3 * 12
    scene = t.new_scene(64, 36)
    t.add_camera(scene)
    points = bpy.data.meshes.new("Points")
    points.from_pydata([(-1, 0, 0.5), (0, 0, 0.5), (1, 0, 0.5)], [], [])
    item = t.add_object(scene, "Points", points)
    tree = t.geometry_group("Scatter")
    start, end = tree.nodes["Start"], tree.nodes["End"]
    scatter = tree.nodes.new("GeometryNodeInstanceOnPoints")
    cube = tree.nodes.new("GeometryNodeMeshCube")
    cube.inputs["Size"].default_value = (0.5, 0.5, 0.5)
    tree.links.new(start.outputs[0], scatter.inputs["Points"])
    tree.links.new(cube.outputs["Mesh"], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs[0], end.inputs[0])
    item.modifiers.new("Scatter", "NODES").node_group = tree
    found, _, _ = exported()
    assert len(found) == 3 * 12, f"meshes made by nodes: {len(found)}"


def gpaa(color: np.ndarray, depth: np.ndarray, segments: np.ndarray) -> np.ndarray:
    """GPAA [Persson 2011], pixel by pixel."""
    height, width = depth.shape
    out = color.copy()
    for x0, y0, z0, x1, y1, z1 in segments:
        major = 0 if abs(x1 - x0) > abs(y1 - y0) else 1
        a, b = np.array((x0, y0)), np.array((x1, y1))
        if a[major] > b[major]:
            a, b, z0, z1 = b, a, z1, z0
        for k in range(int(np.floor(a[major] - 0.5)), int(np.ceil(b[major] + 0.5))):
            share = (k + 0.5 - a[major]) / (b[major] - a[major])
            reach = 0.5 / (b[major] - a[major])
            if not -reach <= share <= 1 + reach:
                continue
            across = a[1 - major] + share * (b[1 - major] - a[1 - major])
            z = 1 / (1 / z0 + min(1, max(0, share)) * (1 / z1 - 1 / z0))
            j = int(np.floor(across))
            x, y = (k, j) if major == 0 else (j, k)
            s = across - (j + 0.5)
            nx, ny = (
                (x, y + (1 if s >= 0 else -1)) if major == 0 else (x + (1 if s >= 0 else -1), y)
            )
            if not (0 <= x < width and 0 <= y < height and 0 <= nx < width and 0 <= ny < height):
                continue
            if z > min(depth[y, x], depth[ny, nx]) * 1.01:
                continue
            out[y, x] = color[y, x] + (0.5 - abs(s)) * (color[ny, nx] - color[y, x])
    return out


def test_gpaa_comes_closer_to_the_truth() -> None:
    """The list does what it is for; shifted by a pixel it does not."""
    scene = t.new_scene(96, 54)
    t.add_camera(scene)
    t.add_sun(scene)
    random = np.random.default_rng(5)
    for index in range(6):
        place, turn = (index - 2.5, 0, random.uniform(0, 1)), random.uniform(0, 3, 3)
        item = t.add_object(scene, f"Cube {index}", None, place, turn)
        item.data.materials.append(t.diffuse(f"Colour {index}", random.uniform(0.2, 0.9, 3)))
    out = os.path.join(t.temporary_folder(), "shot")
    t.export(
        out, "--frames", "1", "--passes", "segments,depth", "--jitter", "none", "--truth-samples", "64"
    )  # fmt: skip
    path = os.path.join(out, "frames/000001.exr")
    color = t.stacked(t.read_part(path, "color"), "R G B").astype(np.float64)
    depth = t.read_part(path, "depth")["Z"]
    segments = t.stacked(t.read_part(path, "segments"), NAMES).reshape(-1, 6).astype(np.float64)
    segments = segments[segments[:, 2] > 0]
    halves = [
        t.stacked(t.read_part(os.path.join(out, "truth/000001.exr"), h), "R G B") for h in "ab"
    ]
    truth = (halves[0].astype(np.float64) + halves[1]) / 2

    def error(picture: np.ndarray) -> float:
        return float(((picture - truth) ** 2).mean())

    better = error(gpaa(color, depth, segments)) / error(color)
    shifted = segments + np.array((1, 1, 0, 1, 1, 0))
    worse = error(gpaa(color, depth, shifted)) / error(color)
    print(f"     error left: {better:.3f}, shifted by a pixel {worse:.3f}", file=sys.stderr)
    assert better < 0.45 and worse > 0.8, (better, worse)


def test_asked_for_by_its_method() -> None:
    from aa_resolve import registry

    if "gpaa" in registry.load_methods():
        assert "segments" in registry.required_passes(registry.parse_choices(["gpaa"]))
    assert registry.load_passes()["segments"].is_list


if __name__ == "__main__":
    t.main(
        test_cube,
        test_kinds_of_edges,
        test_clipping,
        test_form_and_order,
        test_instances_modifiers_and_what_is_hidden,
        test_gpaa_comes_closer_to_the_truth,
        test_asked_for_by_its_method,
    )
