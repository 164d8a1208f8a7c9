# SPDX-License-Identifier: MIT
"""arched_window: one window with an arch and a door whose gaps are a pixel wide, whatever the resolution; nothing moves.

After the arched window of [Oliveros 2018, 5.2.4]. An edge of every slope in the arch, gaps
that vanish between samples around the door's panels.

usage: blender -b --python-exit-code 9 -P scenes/arched_window.py -- --out build/scenes/arched_window.blend
"""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import facade as f  # noqa: E402

PICTURE_WIDTH = 9.6  # metres at the window


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution)
    f.add_daylight(scene)
    c.add_box(
        "Facade", (-9.0, 0.0, -6.0), (9.0, 0.4, 9.0), c.material("Plaster", (0.62, 0.47, 0.33))
    )
    f.add_arched_window(
        0.0,
        PICTURE_WIDTH / arguments.resolution[0],
        c.material("Window Blue", f.BLUE),
        c.material("Dark Inside", f.DARK),
    )
    c.add_camera(
        scene, location=(-2.4, -26.5, 3.4), target=(0.0, 0.0, 2.5), lens_mm=100.0, roll_degrees=1.5
    )


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
