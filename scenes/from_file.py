# SPDX-License-Identifier: MIT
"""from_file: an OBJ, glTF or FBX model of your own as a scene, with a camera, its path and a sun by options.

For the assets that the sources measured and that cannot lie here: the Crytek Sponza and McGuire's hairball of
[Oliveros 2018, 4.1]. Materials become matt ones without noise, as in the other scenes: colour and its texture stay, gloss
goes (the thesis had it off), the model's own lights and cameras are left out. Alpha becomes a cut-out at one half, be it a
mask (map_d), the alpha of the colour picture, or a glTF material of mode MASK or BLEND; a constant alpha, as of glass, is
shown opaque.

usage: blender -b --python-exit-code 9 -P scenes/from_file.py -- MODEL --out build/scenes/NAME.blend [options]

Exit code 3: the model or what it refers to is not there, cannot be read, or shows nothing.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import math
import os
import sys
from typing import NoReturn

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)

bpy = c.bpy
ENDINGS = (".obj", ".gltf", ".glb", ".fbx")
GREY: c.RGB = (0.5, 0.5, 0.5)
FILLED = 0.9  # of the picture, by the box about the model


def _stop(message: str) -> NoReturn:
    print(f"error: {message}", file=sys.stderr)
    sys.exit(3)


def _model(text: str) -> str:
    if not text.lower().endswith(ENDINGS):
        raise argparse.ArgumentTypeError(f"expected a file {', '.join(ENDINGS)}, found '{text}'")
    return os.path.abspath(text)


def _above_zero(kind):
    def read(text: str):
        value = kind(text)
        if not 0 < value < math.inf:
            raise argparse.ArgumentTypeError(f"expected a number above 0, found '{text}'")
        return value

    return read


def options(parser: argparse.ArgumentParser) -> None:
    """What the file does not say. After the import z is up; lengths are those of the scaled model."""
    point = dict(type=float, nargs=3, metavar=("X", "Y", "Z"))
    size, count = _above_zero(float), _above_zero(int)
    parser.add_argument("model", type=_model, help="OBJ, glTF, GLB or FBX file")
    parser.add_argument("--scale", type=size, default=1.0, help="0.01 for centimetres (1)")
    parser.add_argument(
        "--view", choices=("outside", "inside"), default="outside",
        help="before the whole model, or in it at one end of its length, looking to the other (outside)",
    )  # fmt: skip
    parser.add_argument("--camera", **point, help="where it stands, in place of the view's")
    parser.add_argument("--target", **point, help="what it looks at, in place of the view's")
    parser.add_argument("--camera-to", **point, help="where the camera is in the last frame")
    parser.add_argument("--target-to", **point, help="what it looks at in the last frame")
    parser.add_argument("--lens", type=size, default=35.0, help="mm, of a 36 mm sensor (35)")
    parser.add_argument("--roll", type=float, default=0.0, help="of the camera, degrees (0)")
    parser.add_argument("--sun", type=float, nargs=2, default=(-60.0, 50.0), metavar=("AZIMUTH", "HEIGHT"),
        help="degrees, from +x towards +y and above the horizon (-60 50)")  # fmt: skip
    parser.add_argument(
        "--turn", type=float, default=0.0,
        help="of the model about the upright axis through its middle, degrees per frame (0)",
    )  # fmt: skip
    parser.add_argument("--frames", type=count, default=100, help="length of the path (100)")
    parser.add_argument("--unlit", action="store_true", help="black on white: the silhouette alone")
    parser.add_argument(
        "--ignore-missing", action="store_true", help="show grey where a picture is not there"
    )


def _named_in(model: str) -> list[str]:
    """Files beside a model that it names at its beginning: an OBJ's materials, a glTF's buffers."""
    folder = os.path.dirname(model)
    names = []
    try:
        if model.lower().endswith(".obj"):
            with open(model, encoding="utf-8", errors="replace") as file:
                for line in file.read(65536).splitlines():
                    if line.startswith("mtllib "):
                        rest = line.split(None, 1)[
                            1
                        ].strip()  # one name, with blanks or without, or several
                        whole = os.path.isfile(os.path.join(folder, rest))
                        names += [rest] if whole else rest.split()
        elif model.lower().endswith(".gltf"):
            with open(model, encoding="utf-8") as file:
                buffers = json.load(file).get("buffers", [])
            names = [
                one["uri"] for one in buffers if not one.get("uri", "data:").startswith("data:")
            ]
    except OSError as error:
        _stop(f"{model}: expected a model, found none that can be read ({error.strerror})")
    except (ValueError, AttributeError) as error:
        _stop(f"{model}: expected a glTF file, found one that is no JSON of its kind ({error})")
    return [os.path.join(folder, name.replace("\\", "/")) for name in names]


def inputs(arguments) -> list[str]:
    """The model and what it names; ends the process with 3 where one is not there."""
    if not os.path.isfile(arguments.model):
        _stop(f"{arguments.model}: expected a model, found no such file")
    beside = _named_in(arguments.model)
    lost = [path for path in beside if not os.path.isfile(path)]
    if lost and not arguments.ignore_missing:
        _stop(f"{arguments.model} names what is not there: {', '.join(lost)}")
    return [arguments.model, *(path for path in beside if path not in lost)]


@contextlib.contextmanager
def old_numpy_names():
    """Names that numpy dropped and the importers of older Blenders still ask for."""
    kinds = {"bool": bool, "int": int, "float": float, "object": object}
    names = {name: kind for name, kind in kinds.items() if name not in vars(np)}
    for name, kind in names.items():
        setattr(np, name, kind)
    try:
        yield
    finally:
        for name in names:
            delattr(np, name)


def import_model(path: str) -> list:
    """The meshes of a model; ends the process with 3 where it has none or cannot be read."""
    ending = os.path.splitext(path)[1].lower()
    try:
        with old_numpy_names():
            if ending == ".obj":
                bpy.ops.wm.obj_import(filepath=path)
            elif ending != ".fbx":
                bpy.ops.import_scene.gltf(filepath=path)
            elif "fbx_import" in dir(bpy.ops.wm):  # newer than the add-on's
                bpy.ops.wm.fbx_import(filepath=path)
            else:
                bpy.ops.import_scene.fbx(filepath=path)
    except RuntimeError as error:
        _stop(f"{path}: Blender's importer says: {str(error).strip()}")
    for item in list(bpy.context.scene.objects):
        if item.type in ("LIGHT", "CAMERA"):
            bpy.data.objects.remove(item)
    meshes = [
        item for item in bpy.context.scene.objects if item.type == "MESH" and item.data.polygons
    ]
    if not meshes:
        _stop(f"{path}: expected a model with faces, found none")
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
    """Whether a node's picture is not there or cannot be read."""
    return node.image is None or not min(node.image.size)


def _picture_name(node) -> str:
    image = node.image
    if image is None:
        return "(none)"
    return bpy.path.abspath(image.filepath) or image.name


def _cuts(image) -> bool:
    """Whether an image's alpha has holes: values on both sides of one half."""
    if image.channels < 4:
        return False
    pixels = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    alpha = pixels[3::4]
    return bool(alpha.size) and alpha.min() <= 0.5 < alpha.max()


def _principled(surface):
    nodes = surface.node_tree.nodes if surface.node_tree else []
    return next((node for node in nodes if node.bl_idname == "ShaderNodeBsdfPrincipled"), None)


def _lost_pictures(surfaces: list) -> list[str]:
    """Pictures that the colour or alpha of a material needs and that are not there."""
    found = set()
    for surface in surfaces:
        principled = _principled(surface)
        for name in ("Base Color", "Alpha") if principled else ():
            found |= {
                _picture_name(n) for n in _images_before(principled.inputs[name]) if _missing(n)
            }
    return sorted(found)


def _alpha_of(principled, colours: list):
    """Socket that cuts the surface out, or None. A constant alpha is no cut-out: old MTL files say 0 for opaque.

    ``colours``: pictures of the colour that may hold the holes though nothing says so."""
    entry = principled.inputs["Alpha"]
    masks = _images_before(entry)
    if entry.links and masks and not any(map(_missing, masks)):
        socket = entry.links[0].from_socket
        node = socket.node
        if node.bl_idname == "ShaderNodeTexImage" and not _cuts(node.image):
            return node.outputs["Color"]  # a grey mask
        return socket
    if not entry.links:
        holes = [node for node in colours if _cuts(node.image)]
        return holes[0].outputs["Alpha"] if holes else None
    return None


def make_matt(surface, states_alpha: bool, unlit: bool) -> None:
    """Rebuilds an imported material out of its own colour and alpha.

    ``states_alpha``: the file's format says of each material whether its colour's alpha counts."""
    principled = _principled(surface)
    albedo, alpha = tuple(surface.diffuse_color[:3]), None
    if principled is None:
        print(f"note: material '{surface.name}' has no Principled shader; its flat colour is shown")
        surface.use_nodes = True
    else:
        entry = principled.inputs["Base Color"]
        colours = _images_before(entry)
        if not entry.links:
            albedo = tuple(entry.default_value[:3])
        else:
            albedo = GREY if any(map(_missing, colours)) else entry.links[0].from_socket
        colours = [node for node in colours if not _missing(node)]
        alpha = _alpha_of(principled, [] if states_alpha else colours)
        if alpha is not None:
            for node in colours:  # else the colour fades towards the holes
                node.image.alpha_mode = "CHANNEL_PACKED"
    c.no_light_source(surface)
    tree = surface.node_tree
    output = tree.get_output_node("ALL") or tree.nodes.new("ShaderNodeOutputMaterial")
    shader = c.matt(tree, (0.0, 0.0, 0.0) if unlit else albedo, lit=not unlit)
    if alpha is not None:
        shader = c.cut_out_by(tree, shader, alpha)
    tree.links.new(shader, output.inputs["Surface"])
    if principled is not None:
        tree.nodes.remove(principled)


def _dress(meshes: list, arguments) -> None:
    """Gives every face a matt material."""
    plain = c.material(
        "No Material", (0.0, 0.0, 0.0) if arguments.unlit else GREY, lit=not arguments.unlit
    )
    for item in meshes:
        if not item.material_slots:
            item.data.materials.append(plain)
        for slot in item.material_slots:
            slot.material = slot.material or plain
    found = {slot.material for item in meshes for slot in item.material_slots} - {plain}
    surfaces = sorted(found, key=lambda one: one.name)
    lost = _lost_pictures(surfaces)
    if lost and not arguments.ignore_missing:
        _stop(
            f"{arguments.model}: {len(lost)} of its pictures are not there or cannot be read: {', '.join(lost)}; "
            "put them where the model expects them, or pass --ignore-missing to see grey in their place"
        )
    for name in lost:
        print(f"note: there is no picture {name}; grey is shown")
    stated = arguments.model.lower().endswith((".gltf", ".glb"))
    for surface in surfaces:
        make_matt(surface, stated, arguments.unlit)


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
    """Low and high corner of the box about all meshes."""
    corners = [item.matrix_world @ c.Vector(corner) for item in meshes for corner in item.bound_box]
    low = c.Vector([min(corner[axis] for corner in corners) for axis in range(3)])
    high = c.Vector([max(corner[axis] for corner in corners) for axis in range(3)])
    return low, high


def _turn_about(scene, holder, middle, scale: float, degrees_per_frame: float, frames: int) -> None:
    """Lets the model turn about the upright axis through its middle, which stays where it is."""
    for item in scene.objects:
        if item.parent == holder:
            item.matrix_parent_inverse = c.Matrix.Translation(-middle / scale)
    holder.location = middle
    turn = math.radians(degrees_per_frame * (frames - 1))
    c.key_linear(holder, "rotation_euler", [(1, (0, 0, 0)), (frames, (0, 0, turn))])


def _viewpoint(arguments, low, high) -> tuple:
    """Where the camera stands and what it looks at."""
    middle = (low + high) / 2
    if arguments.view == "inside":
        axis = 0 if high.x - low.x >= high.y - low.y else 1
        place = c.Vector((middle.x, middle.y, low.z + 0.25 * (high.z - low.z)))
        target = place.copy()
        place[axis] = low[axis] + 0.15 * (high[axis] - low[axis])
        target[axis] = high[axis]
        return c.Vector(arguments.camera or place), c.Vector(arguments.target or target)
    target = c.Vector(arguments.target or middle)
    away = c.Vector((-0.35, -1.0, 0.3)).normalized()
    distance = _distance_to_see(arguments, low, high, target, away)
    return c.Vector(arguments.camera or target + away * distance), target


def _distance_to_see(arguments, low, high, target, away) -> float:
    """How far away the camera must stand for the whole box to be seen, turned about its middle where it turns."""
    right = c.Vector((0.0, 0.0, 1.0)).cross(away).normalized()
    axes = c.Matrix((right, away.cross(right), away))  # to the right, up, towards the camera
    axes = c.Matrix.Rotation(math.radians(-arguments.roll), 3, "Z") @ axes
    width, height = arguments.resolution
    slope = 18.0 / arguments.lens / max(width, height)  # per pixel from the picture's middle
    middle = (low + high) / 2
    farthest = 0.0
    for degrees in range(0, 360, 15) if arguments.turn else (0,):
        turn = c.Matrix.Rotation(math.radians(degrees), 3, "Z")
        for x, y, z in itertools.product(*zip(low, high)):
            corner = axes @ (middle + turn @ (c.Vector((x, y, z)) - middle) - target)
            aside = max(abs(corner.x) / width, abs(corner.y) / height)
            farthest = max(farthest, corner.z + aside / (slope * FILLED))
    return farthest


def _add_camera(scene, arguments, low, high) -> None:
    """The camera and, where a second place or target is given, its path."""
    location, target = _viewpoint(arguments, low, high)
    end = c.Vector(arguments.camera_to or location)
    end_target = c.Vector(arguments.target_to or target)
    if min((target - location).length, (end_target - end).length) == 0.0:
        _stop(f"{arguments.model}: the camera stands where it looks; pass --camera or --target")
    camera = c.add_camera(scene, location, target, arguments.lens, arguments.roll)
    size = (high - low).length
    camera.data.clip_start = size / 4000
    camera.data.clip_end = 2 * size + max(
        (one - (low + high) / 2).length for one in (location, end)
    )
    if not (arguments.camera_to or arguments.target_to):
        return
    rotation = camera.matrix_world.to_euler()
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
    scene.render.fps = 24
    scene.frame_set(1)
    _dress(meshes, arguments)
    holder = _hold(scene, arguments.scale)
    low, high = _bounds(meshes)
    if not (high - low).length > 0.0:
        _stop(
            f"{arguments.model}: expected a model of some size, found all its points in one place"
        )
    if arguments.turn:
        _turn_about(
            scene, holder, (low + high) / 2, arguments.scale, arguments.turn, arguments.frames
        )
    c.add_sun(scene, *arguments.sun)
    _add_camera(scene, arguments, low, high)
    triangles = sum(len(face.vertices) - 2 for item in meshes for face in item.data.polygons)
    box = " x ".join(f"{edge:.4g}" for edge in high - low)
    print(f"{len(meshes)} meshes, {triangles} triangles, {box} m; camera at "
          f"{', '.join(f'{place:.4g}' for place in scene.camera.matrix_world.translation)}")  # fmt: skip


if __name__ == "__main__":
    c.run(__file__, __doc__, build, options, inputs)
