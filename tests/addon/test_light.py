# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise-free light: the same picture whatever the seed, and the same light in colour and truth."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve.scene import rendering  # noqa: E402


def add_light(scene, kind: str, location, energy: float, **values):
    light = bpy.data.lights.new(kind, kind)
    light.energy = energy
    for name, value in values.items():
        setattr(light, name, value)
    item = bpy.data.objects.new(kind, light)
    item.location = location
    direction = t.Vector((0, 0, 0.5)) - t.Vector(location)
    item.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(item)
    return item


def room(world_color=None):
    """A ball and a lamp-like cube on a floor, with soft lights of every kind."""
    scene = t.new_scene(48, 32)
    t.add_camera(scene, (0, -8, 3), (0, 0, 0.5), 45)
    mesh = bpy.data.meshes.new("Floor")
    mesh.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
    t.add_object(scene, "Floor", mesh).data.materials.append(t.diffuse("Grey", (0.6, 0.5, 0.4)))
    for index in range(3):
        cube = t.add_object(
            scene, f"Cube {index}", None, (index * 1.5 - 1.5, 0, 0.6), (0, 0, index)
        )
        cube.data.materials.append(t.diffuse(f"Colour {index}", (0.2 + 0.3 * index, 0.5, 0.7)))
    glowing = bpy.data.materials.new("Glowing")
    glowing.use_nodes = True
    shader = glowing.node_tree.nodes["Principled BSDF"]
    shader.inputs["Emission"].default_value = (1, 0.8, 0.2, 1)
    shader.inputs["Emission Strength"].default_value = 1.5
    t.add_object(scene, "Lamp", None, (2.6, 0.5, 0.5), (0, 0, 0.3)).data.materials.append(glowing)
    if world_color:
        world = bpy.data.worlds.new("World")
        world.use_nodes = True
        world.node_tree.nodes["Background"].inputs["Color"].default_value = (*world_color, 1)
        scene.world = world
    return scene


SOFT = (
    ("SUN", (3, -4, 6), 1.5, {"angle": 0.1}),
    ("POINT", (-3, -2, 3), 150.0, {"shadow_soft_size": 0.3}),
    ("SPOT", (2, -4, 4), 200.0, {"shadow_soft_size": 0.3}),
    ("AREA", (-1, -3, 5), 100.0, {"size": 1.0}),
)


def colors_with_seeds(lights, world_color=None) -> list[np.ndarray]:
    """Colour of one frame with two seeds of Cycles."""
    pictures = []
    for seed in (0, 17):
        scene = room(world_color)
        for kind, location, energy, values in lights:
            add_light(scene, kind, location, energy, **values)
        original = rendering.sample_points

        def seeded(scene, samples, seed=seed):
            original(scene, samples)
            scene.cycles.seed = seed

        rendering.sample_points = seeded
        try:
            out = os.path.join(t.temporary_folder(), "shot")
            t.export(out, "--frames", "1", "--truth-frames", "none")
        finally:
            rendering.sample_points = original
        path = os.path.join(out, "frames/000001.exr")
        pictures.append(t.stacked(t.read_part(path, "color"), "R G B").astype(np.float64))
    return pictures


def test_no_noise_from_any_light() -> None:
    for light in SOFT:
        first, second = colors_with_seeds([light])
        assert first.max() > 0.05
        assert np.abs(first - second).max() < 1e-5, f"{light[0]}: {np.abs(first - second).max()}"


def test_no_noise_from_many_lights_and_world() -> None:
    first, second = colors_with_seeds(SOFT, (0.2, 0.3, 0.5))
    assert np.abs(first - second).max() < 1e-5, np.abs(first - second).max()


def test_as_is_is_noisy() -> None:
    """The check above can fail: the scene's own light differs from seed to seed."""
    scene = room((0.2, 0.3, 0.5))
    for kind, location, energy, values in SOFT:
        add_light(scene, kind, location, energy, **values)
    out = os.path.join(t.temporary_folder(), "shot")
    shot = t.export(out, "--frames", "1", "--truth-frames", "none", "--lighting", "as-is")
    note = " ".join(shot["notes"])
    for cause in ("4 lights", "area light", "world", "indirect"):
        assert cause in note, (cause, note)


def test_lights_add_up() -> None:
    """Colour of several lights equals the truth away from edges, where all lights are rendered at once."""
    scene = room((0.2, 0.3, 0.5))
    for kind, location, energy, values in SOFT[:3]:
        add_light(scene, kind, location, energy, **values)
    out = os.path.join(t.temporary_folder(), "shot")
    shot = t.export(
        out,
        "--frames",
        "1",
        "--truth-samples",
        "512",
        "--passes",
        "object,depth",
        "--jitter",
        "none",
    )
    color = t.stacked(t.read_part(os.path.join(out, "frames/000001.exr"), "color"), "R G B").astype(
        np.float64
    )
    truth = sum(
        t.stacked(t.read_part(os.path.join(out, "truth/000001.exr"), half), "R G B").astype(
            np.float64
        )
        for half in "ab"
    )
    difference = np.abs(color - truth / 2).max(axis=-1)
    assert np.median(difference) < 0.003, np.median(difference)
    assert np.allclose(shot["color"]["ambient"], (0.2, 0.3, 0.5), atol=1e-4), shot["color"][
        "ambient"
    ]


def test_area_light_keeps_its_power() -> None:
    """On the axis of a small area light, far away, the stand-in gives the same light."""

    def floor_below(kind, lighting):
        scene = t.new_scene(16, 16)
        camera = t.add_camera(scene, (0, -0.01, 9), (0, 0, 0), 200)
        mesh = bpy.data.meshes.new("Floor")
        mesh.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
        t.add_object(scene, "Floor", mesh).data.materials.append(t.diffuse("White", (1, 1, 1)))
        item = add_light(scene, kind, (0, 0, 10), 500.0, size=0.05)
        item.rotation_euler = (0, 0, 0)
        out = os.path.join(t.temporary_folder(), "shot")
        t.export(
            out,
            "--frames",
            "1",
            "--truth-frames",
            "none",
            "--lighting",
            lighting,
            "--samples",
            "16",
        )
        return t.read_part(os.path.join(out, "frames/000001.exr"), "color")["R"].mean()

    real, stand_in = floor_below("AREA", "as-is"), floor_below("AREA", "noise-free")
    assert real > 0.1 and abs(stand_in / real - 1) < 0.02, (real, stand_in)


def test_ambient_of_a_varying_world() -> None:
    """A world that is white above the horizon and black below has a mean of one half."""
    scene = room((1, 1, 1))
    tree = scene.world.node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    above = tree.nodes.new("ShaderNodeMath")
    above.operation = "GREATER_THAN"
    above.inputs[1].default_value = 0.0
    tree.links.new(coordinates.outputs["Generated"], separate.inputs[0])
    tree.links.new(separate.outputs["Z"], above.inputs[0])
    tree.links.new(above.outputs[0], tree.nodes["Background"].inputs["Color"])
    shot = t.export(
        os.path.join(t.temporary_folder(), "s"), "--frames", "1", "--truth-frames", "none"
    )
    assert np.allclose(shot["color"]["ambient"], 0.5, atol=0.01), shot["color"]["ambient"]


if __name__ == "__main__":
    t.main(
        test_no_noise_from_any_light,
        test_no_noise_from_many_lights_and_world,
        test_as_is_is_noisy,
        test_lights_add_up,
        test_area_light_keeps_its_power,
        test_ambient_of_a_varying_world,
    )
