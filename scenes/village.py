# SPDX-License-Identifier: MIT
"""village: a street of houses with barred windows, cobbles, stairs, poles and wires under a cloudy sky.

After the world of the Linkoping thesis. The skeleton of a dinosaur turns on its base, two spheres of tiled stone move
along the street; the cameras stand still. Its views are those of the thesis's four scenes:

* ``overview``: wires, poles, stairs and windows, mostly far;
* ``close-up``: geometric edges with stone textures, bars in front of a window;
* ``wires``: the top of a pole and its wires at a distance, against the sky;
* ``stairs``: a crop of grey steps whose edges are nearly level, several per pixel in the upper ones.

usage: blender -b --python-exit-code 9 -P scenes/village.py -- --out build/scenes/village.blend [--view wires]
"""

from __future__ import annotations

import math
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import masonry as m  # noqa: E402
import textures  # noqa: E402

FRAMES = 100
STREET = 4.2  # half its width, metres
STEPS = 16
STAIR_FOOT = (1.6, 22.0)  # x of its left end, y of its first riser

# view: (camera, target, lens in mm)
VIEWS = {
    "overview": ((-1.9, -9.5, 3.1), (0.3, 12.0, 3.2), 27.0),
    "close-up": ((-1.35, 2.2, 1.75), (-4.3, 4.9, 1.95), 30.0),
    "wires": ((-1.2, -3.0, 1.7), (2.9, 12.0, 7.2), 62.0),
    "stairs": ((1.3, 16.2, 1.75), (1.45, 24.5, 1.45), 58.0),
}

# side of the street, y of the front's low end, width, height of the eaves, kind of wall
HOUSES = (
    (-1, -7.0, 8.2, 5.4, "plaster"),
    (-1, 1.8, 7.4, 6.2, "stone"),
    (-1, 9.8, 6.6, 5.2, "brick"),
    (-1, 17.0, 9.0, 6.6, "plaster"),
    (1, -8.0, 7.6, 5.8, "brick"),
    (1, 0.2, 8.6, 5.2, "plaster"),
    (1, 9.4, 6.8, 6.4, "stone"),
)
DEPTH = 7.0  # of a house


def options(parser) -> None:
    """Which camera looks."""
    parser.add_argument(
        "--view", choices=sorted(VIEWS), default="overview", help="the camera's place (overview)"
    )


def house_place(side: int, y: float, width: float) -> c.Matrix:
    """x runs along the house's front, -y looks into the street."""
    if side < 0:
        return m.at(-STREET, y, 0.0, 90.0)
    return m.at(STREET, y + width, 0.0, -90.0)


class Village:
    """Parts of the houses that share a material, gathered over all of them."""

    def __init__(self) -> None:
        self.frames, self.glass, self.bars, self.wood = (m.Parts() for _ in range(4))
        self.quoins, self.roofs, self.chimneys = m.Parts(), m.Parts(), m.Parts()


def add_window(parts: Village, x: float, half: float, low: float, high: float, place) -> None:
    """Frame, panes with glazing bars, a sill, and a cage of thin bars in front."""
    t = 0.09
    for a, b in (
        ((x - half - t, -0.05, low - t), (x - half, 0.06, high + t)),
        ((x + half, -0.05, low - t), (x + half + t, 0.06, high + t)),
        ((x - half, -0.05, high), (x + half, 0.06, high + t)),
        ((x - half - 0.16, -0.16, low - t - 0.05), (x + half + 0.16, 0.06, low - t + 0.04)),
    ):
        parts.frames.box(a, b, place)
    parts.glass.quad(
        (x - half, 0.2, low),
        (x + half, 0.2, low),
        (x + half, 0.2, high),
        (x - half, 0.2, high),
        place,
    )
    parts.wood.box((x - 0.025, 0.14, low), (x + 0.025, 0.19, high), place)
    for k in range(1, 3):
        z = low + (high - low) * k / 3
        parts.wood.box((x - half, 0.15, z - 0.02), (x + half, 0.185, z + 0.02), place)
    count = max(4, round(2 * half / 0.13))
    for k in range(count + 1):
        bx = x - half + 2 * half * k / count
        ends = [place @ c.Vector((bx, -0.03, z)) for z in (low - 0.05, high + 0.02)]
        parts.bars.add(*c.tube_parts(ends, 0.008, 5, 0))
    for z in (low + 0.12, (low + high) / 2, high - 0.12):
        parts.bars.box(
            (x - half - 0.02, -0.04, z - 0.012), (x + half + 0.02, -0.028, z + 0.012), place
        )


def add_house(name, parts: Village, side, y, width, eaves, wall, seed: int) -> None:
    """Walls with openings, gable roof of round tiles along the street, corner stones, door, chimney."""
    generator = random.Random(seed)
    place = house_place(side, y, width)
    shell = m.Parts()
    bays = max(2, round(width / 2.3))
    door = generator.randrange(bays)
    openings = []
    for index in range(bays):
        x = (index + 0.5) * width / bays
        if index == door:
            continue
        openings.append((x, 0.5, 1.05, 2.45))
    upper = [
        ((index + 0.5) * width / bays, 0.46, 3.75, 5.0 if eaves > 5.5 else 4.75)
        for index in range(bays)
    ]
    centre = (door + 0.5) * width / bays
    lower = sorted([*((x, h, low, high) for x, h, low, high in openings), (centre, 0.55, 0.0, 2.0)])
    split = 3.05
    wall_front(shell, width, 0.0, split, lower, centre, place)
    wall_front(shell, width, split, eaves, upper, None, place)
    for x in (0.0, width):
        corners = [
            (x, 0.0, 0.0),
            (x, DEPTH, 0.0),
            (x, DEPTH, eaves),
            (x, DEPTH / 2, eaves + 2.3),
            (x, 0.0, eaves),
        ]
        shell.add(corners, [tuple(range(5)) if x else tuple(reversed(range(5)))], place)
    shell.quad((width, DEPTH, 0), (0, DEPTH, 0), (0, DEPTH, eaves), (width, DEPTH, eaves), place)
    shell.object(name, wall)
    for x, half, low, high in [*openings, *upper]:
        add_window(parts, x, half, low, high, place)
    m.archivolt(parts.frames, centre, 2.0, 0.55, ((0.08, 0.05), (0.1, 0.08)), place, 14)
    for edge in (-0.73, 0.55):
        parts.frames.box((centre + edge, -0.08, 0.0), (centre + edge + 0.18, 0.0, 2.0), place)
    parts.wood.box((centre - 0.55, 0.16, 0.0), (centre + 0.55, 0.22, 2.55), place)
    for k in range(6):
        x = centre - 0.5 + 0.2 * k
        parts.wood.box((x - 0.085, 0.13, 0.05), (x + 0.085, 0.16, 2.2), place)
    for k in range(2):
        parts.frames.box(
            (centre - 0.95 + 0.14 * k, -0.62 + 0.28 * k, 0.0),
            (centre + 0.95 - 0.14 * k, 0.0, 0.12 * (k + 1)),
            place,
        )
    m.run_of(parts.frames, m.STRING_COURSE, width, place @ m.at(0, 0, split - 0.07))
    m.run_of(parts.frames, m.CORNICE, width, place @ m.at(0, 0, eaves - 0.34))
    for x in (0.0, width):
        for k in range(int(eaves / 0.36) - 1):
            wide = 0.42 if k % 2 else 0.26
            low = x - 0.03 if x == 0.0 else x - wide
            parts.quoins.box(
                (low, -0.03, 0.36 * k + 0.01), (low + wide + 0.03, 0.06, 0.36 * k + 0.35), place
            )
    over = 0.45
    for turned in (False, True):
        slope = place @ (
            m.at(width + 0.15, DEPTH + over, 0.0, 180.0) if turned else m.at(-0.15, -over)
        )
        rise = 2.45 * (DEPTH / 2 + over) / (DEPTH / 2)
        m.tiled_slope(
            parts.roofs, width + 0.3, DEPTH / 2 + over, rise,
            slope @ c.Matrix.Translation((0, 0, eaves + 2.42 - rise)), (0.3, 0.42), 3,
        )  # fmt: skip
    ridge = [place @ c.Vector((x, DEPTH / 2, eaves + 2.44)) for x in (-0.15, width + 0.15)]
    parts.roofs.add(*c.tube_parts(ridge, 0.13, 8, 0))
    x = width * generator.uniform(0.2, 0.8)
    parts.chimneys.box((x - 0.35, 2.1, eaves + 0.8), (x + 0.35, 2.75, eaves + 3.1), place)
    parts.chimneys.box((x - 0.42, 2.03, eaves + 3.1), (x + 0.42, 2.82, eaves + 3.24), place)


def wall_front(shell, width, low, high, openings, door, place) -> None:
    """Front of a storey with square windows 0.24 m deep and, at ``door``, an arched one."""
    left, deep = 0.0, 0.24

    def face(x0, z0, x1, z1) -> None:
        if x1 > x0 and z1 > z0:
            shell.quad((x0, 0, z0), (x1, 0, z0), (x1, 0, z1), (x0, 0, z1), place)

    for x, half, sill, top in openings:
        a, b = x - half, x + half
        face(left, low, a, high)
        face(a, low, b, sill)
        left = b
        if x == door:
            outline = c.arch_points(x, top, half, 14)
        else:
            outline = [(b, top), (a, top)]
            shell.quad((a, 0, sill), (b, 0, sill), (b, deep, sill), (a, deep, sill), place)
        path = [(b, sill), *outline, (a, sill)]
        for (px, pz), (qx, qz) in zip(path, path[1:]):
            if (px, pz) != (qx, qz):
                shell.quad((px, deep, pz), (qx, deep, qz), (qx, 0, qz), (px, 0, pz), place)
        for (px, pz), (qx, qz) in zip(outline, outline[1:]):
            shell.quad((qx, 0, qz), (px, 0, pz), (px, 0, high), (qx, 0, high), place)
    face(left, low, width, high)


def add_cobbles(stone, mortar) -> None:
    """Street of rounded stones, laid in rows with a crown in the middle, and kerbs."""
    generator = random.Random(20150616)
    ground = m.Parts()
    ground.quad((-60, -40, -0.02), (60, -40, -0.02), (60, 90, -0.02), (-60, 90, -0.02))
    ground.object("Ground", mortar)
    cobbles = m.Parts()
    size, row = 0.24, 0
    y = -7.5
    while y < 22.0:
        x = -STREET + 0.95 + (size / 2 if row % 2 else 0.0)
        while x < STREET - 0.95:
            wide = size * generator.uniform(0.84, 0.95)
            deep = size * generator.uniform(0.84, 0.95)
            z = 0.05 * (1.0 - (x / STREET) ** 2) + generator.uniform(-0.006, 0.006)
            vertices = []
            for shrink, height in ((1.0, -0.05), (0.94, z), (0.62, z + 0.028)):
                for sx, sy in (
                    (-1, -0.6),
                    (-0.6, -1),
                    (0.6, -1),
                    (1, -0.6),
                    (1, 0.6),
                    (0.6, 1),
                    (-0.6, 1),
                    (-1, 0.6),
                ):
                    vertices.append(
                        (x + sx * shrink * wide / 2, y + sy * shrink * deep / 2, height)
                    )
            faces = [
                (8 * r + k, 8 * r + (k + 1) % 8, 8 * r + 8 + (k + 1) % 8, 8 * r + 8 + k)
                for r in (0, 1)
                for k in range(8)
            ]
            faces.append(tuple(range(16, 24)))
            cobbles.add(vertices, faces[8:])
            x += size
        y += size
        row += 1
    cobbles.object("Cobbles", stone)


def add_pavements(slabs) -> None:
    """Raised walks of slabs along the houses."""
    walks = m.Parts()
    for side in (-1, 1):
        a, b = sorted((side * STREET, side * (STREET - 0.9)))
        walks.box((a, -8.0, -0.05), (b, 26.0, 0.13))
    walks.object("Pavements", slabs)


def add_stairs(grey, metal, wall) -> None:
    """Broad grey stairs at the street's end, with cheeks, two railings and a terrace above."""
    x, y = STAIR_FOOT[0] - 3.9, STAIR_FOOT[1]
    wide, tread, riser = 6.0, 0.32, 0.165
    steps = m.Parts()
    for k in range(STEPS):
        steps.box((x, y + tread * k, 0.0), (x + wide, y + tread * STEPS, riser * (k + 1) - 0.035))
        steps.box(
            (x, y + tread * k - 0.03, riser * (k + 1) - 0.035),
            (x + wide, y + tread * STEPS, riser * (k + 1)),
        )
    steps.object("Stairs", grey)
    terrace = m.Parts()
    top, back = riser * STEPS, y + tread * STEPS
    terrace.box((-14.0, back, -0.1), (14.0, back + 9.0, top))
    for edge in (x - 0.35, x + wide):
        terrace.add(
            [(edge + dx, *yz) for dx in (0.0, 0.35) for yz in ((y - 0.2, 0), (back, 0), (back, top + 0.3), (y - 0.2, 0.35))],
            [(3, 2, 1, 0), (4, 5, 6, 7), (0, 4, 7, 3), (3, 7, 6, 2)],
        )  # fmt: skip
    terrace.object("Terrace", wall)
    bars = []
    for edge in (x - 0.18, x + wide + 0.18):
        for k in range(STEPS):
            foot = (edge, y + tread * (k + 0.5), riser * (k + 1) + 0.1)
            bars.append([foot, (foot[0], foot[1], foot[2] + 0.85)])
        bars.append(
            [(edge, y + 0.1, riser + 0.92), (edge, y + tread * (STEPS - 0.4), riser * STEPS + 0.95)]
        )
    for k in range(60):
        px = -14.0 + 28.0 * k / 59
        if not x - 0.3 < px < x + wide + 0.3:
            bars.append([(px, back + 0.1, top), (px, back + 0.1, top + 0.95)])
    for a, b in ((-14.0, x - 0.2), (x + wide + 0.2, 14.0)):
        bars.append([(a, back + 0.1, top + 0.95), (b, back + 0.1, top + 0.95)])
    c.add_tubes("Railings", bars, 0.014, 6, metal)


def add_poles(wood, wire, china) -> None:
    """Phone poles along the street with cross arms and insulators, wires between them and to the houses."""
    poles, cups, wires = m.Parts(), m.Parts(), []
    places = [(3.55, -6.0), (3.05, 3.0), (3.35, 12.0), (3.0, 21.0), (6.5, 34.0)]
    arms = [
        (dx, z)
        for z, reach in ((7.55, 0.9), (6.95, 0.7))
        for dx in (-reach, -0.5 * reach, 0.5 * reach, reach)
    ]
    for x, y in places:
        m.lathe(poles, [[(0.14, 0.0), (0.09, 8.0)], [(0.09, 8.0), (0.0, 8.06)]], 12, m.at(x, y))
        for z, reach in ((7.45, 1.05), (6.85, 0.85)):
            poles.box((x - reach, y - 0.15, z - 0.1), (x + reach, y - 0.07, z))
            for sign in (-1, 1):
                ends = [(x, y - 0.12, z - 0.55), (x + sign * 0.6 * reach, y - 0.12, z - 0.06)]
                poles.add(*c.tube_parts(ends, 0.018, 6, 0))
        for dx, z in arms:
            cup = [
                (0.012, -0.1),
                (0.035, -0.09),
                (0.04, -0.03),
                (0.025, -0.01),
                (0.032, 0.02),
                (0.0, 0.05),
            ]
            m.lathe(cups, [cup], 8, m.at(x + dx, y - 0.11, z))
    for (x0, y0), (x1, y1) in zip(places, places[1:]):
        for number, (dx, z) in enumerate(arms):
            wires.append(
                hanging((x0 + dx, y0 - 0.11, z), (x1 + dx, y1 - 0.11, z), 0.3 + 0.02 * (number % 3))
            )
    for (x, y), target in zip(
        places, ((-4.1, -2.0, 5.0), (-4.1, 6.5, 5.6), (-4.1, 14.0, 4.8), (-4.1, 24.0, 6.0))
    ):
        for dx in (-0.06, 0.06):
            wires.append(
                hanging((x - 0.7 + dx, y, 6.95), (target[0], target[1] + 3 * dx, target[2]), 0.35)
            )
    poles.object("Poles", wood)
    cups.object("Insulators", china)
    c.add_tubes("Wires", wires, 0.009, 5, wire)


def hanging(start, end, sag: float, steps: int = 24):
    """A hanging wire as a polyline (a parabola)."""
    a, b = c.Vector(start), c.Vector(end)
    return [
        a.lerp(b, k / steps) - c.Vector((0, 0, 4 * sag * k / steps * (1 - k / steps)))
        for k in range(steps + 1)
    ]


def add_lanterns(iron, pane) -> None:
    """Street lamps: a fluted post, a bracket and a lantern with thin ribs."""
    posts, panes = m.Parts(), m.Parts()
    for x, y in ((-3.0, 0.6), (-3.0, 9.0), (-3.0, 17.4), (2.9, -2.0)):
        profile = [
            [
                (0.16, 0.1),
                (0.16, 0.3),
                (0.1, 0.38),
                (0.06, 0.9),
                (0.045, 1.0),
                (0.035, 3.0),
                (0.05, 3.05),
            ]
        ]
        m.lathe(posts, profile, 12, m.at(x, y))
        m.lathe(panes, [[(0.1, 3.08), (0.17, 3.5)]], 6, m.at(x, y))
        m.lathe(
            posts,
            [[(0.24, 3.5), (0.06, 3.68), (0.02, 3.8), (0.0, 3.82)], [(0.05, 3.05), (0.11, 3.08)]],
            6,
            m.at(x, y),
        )
        for k in range(6):
            a = 2 * math.pi * k / 6
            ends = [
                (x + r * math.cos(a), y + r * math.sin(a), z)
                for r, z in ((0.105, 3.08), (0.175, 3.5))
            ]
            posts.add(*c.tube_parts(ends, 0.01, 5, 0))
        posts.box((x - 0.35, y - 0.012, 2.85), (x + 0.35, y + 0.012, 2.875))
    posts.object("Lamp Posts", iron)
    panes.object("Lamp Panes", pane)


def add_skeleton(bone, stone) -> c.bpy.types.Object:
    """Dinosaur on two legs about the upright axis: its bones are tubes of a few centimetres and less."""

    def spine(t: float) -> c.Vector:
        """From the tail's tip (0) over the hip (0.5) to the skull (1)."""
        x = -1.75 + 3.1 * t
        z = 1.45 + 0.2 * math.sin(3.2 * t - 0.8) + 0.75 * max(0.0, t - 0.68) ** 1.2 * 3.0
        return c.Vector((x, 0.12 * math.sin(4.0 * t), z))

    bones: list[tuple[list, float]] = []
    for k in range(44):
        t = k / 44
        thick = 0.012 + 0.034 * math.exp(-(((t - 0.58) / 0.24) ** 2))
        bones.append(([spine(t), spine(t + 0.8 / 44)], thick))
        height = 0.03 + 0.15 * math.exp(-(((t - 0.58) / 0.22) ** 2))
        middle = spine(t + 0.4 / 44)
        bones.append(([middle, middle + c.Vector((-0.03, 0.0, height))], 0.008))
        if t < 0.45:
            bones.append(([middle, middle + c.Vector((-0.03, 0.0, -0.7 * height))], 0.007))
    for k in range(12):
        root = spine(0.55 + 0.019 * k)
        wide, deep = 0.3 - 0.012 * abs(k - 6), 0.62 - 0.02 * abs(k - 7)
        for side in (-1, 1):
            rib = [
                root
                + c.Vector((-0.05 * a, side * wide * math.sin(a), -deep * (1 - math.cos(a)) / 2))
                for a in (j * 0.27 for j in range(11))
            ]
            bones.append((rib, 0.011))
    hip, chest, head = spine(0.5), spine(0.78), spine(1.0)
    for side in (-1, 1):

        def shifted(base, *offsets):
            return [base + c.Vector((x, side * y, z)) for x, y, z in offsets]

        bones.append((shifted(hip, (-0.18, 0.1, 0.1), (0.0, 0.14, 0.02), (0.2, 0.1, 0.12)), 0.03))
        knee = hip + c.Vector((0.28, side * 0.24, -0.62))
        heel = hip + c.Vector((-0.16, side * 0.26, -1.08))
        sole = c.Vector((hip.x + 0.05, side * 0.27, 0.12))
        bones.append(([hip + c.Vector((0, side * 0.14, 0)), knee], 0.036))
        for gap in (-0.022, 0.022):
            bones.append(([knee + c.Vector((0, gap, 0)), heel + c.Vector((0, gap, 0))], 0.018))
        bones.append(([heel, sole], 0.022))
        for toe in (-1, 0, 1):
            bones.append(
                (
                    [
                        sole,
                        sole + c.Vector((0.2, 0.1 * toe, -0.06)),
                        sole + c.Vector((0.3, 0.14 * toe, -0.1)),
                    ],
                    0.012,
                )
            )
        elbow = chest + c.Vector((0.05, side * 0.22, -0.42))
        wrist = chest + c.Vector((0.25, side * 0.2, -0.5))
        bones.append((shifted(chest, (-0.12, 0.1, 0.02), (0.03, 0.19, -0.22)), 0.016))
        bones.append(([chest + c.Vector((0.03, side * 0.19, -0.22)), elbow, wrist], 0.012))
        for finger in (-1, 1):
            bones.append(([wrist, wrist + c.Vector((0.1, 0.03 * finger, -0.08))], 0.006))
        skull = [
            (-0.08, 0.09, 0.04),
            (0.08, 0.12, 0.1),
            (0.26, 0.09, 0.06),
            (0.5, 0.05, -0.04),
            (0.56, 0.0, -0.07),
        ]
        bones.append((shifted(head, *skull), 0.022))
        bones.append(
            (
                shifted(
                    head,
                    (-0.08, 0.09, 0.04),
                    (0.06, 0.12, -0.06),
                    (0.3, 0.09, -0.06),
                    (0.56, 0.0, -0.08),
                ),
                0.016,
            )
        )
        bones.append((shifted(head, (0.08, 0.12, 0.1), (0.12, 0.12, -0.06)), 0.012))
        bones.append((shifted(head, (0.26, 0.09, 0.06), (0.3, 0.09, -0.06)), 0.01))
        jaw = [(-0.04, 0.1, -0.06), (0.2, 0.08, -0.24), (0.44, 0.04, -0.28), (0.5, 0.0, -0.27)]
        bones.append((shifted(head, *jaw), 0.016))
        for k in range(7):
            x = 0.2 + 0.05 * k
            bones.append(
                (shifted(head, (x, 0.1 - 0.012 * k, -0.06), (x, 0.1 - 0.012 * k, -0.12)), 0.007)
            )
            bones.append(
                (shifted(head, (x, 0.085 - 0.01 * k, -0.245), (x, 0.085 - 0.01 * k, -0.18)), 0.006)
            )
    parts = m.Parts()
    for path, radius in bones:
        parts.add(*c.tube_parts(path, radius, 8, 0))
    skeleton = parts.object("Skeleton", bone)
    base = m.Parts()
    m.lathe(
        base,
        [
            [(1.15, 0.0), (1.15, 0.3)],
            m.round_moulding(1.12, 0.3, 0.12, 0.08),
            [(1.12, 0.42), (0.0, 0.42)],
        ],
        40,
        m.at(-0.6, 11.2, 0.03),
    )
    base.object("Skeleton Base", stone)
    return skeleton


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution, FRAMES)
    textures.add_cloudy_sky(scene, (0.70, 0.78, 0.86), (0.18, 0.37, 0.72), (0.88, 0.88, 0.90), 3.7)
    walls = {
        "plaster": textures.mottled("House Plaster", (0.74, 0.64, 0.46), (0.62, 0.5, 0.34), 0.7),
        "stone": textures.bricks(
            "House Stone",
            (0.52, 0.48, 0.42),
            (0.4, 0.36, 0.32),
            (0.26, 0.23, 0.2),
            (0.55, 0.28),
            0.014,
        ),
        "brick": textures.bricks(
            "House Brick",
            (0.46, 0.17, 0.11),
            (0.34, 0.12, 0.08),
            (0.5, 0.46, 0.4),
            (0.24, 0.075),
            0.008,
        ),
    }
    trim = textures.mottled("Trim Stone", (0.7, 0.66, 0.58), (0.56, 0.52, 0.45), 0.3)
    grey = c.material("Step Stone", (0.5, 0.5, 0.5))
    iron = c.material("Iron", (0.035, 0.037, 0.042))
    village = Village()
    for number, (side, y, width, eaves, kind) in enumerate(HOUSES, 1):
        add_house(f"House {number}", village, side, y, width, eaves, walls[kind], number)
    village.frames.object("Frames", trim)
    village.glass.object("Panes", c.material("Glass", (0.05, 0.065, 0.08)))
    village.bars.object("Window Bars", iron)
    village.wood.object("Doors", c.material("Painted Wood", (0.08, 0.2, 0.19)))
    village.quoins.object("Corner Stones", trim)
    village.roofs.object(
        "Roofs", textures.mottled("Roof Tiles", (0.55, 0.24, 0.14), (0.36, 0.15, 0.09), 0.45)
    )
    village.chimneys.object("Chimneys", walls["brick"])
    add_cobbles(
        textures.mottled("Cobble Stone", (0.48, 0.45, 0.42), (0.27, 0.25, 0.24), 0.3),
        textures.mottled("Earth", (0.3, 0.26, 0.2), (0.2, 0.17, 0.13), 0.5),
    )
    add_pavements(
        textures.bricks(
            "Slabs",
            (0.5, 0.48, 0.44),
            (0.43, 0.41, 0.38),
            (0.25, 0.23, 0.21),
            (0.9, 0.9),
            0.012,
            0.0,
        )
    )
    add_stairs(grey, iron, walls["stone"])
    add_poles(
        c.material("Pole Wood", (0.17, 0.11, 0.07)), c.material("Wire", (0.02, 0.02, 0.022)),
        c.material("China", (0.6, 0.62, 0.6)),
    )  # fmt: skip
    add_lanterns(iron, c.material("Lamp Pane", (0.75, 0.7, 0.55)))
    skeleton = add_skeleton(c.material("Bone", (0.8, 0.74, 0.6)), trim)
    skeleton.location = (-0.6, 11.2, 0.44)
    skeleton.scale = (1.45, 1.45, 1.45)
    turn = math.radians(3.0 * (FRAMES - 1))
    c.key_linear(skeleton, "rotation_euler", [(1, (0, 0, 0.4)), (FRAMES, (0, 0, 0.4 + turn))])
    for name, colour, other, radius, start, end in (
        (
            "Sphere Red",
            (0.5, 0.08, 0.06),
            (0.66, 0.6, 0.5),
            0.55,
            (-2.1, 2.2, 0.66),
            (1.9, 8.5, 0.66),
        ),
        (
            "Sphere Green",
            (0.1, 0.32, 0.14),
            (0.7, 0.68, 0.42),
            0.75,
            (1.9, 6.5, 0.86),
            (-1.9, 0.5, 0.86),
        ),
    ):
        surface = c.material(name, colour)
        c.make_checkered(surface, other, 6.0)
        sphere = c.add_sphere(name, start, radius, surface)
        c.key_linear(sphere, "location", [(1, start), (FRAMES, end)])
        c.key_linear(sphere, "rotation_euler", [(1, (0, 0, 0)), (FRAMES, (4.0, 1.0, 2.0))])
    c.add_sun(scene, azimuth_degrees=-58.0, height_degrees=47.0)
    c.add_camera(scene, *VIEWS[arguments.view])


if __name__ == "__main__":
    c.run(__file__, __doc__, build, options)
