# SPDX-License-Identifier: MIT
"""wall: a white wall whose texture bears black letters; nothing moves.

After the wall of [Oliveros 2018, 4.1 and 5.2.7]. All the edges lie inside one flat face: depth, normal and object know
nothing of them, and letters must stay sharp under a filter. The texture has four texels to a pixel of 480 x 270 in either
direction, and none between black and white.

usage: blender -b --python-exit-code 9 -P scenes/wall.py -- --out build/scenes/wall.blend
"""

from __future__ import annotations

import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import facade as f  # noqa: E402

HALF_WIDTH, HALF_HEIGHT = 3.0, 1.6875  # metres
TEXELS = (1920, 1080)
INK = 0.012
LINES = (  # text, centre's height and size in metres
    ("HARD EDGES", 1.05, 0.94),
    ("anti-aliasing 0123456789", 0.28, 0.5),
    ("the quick brown fox jumps over the lazy dog", -0.26, 0.29),
    ("LETTERS USE HARD EDGES TO DEFINE THEIR SHAPE", -0.62, 0.2),
    ("and must stay that way whatever filter the picture goes through, however thin", -0.9, 0.155),
    ("THIN STROKES BREAK UP WHEN A PIXEL IS TOO COARSE FOR THEM  |||||  /////  =====", -1.15, 0.12),
    (
        "the smallest line is here to see where reading ends: 0O 1l 5S 8B mnm wvw {[()]} #%&@",
        -1.38,
        0.1,
    ),
)


def triangles(body: str, height: float, size: float) -> np.ndarray:
    """Letters of Blender's built-in font as triangles (n, 3 corners, x and z)."""
    item = c.add_text("Text", body, (0.0, 0.0, height), size, None)
    evaluated = item.evaluated_get(c.bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    mesh.calc_loop_triangles()
    corners = np.array([vertex.co[:2] for vertex in mesh.vertices]) + (0.0, height)
    found = corners[np.array([triangle.vertices[:] for triangle in mesh.loop_triangles])]
    evaluated.to_mesh_clear()
    curve = item.data
    c.bpy.data.objects.remove(item)
    c.bpy.data.curves.remove(curve)
    return found


def letters_image() -> c.bpy.types.Image:
    """White with black letters: a texel is black if its centre lies in a letter."""
    width, height = TEXELS
    black = np.zeros((height, width), bool)
    scale = np.array((width / (2 * HALF_WIDTH), height / (2 * HALF_HEIGHT)))
    for line in LINES:
        for corners in (triangles(*line) + (HALF_WIDTH, HALF_HEIGHT)) * scale:
            low = np.maximum(np.floor(corners.min(axis=0)).astype(int), 0)
            high = np.minimum(np.ceil(corners.max(axis=0)).astype(int), TEXELS)
            x, y = np.meshgrid(*(np.arange(a, b) + 0.5 for a, b in zip(low, high)))
            sides = [
                (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
                for a, b in zip(corners, np.roll(corners, -1, axis=0))
            ]
            inside = np.minimum.reduce(sides) >= 0, np.maximum.reduce(sides) <= 0
            black[low[1] : high[1], low[0] : high[0]] |= inside[0] | inside[1]
    image = c.bpy.data.images.new("Letters", width, height, float_buffer=True, is_data=True)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = np.where(black[..., None], INK, f.WHITE)
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    return image


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution)
    c.add_sky(scene, horizon=(0.62, 0.74, 0.90), zenith=(0.16, 0.34, 0.70))
    paper = c.material("Wall White", f.WHITE)
    image = letters_image()
    c.textured(paper, image)
    right, up = c.Vector((HALF_WIDTH, 0.0, 0.0)), c.Vector((0.0, 0.0, HALF_HEIGHT))
    c.add_squares("Wall", [(c.Vector((0.0, 0.0, 0.0)), right, up)], paper)
    c.add_sun(scene, azimuth_degrees=-118.0, height_degrees=42.0)
    c.add_camera(
        scene, location=(-3.4, -17.0, 1.2), target=(0.0, 0.0, 0.0), lens_mm=96.0, roll_degrees=2.0
    )


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
