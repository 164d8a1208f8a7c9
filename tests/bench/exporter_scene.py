# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene of the exporter's benchmarks, made inside Blender; it puts the add-on in Python's path."""

from __future__ import annotations

import math
import os
import sys

import bpy
import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "blender_addon"))


def sphere(rings: int, sides: int) -> bpy.types.Mesh:
    """A ball of about 2 * rings * sides triangles, smooth."""
    angle = np.arange(sides) * math.tau / sides
    height = np.arange(1, rings) * math.pi / rings
    points = [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]
    points += [
        (math.sin(h) * math.cos(a), math.sin(h) * math.sin(a), math.cos(h))
        for h in height
        for a in angle
    ]

    def at(ring: int, side: int) -> int:
        return 2 + ring * sides + side % sides

    faces = []
    for side in range(sides):
        faces.append((0, at(0, side), at(0, side + 1)))
        faces.append((1, at(rings - 2, side + 1), at(rings - 2, side)))
        faces += [
            (at(r, side), at(r + 1, side), at(r + 1, side + 1), at(r, side + 1))
            for r in range(rings - 2)
        ]
    mesh = bpy.data.meshes.new("Ball")
    mesh.from_pydata(points, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    return mesh


def make_scene(triangles: int, animated: bool, last: int) -> int:
    """25 balls on a floor in the sun, no cut-outs, rising and falling if `animated` up to frame `last`: the number of
    triangles."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    side = max(4, int(math.sqrt(triangles / 25 / 2)))
    count = 0
    for index in range(25):
        mesh = sphere(side, side)
        mesh.calc_loop_triangles()
        count += len(mesh.loop_triangles)
        material = bpy.data.materials.new(f"Colour {index}")
        material.use_nodes = True
        colour = (index % 5 / 5 + 0.1, index // 5 / 5 + 0.1, 0.4, 1.0)
        material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
        mesh.materials.append(material)
        item = bpy.data.objects.new(f"Ball {index}", mesh)
        item.location = (index % 5 * 2.2 - 4.4, index // 5 * 2.2 - 4.4, 1.0)
        if animated:
            for frame in range(1, last + 1):
                item.location.z = 1.0 + 0.2 * (frame % 2)
                item.keyframe_insert("location", frame=frame)
        scene.collection.objects.link(item)
    floor = bpy.data.meshes.new("Floor")
    floor.from_pydata([(-30, -30, 0), (30, -30, 0), (30, 30, 0), (-30, 30, 0)], [], [(0, 1, 2, 3)])
    scene.collection.objects.link(bpy.data.objects.new("Floor", floor))
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler = (0.6, 0.2, 0.3)
    scene.collection.objects.link(sun)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler = (0.0, -15.0, 7.0), (1.15, 0.0, 0.0)
    camera.keyframe_insert(
        "location", frame=1
    )  # it moves, so that the main pass has motion vectors
    camera.location.x = 2.0
    camera.keyframe_insert("location", frame=11)
    scene.collection.objects.link(camera)
    scene.camera = camera
    return count
