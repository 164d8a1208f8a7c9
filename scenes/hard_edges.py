# SPDX-License-Identifier: MIT
"""hard_edges: a facade full of thin straight things, seen by a far camera; nothing moves.

After the "hard edges" test of [Oliveros 2018, 5.2.7], its four models together: a brown pipe, a blue window with closed
blinds whose slits are about one pixel wide, a blue arched window with a door in it whose gaps are as thin, and a white
wall whose texture bears black letters. The camera looks slightly from the side and is rolled by two degrees, so that hardly
an edge is parallel to the pixel grid.

usage: blender -b --python-exit-code 9 -P scenes/hard_edges.py -- --out build/scenes/hard_edges.blend
"""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import facade as f  # noqa: E402

PICTURE_WIDTH = 16.3  # metres at the facade
TEXELS_PER_METRE = 240  # eight to a pixel of 480 x 270
LINES = (  # text, height of its middle over the wall's, size: metres
    ("HARD EDGES", 0.75, 0.86),
    ("anti-aliasing 0123456789", -0.05, 0.42),
    ("the quick brown fox jumps over the lazy dog", -0.6, 0.26),
    ("THIN STROKES BREAK UP WHEN A PIXEL IS TOO COARSE FOR THEM", -1.05, 0.16),
)


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution)
    f.add_daylight(scene)
    blue = c.material("Window Blue", f.BLUE)
    dark = c.material("Dark Inside", f.DARK)
    white = c.material("White", f.WHITE)
    slit = PICTURE_WIDTH / arguments.resolution[0]
    plaster = c.material("Plaster", (0.62, 0.47, 0.33))
    stone = c.material("Stone", (0.46, 0.42, 0.37))
    ground = c.material("Ground", (0.30, 0.33, 0.24))
    pipe = c.material("Pipe Brown", f.PIPE_BROWN)

    c.add_box("Facade", (-8.6, 0.0, 0.0), (8.3, 3.0, 6.1), plaster)
    c.add_box("Plinth", (-8.75, -0.18, 0.0), (3.1, 0.0, 0.75), stone)
    c.add_box("Plinth Right", (6.7, -0.18, 0.0), (8.45, 0.0, 0.75), stone)
    c.add_box("Cornice", (-8.9, -0.35, 6.1), (8.6, 3.2, 6.38), stone)
    c.add_boxes(
        "Cornice Teeth",
        [
            ((-8.5 + 0.3 * index, -0.24, 5.94), (-8.36 + 0.3 * index, 0.0, 6.1))
            for index in range(56)
        ],
        stone,
    )
    c.add_box("Ground", (-60.0, -50.0, -0.2), (60.0, 60.0, 0.0), ground)
    c.add_boxes(
        "Steps", [((3.2, -1.1, 0.0), (6.6, 0.0, 0.1)), ((3.4, -0.6, 0.1), (6.4, 0.0, 0.2))], stone
    )
    f.add_blinds_window((-7.2, 1.9), (-4.3, 5.0), slit, blue, dark, white)
    f.add_arched_window(4.9, slit, blue, dark)
    c.add_box("Wall Behind Letters", (-3.1, -0.16, 2.3), (2.4, 0.0, 5.1), white)
    f.add_text_wall((-0.35, -0.165, 3.7), 2.75, 1.4, LINES, TEXELS_PER_METRE)
    c.add_cylinder("Pipe", (-3.6, -1.5, 0.22), (3.5, -1.1, 1.75), 0.3, 10, pipe)
    c.add_cylinder(
        "Pipe Collar Left", (-3.72, -1.507, 0.195), (-3.1, -1.472, 0.328), 0.37, 10, pipe
    )
    c.add_cylinder("Pipe Collar Right", (3.0, -1.128, 1.642), (3.6, -1.094, 1.772), 0.37, 10, pipe)
    c.add_cylinder("Down Pipe", (7.55, -0.14, 0.0), (7.55, -0.14, 6.1), 0.085, 10, pipe)
    c.add_cylinder("Mast", (-9.7, -0.8, 0.0), (-9.45, -0.8, 7.2), 0.05, 8, stone)
    wire = c.material("Wire", (0.02, 0.02, 0.02))
    c.add_cylinder("Wire Upper", (-9.47, -0.8, 7.0), (-3.0, 0.2, 6.36), 0.014, 6, wire)
    c.add_cylinder("Wire Lower", (-9.5, -0.8, 6.6), (-6.0, 0.2, 6.34), 0.014, 6, wire)

    c.add_camera(
        scene,
        location=(-9.5, -45.0, 5.6),
        target=(-0.45, 0.0, 3.25),
        lens_mm=100.0,
        roll_degrees=2.0,
    )


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
