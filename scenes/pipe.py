# SPDX-License-Identifier: MIT
"""pipe: one brown pipe with two flanges in front of a plain sky; nothing moves.

After the pipe tests of [Oliveros 2018, 5.2.2]. One solid colour and long straight edges alone: upright and level ones
that a filter finds easily, and with ``--rolled``, where the camera is skewed, ones of a low slope.

usage: blender -b --python-exit-code 9 -P scenes/pipe.py -- --out build/scenes/pipe.blend [--rolled]
"""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import facade as f  # noqa: E402

ROLL_DEGREES = 19.0  # neither along the pixels nor along their diagonals
OUTER, INNER, FLANGE = 0.5, 0.4, 0.7  # radii, metres
LENGTH = 4.4


def options(parser) -> None:
    """Variants of the scene."""
    parser.add_argument("--rolled", action="store_true", help="the camera is skewed by 19 degrees")


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution)
    c.add_sky(scene, horizon=(0.62, 0.74, 0.90), zenith=(0.62, 0.74, 0.90))
    end, flange = LENGTH, 0.2
    outside = [(end, OUTER), (end - 0.5, OUTER), (end - 0.5, FLANGE), (end - 0.5 - flange, FLANGE)]
    outside += [(end - 0.5 - flange, OUTER), (0.5 + flange, OUTER), (0.5 + flange, FLANGE)]
    outside += [(0.5, FLANGE), (0.5, OUTER), (0.0, OUTER)]
    c.add_revolved(
        "Pipe",
        (-LENGTH / 2, 0.0, 0.0),
        (1.0, 0.0, 0.0),
        [*outside, (0.0, INNER), (end, INNER)],
        16,
        c.material("Pipe Brown", f.PIPE_BROWN),
    )
    c.add_sun(scene, azimuth_degrees=-118.0, height_degrees=42.0)
    c.add_camera(
        scene,
        location=(-4.2, -9.0, 1.1),
        target=(0.0, 0.0, 0.0),
        lens_mm=66.0,
        roll_degrees=ROLL_DEGREES if arguments.rolled else 0.0,
    )


if __name__ == "__main__":
    c.run(__file__, __doc__, build, options)
