# SPDX-License-Identifier: MIT
"""Building blocks of the procedural test scenes.

Everything is made from numbers in these files: no random state, no binary, no add-on. Two rules keep the
light free of noise at one sample per pixel, so that what is measured is aliasing and nothing else:

* one sun with angle 0 (a delta light: every shadow ray agrees) and no bounces;
* the ambient part is emission = albedo * ambient, seen by camera rays only, because light from the world is
  always sampled at random. The emission is no light source.

Units: metres, z up. Colours are linear BT.709.
"""

from __future__ import annotations

import argparse
import hashlib
import math
import os
import sys
from typing import Callable, Sequence

import bpy
from mathutils import Matrix, Vector

from materials import (  # noqa: F401  (one import for all that a scene needs)
    RGB,
    cut_out,
    cut_out_by,
    make_checkered,
    material,
    matt,
    no_light_source,
    paint,
    textured,
)
from shapes import (  # noqa: F401
    Point2,
    add_arch_wall,
    add_box,
    add_boxes,
    add_cylinder,
    add_mesh,
    add_revolved,
    add_sphere,
    add_squares,
    add_text,
    add_tubes,
    arch_points,
    box_parts,
    tube_parts,
)

SUN_IRRADIANCE = math.pi * 0.78  # a white surface facing the sun shows 0.78 of full white


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdigit() and height.isdigit()) or min(int(width), int(height)) < 1:
        raise argparse.ArgumentTypeError(f"expected WxH as in 480x270, found '{text}'")
    return int(width), int(height)


def parse_arguments(
    description: str,
    extra: Callable[[argparse.ArgumentParser], None] | None = None,
    argv: Sequence[str] | None = None,
) -> argparse.Namespace:
    """Reads what follows ``--`` on Blender's command line; ends the process with 2 on wrong usage."""
    if argv is None:
        argv = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="scene", description=description)
    parser.add_argument("--out", required=True, help="the .blend file to write")
    parser.add_argument(
        "--resolution", type=_size, default=(480, 270), metavar="WxH", help="pixels (480x270)"
    )
    if extra:
        extra(parser)
    return parser.parse_args(argv)


def new_scene(resolution: Sequence[int], frames: int = 100) -> bpy.types.Scene:
    """Empty file with Cycles set up for noise-free light."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = resolution
    scene.render.resolution_percentage = 100
    scene.render.fps = 24
    scene.frame_start, scene.frame_end = 1, frames
    scene.view_settings.view_transform = "Standard"
    cycles = scene.cycles
    cycles.use_denoising = False
    cycles.use_adaptive_sampling = False
    cycles.samples = 64
    cycles.light_sampling_threshold = 0.0
    cycles.max_bounces = 0
    cycles.diffuse_bounces = (
        cycles.glossy_bounces
    ) = cycles.transmission_bounces = cycles.volume_bounces = 0
    return scene


def add_sky(scene: bpy.types.Scene, horizon: RGB, zenith: RGB) -> None:
    """Background as a vertical gradient, seen by the camera only."""
    world = bpy.data.worlds.new("Sky")
    world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    ramp = tree.nodes.new("ShaderNodeMapRange")
    ramp.inputs["From Min"].default_value = 0.0
    ramp.inputs["From Max"].default_value = 0.5
    mix = tree.nodes.new("ShaderNodeMixRGB")
    mix.inputs["Color1"].default_value = (*horizon, 1.0)
    mix.inputs["Color2"].default_value = (*zenith, 1.0)
    background = tree.nodes.new("ShaderNodeBackground")
    output = tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(coordinates.outputs["Generated"], separate.inputs[0])
    tree.links.new(separate.outputs["Z"], ramp.inputs["Value"])
    tree.links.new(ramp.outputs["Result"], mix.inputs["Fac"])
    tree.links.new(mix.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    world.cycles.sampling_method = (
        "NONE"  # a varying world would else be picked as a light, in place of the sun
    )
    visibility = world.cycles_visibility
    visibility.diffuse = visibility.glossy = visibility.transmission = visibility.scatter = False
    scene.world = world


def add_sun(
    scene: bpy.types.Scene, azimuth_degrees: float, height_degrees: float
) -> bpy.types.Object:
    """Sun at an azimuth counted from +x towards +y, and a height over the horizon; angle 0, so no penumbra."""
    light = bpy.data.lights.new("Sun", "SUN")
    light.energy = SUN_IRRADIANCE
    light.angle = 0.0
    light.color = (1.0, 0.95, 0.86)
    sun = bpy.data.objects.new("Sun", light)
    azimuth, height = math.radians(azimuth_degrees), math.radians(height_degrees)
    towards_sun = Vector(
        (
            math.cos(azimuth) * math.cos(height),
            math.sin(azimuth) * math.cos(height),
            math.sin(height),
        )
    )
    sun.rotation_euler = towards_sun.to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(sun)
    return sun


def add_camera(
    scene: bpy.types.Scene,
    location: Sequence[float],
    target: Sequence[float],
    lens_mm: float,
    roll_degrees: float = 0.0,
) -> bpy.types.Object:
    """Camera with a 36 mm sensor that looks at ``target``; a positive roll turns the picture to the left."""
    data = bpy.data.cameras.new("Camera")
    data.lens = lens_mm
    data.clip_start, data.clip_end = 0.1, 500.0
    camera = bpy.data.objects.new("Camera", data)
    direction = Vector(target) - Vector(location)
    rotation = direction.to_track_quat("-Z", "Y").to_matrix().to_4x4()
    roll = Matrix.Rotation(math.radians(roll_degrees), 4, "Z")
    camera.matrix_world = Matrix.Translation(location) @ rotation @ roll
    scene.collection.objects.link(camera)
    scene.camera = camera
    return camera


def key_linear(
    target: bpy.types.Object, path: str, keys: Sequence[tuple[int, Sequence[float]]]
) -> None:
    """Keyframes with straight lines between them: the same step in every frame."""
    for frame, value in keys:
        setattr(target, path, value)
        target.keyframe_insert(path, frame=frame)
    for curve in curves_of(target):
        curve.extrapolation = "LINEAR"
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def curves_of(target: bpy.types.Object) -> list[bpy.types.FCurve]:
    """F-curves of the action that animates an object."""
    action = target.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [  # since 5.0 actions have layers alone
        curve
        for layer in action.layers
        for strip in layer.strips
        for bag in strip.channelbags
        for curve in bag.fcurves
    ]


def run(
    script: str,
    description: str,
    build: Callable[[argparse.Namespace], None],
    extra: Callable[[argparse.ArgumentParser], None] | None = None,
    inputs: Callable[[argparse.Namespace], Sequence[str]] | None = None,
) -> None:
    """The command line of a scene: builds it and writes the .blend, unless one of the same sources is there.

    Blender never writes the same scene as the same bytes twice, and to an exporter a changed file is a changed scene;
    so a file that is up to date is kept. It carries the digest of its sources as the name of an empty text. ``inputs``
    names other files that decide the scene.
    """
    arguments = parse_arguments(description, extra)
    wishes = sorted((key, value) for key, value in vars(arguments).items() if key != "out")
    digest = hashlib.sha256(f"{wishes} {bpy.app.version_string}".encode())
    folder = os.path.dirname(os.path.abspath(__file__))
    shared = {
        os.path.abspath(module.__file__)
        for module in list(sys.modules.values())
        if os.path.dirname(os.path.abspath(getattr(module, "__file__", None) or "")) == folder
    }
    for path in sorted(shared | {os.path.abspath(script)}):
        with open(path, "rb") as file:
            digest.update(file.read())
    if inputs:
        for path in inputs(arguments):
            digest.update(f"{path} {os.path.getsize(path)} {os.path.getmtime(path)}".encode())
    mark = f"sources {digest.hexdigest()[:40]}"
    path = os.path.abspath(arguments.out)
    if os.path.exists(path):
        with bpy.data.libraries.load(path) as (content, _):
            if mark in content.texts:
                print(f"{path} is up to date")
                return
    build(arguments)
    bpy.data.texts.new(mark)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=path, check_existing=False)
    print(f"wrote {path}")
