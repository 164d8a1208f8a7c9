# SPDX-License-Identifier: MIT
"""hairball: thousands of fibres thinner than a pixel, in front of a plain sky.

After the hairball tests of [Oliveros 2018, 5.2.9]: lit or as a black silhouette (``--unlit``), at rest or rotating by
1.2 degrees per frame (``--rotating``: about two pixels at the rim, 480 x 270). At any ``--resolution`` a fibre is 0.8 of a
pixel wide, and there are as many as cover the ball alike: 3000 of them, 200,000 triangles, at 480 x 270.

usage: blender -b --python-exit-code 9 -P scenes/hairball.py -- --out build/scenes/hairball.blend [--unlit] [--rotating]
"""

from __future__ import annotations

import math
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)

FRAMES = 100
SEGMENTS = 10
PICTURE_WIDTH = 3.84  # metres at the ball
FIBRE_PIXELS = 0.8  # width
FIBRES_PER_COLUMN = 6.25  # of pixels: 3000 at 480
DEGREES_PER_FRAME = 1.2


def options(parser) -> None:
    """Variants of the scene."""
    parser.add_argument(
        "--unlit", action="store_true", help="black fibres on white: the silhouette alone"
    )
    parser.add_argument("--rotating", action="store_true", help="turn by 1.2 degrees per frame")
    parser.add_argument("--fibres", type=int, help="number of fibres (6.25 per pixel of width)")


def fibre(generator: random.Random) -> list[c.Vector]:
    """A wandering path from inside the ball to its rim and back along it."""
    height = generator.uniform(-1.0, 1.0)
    azimuth = generator.uniform(0.0, 2.0 * math.pi)
    ring = math.sqrt(1.0 - height * height)
    direction = c.Vector((ring * math.cos(azimuth), ring * math.sin(azimuth), height))
    sideways = direction.cross(
        c.Vector([generator.uniform(-1.0, 1.0) for _ in range(3)])
    ).normalized()
    bend = generator.uniform(0.4, 1.3)
    reach = generator.uniform(0.75, 1.0)
    wave, phase = generator.uniform(0.02, 0.06), generator.uniform(0.0, 6.0)
    twist = direction.cross(sideways)
    points = []
    for step in range(SEGMENTS + 1):
        t = step / SEGMENTS
        angle = bend * t * t
        ray = direction * math.cos(angle) + sideways * math.sin(angle)
        points.append(
            ray * (0.15 + (reach - 0.15) * math.sin(t * math.pi / 2))
            + twist * (wave * math.sin(7 * t + phase))
        )
    return points


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution, FRAMES)
    if arguments.unlit:
        c.add_sky(scene, horizon=(0.9, 0.9, 0.9), zenith=(0.9, 0.9, 0.9))
        hair = c.material("Fibre", (0.0, 0.0, 0.0), lit=False)
    else:
        c.add_sky(scene, horizon=(0.60, 0.70, 0.80), zenith=(0.35, 0.48, 0.66))
        hair = c.material("Fibre", (0.52, 0.27, 0.12), ambient_scale=0.8)
    generator = random.Random(20180731)
    columns = arguments.resolution[0]
    count = arguments.fibres or round(FIBRES_PER_COLUMN * columns)
    radius = FIBRE_PIXELS / 2 * PICTURE_WIDTH / columns
    ball = c.add_tubes("Hairball", [fibre(generator) for _ in range(count)], radius, 3, hair)
    if arguments.rotating:
        turn = math.radians(DEGREES_PER_FRAME * (FRAMES - 1))
        c.key_linear(ball, "rotation_euler", [(1, (0.0, 0.0, 0.0)), (FRAMES, (0.0, 0.0, turn))])
    c.add_sun(scene, azimuth_degrees=-50.0, height_degrees=48.0)
    c.add_camera(scene, location=(0.0, -7.0, 0.9), target=(0.0, 0.0, 0.0), lens_mm=66.0)


if __name__ == "__main__":
    c.run(__file__, __doc__, build, options)
