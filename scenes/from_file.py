# SPDX-License-Identifier: MIT
"""from_file: an OBJ or glTF model of your own as a scene, with a camera, its path and a sun by options.

For the assets that the sources measured and that cannot lie here: the Crytek Sponza and McGuire's hairball of
[Oliveros 2018, 4.1]. Materials become matt ones without noise, as in the other scenes: colour and its texture stay, alpha
is cut at one half, gloss goes (the thesis had it off). The model's own lights are left out.

usage: blender -b --python-exit-code 9 -P scenes/from_file.py -- MODEL --out build/scenes/NAME.blend [options]
"""

from __future__ import annotations

import argparse
import contextlib
import math
import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)

bpy = c.bpy
ENDINGS = (".obj", ".gltf", ".glb")
GREY: c.RGB = (0.5, 0.5, 0.5)


def _model(text: str) -> str:
    if not text.lower().endswith(ENDINGS):
        raise argparse.ArgumentTypeError(f"expected a file {', '.join(ENDINGS)}, found '{text}'")
    if not os.path.isfile(text):
        raise argparse.ArgumentTypeError(f"there is no file '{text}'")
    return os.path.abspath(text)


def options(parser: argparse.ArgumentParser) -> None:
    """What the file does not say. After the import z is up; lengths are those of the scaled model."""
    point = dict(type=float, nargs=3, metavar=("X", "Y", "Z"))
    parser.add_argument("model", type=_model, help="OBJ, glTF or GLB file")
    parser.add_argument("--scale", type=float, default=1.0, help="0.01 for centimetres (1)")
    parser.add_argument("--camera", **point, help="where it stands (before the whole model)")
    parser.add_argument("--target", **point, help="what it looks at (the model's middle)")
    parser.add_argument("--camera-to", **point, help="where the camera is in the last frame")
    parser.add_argument("--target-to", **point, help="what it looks at in the last frame")
    parser.add_argument("--lens", type=float, default=35.0, help="mm, of a 36 mm sensor (35)")
    parser.add_argument("--roll", type=float, default=0.0, help="of the camera, degrees (0)")
    parser.add_argument("--sun", type=float, nargs=2, default=(-60.0, 50.0), metavar=("AZIMUTH", "HEIGHT"),
        help="degrees, from +x towards +y and above the horizon (-60 50)")  # fmt: skip
    parser.add_argument(
        "--turn",
        type=float,
        default=0.0,
        help="of the model about its middle, degrees per frame (0)",
    )
    parser.add_argument("--frames", type=int, default=100, help="length of the path (100)")
    parser.add_argument("--unlit", action="store_true", help="black on white: the silhouette alone")
    parser.add_argument(
        "--materials", choices=("matt", "imported"), default="matt",
        help="imported: as Blender's importer made them, gloss and half transparent ones too",
    )  # fmt: skip


@contextlib.contextmanager
def _old_numpy_names():
    """Names that numpy dropped and the glTF importer of older Blenders still asks for."""
    names = {name: kind for name, kind in (("bool", bool), ("int", int), ("float", float), ("object", object))
             if name not in vars(np)}  # fmt: skip
    for name, kind in names.items():
        setattr(np, name, kind)
    try:
        yield
    finally:
        for name in names:
            delattr(np, name)


def import_model(path: str) -> list:
    """The meshes of a model; ends the process with 3 where it has none or cannot be read."""
    before = set(bpy.data.objects)
    try:
        if path.lower().endswith(".obj"):
            bpy.ops.wm.obj_import(filepath=path)
        else:
            with _old_numpy_names():
                bpy.ops.import_scene.gltf(filepath=path)
    except RuntimeError as error:
        print(f"error: {path}: Blender's importer says: {str(error).strip()}", file=sys.stderr)
        sys.exit(3)
    found = [item for item in bpy.data.objects if item not in before]
    for item in found:
        if item.type == "LIGHT":
            bpy.data.objects.remove(item)
    meshes = [item for item in bpy.context.scene.objects if item.type == "MESH"]
    if not meshes:
        print(f"error: {path}: expected a model with faces, found none", file=sys.stderr)
        sys.exit(3)
    return meshes


def _images_before(socket) -> list:
    """Image nodes that a socket hangs on."""
    found, waiting, seen = [], [link.from_node for link in socket.links], set()
    while waiting:
        node = waiting.pop()
        if node in seen:
            continue
        seen.add(node)
        if node.bl_idname == "ShaderNodeTexImage":
            found.append(node)
        waiting += [link.from_node for entry in node.inputs for link in entry.links]
    return found


def _missing(node) -> bool:
    image = node.image
    if image is None:
        return True
    return not image.packed_file and not os.path.exists(bpy.path.abspath(image.filepath))


def _cuts(image) -> bool:
    """Whether an image's alpha has holes: values on both sides of one half."""
    if image.channels < 4:
        return False
    pixels = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    alpha = pixels[3::4]
    return bool(alpha.size) and alpha.min() <= 0.5 < alpha.max()


def _alpha_of(principled, colours: list):
    """Socket that cuts the surface out, or None. A constant alpha is no cut-out: old MTL files say 0 for opaque."""
    entry = principled.inputs["Alpha"]
    masks = _images_before(entry)
    if entry.links and masks and not any(map(_missing, masks)):
        socket = entry.links[0].from_socket
        node = socket.node
        if node.bl_idname == "ShaderNodeTexImage" and not _cuts(node.image):
            return node.outputs["Color"]  # a grey mask
        return socket
    if not entry.links:  # an OBJ whose colour picture has the holes
        holes = [node for node in colours if _cuts(node.image)]
        return holes[0].outputs["Alpha"] if holes else None
    return None


def make_matt(surface, of_obj: bool, unlit: bool) -> None:
    """Rebuilds an imported material out of its own colour and alpha."""
    c.no_light_source(surface)
    tree = surface.node_tree
    principled = next((n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled"), None)
    albedo, alpha = tuple(surface.diffuse_color[:3]), None
    if principled is None:
        print(
            f"note: material '{surface.name}' has no Principled shader; its viewport colour is shown"
        )
    else:
        entry = principled.inputs["Base Color"]
        colours = _images_before(entry)
        lost = [
            node for node in colours + _images_before(principled.inputs["Alpha"]) if _missing(node)
        ]
        for node in lost:
            name = os.path.basename(node.image.filepath) if node.image else "(none)"
            print(
                f"note: material '{surface.name}': there is no picture '{name}'; it is shown without"
            )
        colours = [node for node in colours if node not in lost]
        if entry.links and not any(node in lost for node in _images_before(entry)):
            albedo = entry.links[0].from_socket
        else:
            albedo = GREY if entry.links else tuple(entry.default_value[:3])
        alpha = _alpha_of(principled, colours if of_obj else [])
        if alpha is not None:
            for node in colours:  # else the colour fades towards the holes
                node.image.alpha_mode = "CHANNEL_PACKED"
    output = tree.get_output_node("ALL") or tree.nodes.new("ShaderNodeOutputMaterial")
    shader = c.matt(tree, (0.0, 0.0, 0.0) if unlit else albedo, lit=not unlit)
    if alpha is not None:
        shader = c.cut_out_by(tree, shader, alpha)
    tree.links.new(shader, output.inputs["Surface"])
    if principled is not None:
        tree.nodes.remove(principled)


def _dress(meshes: list, arguments) -> None:
    """Gives every face a material of the wished kind."""
    plain = None
    for item in meshes:
        for slot in item.material_slots:
            if slot.material is None:
                plain = plain or c.material("No Material", GREY)
                slot.material = plain
        if not item.material_slots:
            plain = plain or c.material("No Material", GREY)
            item.data.materials.append(plain)
    surfaces = {slot.material for item in meshes for slot in item.material_slots} - {plain}
    if arguments.materials == "matt":
        for surface in sorted(surfaces, key=lambda one: one.name):
            make_matt(surface, arguments.model.lower().endswith(".obj"), arguments.unlit)


def _hold(scene, scale: float) -> object:
    """An empty that carries the whole model, scaled."""
    roots = [item for item in scene.objects if item.parent is None]
    holder = bpy.data.objects.new("Model", None)
    scene.collection.objects.link(holder)
    for item in roots:
        item.parent = holder
    holder.scale = (scale, scale, scale)
    bpy.context.view_layer.update()
    return holder


def _bounds(meshes: list) -> tuple:
    """Middle of the meshes' box and half of its diagonal."""
    corners = [item.matrix_world @ c.Vector(corner) for item in meshes for corner in item.bound_box]
    low = c.Vector([min(corner[axis] for corner in corners) for axis in range(3)])
    high = c.Vector([max(corner[axis] for corner in corners) for axis in range(3)])
    return (low + high) / 2, (high - low).length / 2


def _add_camera(scene, arguments, middle, radius: float) -> None:
    width, height = arguments.resolution
    half_angle = math.atan(18.0 * min(1.0, height / width) / arguments.lens)
    away = c.Vector((-0.35, -1.0, 0.3)).normalized() * radius / math.sin(half_angle)
    target = c.Vector(arguments.target or middle)
    location = c.Vector(arguments.camera or target + away)
    camera = c.add_camera(scene, location, target, arguments.lens, arguments.roll)
    camera.data.clip_start = radius / 2000
    camera.data.clip_end = 4 * radius + (location - middle).length
    if not (arguments.camera_to or arguments.target_to):
        return
    rotation = camera.matrix_world.to_euler()
    end, end_target = c.Vector(arguments.camera_to or location), c.Vector(
        arguments.target_to or target
    )
    aim = (end_target - end).to_track_quat("-Z", "Y").to_matrix()
    aim = aim @ c.Matrix.Rotation(math.radians(arguments.roll), 3, "Z")
    last = arguments.frames
    c.key_linear(camera, "location", [(1, location), (last, end)])
    c.key_linear(camera, "rotation_euler", [(1, rotation), (last, aim.to_euler("XYZ", rotation))])


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution, arguments.frames)
    scene.cycles.transparent_max_bounces = 64  # many leaves in a row
    sky = ((0.9, 0.9, 0.9),) * 2 if arguments.unlit else ((0.66, 0.77, 0.90), (0.14, 0.32, 0.68))
    c.add_sky(scene, *sky)
    meshes = import_model(arguments.model)
    scene.frame_start, scene.frame_end = 1, arguments.frames  # an importer may set its own
    scene.frame_set(1)
    _dress(meshes, arguments)
    holder = _hold(scene, arguments.scale)
    middle, radius = _bounds(meshes)
    if arguments.turn:
        pivot = c.Matrix.Translation(middle)
        for item in (i for i in scene.objects if i.parent == holder):
            item.matrix_parent_inverse = c.Matrix.Translation(-middle / arguments.scale)
        holder.matrix_world = pivot @ c.Matrix.Scale(arguments.scale, 4)
        turn = math.radians(arguments.turn * (arguments.frames - 1))
        c.key_linear(holder, "rotation_euler", [(1, (0, 0, 0)), (arguments.frames, (0, 0, turn))])
    c.add_sun(scene, *arguments.sun)
    _add_camera(scene, arguments, middle, radius)


def inputs(arguments) -> list[str]:
    """The model and the files of its name beside it."""
    stem = os.path.splitext(arguments.model)[0]
    return [arguments.model, *filter(os.path.exists, (f"{stem}.mtl", f"{stem}.bin"))]


if __name__ == "__main__":
    c.run(__file__, __doc__, build, options, inputs)
