# SPDX-License-Identifier: MIT
"""The models that several scenes of hard edges show: window with blinds, arched window, wall with letters. Slits are as
wide as the scene asks."""

from __future__ import annotations

import math
from typing import Sequence

import common as c
import numpy as np

BLUE: c.RGB = (0.055, 0.16, 0.46)
SLAT_BLUE: c.RGB = (0.16, 0.36, 0.72)
DOOR_BLUE: c.RGB = (0.10, 0.27, 0.60)
DARK: c.RGB = (0.012, 0.014, 0.02)
WHITE: c.RGB = (0.80, 0.79, 0.76)
PIPE_BROWN: c.RGB = (0.30, 0.125, 0.045)
INK = 0.012

Line = tuple[str, float, float]  # text, height of its middle over the wall's, size: metres


def add_daylight(scene) -> None:
    """The sky and the sun before which they all stand."""
    c.add_sky(scene, horizon=(0.62, 0.74, 0.90), zenith=(0.16, 0.34, 0.70))
    c.add_sun(scene, azimuth_degrees=-118.0, height_degrees=42.0)


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


def _letter_triangles(body: str, height: float, size: float) -> np.ndarray:
    """Letters of Blender's built-in font as triangles (n, 3 corners, x and z)."""
    item = c.add_text("Text", body, (0.0, 0.0, 0.0), size, None)
    evaluated = item.evaluated_get(c.bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    mesh.calc_loop_triangles()
    corners = np.array([vertex.co[:2] for vertex in mesh.vertices]) + (0.0, height)
    found = corners[np.array([triangle.vertices[:] for triangle in mesh.loop_triangles])]
    evaluated.to_mesh_clear()
    curve = item.data
    c.bpy.data.objects.remove(item)
    c.bpy.data.curves.remove(curve)
    return found


def _letters_image(
    half_width: float, half_height: float, lines: Sequence[Line], texels_per_metre: int
) -> c.bpy.types.Image:
    """White with black letters: a texel is black if its centre lies in a letter."""
    texels = [round(2 * half * texels_per_metre) for half in (half_width, half_height)]
    width, height = texels
    black = np.zeros((height, width), bool)
    for line in lines:
        for corners in (_letter_triangles(*line) + (half_width, half_height)) * texels_per_metre:
            low = np.maximum(np.floor(corners.min(axis=0)).astype(int), 0)
            high = np.minimum(np.ceil(corners.max(axis=0)).astype(int), texels)
            x, y = np.meshgrid(*(np.arange(a, b) + 0.5 for a, b in zip(low, high)))
            sides = [
                (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
                for a, b in zip(corners, np.roll(corners, -1, axis=0))
            ]
            inside = np.minimum.reduce(sides) >= 0, np.maximum.reduce(sides) <= 0
            black[low[1] : high[1], low[0] : high[0]] |= inside[0] | inside[1]
    image = c.bpy.data.images.new("Letters", width, height, float_buffer=True, is_data=True)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = np.where(black[..., None], INK, WHITE)
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    return image


def add_text_wall(
    centre: Sequence[float],
    half_width: float,
    half_height: float,
    lines: Sequence[Line],
    texels_per_metre: int,
) -> c.bpy.types.Object:
    """Upright white face whose texture bears black letters, with no texel between black and white."""
    paper = c.material("Wall White", WHITE)
    c.textured(paper, _letters_image(half_width, half_height, lines, texels_per_metre))
    right, up = c.Vector((half_width, 0.0, 0.0)), c.Vector((0.0, 0.0, half_height))
    return c.add_squares("Wall", [(c.Vector(centre), right, up)], paper)
