# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that every Blender builds alike, for agree.py: cars, a fence, a fan, wires and cut-out leaves under a moving
camera, diffuse materials, one sun.

    blender -b --factory-startup --python-exit-code 9 -P tests/blenders/street.py -- FILE.blend
"""

from __future__ import annotations

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "addon"))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

WIDTH, HEIGHT = 192, 108


def mesh_of(name: str, points, faces) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, point)) for point in points], [], faces)
    mesh.update()
    return mesh


def tube(name: str, start, end, radius: float, sides: int = 8) -> bpy.types.Mesh:
    """A cylinder without caps, flat-shaded: what Cycles does where a smooth normal turns away from the eye differs
    between versions (by up to 0.26 in a component on eight sides)."""
    start, end = np.array(start, float), np.array(end, float)
    along = (end - start) / np.linalg.norm(end - start)
    aside = np.cross(along, (0.0, 0.0, 1.0) if abs(along[2]) < 0.9 else (1.0, 0.0, 0.0))
    aside /= np.linalg.norm(aside)
    upward = np.cross(along, aside)
    angles = [math.tau * k / sides for k in range(sides)]
    ring = [radius * (math.cos(angle) * aside + math.sin(angle) * upward) for angle in angles]
    points = [start + offset for offset in ring] + [end + offset for offset in ring]
    faces = [(k, (k + 1) % sides, sides + (k + 1) % sides, sides + k) for k in range(sides)]
    return mesh_of(name, points, faces)


def cut_out(name: str, color) -> bpy.types.Material:
    """Diffuse where the alpha of an image says so, else clear."""
    image = bpy.data.images.new(name, 32, 32, alpha=True)
    row, column = (np.mgrid[0:32, 0:32] + 0.5) / 16.0 - 1.0
    inside = (row * row + (column * (1.6 + row)) ** 2 < 0.9) & (np.abs(column) > 0.05)
    pixels = np.ones((32, 32, 4), np.float32)
    pixels[..., 3] = inside
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    material = t.diffuse(name, color)
    tree = material.node_tree
    texture, mix = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeMixShader")
    texture.image, texture.interpolation = image, "Closest"
    clear = tree.nodes.new("ShaderNodeBsdfTransparent")
    surface = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfDiffuse")
    end = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeOutputMaterial")
    tree.links.new(texture.outputs["Alpha"], mix.inputs[0])
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(surface.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], end.inputs["Surface"])
    return material


def build() -> bpy.types.Scene:
    """The scene, frames 1 to 4."""
    scene = t.new_scene(WIDTH, HEIGHT)
    scene.frame_start, scene.frame_end = 1, 4
    camera = t.add_camera(scene, (0, -9, 1.6), (0, 0, 0.9), 35)
    t.key(camera, "location", {1: (-0.6, -9, 1.6), 11: (0.9, -8, 1.9)})
    t.key(camera, "rotation_euler", {1: (1.48, 0, 0), 11: (1.45, 0.03, 0.1)})
    t.key(camera.data, "lens", {1: 34.0, 11: 38.0})
    t.add_sun(scene, rotation=(0.7, 0.25, 0.3))
    ground = mesh_of(
        "Ground", [(-20, -9, 0), (20, -9, 0), (20, 20, 0), (-20, 20, 0)], [(0, 1, 2, 3)]
    )
    t.add_object(scene, "Ground", ground).data.materials.append(
        t.diffuse("Ground", (0.4, 0.42, 0.4))
    )

    paint = {name: t.diffuse(name, color) for name, color in (
        ("Red", (0.7, 0.1, 0.08)), ("Blue", (0.1, 0.2, 0.6)), ("Dark", (0.05, 0.05, 0.06)),
        ("Wood", (0.45, 0.3, 0.15)), ("Steel", (0.5, 0.5, 0.55)),
    )}  # fmt: skip
    for index, (name, side) in enumerate((("Red", 1.0), ("Blue", -1.0))):
        body = t.add_object(scene, f"Car {name}", t.cube_mesh(f"Car {name}"), scale=(1.6, 0.7, 0.5))
        body.data.materials.append(paint[name])
        lane = -2.0 + 1.4 * index
        t.key(body, "location", {1: (-1.5 * side, lane, 0.45), 11: (2.0 * side, lane + 0.2, 0.45)})
        t.key(body, "rotation_euler", {1: (0, 0, 0), 11: (0, 0, 0.2 * side)})

    slat = t.cube_mesh("Slat")
    slat.materials.append(paint["Wood"])
    for index in range(24):
        place = (-3.4 + 0.3 * index, 1.0, 0.5)
        t.add_object(scene, f"Slat {index:02d}", slat, place, scale=(0.08, 0.04, 1.0))

    fan = t.add_object(scene, "Fan", t.cube_mesh("Fan"), (2.3, 0.2, 1.9), scale=(1.4, 0.02, 0.12))
    fan.data.materials.append(paint["Steel"])
    t.key(fan, "rotation_euler", {1: (0, 0.2, 0), 11: (0, 3.2, 0)})
    for index in range(5):
        height = 2.2 + 0.14 * index
        wire = tube(f"Wire {index}", (-6, 2 + 0.1 * index, height), (6, 1, height + 0.5), 0.012)
        wire.materials.append(paint["Dark"])
        t.add_object(scene, f"Wire {index}", wire)

    leaf = mesh_of(
        "Leaf", [(-0.3, 0, -0.4), (0.3, 0, -0.4), (0.3, 0, 0.4), (-0.3, 0, 0.4)], [(0, 1, 2, 3)]
    )
    layer = leaf.uv_layers.new(name="UVMap")
    for index, corner in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        layer.data[index].uv = corner
    leaf.materials.append(cut_out("Leaf", (0.2, 0.5, 0.1)))
    collection = bpy.data.collections.new("Leaves")
    collection.objects.link(bpy.data.objects.new("Leaf", leaf))
    random = np.random.default_rng(3)
    for index in range(12):
        place = bpy.data.objects.new(f"Twig {index:02d}", None)
        place.instance_type, place.instance_collection = "COLLECTION", collection
        place.location = tuple(random.uniform((-3.2, -1.2, 1.2), (-1.2, 0.6, 2.6)))
        place.rotation_euler = tuple(random.uniform(-0.6, 0.6, 3))
        scene.collection.objects.link(place)
    return scene


if __name__ == "__main__":
    t.save(build(), os.path.abspath(sys.argv[sys.argv.index("--") + 1]))
