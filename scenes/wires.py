# SPDX-License-Identifier: MIT
"""wires: what is thinner than a pixel, at rest and moving, under a camera that moves slowly.

Phone wires and poles against the sky, stairs with railings, a turning skeleton of thin bones, and two chequered
spheres that cross each other. The camera drifts to the right by half a pixel per frame at 480 x 270.

usage: blender -b --python-exit-code 9 -P scenes/wires.py -- --out build/scenes/wires.blend
"""

from __future__ import annotations

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)

FRAMES = 100
WIRE_RADIUS = 0.011  # metres; a pixel is 0.03 to 0.1 m wide at the wires


def catenary(start, end, sag: float, steps: int = 24):
    """A hanging wire as a polyline (a parabola, which it is to a fraction of a millimetre)."""
    a, b = c.Vector(start), c.Vector(end)
    return [
        a.lerp(b, step / steps) - c.Vector((0, 0, 4 * sag * step / steps * (1 - step / steps)))
        for step in range(steps + 1)
    ]


def add_poles(wood, wire) -> None:
    """Five poles that recede to the right, eight wires from pole to pole."""
    places = [(-9.0 + 5.5 * index, 6.0 + 6.0 * index) for index in range(5)]
    arms = [
        (-0.85, 6.2),
        (-0.35, 6.2),
        (0.35, 6.2),
        (0.85, 6.2),
        (-0.6, 5.6),
        (-0.25, 5.6),
        (0.25, 5.6),
        (0.6, 5.6),
    ]
    for index, (x, y) in enumerate(places):
        c.add_cylinder(f"Pole {index + 1}", (x, y, 0.0), (x, y, 6.6), 0.11, 10, wood)
        c.add_boxes(
            f"Cross Arms {index + 1}",
            [
                ((x - 0.95, y - 0.05, 6.08), (x + 0.95, y + 0.05, 6.2)),
                ((x - 0.7, y - 0.05, 5.48), (x + 0.7, y + 0.05, 5.6)),
            ],
            wood,
        )
    wires = []
    for (x0, y0), (x1, y1) in zip(places, places[1:]):
        wires += [catenary((x0 + dx, y0, z), (x1 + dx, y1, z), 0.45) for dx, z in arms]
    c.add_tubes("Wires", wires, WIRE_RADIUS, 5, wire)


def add_stairs(stone, metal) -> None:
    """Fourteen steps seen from the side, with two railings of thin bars."""
    steps = [
        ((-7.6 + 0.28 * k, 1.4, 0.0), (-7.32 + 0.28 * k, 3.2, 0.17 * (k + 1))) for k in range(14)
    ]
    c.add_boxes("Stairs", steps, stone)
    bars = []
    for y in (1.45, 3.15):
        for k in range(14):
            x, z = -7.46 + 0.28 * k, 0.17 * (k + 1)
            bars.append([(x, y, z), (x, y, z + 0.9)])
        bars.append([(-7.46, y, 1.07), (-7.46 + 0.28 * 13, y, 0.17 * 14 + 0.9)])
    c.add_tubes("Railings", bars, 0.012, 6, metal)


def add_skeleton(bone) -> c.bpy.types.Object:
    """Spine, ribs, arms and legs of thin bones about a vertical axis."""
    spine = [(0, 0.05 * math.sin(3 * t), 0.9 + 0.9 * t) for t in (k / 10 for k in range(11))]
    paths = [spine]
    for k in range(8):
        z, wide = 1.75 - 0.085 * k, 0.30 - 0.012 * abs(k - 4)
        for side in (-1, 1):
            paths.append(
                [
                    (side * wide * math.sin(a), 0.1 - 0.26 * (1 - math.cos(a)), z - 0.03 * a)
                    for a in (j * 0.35 for j in range(9))
                ]
            )
    for side in (-1, 1):
        paths.append(
            [
                (side * 0.1, 0, 1.82),
                (side * 0.42, 0, 1.78),
                (side * 0.62, -0.1, 1.25),
                (side * 0.75, -0.35, 0.95),
            ]
        )
        paths += [
            [(side * 0.75, -0.35, 0.95), (side * (0.72 + 0.05 * f), -0.5, 0.82 + 0.02 * f)]
            for f in range(4)
        ]
        paths.append(
            [
                (side * 0.05, 0, 0.9),
                (side * 0.24, 0, 0.86),
                (side * 0.3, -0.08, 0.45),
                (side * 0.28, 0.02, 0.02),
            ]
        )
        paths.append([(side * 0.28, 0.02, 0.02), (side * 0.32, -0.22, 0.01)])
    paths.append(
        [
            (0.13 * math.sin(a), 0.13 * math.cos(a), 2.02)
            for a in (j * math.pi / 6 for j in range(13))
        ]
    )
    paths.append(
        [
            (0.13 * math.sin(a), 0, 2.02 + 0.16 * math.cos(a))
            for a in (j * math.pi / 6 for j in range(13))
        ]
    )
    return c.add_tubes("Skeleton", paths, 0.014, 6, bone)


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution, FRAMES)
    c.add_sky(scene, horizon=(0.78, 0.82, 0.86), zenith=(0.20, 0.40, 0.74))
    wood = c.material("Pole Wood", (0.20, 0.13, 0.08))
    wire = c.material("Wire", (0.02, 0.02, 0.022))
    stone = c.material("Stone", (0.58, 0.54, 0.48))
    metal = c.material("Railing Metal", (0.08, 0.10, 0.12))
    bone = c.material("Bone", (0.82, 0.76, 0.62))
    c.add_box("Ground", (-80, -20, -0.2), (80, 120, 0.0), c.material("Ground", (0.34, 0.36, 0.22)))
    c.add_box(
        "Dark Wall", (-1.6, 3.4, 0.0), (2.6, 3.7, 2.6), c.material("Dark Wall", (0.10, 0.09, 0.10))
    )
    add_poles(wood, wire)
    add_stairs(stone, metal)
    skeleton = add_skeleton(bone)
    skeleton.location = (0.4, 1.6, 0.05)
    turn = math.radians(3.0 * (FRAMES - 1))
    c.key_linear(skeleton, "rotation_euler", [(1, (0, 0, 0)), (FRAMES, (0, 0, turn))])
    for name, colour, other, start, end in (
        ("Sphere Red", (0.62, 0.07, 0.05), (0.80, 0.74, 0.62), (2.4, 1.2, 0.6), (9.3, 3.6, 0.6)),
        ("Sphere Green", (0.06, 0.34, 0.16), (0.78, 0.76, 0.30), (6.2, 3.4, 0.9), (0.7, 0.4, 0.9)),
    ):
        surface = c.material(name, colour)
        c.make_checkered(surface, other, 4.0)
        sphere = c.add_sphere(name, start, 0.6 if name.endswith("Red") else 0.9, surface)
        c.key_linear(sphere, "location", [(1, start), (FRAMES, end)])
        c.key_linear(sphere, "rotation_euler", [(1, (0, 0, 0)), (FRAMES, (0.0, 4.0, 2.0))])
    c.add_sun(scene, azimuth_degrees=-70.0, height_degrees=40.0)
    camera = c.add_camera(scene, location=(-0.6, -10.5, 2.2), target=(-0.4, 3.0, 2.6), lens_mm=32.0)
    c.key_linear(camera, "location", [(1, (-0.6, -10.5, 2.2)), (FRAMES, (0.9, -10.5, 2.2))])


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
