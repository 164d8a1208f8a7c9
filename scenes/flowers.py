# SPDX-License-Identifier: MIT
"""flowers: blossoms and leaves as alpha cut-outs, winding around a column; nothing moves unless ``--sway``.

After the Sponza flowers test of [Oliveros 2018, 5.2.6]. Every blossom is a flat square; its outline lives in the alpha of
an image, so geometry alone knows nothing of the edge. With ``--close`` the cut-outs fill the picture.

usage: blender -b --python-exit-code 9 -P scenes/flowers.py -- --out build/scenes/flowers.blend [--close] [--sway]
"""

from __future__ import annotations

import math
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)

IMAGE_SIZE = 256
FRAMES = 100


def options(parser) -> None:
    """Variants of the scene."""
    parser.add_argument("--sway", action="store_true", help="the garland swings to and fro")
    parser.add_argument(
        "--close", action="store_true", help="the camera near: leaves and blossoms fill the picture"
    )


def shape_image(name: str, inside) -> c.bpy.types.Image:
    """Square image whose alpha is 1 where ``inside(radius, angle, x, y)`` holds; x, y in [-1, 1]."""
    image = c.bpy.data.images.new(name, IMAGE_SIZE, IMAGE_SIZE, alpha=True)
    image.alpha_mode = "CHANNEL_PACKED"
    pixels = []
    for row in range(IMAGE_SIZE):
        for column in range(IMAGE_SIZE):
            x, y = (column + 0.5) / IMAGE_SIZE * 2 - 1, (row + 0.5) / IMAGE_SIZE * 2 - 1
            alpha = 1.0 if inside(math.hypot(x, y), math.atan2(y, x), x, y) else 0.0
            pixels += [1.0, 1.0, 1.0, alpha]
    image.pixels.foreach_set(pixels)
    image.update()
    image.pack()
    return image


def garland(generator: random.Random, count: int, size: tuple[float, float], spread: float):
    """Placements along a helix around the column, turned at random but facing outwards."""
    placements = []
    for index in range(count):
        t = (index + generator.random()) / count
        angle = t * 4.6 * math.pi + generator.uniform(-0.25, 0.25)
        out = c.Vector((math.cos(angle), math.sin(angle), 0.0))
        centre = out * (0.5 + generator.uniform(0.0, spread)) + c.Vector(
            (0, 0, 0.5 + 4.4 * t + generator.uniform(-0.2, 0.2))
        )
        normal = (out + c.Vector([generator.uniform(-0.6, 0.6) for _ in range(3)])).normalized()
        right = normal.orthogonal().normalized()
        up = normal.cross(right)
        roll, half = generator.uniform(0, 6.3), generator.uniform(*size)
        placements.append(
            (
                centre,
                (right * math.cos(roll) + up * math.sin(roll)) * half,
                (up * math.cos(roll) - right * math.sin(roll)) * half,
            )
        )
    return placements


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution, FRAMES)
    scene.cycles.transparent_max_bounces = 64  # many leaves in a row
    c.add_sky(scene, horizon=(0.66, 0.77, 0.88), zenith=(0.22, 0.42, 0.72))
    stone = c.material("Column Stone", (0.66, 0.60, 0.50))
    c.add_cylinder("Column", (0, 0, 0.3), (0, 0, 5.2), 0.36, 20, stone)
    c.add_boxes(
        "Column Ends",
        [((-0.55, -0.55, 0.0), (0.55, 0.55, 0.3)), ((-0.5, -0.5, 5.2), (0.5, 0.5, 5.45))],
        stone,
    )
    c.add_box("Ground", (-30, -30, -0.2), (30, 60, 0.0), c.material("Ground", (0.36, 0.40, 0.24)))
    c.add_box("Wall", (-30, 6.0, 0.0), (30, 6.4, 2.4), c.material("Wall", (0.60, 0.44, 0.34)))
    blossom = shape_image(
        "Blossom", lambda r, a, x, y: r < 0.52 + 0.42 * math.cos(5 * a) and r > 0.12
    )
    leaf = shape_image(
        "Leaf", lambda r, a, x, y: abs(y) < 0.42 * (1 - x * x) and not (abs(y) < 0.03 and x < 0.6)
    )
    fern = shape_image(
        "Fern",
        lambda r, a, x, y: abs(y) < 0.9 * (1 - abs(x))
        and (abs(y) < 0.05 or math.sin(28 * x + 9 * abs(y)) > 0.1),
    )
    generator = random.Random(7)
    garlands = []
    for name, image, colour, count, size, spread in (
        ("Leaves", leaf, (0.10, 0.30, 0.07), 150, (0.16, 0.30), 0.18),
        ("Ferns", fern, (0.20, 0.42, 0.10), 60, (0.24, 0.42), 0.30),
        ("Red Blossoms", blossom, (0.62, 0.05, 0.07), 60, (0.13, 0.24), 0.42),
        ("White Blossoms", blossom, (0.78, 0.74, 0.66), 50, (0.10, 0.20), 0.46),
    ):
        surface = c.material(f"{name} Cut-out", colour)
        c.cut_out(surface, image)
        garlands.append(c.add_squares(name, garland(generator, count, size, spread), surface))
    if arguments.sway:
        for item in garlands:
            c.key_linear(
                item,
                "rotation_euler",
                [
                    (1 + 20 * step, (0.0, 0.0, math.radians(12.0 * (step % 2))))
                    for step in range(FRAMES // 20 + 1)
                ],
            )
    c.add_sun(scene, azimuth_degrees=-60.0, height_degrees=42.0)
    if arguments.close:
        c.add_camera(scene, location=(0.9, -6.0, 2.5), target=(0.0, 0.0, 2.1), lens_mm=76.0)
    else:
        c.add_camera(scene, location=(1.2, -9.5, 2.7), target=(0.0, 0.0, 2.7), lens_mm=54.0)


if __name__ == "__main__":
    c.run(__file__, __doc__, build, options)
