# SPDX-License-Identifier: MIT
"""stairs: plain grey steps that fill the picture; nothing moves.

After the fourth scene of [Stejmar n.d.]: a close-up of steps of one grey, whose edges are nearly level. The upper treads
are seen edge on, and of those above the eye only the bevel shows, so that several edges share a pixel there. Neither
textures nor shadows: the sun stands behind the camera, and all error lies at edges of geometry.

usage: blender -b --python-exit-code 9 -P scenes/stairs.py -- --out build/scenes/stairs.blend
"""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import masonry as m  # noqa: E402

STEPS, TREAD, RISER, BEVEL = 14, 0.32, 0.165, 0.005  # metres; a bevel is below a pixel
HALF_WIDTH = 9.0


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution)
    c.add_sky(scene, horizon=(0.62, 0.74, 0.90), zenith=(0.62, 0.74, 0.90))
    grey = c.material("Step Stone", (0.5, 0.5, 0.5))
    profile = []  # y and z
    for k in range(STEPS):
        front, top = TREAD * k, RISER * (k + 1)
        profile += [(front, top - RISER), (front, top - BEVEL), (front + BEVEL, top)]
    profile += [(TREAD * STEPS, RISER * STEPS), (TREAD * STEPS, 4.0)]  # a wall behind them
    corners = [(x, y, z) for y, z in profile for x in (-HALF_WIDTH, HALF_WIDTH)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    stairs = m.Parts()
    stairs.add(corners, faces)
    stairs.object("Stairs", grey)
    c.add_sun(scene, azimuth_degrees=-97.0, height_degrees=77.0)
    c.add_camera(
        scene,
        location=(-0.2, -2.6, 1.05),
        target=(-0.05, 1.4, 0.72),
        lens_mm=42.0,
        roll_degrees=3.5,
    )


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
