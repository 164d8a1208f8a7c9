# SPDX-License-Identifier: GPL-3.0-or-later
"""The procedural scenes build in this Blender: objects, frames, one sun, and the same numbers each time. A model from a
file keeps its cut-outs."""

from __future__ import annotations

import base64
import glob
import hashlib
import importlib
import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy_extras  # noqa: E402
import support as t  # noqa: E402
from support import bpy, np, oiio  # noqa: E402

SCENES = os.path.join(t.ROOT, "scenes")
sys.path.insert(0, SCENES)
import common  # noqa: E402

VARIANTS = {  # of the scenes that have some
    "pipe": ([], ["--rolled"]),
    "flowers": (["--close"], ["--sway"]),
    "hairball": (
        ["--fibres", "60"],
        ["--fibres", "60", "--unlit"],
        ["--fibres", "60", "--rotating"],
        ["--fibres", "60", "--unlit", "--rotating"],
    ),
}
OBJECTS = {  # what must be there, of the scenes of one model
    "pipe": {"Pipe"},
    "stairs": {"Stairs"},
    "blinds": {"Blinds Slats", "Blinds Frame", "Facade"},
    "arched_window": {"Arch Frame", "Arch Door", "Facade"},
    "wall": {"Wall"},
    "hard_edges": {"Blinds Slats", "Arch Door", "Wall", "Pipe"},
    "hairball": {"Hairball"},
    "flowers": {"Column", "Leaves", "Red Blossoms"},
}
MOVES = ("--rotating", "--sway")


def scenes() -> list[str]:
    """Every script that builds a scene from nothing."""
    names = []
    for path in sorted(glob.glob(os.path.join(SCENES, "*.py"))):
        with open(path, encoding="utf-8") as file:
            if "c.run(__file__" in file.read() and not path.endswith("from_file.py"):
                names.append(os.path.basename(path)[:-3])
    return names


def build(name: str, *words: str):
    script = importlib.import_module(name)
    wishes = ["--out", "unused.blend", "--resolution", "64x36", *words]
    script.build(common.parse_arguments("test", getattr(script, "options", None), wishes))
    return bpy.context.scene


def digest(scene) -> str:
    """Of all numbers that decide what is seen: meshes, places in the first and last frame, pictures."""
    found = hashlib.sha256()
    for mesh in sorted(bpy.data.meshes, key=lambda one: one.name):
        points = np.empty(len(mesh.vertices) * 3, np.float32)
        mesh.vertices.foreach_get("co", points)
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        found.update(mesh.name.encode() + points.tobytes() + corners.tobytes())
    for image in sorted(bpy.data.images, key=lambda one: one.name):
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        found.update(pixels.tobytes())
    for frame in (1, scene.frame_end):
        scene.frame_set(frame)
        for item in sorted(scene.objects, key=lambda one: one.name):
            found.update(item.name.encode() + np.array(item.matrix_world, np.float32).tobytes())
    return found.hexdigest()


def test_every_scene_builds_the_same_twice() -> None:
    names = scenes()
    assert set(OBJECTS) <= set(names), names
    for name in names:
        for words in VARIANTS.get(name, ([],)):
            scene = build(name, *words)
            there = {item.name for item in scene.objects}
            assert OBJECTS.get(name, set()) <= there, (name, words, there)
            assert scene.camera is not None and (scene.frame_start, scene.frame_end) == (1, 100)
            suns = [item.data for item in scene.objects if item.type == "LIGHT"]
            assert [sun.angle for sun in suns] == [0.0], (name, suns)
            animated = [item for item in scene.objects if item.animation_data]
            if name in OBJECTS:
                assert bool(animated) == any(word in MOVES for word in words), (name, words)
            first = digest(scene)
            assert first == digest(build(name, *words)), f"{name} {words} differs when built again"


def test_slits_and_fibres_keep_their_pixels() -> None:
    """In a small picture slits and fibres are wider, and fibres fewer."""

    def slit(name: str, size: str) -> float:
        build(name, "--resolution", size)
        heights = sorted({round(v.co.z, 6) for v in bpy.data.meshes["Blinds Slats"].vertices})
        return heights[2] - heights[1]

    def fibres(size: str) -> tuple[float, int]:
        build("hairball", "--resolution", size)
        ends = bpy.data.meshes["Hairball"].vertices
        return (ends[0].co - ends[1].co).length, len(ends)

    for name in ("blinds", "hard_edges"):
        assert abs(slit(name, "160x90") / slit(name, "800x450") - 5.0) < 0.02, name
    (wide, few), (narrow, many) = fibres("32x18"), fibres("96x54")
    assert abs(wide / narrow - 3.0) < 0.001 and many == 3 * few, (wide, narrow, few, many)


def png(path: str, alpha: np.ndarray, mask: bool = False) -> None:
    """White of 8 x 8 with a fourth channel, or the alpha as a grey mask."""
    pixels = np.full((8, 8, 4), 1.0, np.float32)
    pixels[..., 3] = alpha
    if mask:
        pixels = np.repeat(alpha[..., None], 3, axis=2).astype(np.float32)
    out = oiio.ImageOutput.create(path)
    out.open(path, oiio.ImageSpec(8, 8, pixels.shape[2], "uint8"))
    out.write_image(np.ascontiguousarray(pixels))
    out.close()


def shown(*words: str) -> np.ndarray:
    """Coverage of a picture of 64 x 36, seen along +y by a camera before the origin; 8 m are 64 pixels."""
    camera = ("--camera", "0", "-10", "0", "--target", "0", "0", "0", "--lens", "45")
    scene = build("from_file", *words, *camera)
    scene.render.film_transparent, scene.cycles.samples, scene.cycles.device = True, 1, "CPU"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.filepath = os.path.join(t.temporary_folder(), "picture.exr")
    bpy.ops.render.render(write_still=True)
    return oiio.ImageBuf(scene.render.filepath).get_pixels()[..., 3]


def covered(picture: np.ndarray, centre_x: float) -> tuple[bool, bool]:
    """Whether the left and the right half of a square at x are there."""
    at = lambda x: picture[18, int(round(32 + 8 * x))] > 0.5  # noqa: E731
    return bool(at(centre_x - 0.4)), bool(at(centre_x + 0.4))


def left_half_clear() -> np.ndarray:
    alpha = np.ones((8, 8), np.float32)
    alpha[:, :4] = 0.0
    return alpha


def test_obj_with_holes() -> None:
    """A mask, holes in the colour picture, the old `d 0` of an opaque surface, and a picture that is not there."""
    model = obj_of_squares()
    assert refused(model) == 3, "a picture that is not there"
    picture = shown(model, "--ignore-missing")
    found = [covered(picture, x) for x in (-3.0, -1.0, 1.0, 3.0)]
    assert found == [(False, True), (False, True), (True, True), (True, True)], found


def refused(*words: str) -> int:
    """Exit code of a model that cannot be shown."""
    script = importlib.import_module("from_file")
    try:
        arguments = common.parse_arguments(
            "test", script.options, ["--out", "unused.blend", *words]
        )
        script.inputs(arguments)
        script.build(arguments)
    except SystemExit as stop:
        return stop.code
    raise AssertionError(f"{words} was taken")


def test_what_cannot_be_shown_is_refused() -> None:
    folder = t.temporary_folder()

    def file(name: str, text: str) -> str:
        path = os.path.join(folder, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        return path

    triangle = "v 0 0 0\nv 1 0 0\nv 0 0 1\n"
    assert refused(os.path.join(folder, "nowhere.obj")) == 3
    assert refused(file("points.obj", triangle)) == 3
    assert refused(file("flat.obj", "v 1 1 1\n" * 3 + "f 1 2 3\n")) == 3
    assert refused(file("dressed.obj", "mtllib lost.mtl\n" + triangle + "f 1 2 3\n")) == 3
    assert refused(file("broken.gltf", "{")) == 3
    assert refused(file("model.stl", "")) == 2
    assert refused(file("good.obj", triangle + "f 1 2 3\n"), "--scale", "0") == 2
    build("from_file", os.path.join(folder, "good.obj"))


def test_view_from_outside() -> None:
    """The whole model fills nine tenths of the picture, one way or the other; turning, it never leaves the picture."""
    model = obj_of_squares()

    def reach(scene) -> float:
        """How far from the middle the model is seen: 1 at the picture's rim."""
        place = lambda x, z: bpy.data.objects["Model"].matrix_world @ t.Vector(
            (x, 0.0, z)
        )  # noqa: E731
        ends = [place(x, z) for x in (-3.8, 3.8) for z in (-0.8, 0.8)]
        seen = [
            bpy_extras.object_utils.world_to_camera_view(scene, scene.camera, end) for end in ends
        ]
        return max(2 * abs(value - 0.5) for one in seen for value in one[:2])

    for words in (
        [],
        ["--roll", "20"],
        ["--resolution", "36x64"],
        ["--lens", "80"],
        ["--scale", "2"],
    ):
        scene = build("from_file", model, "--ignore-missing", *words)
        bpy.context.view_layer.update()
        assert abs(reach(scene) - 0.9) < 0.001, (words, reach(scene))
    scene = build("from_file", model, "--ignore-missing", "--turn", "3.6")
    found = []
    for frame in range(1, 101):
        scene.frame_set(frame)
        found.append(reach(scene))
    assert 0.87 < max(found) < 0.91, max(found)


def test_turn_and_path() -> None:
    """The model turns about its middle; the camera moves along its path; a view from within stands in it."""
    model = obj_of_squares()
    path = ("--turn", "3", "--camera-to", "1", "-9", "1")
    scene = build("from_file", model, "--ignore-missing", "--scale", "2", *path)
    assert (scene.frame_start, scene.frame_end) == (1, 100)
    places = []
    for frame in (1, 31, 100):
        scene.frame_set(frame)
        places.append(bpy.data.objects["Square3"].matrix_world @ t.Vector((3.0, 0.0, 0.0)))
    assert (places[0] - t.Vector((6.0, 0.0, 0.0))).length < 1e-4, places
    assert (places[1] - t.Vector((0.0, 6.0, 0.0))).length < 1e-4, places
    assert (scene.camera.matrix_world.translation - t.Vector((1.0, -9.0, 1.0))).length < 1e-4

    scene = build("from_file", model, "--ignore-missing", "--view", "inside", "--frames", "7")
    assert scene.frame_end == 7
    (
        place,
        ahead,
    ) = scene.camera.matrix_world.translation, scene.camera.matrix_world.to_3x3() @ t.Vector(
        (0, 0, -1)
    )
    assert -3.8 < place.x < -1.9 and abs(ahead.x - 1.0) < 1e-4, (place, ahead)


def obj_of_squares() -> str:
    """Four squares side by side, each of a material of its own; y is up and they look along z."""
    folder = t.temporary_folder()
    png(os.path.join(folder, "mask.png"), left_half_clear(), mask=True)
    png(os.path.join(folder, "holes.png"), left_half_clear())
    lines = ["mtllib model.mtl"]
    materials = (
        "newmtl mask\nKd 0.5 0.5 0.5\nmap_d mask.png\n",
        "newmtl holes\nKd 0.5 0.5 0.5\nmap_Kd holes.png\n",
        "newmtl old\nKd 0.5 0.5 0.5\nd 0.0\n",
        "newmtl lost\nKd 0.5 0.5 0.5\nmap_Kd nowhere.png\n",
    )
    for index, x in enumerate((-3.0, -1.0, 1.0, 3.0)):  # y up, looking along -z
        corners = ((x - 0.8, -0.8), (x + 0.8, -0.8), (x + 0.8, 0.8), (x - 0.8, 0.8))
        lines += [f"o Square{index}", *(f"v {a} {b} 0" for a, b in corners)]
        lines += [f"vt {a} {b}" for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        first = 4 * index + 1
        lines += ["usemtl " + materials[index].split()[1]]
        lines += ["f " + " ".join(f"{first + k}/{first + k}" for k in range(4))]
    model = os.path.join(folder, "model.obj")
    for path, text in ((model, "\n".join(lines) + "\n"), (model[:-3] + "mtl", "".join(materials))):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    return model


def test_gltf_with_holes() -> None:
    """alphaMode MASK cuts; OPAQUE does not, whatever the picture's alpha says."""
    folder = t.temporary_folder()
    png(os.path.join(folder, "holes.png"), left_half_clear())
    points = np.array([(-0.8, -0.8, 0), (0.8, -0.8, 0), (0.8, 0.8, 0), (-0.8, 0.8, 0)], np.float32)
    places = np.array([(0, 1), (1, 1), (1, 0), (0, 0)], np.float32)
    corners = np.array([0, 1, 2, 0, 2, 3], np.uint16)
    parts = [part.tobytes() for part in (points, places, corners)]
    views, start = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": start, "byteLength": len(part)})
        start += len(part)
    picture = {"baseColorTexture": {"index": 0}, "metallicFactor": 0}
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            {"name": "Cut", "mesh": 0, "translation": [-1, 0, 0]},
            {"name": "Whole", "mesh": 1, "translation": [1, 0, 0]},
        ],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": m}]}
            for m in (0, 1)
        ],
        "materials": [
            {"pbrMetallicRoughness": picture, "alphaMode": "MASK", "doubleSided": True},
            {"pbrMetallicRoughness": picture, "doubleSided": True},
        ],
        "textures": [{"source": 0}],
        "images": [{"uri": "holes.png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
             "min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [
            {"byteLength": start,
             "uri": "data:application/octet-stream;base64," + base64.b64encode(b"".join(parts)).decode()}
        ],
    }  # fmt: skip
    model = os.path.join(folder, "model.gltf")
    with open(model, "w", encoding="utf-8") as file:
        json.dump(document, file)
    picture = shown(model)
    assert covered(picture, -1.0) == (False, True) and covered(picture, 1.0) == (True, True)


def test_fbx_with_holes() -> None:
    """What Blender's own exporter writes of a square whose colour picture has holes."""
    folder = t.temporary_folder()
    png(os.path.join(folder, "holes.png"), left_half_clear())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    surface = bpy.data.materials.new("Holes")
    surface.use_nodes = True
    tree = surface.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.load(os.path.join(folder, "holes.png"))
    principled = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    tree.links.new(texture.outputs["Color"], principled.inputs["Base Color"])
    square = t.Vector((0.8, 0.0, 0.0)), t.Vector((0.0, 0.0, 0.8))
    common.add_squares("Square", [(t.Vector((-1.0, 0.0, 0.0)), *square)], surface)
    model = os.path.join(folder, "model.fbx")
    with importlib.import_module("from_file").old_numpy_names():
        bpy.ops.export_scene.fbx(filepath=model, path_mode="RELATIVE")
    assert covered(shown(model), -1.0) == (False, True)


if __name__ == "__main__":
    t.main(
        test_every_scene_builds_the_same_twice,
        test_slits_and_fibres_keep_their_pixels,
        test_obj_with_holes,
        test_what_cannot_be_shown_is_refused,
        test_view_from_outside,
        test_turn_and_path,
        test_gltf_with_holes,
        test_fbx_with_holes,
    )
