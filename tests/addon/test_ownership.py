# SPDX-License-Identifier: GPL-3.0-or-later
"""What the exporter sets stays set: curves, drivers and NLA strips on it lose, are named, and nothing else is lost."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve.scene import ownership, render_levels  # noqa: E402

FRAMES = ("--frames", "1-2", "--truth-samples", "8", "--for", "taaSimplest", "--passes", "object")


def make_scene():
    scene = t.new_scene(32, 18)
    camera = t.add_camera(scene)
    sun = t.add_sun(scene)
    item = t.add_object(scene, "Cube", None, (0, 0, 0.5), (0.3, 0.2, 0.5))
    item.data.materials.append(t.diffuse("Colour", (0.3, 0.5, 0.7)))
    t.key(item, "location", {1: (-0.2, 0, 0.5), 3: (0.2, 0, 0.5)})
    return scene, camera, sun, item


def key_path(block, path: str, values: dict[int, object]) -> None:
    """Keyframes of a property by its path from the data-block."""
    holder, _, name = path.rpartition(".")
    owner = block.path_resolve(holder) if holder else block
    for frame, value in values.items():
        setattr(owner, name, value)
        block.keyframe_insert(path, frame=frame)


def drive(block, path: str, expression: str) -> None:
    block.driver_add(path).driver.expression = expression


def to_strip(block) -> None:
    """Moves the block's action to a strip of the NLA."""
    animation = block.animation_data
    slot = getattr(animation, "action_slot", None)
    strip = animation.nla_tracks.new().strips.new("Strip", 1, animation.action)
    if slot is not None:
        strip.action_slot = slot
    animation.action = None


def pictures(prepare) -> tuple[dict[str, np.ndarray], list[str]]:
    """Colour of both frames and both halves of the first truth, and the notes, of the scene that ``prepare`` spoils."""
    scene, camera, sun, item = make_scene()
    prepare(scene, camera, sun, item)
    out = t.temporary_folder()
    shot = t.export(os.path.join(out, "s"), *FRAMES)
    seen = {}
    for number, entry in enumerate(shot["frames"], 1):
        path = os.path.join(out, "s", entry["file"])
        seen[f"color {number}"] = t.stacked(t.read_part(path, "color"), "R G B")
        seen[f"id {number}"] = t.stacked(t.read_part(path, "object"), "id")
        truth = os.path.join(out, "s", entry["truth"])
        for half in ("a", "b"):
            seen[f"truth {half} {number}"] = t.stacked(t.read_part(truth, half), "R G B")
    return seen, shot["notes"]


PLAIN, PLAIN_NOTES = pictures(lambda *_: None)


def expect_plain(prepare, *named: str) -> None:
    """The spoiled scene gives the plain one's pictures, and a note names each path."""
    seen, notes = pictures(prepare)
    for name, expected in PLAIN.items():
        assert np.abs(seen[name].astype(float) - expected.astype(float)).max() < 1e-4, name
    for path in named:
        assert any(f"the animation of '{path}'" in note for note in notes), (path, notes)


def test_plain_scene_has_two_halves_and_no_note() -> None:
    assert not any("the animation of" in note for note in PLAIN_NOTES), PLAIN_NOTES
    assert not np.array_equal(PLAIN["truth a 1"], PLAIN["truth b 1"]), "halves are independent"


def test_no_half_of_the_truth_has_the_centre_sample() -> None:
    """Cycles puts sample 0 at the exact centre whatever the seed: with one sample both halves would be one picture."""
    make_scene()
    out = os.path.join(t.temporary_folder(), "s")
    shot = t.export(out, "--frames", "1", "--truth-samples", "1", "--jitter", "none")
    a, b = (
        t.stacked(t.read_part(os.path.join(out, shot["frames"][0]["truth"]), half), "R G B")
        for half in "ab"
    )
    assert (np.abs(a - b).max(axis=-1) > 0.01).sum() > 2, "no edge pixel differs"


def test_keyed_settings_of_the_render() -> None:
    def spoil(scene, *_):
        key_path(scene, "cycles.seed", {1: 5, 2: 5})
        key_path(scene, "cycles.samples", {1: 1, 2: 1})
        key_path(scene, "cycles.filter_width", {1: 4.0, 2: 5.0})
        key_path(scene, "cycles.sample_offset", {1: 0, 2: 0})
        key_path(scene, "cycles.max_bounces", {1: 4, 2: 4})
        key_path(scene, 'view_layers["ViewLayer"].samples', {1: 3, 2: 3})

    expect_plain(
        spoil, "cycles.seed", "cycles.samples", "cycles.filter_width", "cycles.sample_offset",
        "cycles.max_bounces", 'view_layers["ViewLayer"].samples',
    )  # fmt: skip


def test_strips_and_drivers() -> None:
    def spoil(scene, camera, sun, item):
        key_path(scene, "cycles.seed", {1: 5, 2: 5})
        to_strip(scene)
        drive(scene, "cycles.samples", "frame")
        drive(item, "pass_index", "frame + 7")
        drive(sun.data, "angle", "0.5")
        drive(camera.data, "dof.use_dof", "1")
        camera.data.dof.focus_distance = 1.0
        camera.data.dof.aperture_fstop = 0.1

    expect_plain(spoil, "cycles.seed", "cycles.samples", "pass_index", "angle", "dof.use_dof")


def test_members_by_number() -> None:
    """A curve may name the view layer by its number instead of its name."""

    def spoil(scene, *_):
        key_path(scene, "view_layers[0].samples", {1: 3, 2: 3})

    expect_plain(spoil, 'view_layers["ViewLayer"].samples')


def test_shared_actions_lose_one_user_only() -> None:
    scene, _, sun, _ = make_scene()
    other = t.add_sun(scene)
    for block in (sun.data,):
        key_path(block, "angle", {1: 0.1, 11: 0.3})
        key_path(block, "energy", {1: 1.0, 11: 3.0})
    other.data.animation_data_create()
    other.data.animation_data.action = sun.data.animation_data.action
    if hasattr(other.data.animation_data, "action_slot"):
        other.data.animation_data.action_slot = sun.data.animation_data.action_slot
    ownership.own(sun.data, angle=0.0)
    scene.frame_set(11)
    assert sun.data.angle == 0.0 and abs(other.data.angle - 0.3) < 1e-6
    assert abs(sun.data.energy - 3.0) < 1e-6 and abs(other.data.energy - 3.0) < 1e-6
    ownership.notes()


def test_linked_and_overridden_blocks() -> None:
    """Levels, an index and a size that a library says, and animates, are the exporter's as well."""
    scene = t.new_scene(32, 18)
    ball = t.add_object(scene, "Ball")
    levels = ball.modifiers.new("Levels", "SUBSURF")
    levels.levels, levels.render_levels = 0, 3
    key_path(ball, "pass_index", {1: 1, 10: 9})
    key_path(t.add_sun(scene).data, "angle", {1: 0.1, 10: 0.3})
    library = t.save(scene, os.path.join(t.temporary_folder(), "library.blend"))
    for overridden in (False, True):
        scene = t.new_scene(32, 18)
        with bpy.data.libraries.load(library, link=True) as (_, wanted):
            wanted.objects = ["Ball", "Sun"]
        for item in wanted.objects:
            scene.collection.objects.link(item)
        bpy.context.view_layer.update()
        if overridden:
            for item in wanted.objects:
                item.override_create(remap_local_usages=True)
            scene.objects["Sun"].data.override_create(remap_local_usages=True)
        ball, sun = scene.objects["Ball"], scene.objects["Sun"]
        assert (ball.library is None) == overridden
        ownership.begin()
        render_levels.show_what_renders(scene, scene.view_layers[0])
        ownership.own(ball, pass_index=7)
        ownership.own(sun.data, angle=0.0)
        scene.frame_set(5)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        count = len(ball.evaluated_get(depsgraph).to_mesh().vertices)
        assert (count, ball.pass_index, sun.data.angle) == (386, 7, 0.0), count
        assert len(ownership.notes()) == 2


def test_area_light_keeps_its_animated_power() -> None:
    scene, _, sun, item = make_scene()
    item.animation_data_clear()
    bpy.data.objects.remove(sun)
    light = bpy.data.lights.new("Area", "AREA")
    area = bpy.data.objects.new("Area", light)
    area.location = (0, -4, 4)
    area.rotation_euler = (0.8, 0, 0)
    scene.collection.objects.link(area)
    key_path(light, "energy", {1: 100.0, 2: 300.0})
    out = os.path.join(t.temporary_folder(), "s")
    shot = t.export(out, "--frames", "1-2", "--truth-frames", "none", "--jitter", "none")
    means = [
        float(t.stacked(t.read_part(os.path.join(out, entry["file"]), "color"), "R G B").max())
        for entry in shot["frames"]
    ]
    assert abs(means[1] / means[0] - 3.0) < 0.1, means


def test_transparent_film_with_several_lights() -> None:
    """The background is taken off once per further light only where the picture holds it."""
    scene, _, _, _ = make_scene()
    t.add_sun(scene, 1.0, (0.2, 0.9, 0.0))
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.2, 0.3, 0.4, 1.0)
    scene.render.film_transparent = True
    out = os.path.join(t.temporary_folder(), "s")
    shot = t.export(out, "--frames", "1", "--truth-frames", "none")
    color = t.stacked(t.read_part(os.path.join(out, shot["frames"][0]["file"]), "color"), "R G B A")
    assert np.abs(color[0, 0]).max() == 0.0, color[0, 0]


def test_a_level_follows_an_animated_one() -> None:
    scene, _, _, item = make_scene()
    levels = item.modifiers.new("Levels", "SUBSURF")
    levels.levels = 0
    key_path(item, 'modifiers["Levels"].render_levels', {1: 1, 11: 3})
    ownership.follow(levels, "levels", "render_levels")
    counts = []
    for number in (1, 11):
        scene.frame_set(number)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        counts.append(len(item.evaluated_get(depsgraph).to_mesh().vertices))
    assert counts == [26, 386], counts


if __name__ == "__main__":
    t.main(
        test_plain_scene_has_two_halves_and_no_note,
        test_no_half_of_the_truth_has_the_centre_sample,
        test_keyed_settings_of_the_render,
        test_strips_and_drivers,
        test_members_by_number,
        test_shared_actions_lose_one_user_only,
        test_linked_and_overridden_blocks,
        test_area_light_keeps_its_animated_power,
        test_transparent_film_with_several_lights,
        test_a_level_follows_an_animated_one,
    )
