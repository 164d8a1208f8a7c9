# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on's tests share: small scenes, an export in the running Blender or in a child, and reading of shots.

Each test is a script for ``blender -b --factory-startup --python-exit-code 9 -P tests/addon/test_x.py``; it fails by
an exception. Nothing here computes an expected value with the code under test.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import traceback
from typing import Callable

import bpy
import numpy as np
import OpenImageIO as oiio
from mathutils import Matrix, Vector

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
HEADLESS = os.path.join(ROOT, "blender_addon", "aa_resolve", "headless.py")
sys.path.insert(0, os.path.join(ROOT, "blender_addon"))

import aa_resolve  # noqa: E402,F401
from aa_resolve.command_line import build_parser, settings_from  # noqa: E402
from aa_resolve.export import Exporter  # noqa: E402
from aa_resolve.store import Store  # noqa: E402


_folders: list[str] = []


class Silent:
    """Progress that keeps what was said."""

    def __init__(self) -> None:
        self.notes: list[str] = []

    def say(self, event: str, text: str, **values) -> None:
        if event == "note":
            self.notes.append(text)


def temporary_folder() -> str:
    """A fresh folder, removed at the end of ``main``."""
    folder = tempfile.mkdtemp(prefix="aa_addon_test_")
    _folders.append(folder)
    return folder


def new_scene(width: int = 64, height: int = 36) -> bpy.types.Scene:
    """Empty scene with a black world and no light."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.cycles.device = "CPU"
    return scene


def add_camera(scene, location=(0.0, -8.0, 1.0), target=(0.0, 0.0, 0.5), lens=40.0):
    data = bpy.data.cameras.new("Camera")
    data.lens = lens
    camera = bpy.data.objects.new("Camera", data)
    camera.rotation_mode = "XYZ"
    camera.location = location
    camera.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera
    return camera


def add_sun(scene, strength=math.pi, rotation=(0.6, 0.2, 0.3)):
    light = bpy.data.lights.new("Sun", "SUN")
    light.energy = strength
    light.angle = 0.0
    sun = bpy.data.objects.new("Sun", light)
    sun.rotation_euler = rotation
    scene.collection.objects.link(sun)
    return sun


def cube_mesh(name: str = "Cube", size: float = 1.0):
    h = size / 2
    corners = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    mesh.update()
    return mesh


def add_object(scene, name, mesh=None, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    item = bpy.data.objects.new(name, mesh if mesh is not None else cube_mesh(name))
    item.location, item.rotation_euler, item.scale = location, rotation, scale
    scene.collection.objects.link(item)
    return item


def diffuse(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1.0)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def key(owner, path, values: dict[int, object], index: int = -1) -> None:
    """Keyframes with straight lines in between."""
    for frame, value in values.items():
        if index >= 0:
            vector = getattr(owner, path)
            vector[index] = value
        else:
            setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame, index=index)
    for curve in curves_of(owner.id_data):  # a shape key's curves belong to the block of all keys
        curve.extrapolation = "LINEAR"
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def curves_of(owner: bpy.types.ID) -> list:
    """F-curves of the action that animates a data-block."""
    animation = owner.animation_data
    action = animation.action
    if not hasattr(animation, "action_slot"):
        return list(action.fcurves)
    return [  # since 4.4 one action may serve several owners
        curve
        for layer in action.layers
        for strip in layer.strips
        for bag in strip.channelbags
        if bag.slot == animation.action_slot
        for curve in bag.fcurves
    ]


# Inputs of shader nodes that were renamed in 4.0.
_RENAMED_INPUTS = {
    "Specular": "Specular IOR Level",
    "Emission": "Emission Color",
    "Transmission": "Transmission Weight",
    "Subsurface": "Subsurface Weight",
    "Sheen": "Sheen Weight",
    "Clearcoat": "Coat Weight",
}


def shader_input(node: bpy.types.Node, name: str) -> bpy.types.NodeSocket:
    """Input of a shader node by its name in 3.4, whatever it is called in this version."""
    socket = node.inputs.get(name) or node.inputs.get(_RENAMED_INPUTS.get(name, name))
    assert socket is not None, f"{node.bl_idname} has no input '{name}': {node.inputs.keys()}"
    return socket


def add_group_socket(tree: bpy.types.NodeTree, kind: str, name: str, is_output: bool) -> None:
    """Declares an input or output of a node group, such as ("NodeSocketGeometry", "Geometry")."""
    if hasattr(tree, "interface"):  # since 4.0
        tree.interface.new_socket(name, in_out="OUTPUT" if is_output else "INPUT", socket_type=kind)
    else:
        (tree.outputs if is_output else tree.inputs).new(kind, name)


def geometry_group(name: str) -> bpy.types.NodeTree:
    """Node group of a geometry-nodes modifier with one geometry in, one out, and a node for each."""
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    for is_output in (False, True):
        add_group_socket(tree, "NodeSocketGeometry", "Geometry", is_output)
    tree.nodes.new("NodeGroupInput").name = "Start"
    tree.nodes.new("NodeGroupOutput").name = "End"
    return tree


def smooth_by_angle(mesh: bpy.types.Mesh, angle: float) -> None:
    """Breaks the smooth shading of a mesh where faces meet at more than an angle, radians."""
    if hasattr(mesh, "use_auto_smooth"):  # before 4.1
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, angle
    else:
        mesh.set_sharp_from_angle(angle=angle)


def set_displacement_method(material: bpy.types.Material, method: str) -> None:
    """``BUMP``, ``DISPLACEMENT`` or ``BOTH``."""
    owner = (
        material if hasattr(material, "displacement_method") else material.cycles
    )  # the latter before 4.1
    owner.displacement_method = method


def eevee_engine() -> str:
    """Engine id of Eevee: BLENDER_EEVEE, but BLENDER_EEVEE_NEXT from 4.2 to 4.5."""
    scene = bpy.data.scenes.new("Engine")
    try:
        scene.render.engine = "BLENDER_EEVEE"
    except TypeError:
        scene.render.engine = "BLENDER_EEVEE_NEXT"
    engine = scene.render.engine
    bpy.data.scenes.remove(scene)
    return engine


def compositor_tree(scene: bpy.types.Scene) -> bpy.types.NodeTree:
    """An empty compositor of the scene, switched on."""
    if hasattr(scene, "compositing_node_group"):  # since 5.0
        tree = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
        scene.compositing_node_group = tree
        return tree
    scene.use_nodes = True
    scene.node_tree.nodes.clear()
    return scene.node_tree


def export(out: str, *options: str) -> dict:
    """Exports the open scene in this process; returns shot.json. The scene is changed by it."""
    arguments = build_parser().parse_args(["--out", out, *options])
    settings = settings_from(arguments, bpy.context.scene)
    progress = Silent()
    exporter = Exporter(bpy.context.scene, settings, progress, aa_resolve.ADDON_VERSION)
    exporter.prepare()
    store = Store(settings.out, arguments.claim_timeout)
    exporter.open(store)
    exporter.run(store)
    shot = read_manifest(out)
    shot["notes"] = progress.notes
    return shot


def read_manifest(out: str) -> dict:
    with open(os.path.join(out, "shot.json"), encoding="utf-8") as file:
        return json.load(file)


def save(scene, path: str) -> str:
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=path, check_existing=False)
    return path


def blender_command(blend: str, *options: str, threads: int | None = None) -> list[str]:
    command = [bpy.app.binary_path, "-b", "--factory-startup"]
    if threads:
        command += ["-t", str(threads)]
    return [*command, blend, "--python-exit-code", "9", "-P", HEADLESS, "--", *options]


def run_headless(
    blend: str, *options: str, threads: int | None = None
) -> subprocess.CompletedProcess:
    """The exporter's command line in a child process."""
    command = blender_command(blend, *options, threads=threads)
    return subprocess.run(command, capture_output=True, text=True, timeout=120)


def read_part(path: str, name: str) -> dict[str, np.ndarray]:
    """Channels of one part in their stored type, each H x W."""
    source = oiio.ImageInput.open(path)
    assert source is not None, f"{path}: {oiio.geterror()}"
    index = 0
    while source.seek_subimage(index, 0):
        spec = source.spec()
        if spec.getattribute("oiio:subimagename") == name:
            formats = spec.channelformats or (spec.format,) * spec.nchannels
            channels = {}
            for position, channel in enumerate(spec.channelnames):
                kind = "uint" if str(formats[position]) == "uint" else "float"
                pixels = source.read_image(index, 0, position, position + 1, kind)
                channels[channel] = pixels.reshape(spec.height, spec.width)
            return channels
        index += 1
    raise AssertionError(f"{path} has no part '{name}'")


def part_names(path: str) -> list[str]:
    source = oiio.ImageInput.open(path)
    names = []
    while source.seek_subimage(len(names), 0):
        names.append(source.spec().getattribute("oiio:subimagename"))
    return names


def stacked(channels: dict[str, np.ndarray], names: str) -> np.ndarray:
    return np.stack([channels[name] for name in names.split()], axis=-1)


class Projection:
    """Pin-hole and orthographic projection from Blender's camera settings, written from the definition."""

    def __init__(self, camera, width, height, aspect_x=1.0, aspect_y=1.0) -> None:
        bpy.context.view_layer.update()
        data = camera.data
        fit = data.sensor_fit
        if fit == "AUTO":
            fit = "HORIZONTAL" if width * aspect_x >= height * aspect_y else "VERTICAL"
        sensor = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
        pixels = width if fit == "HORIZONTAL" else height * aspect_y / aspect_x
        self.perspective = data.type == "PERSP"
        # Focal length (or, orthographic, magnification) in pixels of width.
        self.focal = data.lens / sensor * pixels if self.perspective else pixels / data.ortho_scale
        self.aspect = aspect_x / aspect_y
        self.centre_x = width / 2 - data.shift_x * pixels
        self.centre_y = height / 2 + data.shift_y * pixels * self.aspect
        placement = camera.matrix_world.copy()
        rotation = placement.to_3x3().normalized()
        self.to_view = np.array(
            (Matrix.Translation(placement.translation) @ rotation.to_4x4()).inverted(), np.float64
        )

    def project(self, points: np.ndarray) -> np.ndarray:
        """World points (N x 3) to pixels (N x 2, y down)."""
        view = points @ self.to_view[:3, :3].T + self.to_view[:3, 3]
        scale = self.focal / -view[:, 2] if self.perspective else np.full(len(view), self.focal)
        return np.stack(
            [self.centre_x + view[:, 0] * scale, self.centre_y - view[:, 1] * scale * self.aspect],
            -1,
        )

    def unproject(self, x: np.ndarray, y: np.ndarray, depth: np.ndarray) -> np.ndarray:
        """Pixels (y down) and planar depths to world points (N x 3)."""
        scale = depth / self.focal if self.perspective else np.full(depth.shape, 1.0 / self.focal)
        view = np.stack(
            [(x - self.centre_x) * scale, -(y - self.centre_y) * scale / self.aspect, -depth], -1
        )
        return (view - self.to_view[:3, 3]) @ self.to_view[:3, :3]


def main(*tests: Callable[[], None]) -> None:
    """Runs tests in order; ends Blender with 1 and all failures shown when any fails."""
    failed = 0
    for test in tests:
        try:
            test()
            print(f"ok   {test.__name__}", file=sys.stderr, flush=True)
        except Exception:
            failed += 1
            print(f"FAIL {test.__name__}", file=sys.stderr)
            traceback.print_exc()
            sys.stderr.flush()
    print(f"{len(tests) - failed} of {len(tests)} passed", file=sys.stderr, flush=True)
    for folder in _folders:
        shutil.rmtree(folder, ignore_errors=True)
    sys.exit(1 if failed or not tests else 0)
