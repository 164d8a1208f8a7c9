# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that were not made for this: imported glTF with textures and cut-outs, linked libraries, hair, text."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402


def exported(*options: str) -> tuple[dict, str]:
    out = os.path.join(t.temporary_folder(), "shot")
    return t.export(out, *options), out


def textured(name: str, cutout: bool):
    """Principled material with a chequered image; its alpha has holes where ``cutout``."""
    image = bpy.data.images.new(name, 16, 16, alpha=True)
    row, column = np.mgrid[0:16, 0:16]
    checks = ((row // 4 + column // 4) % 2).astype(np.float32)
    pixels = np.stack(
        [
            0.2 + 0.6 * checks,
            0.5 * np.ones_like(checks),
            0.8 - 0.6 * checks,
            checks if cutout else np.ones_like(checks),
        ],
        -1,
    )
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, "Closest"
    shader = tree.nodes["Principled BSDF"]
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    if cutout:
        tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
        material.blend_method = "CLIP"
    return material


def square(scene, name: str, y: float, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(
        [(-1.5, y, -1.2), (1.5, y, -1.2), (1.5, y, 1.2), (-1.5, y, 1.2)], [], [(0, 1, 2, 3)]
    )
    layer = mesh.uv_layers.new(name="UVMap")
    for index, corner in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        layer.data[index].uv = corner
    mesh.materials.append(material)
    return t.add_object(scene, name, mesh)


def test_gltf_with_textures_and_cutouts() -> None:
    scene = t.new_scene(64, 48)
    square(scene, "Fence", 0.0, textured("Fence", True))
    square(scene, "Poster", 1.5, textured("Poster", False))
    path = os.path.join(t.temporary_folder(), "foreign.glb")
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB")
    scene = t.new_scene(64, 48)
    for name, kind in (("bool", bool), ("int", int), ("float", float), ("object", object)):
        if name not in vars(np):
            setattr(np, name, kind)  # the importer of 3.4 uses names that numpy has dropped
    bpy.ops.import_scene.gltf(filepath=path)
    t.add_camera(scene, (0, -8, 0), (0, 0, 0), 60)
    t.add_sun(scene, rotation=(1.2, 0, 0))
    shot, out = exported(
        "--frames", "1", "--passes", "albedo,depth,normal,object,subsamples", "--truth-samples", "16", "--jitter", "none",
    )  # fmt: skip
    assert sorted(shot["objects"].values()) == ["Fence", "Poster"], shot["objects"]
    path = os.path.join(out, "frames/000001.exr")
    names = {name: int(key) for key, name in shot["objects"].items()}
    ids, depth = t.read_part(path, "object")["id"], t.read_part(path, "depth")["Z"]
    assert (
        np.abs(depth[ids == names["Fence"]] - 8.0).max() < 1e-4
        and (ids == names["Fence"]).sum() > 300
    )
    assert (
        np.abs(depth[ids == names["Poster"]] - 9.5).max() < 1e-4
        and (ids == names["Poster"]).sum() > 300
    )
    albedo = t.stacked(t.read_part(path, "albedo"), "albedo.R albedo.G albedo.B")
    assert (
        len(np.unique(np.round(albedo[ids == names["Poster"]], 2), axis=0)) == 2
    ), "the texture's two colours"
    color = t.stacked(t.read_part(path, "color"), "R G B")
    assert np.isfinite(color).all() and color.max() > 0.05


def test_linked_library() -> None:
    """Objects of another file are rendered with ids of their own, and that file is not touched either."""
    scene = t.new_scene(48, 27)
    collection = bpy.data.collections.new("Library")
    collection.objects.link(bpy.data.objects.new("Linked", t.cube_mesh("Linked")))
    scene.collection.children.link(collection)
    library = t.save(scene, os.path.join(t.temporary_folder(), "library.blend"))
    before = os.path.getmtime(library), os.path.getsize(library)
    scene = t.new_scene(48, 27)
    t.add_camera(scene)
    with bpy.data.libraries.load(library, link=True) as (source, target):
        target.collections = list(source.collections)
    scene.collection.children.link(bpy.data.collections["Library"])
    t.add_object(scene, "Own", None, (1.5, 0, 0.5))
    shot, _ = exported(
        "--frames", "1", "--passes", "object,depth,subsamples", "--truth-frames", "none"
    )
    assert len(shot["objects"]) == 2 and "Own" in shot["objects"].values(), shot["objects"]
    assert any(name.startswith("Linked") for name in shot["objects"].values()), shot["objects"]
    assert (os.path.getmtime(library), os.path.getsize(library)) == before


def test_a_linked_scene_as_the_open_one() -> None:
    """It gives the pictures that it gives in its own file; that it is a set of another scene changes nothing."""
    scene = t.new_scene(48, 27)
    scene.name = "Set"
    t.add_camera(scene)
    t.add_sun(scene)
    t.key(t.add_object(scene, "Mover"), "location", {1: (0, 0, 0), 3: (1, 0, 0.5)})
    collection = bpy.data.collections.new("Parts")
    collection.objects.link(bpy.data.objects.new("Part", t.cube_mesh("Part")))
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    empty.location = (1.5, 1, 1)
    scene.collection.objects.link(empty)
    library = t.save(scene, os.path.join(t.temporary_folder(), "library.blend"))
    options = ("--frames", "1-2", "--passes", "motion,object,depth", "--truth-frames", "none")
    pictures = [exported(*options)[1]]
    for used in (False, True):
        scene = t.new_scene()
        with bpy.data.libraries.load(library, link=True) as (_, wanted):
            wanted.scenes = ["Set"]
        if used:
            scene.background_set = wanted.scenes[0]
        bpy.context.window.scene = wanted.scenes[0]
        shot, out = exported(*options)
        assert any(name.startswith("Mover [library") for name in shot["objects"].values()), shot
        pictures.append(out)
    for part in ("color", "depth", "motion"):
        expected, *found = (
            t.read_part(os.path.join(out, "frames/000002.exr"), part) for out in pictures
        )
        for picture in found:
            for channel, pixels in expected.items():
                assert np.array_equal(pixels, picture[channel]), (part, channel)


def test_hair_moves_with_its_emitter() -> None:
    """Strands carry their emitter's id, and their motion is that of the emitter to 0.05 px."""
    scene = t.new_scene(64, 36)
    camera = t.add_camera(scene)
    item = t.add_object(scene, "Head", t.cube_mesh("Head", 0.6), (0, 0, 0.5))
    item.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = item.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length = "HAIR", 400, 1.0
    settings.root_radius, settings.tip_radius, settings.radius_scale = 1.0, 1.0, 0.02
    t.key(item, "location", {1: (-1, 0, 0.5), 11: (1, 0.0, 0.9)})
    places = {}
    for frame in (4, 5):
        scene.frame_set(frame)
        places[frame] = np.array(item.matrix_world.translation)
    projection = t.Projection(camera, 64, 36)
    shot, out = exported(
        "--frames",
        "4-5",
        "--for",
        "taaSimplest",
        "--passes",
        "object,depth",
        "--truth-frames",
        "none",
    )
    path = os.path.join(out, shot["frames"][1]["file"])
    motion = t.stacked(t.read_part(path, "motion"), "motion.X motion.Y").astype(np.float64)
    depth, ids = (
        t.read_part(path, "depth")["Z"].astype(np.float64),
        t.read_part(path, "object")["id"],
    )
    hit = ids > 0
    x, y = np.meshgrid(np.arange(64) + 0.5, np.arange(36) + 0.5)
    jitter = shot["frames"][1]["jitter"]
    here = np.stack([x[hit] + jitter[0], y[hit] + jitter[1]], -1)
    past = projection.project(
        projection.unproject(here[:, 0], here[:, 1], depth[hit]) + places[4] - places[5]
    )
    error = np.abs(motion[hit] - (here - past)).max()
    assert hit.sum() > 150 and error < 0.05, (hit.sum(), error)
    assert list(shot["objects"].values()) == ["Head"]


def test_text_and_hidden_objects() -> None:
    """Text has an id; what is hidden in the viewport renders, what is hidden for rendering does not."""
    scene = t.new_scene(64, 36)
    t.add_camera(scene, (0, -8, 0.3), (0, 0, 0.3))
    curve = bpy.data.curves.new("Text", "FONT")
    curve.body, curve.size = "AA", 2.0
    text = bpy.data.objects.new("Text", curve)
    text.location, text.rotation_euler = (-3, 0, -0.5), (1.5708, 0, 0)
    scene.collection.objects.link(text)
    t.add_object(scene, "Hidden In Viewport", None, (1, 0, 0)).hide_viewport = True
    t.add_object(scene, "Hidden In Render", None, (2.5, 0, 0)).hide_render = True
    shot, _ = exported("--frames", "1", "--passes", "object,edges", "--truth-frames", "none")
    assert sorted(shot["objects"].values()) == ["Hidden In Viewport", "Text"], shot["objects"]


def test_centre_frames_beside_jittered_ones() -> None:
    """Where methods of both kinds are chosen, each instant also exists sampled at the pixel centres."""

    def make():
        scene = t.new_scene(48, 27)
        t.add_camera(scene)
        t.add_sun(scene)
        item = t.add_object(scene, "Cube", None, (0, 0, 0.5), (0.2, 0.3, 0.4))
        t.key(item, "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})

    make()
    shot, out = exported("--frames", "3-5", "--for", "noaa,taaSimplest", "--truth-frames", "none")
    make()
    plain, other = exported("--frames", "3-5", "--for", "noaa", "--truth-frames", "none")
    assert plain["jitter"]["sequence"] == "none" and shot["jitter"]["sequence"] == "halton23"
    for entry, centred in zip(shot["frames"], plain["frames"]):
        assert "centre" not in centred and entry["jitter"] != [0.0, 0.0]
        one = t.read_part(os.path.join(out, entry["centre"]), "color")
        two = t.read_part(os.path.join(other, centred["file"]), "color")
        jittered = t.read_part(os.path.join(out, entry["file"]), "color")
        assert np.array_equal(one["R"], two["R"]) and not np.array_equal(one["R"], jittered["R"])


if __name__ == "__main__":
    t.main(
        test_gltf_with_textures_and_cutouts,
        test_linked_library,
        test_a_linked_scene_as_the_open_one,
        test_hair_moves_with_its_emitter,
        test_text_and_hidden_objects,
        test_centre_frames_beside_jittered_ones,
    )
