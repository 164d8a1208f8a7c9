# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise-free light: the same picture whatever the seed, and the same light in colour and truth."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve.errors import SceneError  # noqa: E402
from aa_resolve.scene import rendering, world_light  # noqa: E402


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
    t.shader_input(shader, "Emission").default_value = (1, 0.8, 0.2, 1)
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


def lit_floor(kind, lighting, values, scale=(1, 1, 1), aside=0.0, prepare=None) -> np.ndarray:
    """Mean colour of a small piece of white floor under a light 4 m above, ``aside`` metres from the point below it."""
    scene = t.new_scene(8, 8)
    t.add_camera(scene, (aside, -0.01, 9), (aside, 0, 0), 400)
    mesh = bpy.data.meshes.new("Floor")
    mesh.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
    t.add_object(scene, "Floor", mesh).data.materials.append(t.diffuse("White", (1, 1, 1)))
    item = add_light(scene, kind, (0, 0, 4), 100.0, **values)
    item.rotation_euler, item.scale = (0, 0, 0), scale
    if prepare:
        prepare(scene, item)
    out = os.path.join(t.temporary_folder(), "shot")
    options = ("--samples", "64") if lighting == "as-is" else ()
    t.export(
        out, "--frames", "1", "--truth-frames", "none", "--jitter", "none", "--lighting", lighting, *options
    )  # fmt: skip
    color = t.read_part(os.path.join(out, "frames/000001.exr"), "color")
    return t.stacked(color, "R G B").astype(np.float64).mean(axis=(0, 1))


SMALL = {"size": 0.1, "size_y": 0.2}
KINDS = (
    ("SUN", {"angle": 0.1}, (1, 1, 1)),
    ("POINT", {"shadow_soft_size": 0.05}, (1, 1, 1)),
    ("POINT", {"shadow_soft_size": 0.05}, (2, 2, 2)),
    ("SPOT", {"shadow_soft_size": 0.05, "spot_size": 2.0}, (1, 1, 1)),
    ("SPOT", {"shadow_soft_size": 0.05, "spot_size": 2.0, "spot_blend": 1.0}, (2, 1, 1)),
    ("AREA", {**SMALL, "shape": "SQUARE"}, (1, 1, 1)),
    ("AREA", {**SMALL, "shape": "RECTANGLE"}, (1, 1, 1)),
    ("AREA", {**SMALL, "shape": "DISK"}, (1, 1, 1)),
    ("AREA", {**SMALL, "shape": "ELLIPSE"}, (2, 1, 3)),
    ("AREA", {**SMALL, "shape": "SQUARE", "spread": 2.0}, (1, 1, 1)),
    ("AREA", {**SMALL, "shape": "DISK", "spread": 1.0}, (1, 1, 1)),
)
SINCE_4_5 = (
    ("SUN", {"angle": 0.1, "normalize": False}, (1, 1, 1)),
    ("SUN", {"angle": 0.0, "normalize": False}, (1, 1, 1)),
    ("POINT", {"shadow_soft_size": 0.1, "normalize": False}, (2, 1, 1)),
    ("POINT", {"shadow_soft_size": 0.0, "normalize": False}, (1, 1, 1)),
    ("SPOT", {"shadow_soft_size": 0.1, "spot_size": 2.0, "normalize": False}, (1, 1, 1)),
    ("AREA", {**SMALL, "shape": "RECTANGLE", "normalize": False}, (2, 1, 1)),
    ("AREA", {**SMALL, "shape": "DISK", "normalize": False}, (1, 1, 1)),
    ("AREA", {**SMALL, "exposure": 1.5, "use_temperature": True, "temperature": 3000}, (1, 1, 1)),
)


def test_every_light_keeps_its_power() -> None:
    """Below a small light and aside, the light without size gives what the real one gives at many samples.

    Their noise and their size, 0.2 m at 4 m, are worth less than 0.3 %."""
    kinds = KINDS + (SINCE_4_5 if "normalize" in bpy.types.Light.bl_rna.properties else ())
    for kind, values, scale in kinds:
        for aside in (0.0, 2.0):
            real, delta = (
                lit_floor(kind, lighting, values, scale, aside)
                for lighting in ("as-is", "noise-free")
            )
            assert real.max() > 1e-3, (kind, values, aside, real)
            error = np.abs(delta / real - 1).max()
            assert error < 0.003, (kind, values, scale, aside, real, delta)


def test_animated_power_of_an_unnormalized_light() -> None:
    """An animated power stays the scene's own; what the size is worth goes elsewhere, or is refused."""
    if "normalize" not in bpy.types.Light.bl_rna.properties:
        return

    def keyed(*paths):
        def prepare(_scene, item):
            for path in paths:
                t.key(item.data, path, {1: getattr(item.data, path), 9: 0.5})

        return prepare

    values = {**SMALL, "shape": "DISK", "normalize": False, "exposure": 1.0}
    for path in ("energy", "exposure"):
        real = lit_floor("AREA", "as-is", values, prepare=keyed(path))
        delta = lit_floor("AREA", "noise-free", values, prepare=keyed(path))
        assert np.abs(delta / real - 1).max() < 0.003, (path, real, delta)
    for paths in (("size",), ("energy", "exposure")):
        try:
            lit_floor("AREA", "noise-free", values, prepare=keyed(*paths))
            raise SystemExit(f"{paths} must be refused")
        except SceneError as error:
            assert "switch on Normalize" in str(error), error


def test_light_linking() -> None:
    """Whom a light shines on and whose shadow it casts stays as it was."""
    if not hasattr(bpy.types.Object, "light_linking"):
        return  # before 4.0

    def scene_with_links(lighting) -> tuple[dict[str, np.ndarray], dict]:
        scene = t.new_scene(48, 24)
        t.add_camera(scene, (0, -0.01, 12), (0, 0, 0), 50)
        mesh = bpy.data.meshes.new("Floor")
        mesh.from_pydata([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], [], [(0, 1, 2, 3)])
        mesh.materials.append(t.diffuse("White", (1, 1, 1)))
        for name, x in (("Left", -2.1), ("Right", 2.1)):
            t.add_object(scene, name, mesh, (x, 0, 0))
            t.add_object(scene, f"Roof {name}", mesh, (x, 0.5, 5), scale=(1, 0.2, 1))
        for index, (shines_on, shadow_of) in enumerate((("Left", None), (None, "Roof Right"))):
            item = add_light(scene, "AREA", (0, 0.5 + index, 9), 300.0, size=0.1)
            item.rotation_euler = (0, 0, 0)
            item.data.color = ((1, 0.2, 0.1), (0.1, 0.2, 1))[index]
            for role, name in (("receiver", shines_on), ("blocker", shadow_of)):
                if name:
                    linked = bpy.data.collections.new(f"{role} {index}")
                    linked.objects.link(bpy.data.objects[name])
                    setattr(item.light_linking, f"{role}_collection", linked)
        out = os.path.join(t.temporary_folder(), "shot")
        options = ("--samples", "64") if lighting == "as-is" else ()
        shot = t.export(
            out, "--frames", "1", "--truth-frames", "none", "--jitter", "none", "--passes", "object",
            "--lighting", lighting, *options,
        )  # fmt: skip
        path = os.path.join(out, "frames/000001.exr")
        color = t.stacked(t.read_part(path, "color"), "R G B").astype(np.float64)
        ids = t.read_part(path, "object")["id"]
        return color, {name: ids == int(key) for key, name in shot["objects"].items()}

    real, where = scene_with_links("as-is")
    delta, _ = scene_with_links("noise-free")
    red, blue = (
        [delta[where[name]][:, channel] for name in ("Left", "Right")] for channel in (0, 2)
    )
    assert red[0].max() > 4 * red[1].max(), "the first light shines on the left alone"
    assert blue[1].min() < 0.1 * blue[1].max(), "the right roof casts a shadow of the second light"
    assert blue[0].min() > 0.3 * blue[0].max(), "the left one does not"
    assert np.median(np.abs(delta - real)) < 1e-3 and np.abs(delta - real).mean() < 0.01


def test_a_portal_does_not_shine() -> None:
    def as_portal(_scene, item):
        item.data.cycles.is_portal = True

    def before_a_world(scene, item):
        as_portal(scene, item)
        scene.world = bpy.data.worlds.new("Bright")
        scene.world.use_nodes = True

    for lighting in ("as-is", "noise-free"):
        assert lit_floor("AREA", lighting, {"size": 1.0}, prepare=as_portal).max() == 0.0, lighting
        lit = lit_floor("AREA", lighting, {"size": 9.0}, prepare=before_a_world)
        assert lit.max() < 0.06, (lighting, lit)  # the default world's 0.05 and no more


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


def behind_what_a_camera_sees(world, way: str) -> None:
    """Shows a camera black in place of the world, in one of the ways in which scenes do."""
    if way == "hidden":
        world.cycles_visibility.camera = False
        return
    tree = world.node_tree
    output = tree.nodes["World Output"]
    black, mix = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeMixShader")
    black.inputs["Color"].default_value = (0, 0, 0, 1)
    if way == "node":
        path = tree.nodes.new("ShaderNodeLightPath")
    else:
        inner = bpy.data.node_groups.new("Path", "ShaderNodeTree")
        t.add_group_socket(inner, "NodeSocketFloat", "Is Camera Ray", True)
        inner.links.new(
            inner.nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"],
            inner.nodes.new("NodeGroupOutput").inputs[0],
        )
        path = tree.nodes.new("ShaderNodeGroup")
        path.node_tree = inner
    tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
    tree.links.new(tree.nodes["Background"].outputs[0], mix.inputs[1])
    tree.links.new(black.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])


def test_ambient_of_a_world_that_the_camera_does_not_see() -> None:
    """It is what surfaces receive; the background stays black, and the world as it was."""
    for way in ("hidden", "node", "group"):
        scene = room((0.5, 0.6, 0.7))
        behind_what_a_camera_sees(scene.world, way)
        worlds, groups = len(bpy.data.worlds), len(bpy.data.node_groups)
        out = os.path.join(t.temporary_folder(), "s")
        shot = t.export(out, "--frames", "1", "--truth-frames", "none")
        ambient = shot["color"]["ambient"]
        assert np.allclose(ambient, (0.5, 0.6, 0.7), atol=1e-5), (way, ambient)
        color = t.read_part(os.path.join(out, "frames/000001.exr"), "color")
        assert color["R"][0].max() == 0.0 < color["R"][-1].min(), way
        assert len(bpy.data.worlds) == worlds and len(bpy.data.node_groups) == groups, way
    # What only other rays than a diffuse one find is not received.
    scene = room((0.5, 0.6, 0.7))
    tree = scene.world.node_tree
    path, background = tree.nodes.new("ShaderNodeLightPath"), tree.nodes["Background"]
    for name, received in (("Is Glossy Ray", 0.0), ("Is Diffuse Ray", 1.0), ("Ray Depth", 1.0)):
        tree.links.new(path.outputs[name], background.inputs["Strength"])
        ambient = world_light.mean_radiance(scene, scene.world, t.temporary_folder())
        assert np.allclose(ambient, np.array((0.5, 0.6, 0.7)) * received, atol=1e-5), name


def under_a_sky(lighting, elevation, rotation, shown=True, way="shown") -> tuple[np.ndarray, dict]:
    """A pole on a floor, seen from above, under a sky texture of the kind that this version has first."""
    scene = t.new_scene(32, 32)
    t.add_camera(scene, (0, -0.01, 9), (0, 0, 0), 100)
    mesh = bpy.data.meshes.new("Floor")
    mesh.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
    for item in (
        t.add_object(scene, "Floor", mesh),
        t.add_object(scene, "Pole", t.cube_mesh("Pole", 0.4), (0, 0, 0.5)),
    ):
        item.data.materials.append(t.diffuse("White", (0.8, 0.8, 0.8)))
    scene.world = bpy.data.worlds.new("Sky")
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    sky, background = tree.nodes.new("ShaderNodeTexSky"), tree.nodes["Background"]
    sky.sun_elevation, sky.sun_rotation = elevation, rotation
    background.inputs["Strength"].default_value = 0.1
    if shown:
        tree.links.new(sky.outputs["Color"], background.inputs["Color"])
    if way != "shown":
        behind_what_a_camera_sees(scene.world, way)
    scene.cycles.max_bounces = 0
    out = os.path.join(t.temporary_folder(), "s")
    options = ("--samples", "64") if lighting == "as-is" else ()
    shot = t.export(
        out, "--frames", "1", "--truth-frames", "none", "--jitter", "none", "--lighting", lighting, *options
    )  # fmt: skip
    color = t.read_part(os.path.join(out, "frames/000001.exr"), "color")
    return t.stacked(color, "R G B").astype(np.float64), shot


def test_sun_of_a_sky_texture() -> None:
    """It shines from where the sky draws it, as bright, and casts its shadow there; the rest of the sky is ambient."""
    for elevation, rotation in ((0.9, 0.7), (0.7, 3.6)):
        real, _ = under_a_sky("as-is", elevation, rotation)
        delta, shot = under_a_sky("noise-free", elevation, rotation)
        assert "the sky's sun is a light without size" in " ".join(shot["notes"]), shot["notes"]
        lit, shadow = real[..., 0] > 0.9 * np.median(real[..., 0]), real[..., 0] < 0.5
        assert shadow.sum() > 10
        assert np.abs(np.median(delta[lit], 0) / np.median(real[lit], 0) - 1).max() < 0.1
        assert ((delta[..., 0] < 0.5) == shadow).mean() > 0.96, "the shadow lies elsewhere"
        sun = [
            np.median(picture[lit, 0]) - np.median(picture[shadow, 0]) for picture in (real, delta)
        ]
        assert abs(sun[1] / sun[0] - 1) < 0.04, sun
        for way in ("hidden", "group"):  # the floor fills the picture
            behind, _ = under_a_sky("noise-free", elevation, rotation, way=way)
            assert np.abs(behind - delta).max() < 1e-5, way
    _, shot = under_a_sky("noise-free", 0.9, 0.7, shown=False)
    assert "the sky's sun" not in " ".join(shot["notes"]), shot["notes"]


def test_exposure_of_the_film_scales_everything() -> None:
    """Light, emission, background and the ambient that stands for the world."""
    pictures = []
    for exposure in (1.0, 2.0):
        scene = room((0.2, 0.3, 0.5))
        scene.cycles.film_exposure = exposure
        for kind, location, energy, values in SOFT[:2]:
            add_light(scene, kind, location, energy, **values)
        out = os.path.join(t.temporary_folder(), "s")
        t.export(out, "--frames", "1", "--truth-frames", "none")
        color = t.read_part(os.path.join(out, "frames/000001.exr"), "color")
        pictures.append(t.stacked(color, "R G B").astype(np.float64))
    error = np.abs(pictures[1] / pictures[0] - 2).max()
    assert error < 1e-4, error


def test_world_of_the_view_layer() -> None:
    """A view layer's own world gives the ambient light and the background."""
    if "world_override" not in bpy.types.ViewLayer.bl_rna.properties:
        return  # before 4.3
    scene = room((1, 0, 0))
    other = bpy.data.worlds.new("Other")
    other.use_nodes = True
    other.node_tree.nodes["Background"].inputs["Color"].default_value = (0.1, 0.2, 0.3, 1)
    scene.view_layers[0].world_override = other
    out = os.path.join(t.temporary_folder(), "s")
    shot = t.export(out, "--frames", "1", "--truth-frames", "none")
    assert np.allclose(shot["color"]["ambient"], (0.1, 0.2, 0.3), atol=1e-4), shot["color"]


def test_lights_of_nested_instances() -> None:
    """A light that is instanced by what is instanced, or by nodes, shines as it does in the scene itself."""

    def nest(scene, lamp):
        inner, outer = bpy.data.collections.new("Inner"), bpy.data.collections.new("Outer")
        inner.objects.link(lamp)
        for name, content, holder in (
            ("One", inner, outer),
            ("Other", outer, scene.collection),
        ):
            empty = bpy.data.objects.new(name, None)
            empty.instance_type, empty.instance_collection = "COLLECTION", content
            holder.objects.link(empty)

    def by_nodes(scene, lamp):
        lamps = bpy.data.collections.new("Lamps")
        lamps.objects.link(lamp)
        tree = t.geometry_group("Lamps")
        info = tree.nodes.new("GeometryNodeCollectionInfo")
        info.inputs["Collection"].default_value = lamps
        tree.links.new(info.outputs[0], tree.nodes["End"].inputs[0])
        mesh = bpy.data.meshes.new("Holder")
        t.add_object(scene, "Holder", mesh).modifiers.new("Lamps", "NODES").node_group = tree

    def by_faces(scene, lamp):
        mesh = bpy.data.meshes.new("Face")
        mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
        face = t.add_object(scene, "Face", mesh, tuple(lamp.location))
        face.instance_type, face.show_instancer_for_render = "FACES", False
        lamp.parent, lamp.location = face, (0, 0, 0)
        scene.collection.objects.link(lamp)

    def two_faces(scene, lamp):
        by_faces(scene, lamp)
        mesh = bpy.data.meshes["Face"]
        mesh.clear_geometry()
        corners = [(x, y, z) for z in (0, 0.5) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        mesh.from_pydata(corners, [], [(0, 1, 2, 3), (4, 5, 6, 7)])

    def beside_itself(scene, lamp):
        nest(scene, lamp)
        scene.collection.objects.link(lamp)

    several = (two_faces, beside_itself)
    colors = []
    for hide in (None, nest, by_nodes, by_faces, *several):
        scene = room()
        t.add_sun(scene)
        lamp = add_light(scene, "POINT", (1, -2, 3), 300.0, shadow_soft_size=0.5)
        if hide:
            scene.collection.objects.unlink(lamp)
            hide(scene, lamp)
        out = os.path.join(t.temporary_folder(), "s")
        shot = t.export(out, "--frames", "1", "--truth-frames", "none", "--jitter", "none")
        noisy = [note for note in shot["notes"] if "several at once" in note]
        assert bool(noisy) == (hide in several), (hide, shot["notes"])
        part = t.read_part(os.path.join(out, "frames/000001.exr"), "color")
        if hide not in several:
            colors.append(t.stacked(part, "R G B"))
    assert colors[0].max() > 0.3
    for color in colors[1:]:
        assert np.abs(color - colors[0]).max() < 1e-4, np.abs(color - colors[0]).max()


def test_an_emitting_mesh_that_instances_lights_is_noted() -> None:
    scene = room()
    lamp = add_light(scene, "POINT", (0, 0, 0), 300.0)
    glowing = bpy.data.objects["Lamp"]
    lamp.parent, glowing.instance_type = glowing, "VERTS"
    shot = t.export(t.temporary_folder() + "/s", "--frames", "1", "--truth-frames", "none")
    assert any("instance lights (Lamp)" in note for note in shot["notes"]), shot["notes"]


def test_lights_that_are_switched_on_later() -> None:
    """One that is hidden in the first frame is without size where it shines; beside another it is refused, as it is where
    it shines in the first frame, unless no frame of the shot shows it."""

    def exported(lights: int, frames: str, *options: str) -> np.ndarray:
        scene = room()
        scene.objects["Cube 0"].location.x = -3
        for _ in range(lights - 1):
            add_light(scene, "SUN", (3, -4, 6), 1.0, angle=0.0)
        later = add_light(scene, "SUN", (-3, -4, 4), 2.0, angle=0.5)
        for frame, hidden in ((1, True), (3, False)):
            later.hide_render = hidden
            later.keyframe_insert("hide_render", frame=frame)
        out = os.path.join(t.temporary_folder(), "shot")
        shot = t.export(out, "--frames", frames, "--truth-frames", "none", *options)
        path = os.path.join(out, shot["frames"][-1]["file"])
        return t.stacked(t.read_part(path, "color"), "R G B").astype(np.float32)

    one, many = (exported(1, "1-3", "--jitter", "none", "--samples", n) for n in ("1", "16"))
    assert one.max() > 0.1, "it shines"
    assert np.abs(one - many).max() < 0.02, np.abs(one - many).max()  # edges: a filter of 0.01 px
    assert exported(2, "1-2").max() > 0.1
    try:
        exported(2, "1-3")
        raise AssertionError("two of which one is switched on were taken")
    except SceneError as error:
        assert "its render visibility is animated" in str(error), error


if __name__ == "__main__":
    t.main(
        test_no_noise_from_any_light,
        test_no_noise_from_many_lights_and_world,
        test_as_is_is_noisy,
        test_lights_add_up,
        test_lights_of_nested_instances,
        test_an_emitting_mesh_that_instances_lights_is_noted,
        test_every_light_keeps_its_power,
        test_animated_power_of_an_unnormalized_light,
        test_light_linking,
        test_a_portal_does_not_shine,
        test_ambient_of_a_varying_world,
        test_ambient_of_a_world_that_the_camera_does_not_see,
        test_sun_of_a_sky_texture,
        test_exposure_of_the_film_scales_everything,
        test_world_of_the_view_layer,
        test_lights_that_are_switched_on_later,
    )
