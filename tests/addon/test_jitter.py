# SPDX-License-Identifier: GPL-3.0-or-later
"""Jitter means what the shot says: a jittered picture equals the matching sub-samples of one 8 times as large."""

from __future__ import annotations

import itertools
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import Vector, bpy, np  # noqa: E402

from aa_resolve import jitter  # noqa: E402
from aa_resolve.errors import SceneError, UsageError  # noqa: E402
from aa_resolve.scene import camera as cam  # noqa: E402
from aa_resolve.scene import rendering, suitability  # noqa: E402

FACTOR = 8
CELLS = ((1, 6), (7, 0), (3, 3))  # column and row of the sub-sample, of 8


def scattered_cubes(width: int, height: int):
    """Turned cubes of many sizes: edges of all slopes everywhere in the picture."""
    scene = t.new_scene(width, height)
    camera = t.add_camera(scene)
    random = np.random.default_rng(7)
    for index in range(40):
        place = (random.uniform(-4, 4), random.uniform(-2, 3), random.uniform(-2.5, 3.5))
        item = t.add_object(
            scene,
            f"Cube {index}",
            None,
            place,
            random.uniform(0, 3, 3),
            random.uniform(0.2, 1.1, 3),
        )
        item.data.materials.append(t.diffuse(f"Colour {index}", random.uniform(0.1, 0.9, 3)))
    return scene, camera


def recorder(scene):
    """Renders id and depth of the current camera at a jitter, the way the exporter does."""
    layer, _ = suitability.refuse_unsuitable(scene, None)
    rendering.prepare(scene, layer)
    rendering.request_passes(layer, {"Depth", "IndexOB"})
    rendering.sample_points(scene, 1)
    for index, item in enumerate(sorted(bpy.data.objects, key=lambda item: item.name), 1):
        item.pass_index = index
    folder = rendering.temporary_folder()

    def record(jittered, x, y, premultiplied=(0.0, 0.0)):
        frame = cam.frame_of(scene)
        jittered.aim(frame, bpy.context.evaluated_depsgraph_get(), x, y, premultiplied)
        scene.camera = jittered.object
        layers = rendering.render(scene, layer, folder)
        return layers.get("IndexOB")[:, :, 0], layers.get("Depth")[:, :, 0]

    return record


def compare(scene, camera, label: str, cells=CELLS) -> None:
    record = recorder(scene)
    jittered = cam.JitterCamera(scene, camera, "Jittered")
    render = scene.render
    width, height = render.resolution_x, render.resolution_y
    render.resolution_x, render.resolution_y = width * FACTOR, height * FACTOR
    large_id, large_depth = record(jittered, 0.0, 0.0)
    render.resolution_x, render.resolution_y = width, height
    assert len(np.unique(large_id)) > 10, f"{label}: the picture shows too little to prove anything"
    for column, row in cells:
        x, y = (column + 0.5) / FACTOR - 0.5, (row + 0.5) / FACTOR - 0.5
        ids, depth = record(jittered, x, y)
        expected = large_id[row::FACTOR, column::FACTOR]
        wrong = int((ids != expected).sum())
        assert wrong == 0, f"{label}, jitter {x, y}: {wrong} ids differ of {ids.size}"
        relative = np.abs(depth / large_depth[row::FACTOR, column::FACTOR] - 1.0).max()
        assert relative < 1e-4, f"{label}, jitter {x, y}: depth differs by {relative}"
        flipped, _ = record(jittered, x, -y)
        assert (flipped != expected).any(), f"{label}: a flipped jitter must be seen"


def test_all_fits_sizes_and_kinds() -> None:
    sizes = ((32, 18, 1.0, 1.0), (18, 32, 1.0, 1.0), (30, 20, 1.0, 1.5), (24, 24, 2.0, 1.0))
    for kind, fit, (width, height, aspect_x, aspect_y) in itertools.product(
        ("PERSP", "ORTHO"), ("AUTO", "HORIZONTAL", "VERTICAL"), sizes
    ):
        scene, camera = scattered_cubes(width, height)
        scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect_x, aspect_y
        camera.data.type, camera.data.sensor_fit, camera.data.ortho_scale = kind, fit, 5.0
        camera.data.sensor_width, camera.data.sensor_height = 36.0, 20.0
        compare(
            scene, camera, f"{kind} {fit} {width}x{height} aspect {aspect_x}:{aspect_y}", CELLS[:1]
        )


def test_existing_shift_and_percentage() -> None:
    scene, camera = scattered_cubes(64, 36)
    scene.render.resolution_percentage = 50
    camera.data.shift_x, camera.data.shift_y = 0.13, -0.21
    compare(scene, camera, "existing shift, 50 %")


def test_keyed_shift_and_lens() -> None:
    scene, camera = scattered_cubes(32, 18)
    t.key(camera.data, "shift_x", {1: 0.0, 11: 0.5})
    t.key(camera.data, "lens", {1: 30.0, 11: 60.0})
    scene.frame_set(5)
    assert abs(camera.data.shift_x - 0.2) < 1e-6
    compare(scene, camera, "keyed shift and lens")


def test_parent_with_scale() -> None:
    scene, camera = scattered_cubes(32, 18)
    parent = bpy.data.objects.new("Parent", None)
    parent.scale = (2.0, 2.0, 2.0)
    scene.collection.objects.link(parent)
    camera.parent = parent
    camera.location = camera.location / 2.0
    bpy.context.view_layer.update()
    compare(scene, camera, "camera under a scaled parent")


def test_border() -> None:
    """A border shows the same samples as the full picture."""
    scene, camera = scattered_cubes(32, 20)
    record = recorder(scene)
    jittered = cam.JitterCamera(scene, camera, "Jittered")
    full, _ = record(jittered, 0.3, -0.2)
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.1, 0.6
    frame = cam.frame_of(scene)
    part, _ = record(jittered, 0.3, -0.2)
    assert part.shape == (frame.height, frame.width) == (10, 16), part.shape
    window = full[frame.top : frame.top + frame.height, frame.left : frame.left + frame.width]
    assert np.array_equal(part, window)


def test_premultiplied() -> None:
    """The camera moves parallel to its picture: every point by jitter x focal length / depth, whatever holds it."""
    for parent_scale in (None, (2.0, 0.5, 3.0)):
        scene, camera = scattered_cubes(64, 36)
        camera.data.shift_x = 0.1
        if parent_scale:
            parent = bpy.data.objects.new("Parent", None)
            parent.scale = parent_scale
            scene.collection.objects.link(parent)
            camera.parent = parent
            camera.rotation_euler = (math.pi / 2, 0.0, 0.0)  # along the axes: scaled, not sheared
            camera.location = (0.0, -4.0 / parent_scale[1] * 2, 0.5 / parent_scale[2])
        bpy.context.view_layer.update()
        record = recorder(scene)
        jittered = cam.JitterCamera(scene, camera, "Jittered")
        x, y = 0.4, -0.3
        _, at_rest = record(jittered, 0.0, 0.0)
        _, moved = record(jittered, 0.0, 0.0, premultiplied=(x, y))
        bpy.context.view_layer.update()
        projection = t.Projection(camera, 64, 36)
        # (2 jx / W, -2 jy / H) scene units to the camera's right and up.
        movement = projection.to_view[:3, :3].T @ np.array((2.0 * x / 64.0, -2.0 * y / 36.0, 0.0))
        found = jittered.object.matrix_world.translation - camera.matrix_world.translation
        assert np.allclose(found, movement, atol=1e-6), (found, movement)
        # What a pixel shows lies at jitter x P / depth from its centre in the picture at rest; P is the focal length in
        # units of half the picture.
        seen = moved < 1e9
        assert seen.sum() > 500
        row, column = np.nonzero(seen)
        depth = moved[seen].astype(np.float64)
        offset_x, offset_y = (
            x * projection.focal / 32.0 / depth,
            y * projection.focal / 18.0 / depth,
        )
        there = projection.unproject(column + 0.5 + offset_x, row + 0.5 + offset_y, depth)
        here = projection.unproject(column + 0.5, row + 0.5, depth) + movement
        assert np.allclose(there, here, atol=1e-5)
        # The same picture as that of a camera that was moved there by hand; not that of the jitter.
        _, jittered_depth = record(jittered, x, y)
        world = camera.matrix_world.copy()
        world.translation += Vector(movement)
        camera.matrix_world = world
        bpy.context.view_layer.update()
        _, by_hand = record(jittered, 0.0, 0.0)
        assert np.mean(np.abs(by_hand / moved - 1.0) < 1e-5) > 0.999
        assert np.mean(moved != at_rest) > 0.3 and np.mean(moved != jittered_depth) > 0.3


def test_premultiplied_export() -> None:
    """The shot says so, keeps the wanted jitter, and its truth is that of the camera at rest."""
    shots, folders = {}, {}
    for name in ("post", "pre"):
        scattered_cubes(48, 27)
        folders[name] = t.temporary_folder()
        shots[name] = t.export(
            folders[name],
            *("--frames", "1-2", "--for", "taaSimplest", "--passes", "depth"),
            *("--jitter", "t2msaa", "--period", "2", "--truth-samples", "4"),
            *("--jitter-projection", name),
        )
    assert shots["pre"]["jitter"]["projection"] == "premultiplied"
    assert "projection" not in shots["post"]["jitter"]
    for one, other in zip(shots["pre"]["frames"], shots["post"]["frames"]):
        assert one["jitter"] == other["jitter"] and abs(one["jitter"][0]) == 0.25
        assert one["camera"] == other["camera"]
        file, truth = one["file"], one["truth"]
        depth = [t.read_part(f"{folders[name]}/{file}", "depth")["Z"] for name in shots]
        assert (depth[0] != depth[1]).any()
        truths = [t.read_part(f"{folders[name]}/{truth}", "a") for name in shots]
        for channel in truths[0]:
            assert np.array_equal(truths[0][channel], truths[1][channel])
    scene, camera = scattered_cubes(48, 27)
    for options, says in (
        (("--jitter", "none"), "no effect"),
        (("--passes", "edges"), "leave out the pass 'edges'"),
    ):
        expect_error(
            UsageError, says, "--for", "taaSimplest", "--jitter-projection", "pre", *options
        )
    camera.data.type = "ORTHO"
    expect_error(
        SceneError, "not a perspective one", "--for", "taaSimplest", "--jitter-projection", "pre"
    )


def expect_error(kind: type[Exception], says: str, *options: str) -> None:
    try:
        t.export(t.temporary_folder(), "--frames", "1-2", *options)
    except kind as error:
        assert says in str(error), error
    else:
        raise AssertionError(f"{options}: expected {kind.__name__}")


def test_sequences() -> None:
    expected = [(0, -1 / 6), (-1 / 4, 1 / 6), (1 / 4, -7 / 18), (-3 / 8, -1 / 18)]
    expected += [(1 / 8, 5 / 18), (-1 / 8, -5 / 18), (3 / 8, 1 / 18), (-7 / 16, 7 / 18)]
    for index, pair in enumerate(expected):
        assert np.allclose(jitter.jitter_at("halton23", index, 16), pair, atol=1e-12), index
    rr2 = [(0, 0), (1 / 2, 2 / 3), (1 / 4, 1 / 3), (3 / 4, 2 / 9), (1 / 8, 8 / 9), (5 / 8, 5 / 9)]
    for index, (u, v) in enumerate(rr2):
        assert np.allclose(
            jitter.jitter_at("thesis", index, 16), (u - 0.5, v - 0.5), atol=1e-12
        ), index
    # conventions 6, y down: published lists with y up are turned over.
    lists = {
        "none": [(0, 0)],
        "halton23zero": [(-1 / 2, -1 / 2), (0, -1 / 6), (-1 / 4, 1 / 6)],
        "hammersley": [(-1 / 2, -1 / 2), (1 / 16 - 1 / 2, 0), (2 / 16 - 1 / 2, -1 / 4)],
        "quadrant": [(-0.25, -0.25), (-0.25, 0.25), (0.25, -0.25), (0.25, 0.25), (-0.25, -0.25)],
        "insideUniform4": [(-0.25, 0.25), (0.25, -0.25), (0.25, 0.25), (-0.25, -0.25)],
        "insideRotated4": [(-0.125, 0.375), (0.375, 0.125), (0.125, -0.375), (-0.375, -0.125)],
        "msaa8": [
            (x / 16, y / 16)
            for x, y in ((1, -3), (-1, 3), (5, 1), (-3, -5), (-5, 5), (-7, -1), (3, 7), (7, -7))
        ],
        "smaaT2x": [(0.25, 0.25), (-0.25, -0.25), (0.25, 0.25)],
        "smaa4x": [(0.125, -0.125), (-0.125, 0.125), (0.125, -0.125)],
        "t2msaa": [(0.25, -0.25), (-0.25, 0.25), (0.25, -0.25)],
        "t2msaa1875": [(0.1875, -0.1875), (-0.1875, 0.1875), (0.1875, -0.1875)],
        "t2msaa125": [(0.125, -0.125), (-0.125, 0.125), (0.125, -0.125)],
        "r2": [
            ((0.5 + n * a) % 1 - 0.5, (0.5 + n * b) % 1 - 0.5)
            for a, b in ((0.7548776662466927, 0.5698402909980532),)
            for n in range(16)
        ],
        "ign": [
            tuple(
                (
                    52.9829189
                    * ((0.06711056 * (1 + 5.588238 * n) + 0.00583715 * (y + 5.588238 * n)) % 1)
                )
                % 1
                - 0.5
                for y in (1, 2)
            )
            for n in range(16)
        ],
    }
    for name, points in lists.items():
        for index, pair in enumerate(points):
            assert np.allclose(jitter.jitter_at(name, index, 16), pair, atol=1e-12), (name, index)
    normal = np.array([jitter.jitter_at("gaussian", index, 4096) for index in range(4096)])
    assert (np.abs(normal.mean(axis=0)) < 0.015).all() and np.allclose(
        normal.std(0), 0.25, atol=0.01
    )
    for index in range(
        64
    ):  # quarter points in turn plus the same normal numbers, kept within the pixel
        place = np.array(lists["quadrant"][index % 4]) + jitter.jitter_at("gaussian", index, 64)
        both = jitter.jitter_at("quadrantGaussian", index, 64)
        assert np.allclose(both, np.clip(place, -0.5, 0.5), atol=1e-12), index
    # [Stejmar n.d.] multiplies by sigma squared where sigma is meant: the same numbers, smaller by
    # 0.2575.
    shrunk = [
        np.array(jitter.jitter_at("quadrantGaussianVariance", index, 4096))
        - lists["quadrant"][index % 4]
        for index in range(4096)
    ]
    assert np.allclose(np.std(shrunk, axis=0), 0.0663, atol=2e-3)
    inside = (np.abs(normal) < 0.5).all(axis=1)
    assert np.allclose(np.array(shrunk)[inside], 0.2575 * normal[inside], atol=1e-12)
    named = {"halton23", "thesis", "gaussian", "quadrantGaussian", "quadrantGaussianVariance"}
    assert {*lists, *named} == set(jitter.SEQUENCES)
    mean = np.mean([jitter.jitter_at("halton23", index, 16) for index in range(16)], axis=0)
    assert np.allclose(mean, (-0.0293, -0.0370), atol=5e-5), mean
    for name in jitter.SEQUENCES:
        for index in range(40):
            x, y = jitter.jitter_at(name, index, 16)
            assert -0.5 <= x <= 0.5 and -0.5 <= y <= 0.5, (name, index, x, y)
            assert (x, y) == jitter.jitter_at(name, index + 16, 16), (name, index)
        centred = np.mean([jitter.jitter_at(name, index, 16, True) for index in range(16)], axis=0)
        assert np.allclose(centred, 0.0, atol=1e-12), (name, centred)
    for name, count in (("d3d2", 2), ("d3d4", 4), ("d3d8", 8), ("d3d16", 16), ("grid3", 9)):
        positions = jitter.pattern_positions(name)
        assert len(set(positions)) == count
        assert name == "d3d16" or np.allclose(np.mean(positions, axis=0), 0.0), name


def following_cube():
    """A cube under a sun that rises and falls with what is made to move it, and a camera that does."""
    scene = t.new_scene(48, 32)
    camera = t.add_camera(scene)
    t.add_sun(scene)
    t.key(camera, "location", {1: (-1.0, -8.0, 1.0), 5: (1.0, -8.0, 1.6)})
    item = t.add_object(scene, "Cube")
    item.data.materials.append(t.diffuse("Colour", (0.5, 0.5, 0.5)))
    return scene, camera, item


def variable_on(item, axis: int) -> bpy.types.DriverVariable:
    driver = item.driver_add("location", axis).driver
    driver.expression = "place"
    variable = driver.variables.new()
    variable.name = "place"
    return variable


def by_driver(active: bool) -> None:
    scene, camera, item = following_cube()
    target = variable_on(item, 0).targets[0]
    target.id_type = "SCENE" if active else "OBJECT"
    target.id = scene if active else camera
    target.data_path = "camera.location[0]" if active else "location[0]"
    camera["height"] = 1.0
    target = variable_on(item, 2).targets[0]
    target.id_type = "SCENE" if active else "OBJECT"
    target.id = scene if active else camera
    target.data_path = 'camera["height"]' if active else '["height"]'


def by_driver_of_the_context(active: bool) -> None:
    by_driver(False)
    if active and bpy.app.version >= (4, 0, 0):
        item = bpy.data.objects["Cube"]
        item.driver_remove("location", 0)
        variable = variable_on(item, 0)
        variable.type = "CONTEXT_PROP"
        variable.targets[0].context_property = "ACTIVE_SCENE"
        variable.targets[0].data_path = "camera.location[0]"


def by_tracking(active: bool) -> None:
    _, camera, item = following_cube()
    path = os.path.join(t.temporary_folder(), "clip.png")
    image = bpy.data.images.new("Clip", 48, 32)
    image.filepath_raw, image.file_format = path, "PNG"
    image.save()
    clip = bpy.data.movieclips.load(path)
    clip.tracking.tracks.new(name="Track", frame=1).markers.insert_frame(1, co=(0.6, 0.5))
    constraint = item.constraints.new("FOLLOW_TRACK")
    constraint.use_active_clip = constraint.use_3d_position = False
    constraint.clip, constraint.track = clip, "Track"
    constraint.camera = None if active else camera


def by_nodes(active: bool) -> None:
    _, camera, item = following_cube()
    tree = t.geometry_group("Follow")
    move, info = tree.nodes.new("GeometryNodeTransform"), tree.nodes.new("GeometryNodeObjectInfo")
    known = hasattr(bpy.types, "GeometryNodeInputActiveCamera")  # since 4.1
    if active and known:
        node = tree.nodes.new("GeometryNodeInputActiveCamera")
        tree.links.new(node.outputs[0], info.inputs["Object"])
    else:
        info.inputs["Object"].default_value = camera
    lift = tree.nodes.new("ShaderNodeVectorMath")
    lift.inputs[1].default_value = (0.0, 8.0, 0.0)
    tree.links.new(info.outputs["Location"], lift.inputs[0])
    tree.links.new(lift.outputs[0], move.inputs["Translation"])
    tree.links.new(tree.nodes["Start"].outputs[0], move.inputs["Geometry"])
    tree.links.new(move.outputs[0], tree.nodes["End"].inputs[0])
    item.modifiers.new("Follow", "NODES").node_group = tree


def test_what_reads_the_active_camera() -> None:
    """It finds the scene's own, as what names that one does: neither its place nor its shift is the jittered one's."""

    def found(build, active: bool) -> list[np.ndarray]:
        build(active)
        out = os.path.join(t.temporary_folder(), "shot")
        options = ("--passes", "depth,motion", "--truth-frames", "none")
        shot = t.export(out, "--frames", "2-4", *options)
        assert not shot["static"], build.__name__
        return [
            plane
            for entry in shot["frames"]
            for part in ("depth", "motion")
            for plane in t.read_part(os.path.join(out, entry["file"]), part).values()
        ]

    for build in (by_driver, by_driver_of_the_context, by_tracking, by_nodes):
        for one, other in zip(found(build, True), found(build, False)):
            assert np.allclose(one, other, atol=1e-5), build.__name__


def test_the_active_camera_of_a_cut() -> None:
    """What reads it follows the markers; what reads it by Python is named."""
    scene, first, item = following_cube()
    second = t.add_camera(scene, (2.0, -7.0, 1.0))
    for frame, camera in ((1, first), (3, second)):
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    target = variable_on(item, 0).targets[0]
    target.id_type, target.id, target.data_path = "SCENE", scene, "camera.location[0]"
    item.driver_add("location", 2).driver.expression = "0.5 if bpy.context.scene.camera else 0.0"
    out = os.path.join(t.temporary_folder(), "shot")
    shot = t.export(out, "--frames", "2-3", "--passes", "depth", "--truth-frames", "none")
    assert any("Cube.location" in n and "active camera" in n for n in shot["notes"]), shot["notes"]
    assert abs(item.matrix_world.translation.x - 2.0) < 1e-5, item.matrix_world


if __name__ == "__main__":
    t.main(
        test_sequences,
        test_premultiplied,
        test_premultiplied_export,
        test_border,
        test_parent_with_scale,
        test_existing_shift_and_percentage,
        test_keyed_shift_and_lens,
        test_all_fits_sizes_and_kinds,
        test_what_reads_the_active_camera,
        test_the_active_camera_of_a_cut,
    )
