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
from typing import Callable, Iterable, Sequence

import bpy
from mathutils import Matrix, Vector

RGB = tuple[float, float, float]
Point2 = tuple[float, float]

SUN_IRRADIANCE = math.pi * 0.78  # a white surface facing the sun shows 0.78 of full white
AMBIENT_UP: RGB = (0.27, 0.31, 0.38)  # light from the sky, for normals that point up
AMBIENT_DOWN: RGB = (0.15, 0.13, 0.11)  # light from the ground, for normals that point down


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdigit() and height.isdigit()) or min(int(width), int(height)) < 1:
        raise argparse.ArgumentTypeError(f"expected WxH as in 480x270, found '{text}'")
    return int(width), int(height)


def parse_arguments(
    description: str, extra: Callable[[argparse.ArgumentParser], None] | None = None
):
    """Reads what follows ``--`` on Blender's command line; ends the process with 2 on wrong usage."""
    argv = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="scene", description=description)
    parser.add_argument("--out", required=True, help="the .blend file to write")
    parser.add_argument(
        "--resolution", type=_size, default=(480, 270), metavar="WxH", help="pixels (480x270)"
    )
    if extra:
        extra(parser)
    arguments = parser.parse_args(argv)
    return arguments


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


def _ambient_by_normal(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """Mix of ground and sky light by the height of the geometric normal."""
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    ramp = tree.nodes.new("ShaderNodeMapRange")
    ramp.inputs["From Min"].default_value = -1.0
    mix = tree.nodes.new("ShaderNodeMixRGB")
    mix.inputs["Color1"].default_value = (*AMBIENT_DOWN, 1.0)
    mix.inputs["Color2"].default_value = (*AMBIENT_UP, 1.0)
    tree.links.new(geometry.outputs["Normal"], separate.inputs[0])
    tree.links.new(separate.outputs["Z"], ramp.inputs["Value"])
    tree.links.new(ramp.outputs["Result"], mix.inputs["Fac"])
    return mix.outputs["Color"]


def material(
    name: str, albedo: RGB, ambient_scale: float = 1.0, lit: bool = True
) -> bpy.types.Material:
    """Solid matt colour: diffuse under the sun plus albedo * ambient for the camera.

    ``ambient_scale`` darkens surfaces that see little of the sky; ``lit=False`` leaves the sun out.
    """
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    result.diffuse_color = (*albedo, 1.0)
    if hasattr(result.cycles, "emission_sampling"):  # since 3.5
        result.cycles.emission_sampling = "NONE"
    else:
        result.cycles.sample_as_light = False
    tree = result.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tint = tree.nodes.new("ShaderNodeMixRGB")
    tint.blend_type = "MULTIPLY"
    tint.inputs["Fac"].default_value = 1.0
    tint.inputs["Color1"].default_value = (*albedo, 1.0)
    tree.links.new(_ambient_by_normal(tree), tint.inputs["Color2"])
    camera_ray = tree.nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"]
    strength = tree.nodes.new("ShaderNodeMath")
    strength.operation = "MULTIPLY"
    strength.inputs[1].default_value = ambient_scale
    tree.links.new(camera_ray, strength.inputs[0])
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(tint.outputs["Color"], emission.inputs["Color"])
    tree.links.new(strength.outputs[0], emission.inputs["Strength"])
    surface = emission.outputs[0]
    if lit:
        diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = (*albedo, 1.0)
        add = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(diffuse.outputs[0], add.inputs[0])
        tree.links.new(emission.outputs[0], add.inputs[1])
        surface = add.outputs[0]
    tree.links.new(surface, output.inputs["Surface"])
    return result


def cut_out(surface: bpy.types.Material, image: bpy.types.Image) -> None:
    """Lets a material exist only where the image's alpha is above one half (uv map of the mesh)."""
    tree = surface.node_tree
    output = tree.get_output_node("ALL")
    shader = output.inputs["Surface"].links[0].from_socket
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    threshold = tree.nodes.new("ShaderNodeMath")
    threshold.operation = "GREATER_THAN"
    threshold.inputs[1].default_value = 0.5
    clear = tree.nodes.new("ShaderNodeBsdfTransparent")
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(texture.outputs["Alpha"], threshold.inputs[0])
    tree.links.new(threshold.outputs[0], mix.inputs["Fac"])
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(shader, mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])


def make_checkered(surface: bpy.types.Material, other: RGB, scale: float) -> None:
    """Turns a solid material into checks of its own and another colour, in the object's own space."""
    tree = surface.node_tree
    tint = next(
        node
        for node in tree.nodes
        if node.bl_idname == "ShaderNodeMixRGB" and node.blend_type == "MULTIPLY"
    )
    diffuse = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfDiffuse")
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = scale
    checker.inputs["Color1"].default_value = diffuse.inputs["Color"].default_value
    checker.inputs["Color2"].default_value = (*other, 1.0)
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Object"], checker.inputs["Vector"])
    tree.links.new(checker.outputs["Color"], tint.inputs["Color1"])
    tree.links.new(checker.outputs["Color"], diffuse.inputs["Color"])


def tube_parts(
    points: Sequence[Sequence[float]], radius: float, sides: int, first: int
) -> tuple[list[Vector], list[tuple[int, ...]]]:
    """Vertices and faces of a tube along a polyline, its vertices counted from ``first``; the ends are closed."""
    path = [Vector(point) for point in points]
    vertices: list[Vector] = []
    side = (path[1] - path[0]).orthogonal().normalized()
    for index, point in enumerate(path):
        ahead = path[min(index + 1, len(path) - 1)] - path[max(index - 1, 0)]
        axis = ahead.normalized()
        side = (
            side - axis * side.dot(axis)
        ).normalized()  # carried along, so that the tube does not twist
        other = axis.cross(side)
        for step in range(sides):
            angle = 2.0 * math.pi * step / sides
            vertices.append(point + (side * math.cos(angle) + other * math.sin(angle)) * radius)
    faces: list[tuple[int, ...]] = []
    for index in range(len(path) - 1):
        low, high = first + index * sides, first + (index + 1) * sides
        for step in range(sides):
            following = (step + 1) % sides
            faces.append((low + step, low + following, high + following, high + step))
    last = first + (len(path) - 1) * sides
    faces.append(tuple(first + step for step in reversed(range(sides))))
    faces.append(tuple(last + step for step in range(sides)))
    return vertices, faces


def add_tubes(
    name: str, paths: Iterable[Sequence[Sequence[float]]], radius: float, sides: int, surface
) -> bpy.types.Object:
    """One object made of tubes along polylines."""
    vertices: list = []
    faces: list = []
    for path in paths:
        tube_vertices, tube_faces = tube_parts(path, radius, sides, len(vertices))
        vertices += tube_vertices
        faces += tube_faces
    return add_mesh(name, vertices, faces, surface)


def add_mesh(
    name: str,
    vertices: Iterable[Sequence[float]],
    faces: Iterable[Sequence[int]],
    surface: bpy.types.Material,
    smooth: bool = False,
) -> bpy.types.Object:
    """Object from plain vertices (metres) and faces, counter-clockwise seen from outside."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(vertex) for vertex in vertices], [], [tuple(face) for face in faces])
    mesh.materials.append(surface)
    if smooth:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.validate()
    mesh.update()
    result = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(result)
    return result


def box_parts(
    low: Sequence[float], high: Sequence[float]
) -> tuple[list[Point2], list[tuple[int, ...]]]:
    """Vertices and faces of an axis-aligned box."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    vertices = [
        (x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0),
        (x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1),
    ]  # fmt: skip
    faces = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return vertices, faces


def add_boxes(
    name: str, boxes: Iterable[tuple[Sequence[float], Sequence[float]]], surface
) -> bpy.types.Object:
    """One object made of several boxes, each given by its low and high corner."""
    vertices: list = []
    faces: list = []
    for low, high in boxes:
        box_vertices, box_faces = box_parts(low, high)
        faces += [tuple(index + len(vertices) for index in face) for face in box_faces]
        vertices += box_vertices
    return add_mesh(name, vertices, faces, surface)


def add_box(name: str, low: Sequence[float], high: Sequence[float], surface) -> bpy.types.Object:
    """One box between two corners."""
    return add_boxes(name, [(low, high)], surface)


def add_cylinder(
    name: str,
    start: Sequence[float],
    end: Sequence[float],
    radius: float,
    sides: int,
    surface,
    smooth: bool = False,
) -> bpy.types.Object:
    """Capped cylinder (a prism of ``sides`` sides) from ``start`` to ``end``."""
    axis = Vector(end) - Vector(start)
    rotation = axis.to_track_quat("Z", "Y").to_matrix()
    vertices = []
    for base in (Vector(start), Vector(end)):
        for side in range(sides):
            angle = 2.0 * math.pi * side / sides
            vertices.append(
                base + rotation @ Vector((radius * math.cos(angle), radius * math.sin(angle), 0.0))
            )
    faces = [
        (side, (side + 1) % sides, sides + (side + 1) % sides, sides + side)
        for side in range(sides)
    ]
    faces.append(tuple(reversed(range(sides))))
    faces.append(tuple(range(sides, 2 * sides)))
    return add_mesh(name, vertices, faces, surface, smooth)


def add_sphere(
    name: str, centre: Sequence[float], radius: float, surface, segments: int = 40, rings: int = 24
) -> bpy.types.Object:
    """Smooth sphere about the object's origin.

    40 x 24 faces stay below 1024, the size from which Blender sums normals in several threads, in an order
    that changes from run to run: the same file gives the same picture, bit for bit."""
    vertices: list[tuple[float, float, float]] = [(0.0, 0.0, radius)]
    for ring in range(1, rings):
        polar = math.pi * ring / rings
        for segment in range(segments):
            azimuth = 2.0 * math.pi * segment / segments
            vertices.append(
                (
                    radius * math.sin(polar) * math.cos(azimuth),
                    radius * math.sin(polar) * math.sin(azimuth),
                    radius * math.cos(polar),
                )
            )
    vertices.append((0.0, 0.0, -radius))
    south = len(vertices) - 1
    faces: list[tuple[int, ...]] = []
    for segment in range(segments):
        following = (segment + 1) % segments
        faces.append((0, 1 + segment, 1 + following))
        for ring in range(rings - 2):
            upper, lower = 1 + ring * segments, 1 + (ring + 1) * segments
            faces.append((upper + segment, lower + segment, lower + following, upper + following))
        last = 1 + (rings - 2) * segments
        faces.append((last + segment, south, last + following))
    result = add_mesh(name, vertices, faces, surface, smooth=True)
    result.location = centre
    return result


def arch_points(centre_x: float, spring_z: float, half_width: float, steps: int) -> list[Point2]:
    """Half circle (x, z) from the right springing over the crown to the left one."""
    points = []
    for step in range(steps + 1):
        angle = math.pi * step / steps
        points.append(
            (centre_x + half_width * math.cos(angle), spring_z + half_width * math.sin(angle))
        )
    return points


def add_arch_wall(
    name: str,
    x_range: tuple[float, float],
    z_range: tuple[float, float],
    y_range: tuple[float, float],
    openings: Sequence[tuple[float, float, float, float]],
    surface: bpy.types.Material,
    steps: int = 24,
) -> bpy.types.Object:
    """Upright slab in the xz-plane with arched openings.

    ``openings``: (centre x, half width, sill z, springing z), from left to right, not touching each other. The
    front lies at the smaller y. Made of vertical strips, so that every face is convex."""
    y_front, y_back = y_range
    z_low, z_high = z_range
    vertices: list[tuple[float, float, float]] = []
    faces: list[tuple[int, ...]] = []

    def slab(outline: Sequence[Point2]) -> None:
        """Prism from an outline that runs counter-clockwise seen from the front (x right, z up)."""
        first, count = len(vertices), len(outline)
        vertices.extend((x, y_front, z) for x, z in outline)
        vertices.extend((x, y_back, z) for x, z in outline)
        faces.append(tuple(first + index for index in range(count)))
        faces.append(tuple(first + count + index for index in reversed(range(count))))
        for index in range(count):
            following = (index + 1) % count
            faces.append(
                (first + following, first + index, first + count + index, first + count + following)
            )

    left = x_range[0]
    for centre, half_width, sill, spring in openings:
        slab(
            [
                (left, z_low),
                (centre - half_width, z_low),
                (centre - half_width, z_high),
                (left, z_high),
            ]
        )
        if sill > z_low:
            slab(
                [
                    (centre - half_width, z_low),
                    (centre + half_width, z_low),
                    (centre + half_width, sill),
                    (centre - half_width, sill),
                ]
            )
        crown = list(reversed(arch_points(centre, spring, half_width, steps)))  # from left to right
        for (x0, z0), (x1, z1) in zip(crown, crown[1:]):
            slab([(x0, z0), (x1, z1), (x1, z_high), (x0, z_high)])
        left = centre + half_width
    slab([(left, z_low), (x_range[1], z_low), (x_range[1], z_high), (left, z_high)])
    return add_mesh(name, vertices, faces, surface)


def add_text(
    name: str, body: str, location: Sequence[float], size: float, surface, align: str = "CENTER"
) -> bpy.types.Object:
    """Flat letters of Blender's built-in font in the xz-plane, facing -y; ``size`` in metres."""
    curve = bpy.data.curves.new(name, "FONT")
    curve.body = body
    curve.size = size
    curve.align_x = align
    curve.align_y = "CENTER"
    curve.materials.append(surface)
    result = bpy.data.objects.new(name, curve)
    result.location = location
    result.rotation_euler = (math.pi / 2.0, 0.0, 0.0)
    bpy.context.scene.collection.objects.link(result)
    return result


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
) -> None:
    """The command line of a scene: builds it and writes the .blend, unless one of the same sources is there.

    Blender never writes the same scene as the same bytes twice, and to an exporter a changed file is a changed scene;
    so a file that is up to date is kept. It carries the digest of its sources as the name of an empty text.
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
