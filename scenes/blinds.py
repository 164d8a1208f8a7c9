# SPDX-License-Identifier: MIT
"""blinds: one window whose closed blinds leave slits of a pixel, whatever the resolution; nothing moves.

After the window with blinds of [Oliveros 2018, 5.2.3]. Lines of one pixel at an even distance that beat against the
pixel grid; the camera is a little aslant, so that each slit crosses several rows.

usage: blender -b --python-exit-code 9 -P scenes/blinds.py -- --out build/scenes/blinds.blend
"""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import facade as f  # noqa: E402

PICTURE_WIDTH = 6.9  # metres at the window


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution)
    f.add_daylight(scene)
    c.add_box(
        "Facade", (-9.0, 0.0, -6.0), (9.0, 0.4, 6.0), c.material("Plaster", (0.62, 0.47, 0.33))
    )
    f.add_blinds_window(
        (-1.9, -1.35),
        (1.9, 1.55),
        PICTURE_WIDTH / arguments.resolution[0],
        c.material("Window Blue", f.BLUE),
        c.material("Dark Inside", f.DARK),
        c.material("White", f.WHITE),
    )
    c.add_camera(
        scene, location=(-1.6, -19.0, 0.8), target=(0.0, 0.0, 0.0), lens_mm=100.0, roll_degrees=1.5
    )


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
