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

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import facade as f  # noqa: E402

HALF_WIDTH, HALF_HEIGHT = 3.0, 1.6875  # metres
TEXELS_PER_METRE = 320
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


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution)
    f.add_daylight(scene)
    f.add_text_wall((0.0, 0.0, 0.0), HALF_WIDTH, HALF_HEIGHT, LINES, TEXELS_PER_METRE)
    c.add_camera(
        scene, location=(-3.4, -17.0, 1.2), target=(0.0, 0.0, 0.0), lens_mm=96.0, roll_degrees=2.0
    )


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
