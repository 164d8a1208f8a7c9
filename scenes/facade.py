# SPDX-License-Identifier: MIT
"""The models of the hard edges: window with blinds, arched window. Their slits are as wide as the scene asks."""

from __future__ import annotations

import math

import common as c

BLUE: c.RGB = (0.055, 0.16, 0.46)
SLAT_BLUE: c.RGB = (0.16, 0.36, 0.72)
DOOR_BLUE: c.RGB = (0.10, 0.27, 0.60)
DARK: c.RGB = (0.012, 0.014, 0.02)
WHITE: c.RGB = (0.80, 0.79, 0.76)
PIPE_BROWN: c.RGB = (0.30, 0.125, 0.045)


def add_blinds_window(low: c.Point2, high: c.Point2, slit: float, blue, dark, white) -> None:
    """Frame between two corners (x, z) with 24 closed slats; the slits between them are dark."""
    (x0, z0), (x1, z1) = low, high
    rim = 0.16
    c.add_box("Blinds Recess", (x0, -0.02, z0), (x1, 0.02, z1), dark)
    c.add_boxes(
        "Blinds Frame",
        [
            ((x0 - rim, -0.28, z0 - rim), (x0, 0.0, z1 + rim)),
            ((x1, -0.28, z0 - rim), (x1 + rim, 0.0, z1 + rim)),
            ((x0, -0.28, z1), (x1, 0.0, z1 + rim)),
            ((x0, -0.28, z0 - rim), (x1, 0.0, z0)),
        ],
        blue,
    )
    c.add_box("Blinds Sill", (x0 - 0.35, -0.42, z0 - rim - 0.14), (x1 + 0.35, 0.0, z0 - rim), white)
    count = 24
    pitch = (z1 - z0) / count
    slats = [
        (
            (x0, -0.12, z0 + index * pitch + slit / 2),
            (x1, -0.09, z0 + (index + 1) * pitch - slit / 2),
        )
        for index in range(count)
    ]
    c.add_boxes("Blinds Slats", slats, c.material("Slat Blue", SLAT_BLUE))


def add_arched_window(centre: float, gap: float, blue, dark) -> None:
    """Arched frame, 3 m wide, with a two-leaf door and a fan light: gaps between its panels, thin glazing bars."""
    half, sill, spring = 1.5, 0.25, 3.3
    c.add_arch_wall(
        "Arch Frame",
        (centre - half - 0.24, centre + half + 0.24),
        (sill - 0.2, spring + half + 0.26),
        (-0.22, 0.0),
        [(centre, half, sill, spring)],
        blue,
        steps=32,
    )
    c.add_box(
        "Arch Recess", (centre - half, -0.02, sill), (centre + half, 0.02, spring + half), dark
    )
    leaf = c.material("Door Blue", DOOR_BLUE)
    panels = []
    for side in (-1, 1):
        near, far = centre + side * gap / 2, centre + side * (half - gap)
        low_x, high_x = min(near, far), max(near, far)
        rows = 4
        height = (spring - sill - 0.2) / rows
        for row in range(rows):
            z = sill + row * height
            panels.append(((low_x, -0.1, z + gap / 2), (high_x, -0.06, z + height - gap / 2)))
    c.add_boxes("Arch Door", panels, leaf)
    c.add_box(
        "Arch Transom",
        (centre - half, -0.14, spring - 0.2),
        (centre + half, -0.05, spring - 0.06),
        blue,
    )
    for index, degrees in enumerate((30.0, 60.0, 90.0, 120.0, 150.0)):
        angle = math.radians(degrees)
        end = (centre + half * math.cos(angle), -0.08, spring - 0.06 + half * math.sin(angle))
        c.add_cylinder(f"Fan Bar {index + 1}", (centre, -0.08, spring - 0.06), end, 0.022, 8, blue)
    c.add_cylinder(
        "Door Knob Left", (centre - 0.16, -0.2, 1.6), (centre - 0.16, -0.1, 1.6), 0.06, 12, dark
    )
    c.add_cylinder(
        "Door Knob Right", (centre + 0.16, -0.2, 1.6), (centre + 0.16, -0.1, 1.6), 0.06, 12, dark
    )
