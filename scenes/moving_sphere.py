# SPDX-License-Identifier: MIT
"""moving_sphere: a dark-blue sphere travels along a colonnade in front of a camera that stands still.

After the moving sphere test of the Oliveros thesis (there: through the alley of the Sponza atrium). The sphere
covers and uncovers columns, arches, shadow edges and floor joints, up to five pixels per frame at 480 x 270;
the rest of the picture is at rest. 100 frames, so that any shorter range shows the same motion.

usage: blender -b --python-exit-code 9 -P scenes/moving_sphere.py -- --out build/scenes/moving_sphere.blend
"""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)

BAY = 3.0  # distance from column to column, metres
BAYS = 7
COLUMN_RADIUS = 0.27
SPRING = 3.3  # height at which the arches begin
FRAMES = 100
SPHERE_RADIUS = 0.8


def add_column(name: str, x: float, y: float, stone, base) -> None:
    """Eight-sided shaft on a square foot, under a square head."""
    c.add_cylinder(name, (x, y, 0.3), (x, y, SPRING - 0.25), COLUMN_RADIUS, 16, stone)
    half = COLUMN_RADIUS + 0.12
    c.add_boxes(
        f"{name} Ends",
        [
            ((x - half, y - half, 0.0), (x + half, y + half, 0.18)),
            ((x - half + 0.07, y - half + 0.07, 0.18), (x + half - 0.07, y + half - 0.07, 0.3)),
            (
                (x - half + 0.05, y - half + 0.05, SPRING - 0.25),
                (x + half - 0.05, y + half - 0.05, SPRING - 0.13),
            ),
            ((x - half, y - half, SPRING - 0.13), (x + half, y + half, SPRING)),
        ],
        base,
    )


def add_floor(light, dark) -> None:
    """Slab with darker tiles laid like a chess board: long edges that run to the horizon."""
    c.add_box("Floor", (-40.0, -30.0, -0.2), (40.0, 30.0, 0.0), light)
    tiles = []
    size = 1.0
    for row in range(-8, 5):
        for column in range(-14, 14):
            if (row + column) % 2:
                x, y = column * size, row * size
                tiles.append(((x, y, -0.1), (x + size, y + size, 0.004)))
    c.add_boxes("Floor Tiles", tiles, dark)


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution, FRAMES)
    c.add_sky(scene, horizon=(0.66, 0.77, 0.90), zenith=(0.14, 0.32, 0.68))
    stone = c.material("Column Stone", (0.72, 0.62, 0.47))
    trim = c.material("Trim Stone", (0.60, 0.49, 0.36))
    wall = c.material("Arch Wall", (0.70, 0.50, 0.31))
    back = c.material("Back Wall", (0.46, 0.20, 0.13))
    light = c.material("Floor Light", (0.56, 0.50, 0.42))
    dark = c.material("Floor Dark", (0.27, 0.23, 0.20))
    shutter = c.material("Shutter", (0.10, 0.25, 0.22))
    sphere_blue = c.material("Sphere Blue", (0.016, 0.035, 0.17))

    half_length = BAY * BAYS / 2.0
    openings = [
        (-half_length + BAY * (index + 0.5), BAY / 2.0 - COLUMN_RADIUS - 0.07, SPRING, SPRING)
        for index in range(BAYS)
    ]
    c.add_arch_wall(
        "Arches",
        (-half_length - 0.4, half_length + 0.4),
        (SPRING, 6.2),
        (2.65, 3.35),
        openings,
        wall,
        28,
    )
    for index in range(BAYS + 1):
        add_column(f"Column {index + 1}", -half_length + BAY * index, 3.0, stone, trim)
    c.add_box("Entablature", (-half_length - 0.6, 2.5, 6.2), (half_length + 0.6, 3.5, 6.45), trim)
    c.add_boxes(
        "Railing",
        [
            (
                (-half_length + 0.25 * index, 2.92, 6.45),
                (-half_length + 0.25 * index + 0.06, 3.02, 7.1),
            )
            for index in range(int(BAY * BAYS / 0.25))
        ]
        + [((-half_length - 0.4, 2.88, 7.1), (half_length + 0.4, 3.06, 7.18))],
        trim,
    )
    c.add_box("Back Wall", (-half_length - 3.0, 6.2, 0.0), (half_length + 3.0, 6.6, 6.4), back)
    c.add_box("Gallery Roof", (-half_length - 0.6, 3.4, 6.2), (half_length + 0.6, 6.6, 6.44), trim)
    for index in range(BAYS):
        x = -half_length + BAY * (index + 0.5)
        c.add_boxes(
            f"Shutter {index + 1}",
            [
                ((x - 0.55, 6.12, 1.0 + 0.13 * slat), (x + 0.55, 6.2, 1.085 + 0.13 * slat))
                for slat in range(15)
            ],
            shutter,
        )
    add_floor(light, dark)

    sphere = c.add_sphere("Sphere", (0.0, 0.0, SPHERE_RADIUS), SPHERE_RADIUS, sphere_blue)
    start, end = (-5.2, -0.6, SPHERE_RADIUS + 0.35), (13.0, 1.2, SPHERE_RADIUS + 0.35)
    c.key_linear(sphere, "location", [(1, start), (FRAMES, end)])

    c.add_sun(scene, azimuth_degrees=-62.0, height_degrees=38.0)
    c.add_camera(scene, location=(-8.6, -8.4, 2.5), target=(0.2, 3.1, 2.75), lens_mm=30.0)


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
