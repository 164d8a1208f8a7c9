# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of what a scene may contain knows every type, modifier and setting of this Blender, and does what it says."""

from __future__ import annotations

import importlib
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve.errors import SceneError  # noqa: E402
from aa_resolve.scene import features, ownership, rendering  # noqa: E402

ONE = ("--frames", "1", "--truth-frames", "none")


def identifiers(kind: str, name: str) -> list[str]:
    """Blender's own list of an enumeration."""
    return [item.identifier for item in getattr(bpy.types, kind).bl_rna.properties[name].enum_items]


def keyable(struct, prefix: str) -> list[str]:
    """Settings that can be animated."""
    return [
        f"{prefix}.{item.identifier}"
        for item in struct.bl_rna.properties
        if item.is_animatable and not item.is_readonly and item.identifier not in ("tag",)
    ]


def expect_known(kind: str, names: list[str]) -> None:
    unknown = [name for name in names if features.feature_of(kind, name) is None]
    assert names and not unknown, f"{kind}: the table does not know {' '.join(unknown)}"


def test_every_type_is_known() -> None:
    expect_known("object", identifiers("Object", "type"))
    expect_known("modifier", identifiers("Modifier", "type"))
    if hasattr(bpy.types, "GpencilModifier"):
        grease = [n for n in identifiers("GpencilModifier", "type") if n != "SHRINKWRAP"]
        expect_known("modifier", grease)
    expect_known("physics", identifiers("ParticleSettings", "physics_type"))
    expect_known("light", identifiers("Light", "type"))
    expect_known("camera", identifiers("Camera", "type"))


def settings_of(scene) -> list[str]:
    layer = scene.view_layers[0]
    return (
        keyable(scene.render, "render")
        + keyable(scene.cycles, "cycles")
        + [name for name in keyable(layer, "layer")]
        + keyable(layer.cycles, "layer.cycles")
    )


def test_every_setting_that_can_be_keyed_is_known() -> None:
    expect_known("setting", settings_of(t.new_scene()))


def test_no_row_covers_another_and_all_functions_exist() -> None:
    for row in features.FEATURES:
        assert row.treatment in (
            features.SHOWN, features.HANDLED, features.NOTED, features.REFUSED, features.NOTHING,
        ), row  # fmt: skip
        if row.treatment in (features.HANDLED, features.NOTED, features.REFUSED):
            file, _, function = row.by.partition(":")
            module = importlib.import_module(f"aa_resolve.scene.{file}")
            assert callable(getattr(module, function)), row.by
    said = [
        name for row in features.FEATURES if row.kind != "file" for name in
        (f"{row.kind} {name}" for name in row.names.split())
    ]  # fmt: skip
    assert len(said) == len(set(said)), sorted({name for name in said if said.count(name) > 1})


def test_the_page_is_fresh() -> None:
    with open(os.path.join(t.ROOT, "docs", "scenes.md"), encoding="utf-8") as file:
        assert (
            file.read() == features.page()
        ), "write it anew: python3 blender_addon/write_scenes_page.py"


def path_of(name: str) -> str:
    """Data path, from the scene, of a setting of the table."""
    return (
        name.replace("layer.", 'view_layers["ViewLayer"].', 1)
        if name.startswith("layer.")
        else name
    )


def test_what_the_table_calls_owned_loses_its_curves_and_nothing_else() -> None:
    """Keys all that can be keyed, prepares an export, and looks which curves are left."""
    scene = t.new_scene(16, 9)
    t.add_camera(scene)
    t.add_sun(scene)
    t.add_object(scene, "Cube")
    keyed = []
    for name in settings_of(scene):
        if name == "render.use_multiview":  # refused where it is on
            continue
        try:
            scene.keyframe_insert(path_of(name), frame=1)
        except (
            TypeError,
            RuntimeError,
        ):  # a setting without a path, such as those of a layer's Cycles
            continue
        keyed.append(name)
    made = {curve.data_path for curve in t.curves_of(scene)}  # 4.3 makes none of a layer's Cycles
    keyed = [name for name in keyed if path_of(name) in made]
    assert len(keyed) > 100, len(keyed)
    shot = t.export(os.path.join(t.temporary_folder(), "s"), *ONE)
    left = {curve.data_path for curve in t.curves_of(scene)}
    for name in keyed:
        owned = features.feature_of("setting", name).by in (
            "ownership:own",
            "render_levels:show_what_renders",
        )
        gone = path_of(name) not in left
        assert (
            gone == owned
        ), f"{name}: the table says {'owned' if owned else 'kept'}, the curve is {'gone' if gone else 'there'}"
    told = " ".join(shot["notes"])
    for name in ("cycles.seed", "cycles.samples", "cycles.max_bounces"):
        assert f"the animation of '{name}'" in told, told


def attempt(change, *options: str) -> tuple[str, dict]:
    """Notes (or the refusal) of the export of a small scene, and its parts of the first frame."""
    scene = t.new_scene(32, 18)
    camera = t.add_camera(scene)
    t.add_sun(scene)
    cube = t.add_object(scene, "Cube", None, (0, 0, 0.5))
    cube.data.materials.append(t.diffuse("Colour", (0.3, 0.5, 0.7)))
    floor = t.add_object(scene, "Floor", None, (0, 0, -0.1), scale=(8, 8, 0.2))
    floor.data.materials.append(t.diffuse("Ground", (0.4, 0.4, 0.4)))
    change(scene, camera, cube, floor)
    out = os.path.join(t.temporary_folder(), "s")
    try:
        shot = t.export(out, *ONE, "--passes", "albedo,normal,object,depth", *options)
    except SceneError as error:
        return f"refused: {error}", {}
    path = os.path.join(out, shot["frames"][0]["file"])
    parts = {name: t.read_part(path, name) for name in ("color", "albedo", "normal", "object")}
    return " ".join(shot["notes"]), {**parts, "names": shot["objects"]}


def test_an_animated_exposure_is_not_static() -> None:
    """Nothing moves and no colour of a material changes, but the pictures differ; a keyed seed alone changes nothing."""
    for path, static in (("cycles.film_exposure", False), ("cycles.seed", True)):
        scene = t.new_scene(16, 9)
        t.add_camera(scene)
        t.add_sun(scene)
        t.add_object(scene, "Cube")
        for number in (1, 2):
            setattr(scene.cycles, path[7:], number)
            scene.keyframe_insert(path, frame=number)
        shot = t.export(
            os.path.join(t.temporary_folder(), "s"), "--frames", "1-2", "--truth-frames", "none"
        )
        assert shot["static"] == static, (path, shot["notes"])


def test_shadow_catchers() -> None:
    told, parts = attempt(lambda _s, _c, _cube, floor: setattr(floor, "is_shadow_catcher", True))
    _, plain = attempt(lambda *_: None)
    assert "'Floor' catches shadows only" in told, told
    normals = np.stack([*parts["normal"].values()], axis=-1).astype(float)
    assert np.linalg.norm(normals, axis=-1).max() < 1.01
    for name in ("albedo", "color"):
        for channel, plane in parts[name].items():
            assert np.allclose(plane, plain[name][channel], atol=1e-4), (name, channel)


def test_grease_pencil() -> None:
    def draw(scene, *_):
        blocks = getattr(bpy.data, "grease_pencils_v3", None) or bpy.data.grease_pencils
        data = blocks.new("Sketch")
        sketch = t.add_object(scene, "Sketch", data)
        assert sketch.type in ("GPENCIL", "GREASEPENCIL"), sketch.type

    def draw_later(scene, *_):
        draw(scene)
        sketch = scene.objects["Sketch"]
        t.key(sketch, "hide_render", {1: False, 2: True})
        scene.frame_set(2)  # as the file was saved
        assert sketch.hide_render

    _, plain = attempt(lambda *_: None)
    for change in (draw, draw_later):
        told, parts = attempt(change)
        assert "Grease Pencil 'Sketch' is left out" in told, told
        assert np.allclose(
            t.stacked(parts["color"], "R G B"), t.stacked(plain["color"], "R G B"), atol=1e-4
        )


def test_a_portal_does_not_shine() -> None:
    def add(scene, *_):
        light = bpy.data.lights.new("Portal", "AREA")
        light.energy = 1000.0
        light.cycles.is_portal = True
        portal = t.add_object(scene, "Portal", light, (0, -2, 3))
        assert portal.type == "LIGHT"

    told, parts = attempt(add)
    _, plain = attempt(lambda *_: None)
    assert np.allclose(
        t.stacked(parts["color"], "R G B"), t.stacked(plain["color"], "R G B"), atol=1e-4
    )
    assert "Portal" not in told, told


def test_a_hidden_camera_at_a_marker() -> None:
    def add(scene, *_):
        blind = t.add_camera(scene, (0, 8, 1), (0, 20, 0))
        blind.hide_render = True
        marker = scene.timeline_markers.new("Cut", frame=1)
        marker.camera = blind
        scene.camera = bpy.data.objects["Camera"]

    _, parts = attempt(add)
    assert "Cube" in parts["names"].values(), parts["names"]


def test_holdouts_and_volumes() -> None:
    told, _ = attempt(lambda _s, _c, cube, _f: setattr(cube, "is_holdout", True))
    assert "holdouts ('Cube')" in told, told
    told, _ = attempt(lambda _s, _c, cube, _f: t.key(cube, "is_holdout", {3: True, 1: False}))
    assert "holdouts ('Cube')" in told, told

    def fog(_scene, _camera, cube, _floor):
        tree = cube.data.materials[0].node_tree
        tree.links.new(
            tree.nodes.new("ShaderNodeVolumeScatter").outputs[0],
            next(n for n in tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial").inputs[
                "Volume"
            ],
        )

    told, _ = attempt(fog)
    assert "volume of material Colour" in told, told


def test_a_long_name_of_a_view_layer() -> None:
    told, parts = attempt(lambda scene, *_: setattr(scene.view_layers[0], "name", "é" * 31))
    assert not told.startswith("refused") and "Cube" in parts["names"].values(), told


def test_scripts_do_not_win() -> None:
    def spoil(scene, *_) -> None:
        scene.cycles.seed = 77
        scene.cycles.samples = 5
        scene.cycles.filter_width = 9.0

    spoil.__module__ = "artist"
    try:
        told, _ = attempt(
            lambda *_: bpy.app.handlers.frame_change_post.append(spoil), "--for", "rsaa"
        )
        scene = bpy.context.scene
        rendering.sample_pixel_area(scene, 8, 2)
        scene.frame_set(5)
        assert scene.cycles.seed == 2 and scene.cycles.samples in (8, 16), scene.cycles.seed
    finally:
        bpy.app.handlers.frame_change_post.remove(spoil)
        ownership.begin()
    assert "scripts run when the frame changes (spoil)" in told, told
    assert ownership.set_again not in bpy.app.handlers.frame_change_post


def test_blocked_drivers_are_named() -> None:
    scene = t.new_scene(16, 9)
    t.add_camera(scene)
    t.add_sun(scene)
    cube = t.add_object(scene, "Cube")
    cube.driver_add("location", 0).driver.expression = "[frame * 0.1 for _ in range(1)][0]"
    cube.driver_add("location", 1).driver.expression = "frame * 0.01"  # needs no Python
    blend = t.save(scene, os.path.join(t.temporary_folder(), "driven.blend"))
    done = t.run_headless(blend, "--out", os.path.join(t.temporary_folder(), "s"), *ONE)
    assert done.returncode == 0, done.stderr
    assert "the Python of 1 driver (" in done.stdout and "Cube.location" in done.stdout, done.stdout


if __name__ == "__main__":
    t.main(
        test_every_type_is_known,
        test_every_setting_that_can_be_keyed_is_known,
        test_no_row_covers_another_and_all_functions_exist,
        test_the_page_is_fresh,
        test_what_the_table_calls_owned_loses_its_curves_and_nothing_else,
        test_an_animated_exposure_is_not_static,
        test_shadow_catchers,
        test_grease_pencil,
        test_a_portal_does_not_shine,
        test_a_hidden_camera_at_a_marker,
        test_holdouts_and_volumes,
        test_a_long_name_of_a_view_layer,
        test_scripts_do_not_win,
        test_blocked_drivers_are_named,
    )
