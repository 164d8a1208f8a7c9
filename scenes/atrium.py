# SPDX-License-Identifier: MIT
"""atrium: a hall of two storeys of columns and arches round a court that is open to the sun.

After the plan of the Sponza atrium in the Oliveros thesis: arcades, galleries behind them, drapes, a tiled floor, sun
and shadow. A dark-blue sphere rests in the middle, or (``--flying``) comes along the hall in 100 frames, covers the
whole view once, about frame 63, and leaves over the camera's head. The camera stands still.

usage: blender -b --python-exit-code 9 -P scenes/atrium.py -- --out build/scenes/atrium.blend [--flying]
"""

from __future__ import annotations

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)
import masonry as m  # noqa: E402
import textures  # noqa: E402

FRAMES = 100
BAY = 3.2  # metres from column to column
LONG, SHORT = 9, 3  # bays of the court along x and along y
COURT_X, COURT_Y = LONG * BAY / 2, SHORT * BAY / 2
WALL = 0.62  # thickness of the arcades
GALLERY = 3.4  # depth of the galleries behind them

# heights, metres
SPRING = 3.05
STOREY = 5.35  # floor of the upper gallery
UPPER_SPRING = 7.75
EAVES = 9.1

# (turn, bays) of the four sides; each is built along x with its front at -y, its middle on the origin
SIDES = (
    ("North", 0.0, LONG, COURT_Y),
    ("West", 90.0, SHORT, COURT_X),
    ("South", 180.0, LONG, COURT_Y),
    ("East", 270.0, SHORT, COURT_X),
)

CAMERA = (-12.6, -1.5, 2.3)
TARGET = (0.0, 0.9, 3.05)
LENS_MM = 26.0
SPHERE_RADIUS = 1.7
COVER_FRAME = 63


def options(parser) -> None:
    """Variants of the scene."""
    parser.add_argument(
        "--flying", action="store_true", help="let the sphere fly along the hall (100 frames)"
    )


def side_place(turn: float, bays: int, distance: float) -> c.Matrix:
    """Where a side's left end lies: x runs along it, -y looks into the court."""
    return c.Matrix.Rotation(math.radians(turn), 4, "Z") @ c.Matrix.Translation(
        (-bays * BAY / 2, distance, 0.0)
    )


def add_columns(stone, slim) -> None:
    """Columns of both storeys; all of one storey share a mesh."""
    low = m.Parts()
    m.column(low, 0.34, SPRING, 32, 0.42, 0.55)
    high = m.Parts()
    m.column(high, 0.15, UPPER_SPRING - STOREY, 20, 0.2, 0.3)
    first_low = low.object("Column", stone, smooth=False)
    first_high = high.object("Upper Column", slim, smooth=False)
    for first in (first_low, first_high):
        smooth_round(first)
    places = {first_low: [], first_high: []}
    middle = WALL / 2
    for _, turn, bays, distance in SIDES:
        place = side_place(turn, bays, distance)
        for index in range(1, bays):
            places[first_low].append(place @ c.Vector((index * BAY, middle, 0.0)))
        for index in range(1, 2 * bays):
            places[first_high].append(place @ c.Vector((index * BAY / 2, middle, STOREY)))
    for first, points in places.items():
        first.location = points[0]
        for number, point in enumerate(points[1:], 2):
            m.copy_of(first, f"{first.name} {number}", c.Matrix.Translation(point))


def smooth_round(target) -> None:
    """Smooth faces where a shape is turned, flat ones on its square ends (the boxes, whose faces are their own)."""
    mesh = target.data
    assert len(mesh.polygons) < m.SMOOTH_LIMIT, target.name
    upright = [abs(polygon.normal.z) > 0.999 for polygon in mesh.polygons]
    square = [
        max(abs(polygon.normal.x), abs(polygon.normal.y)) > 0.9999 for polygon in mesh.polygons
    ]
    mesh.polygons.foreach_set("use_smooth", [not (u or s) for u, s in zip(upright, square)])
    mesh.update()


def add_arcades(wall, trim) -> None:
    """Walls of arches on all four sides of both storeys, with mouldings, keystones and corner piers."""
    for name, turn, bays, distance in SIDES:
        place = side_place(turn, bays, distance)
        length = bays * BAY
        walls, mouldings = m.Parts(), m.Parts()
        half = BAY / 2 - 0.42
        lower = [((index + 0.5) * BAY, half, SPRING, SPRING) for index in range(bays)]
        m.arcade(walls, length, (SPRING, STOREY), WALL, lower, place)
        small = BAY / 4 - 0.19
        upper = [
            ((index + 0.5) * BAY / 2, small, UPPER_SPRING, UPPER_SPRING)
            for index in range(2 * bays)
        ]
        high = place @ c.Matrix.Translation((0.0, 0.09, 0.0))
        m.arcade(walls, length, (UPPER_SPRING, EAVES), WALL - 0.18, upper, high, 14)
        for centre, radius, _, spring in lower:
            m.archivolt(
                mouldings, centre, spring, radius, ((0.07, 0.03), (0.1, 0.06), (0.05, 0.1)), place
            )
            mouldings.add(
                [
                    (centre + x, y, spring + radius + z)
                    for y in (-0.15, 0.0)
                    for x, z in ((-0.1, -0.04), (0.1, -0.04), (0.15, 0.34), (-0.15, 0.34))
                ],
                [(0, 1, 2, 3), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
                place,
            )
        for centre, radius, _, spring in upper:
            m.archivolt(mouldings, centre, spring, radius, ((0.05, 0.03), (0.06, 0.06)), high, 14)
        for index in range(1, bays):  # a round shield between the arches
            shield = place @ c.Matrix.Translation((index * BAY, 0.0, SPRING + 1.15))
            shield = shield @ c.Matrix.Rotation(math.pi / 2, 4, "X")
            rings = [
                [(0.3, 0.0), (0.3, 0.07), (0.24, 0.07), (0.22, 0.03), (0.09, 0.03), (0.0, 0.06)]
            ]
            m.lathe(mouldings, rings, 20, shield)
        floor = c.Matrix.Translation((0.0, 0.0, STOREY - 0.34))
        m.run_of(mouldings, m.CORNICE, length, place @ floor)
        m.run_of(mouldings, m.STRING_COURSE, length, high @ c.Matrix.Translation((0, 0, 8.72)))
        m.run_of(mouldings, m.CORNICE, length, high @ c.Matrix.Translation((0, 0, EAVES)))
        pier = 0.5
        for storey, low, top in ((0, 0.0, SPRING), (1, STOREY, UPPER_SPRING)):
            walls.box((-pier, -0.05, low), (pier, WALL, top), place)
            cap = 0.06
            mouldings.box((-pier - cap, -0.05 - cap, low), (pier + cap, WALL, low + 0.3), place)
            mouldings.box((-pier - cap, -0.05 - cap, top - 0.2), (pier + cap, WALL, top), place)
        walls.object(f"Arcade {name}", wall)
        mouldings.object(f"Mouldings {name}", trim)


def add_balustrade(stone) -> None:
    """Turned balusters under a rail between the upper columns."""
    for name, turn, bays, distance in SIDES:
        place = side_place(turn, bays, distance)
        parts = m.Parts()
        profile = [
            (0.035, 0.14), (0.05, 0.2), (0.062, 0.3), (0.05, 0.42), (0.028, 0.56), (0.026, 0.64), (0.05, 0.72),
        ]  # fmt: skip
        y = WALL / 2 - 0.12
        for k in range(int(bays * BAY / 0.2)):
            spot = place @ c.Matrix.Translation((0.1 + 0.2 * k, y, STOREY))
            m.lathe(parts, [profile], 8, spot)
        length = bays * BAY
        parts.box((0, y - 0.1, STOREY), (length, y + 0.1, STOREY + 0.14), place)
        parts.box((0, y - 0.12, STOREY + 0.72), (length, y + 0.12, STOREY + 0.8), place)
        parts.box((0, y - 0.09, STOREY + 0.8), (length, y + 0.09, STOREY + 0.86), place)
        parts.object(f"Balustrade {name}", stone)


def add_galleries(plaster, ceiling, trim, wood, dark) -> None:
    """What stands behind the arcades: walls with doors and windows, vaults below, beams above, and floors."""
    outer_x, outer_y = COURT_X + WALL + GALLERY, COURT_Y + WALL + GALLERY
    for name, turn, bays, distance in SIDES:
        back = distance + WALL + GALLERY
        wide = bays + 2  # the back wall goes round the corners
        place = side_place(turn, wide, back)
        walls, details, doors, vaults, beams = (m.Parts() for _ in range(5))
        offset = BAY
        lower = [(offset + (index + 0.5) * BAY, 0.62, 0.0, 2.2) for index in range(bays)]
        upper = [
            (offset + (index + 0.5) * BAY, 0.5, STOREY + 0.9, STOREY + 2.1) for index in range(bays)
        ]
        reach = 1.6  # walls go past the corner into the neighbour's
        for z_range, openings in (((0.0, STOREY), lower), ((STOREY, EAVES + 0.3), upper)):
            shifted = [(x + reach, h, sill, spring) for x, h, sill, spring in openings]
            m.arcade(
                walls, wide * BAY + 2 * reach, z_range, 0.4, shifted,
                place @ c.Matrix.Translation((-reach, 0.0, 0.0)), 12,
            )  # fmt: skip
        for centre, half, sill, spring in lower + upper:
            m.archivolt(details, centre, spring, half, ((0.08, 0.05), (0.06, 0.09)), place, 12)
            for edge in (-half - 0.14, half):
                details.box(
                    (centre + edge, -0.07, sill), (centre + edge + 0.14, 0.0, spring), place
                )
            doors.box((centre - half, 0.3, sill), (centre + half, 0.34, spring + half), place)
            for k in range(1, 4):  # planks of the doors, bars of the windows
                x = centre - half + 2 * half * k / 4
                doors.box((x - 0.02, 0.26, sill), (x + 0.02, 0.3, spring + half * 0.7), place)
        m.run_of(
            details,
            m.STRING_COURSE,
            wide * BAY,
            place @ c.Matrix.Translation((0, 0, SPRING - 0.14)),
        )
        middle = side_place(turn, bays, distance + WALL + GALLERY / 2)
        for index in range(bays):
            spot = middle @ c.Matrix.Translation(((index + 0.5) * BAY, 0.0, SPRING))
            m.groin_vault(vaults, (BAY, GALLERY), BAY / 2 - 0.1, spot, 12)
            for k in range(4):
                x = (index + k / 4) * BAY
                beams.box(
                    (x - 0.07, -GALLERY / 2, EAVES - 0.1),
                    (x + 0.07, GALLERY / 2, EAVES + 0.12),
                    middle,
                )
        walls.object(f"Gallery Wall {name}", plaster)
        details.object(f"Gallery Frames {name}", trim)
        doors.object(f"Doors {name}", wood)
        vaults.object(f"Vaults {name}", ceiling)
        beams.object(f"Beams {name}", dark)
    ring, roof = m.Parts(), m.Parts()
    inner_x, inner_y = COURT_X + 0.02, COURT_Y + 0.02
    for parts, low, high in ((ring, STOREY - 0.3, STOREY), (roof, EAVES + 0.12, EAVES + 0.3)):
        parts.box((-outer_x, inner_y, low), (outer_x, outer_y, high))
        parts.box((-outer_x, -outer_y, low), (outer_x, -inner_y, high))
        parts.box((inner_x, -inner_y, low), (outer_x, inner_y, high))
        parts.box((-outer_x, -inner_y, low), (-inner_x, inner_y, high))
    ring.object("Gallery Floor", trim)
    roof.object("Gallery Ceiling", dark)


def add_roof(terracotta) -> None:
    """Round tiles that climb from the court's eaves to the ridge outside."""
    for name, turn, bays, distance in SIDES:
        parts = m.Parts()
        place = side_place(turn, bays, distance - 0.35)
        m.tiled_slope(
            parts, bays * BAY, 2.4, 0.9, place @ c.Matrix.Translation((0, 0, EAVES + 0.36)), arc=3
        )
        parts.object(f"Roof {name}", terracotta)


def add_drapes(reds, greens, blues) -> None:
    """Long cloths over the balustrade and curtains in the arches, drawn together at their middle."""
    place_north = side_place(*SIDES[0][1:])
    place_south = side_place(*SIDES[2][1:])
    colours = (reds, greens, blues)
    rods = m.Parts()
    for side, place in (("North", place_north), ("South", place_south)):
        for index in range(LONG):
            x = (index + 0.5) * BAY
            if index % 2 == 1:
                parts = m.Parts()
                spot = place @ c.Matrix.Translation((x, WALL + 0.12, SPRING + 0.25))
                m.cloth(parts, 2.3, SPRING + 0.15, 7, 0.11, spot, gather=0.45)
                parts.object(f"Curtain {side} {index + 1}", colours[index // 2 % 3], smooth=True)
                rods.box(
                    (x - 1.25, WALL + 0.1, SPRING + 0.24),
                    (x + 1.25, WALL + 0.14, SPRING + 0.28),
                    place,
                )
            else:
                parts = m.Parts()
                spot = place @ c.Matrix.Translation((x, -0.36, STOREY + 0.82))
                m.cloth(parts, 1.5, 2.1, 4, 0.05, spot)
                parts.object(
                    f"Banner {side} {index + 1}", colours[(index // 2 + 1) % 3], smooth=True
                )
                rods.box((x - 0.85, -0.38, STOREY + 0.81), (x + 0.85, -0.34, STOREY + 0.85), place)
                for end in (-0.7, 0.7):
                    rods.box(
                        (x + end - 0.02, -0.36, STOREY + 0.8),
                        (x + end + 0.02, 0.3, STOREY + 0.82),
                        place,
                    )
    rods.object("Drape Rods", c.material("Rod Iron", (0.06, 0.05, 0.045)))


def add_lamps(bronze) -> None:
    """Bronze bowls on three thin chains in the arches of the long sides, and pots on the floor."""
    bowl = [(0.0, 0.0), (0.12, 0.02), (0.2, 0.08), (0.24, 0.17), (0.25, 0.2), (0.21, 0.18)]
    parts = m.Parts()
    chains = []
    for _, turn, bays, distance in (SIDES[0], SIDES[2]):
        place = side_place(turn, bays, distance)
        for index in range(0, bays, 2):
            centre = place @ c.Vector(((index + 0.5) * BAY, WALL / 2, 2.75))
            m.lathe(parts, [bowl], 16, c.Matrix.Translation(centre))
            for k in range(3):
                angle = 2.0 * math.pi * k / 3
                rim = c.Vector((0.23 * math.cos(angle), 0.23 * math.sin(angle), 0.19))
                chains.append([centre + rim, centre + c.Vector((0.0, 0.0, 1.3))])
            chains.append([centre + c.Vector((0, 0, 1.28)), centre + c.Vector((0, 0, 1.5))])
    parts.object("Lamps", bronze)
    c.add_tubes("Lamp Chains", chains, 0.008, 5, bronze)


def add_pots(clay, leaf) -> None:
    """Clay pots with a tuft of leaves along the court's edge."""
    pot = [
        [(0.22, 0.0), (0.3, 0.1), (0.38, 0.36), (0.4, 0.52), (0.36, 0.6)],
        [(0.36, 0.6), (0.45, 0.62), (0.45, 0.7), (0.36, 0.7), (0.34, 0.58), (0.0, 0.58)],
    ]
    pots, leaves = m.Parts(), m.Parts()
    for index in range(0, LONG + 1, 2):
        for y in (-1.0, 1.0):
            x = -COURT_X + (index + 0.5) * BAY
            place = c.Matrix.Translation((x, y * (COURT_Y - 0.75), 0.0))
            m.lathe(pots, pot, 20, place)
            for k in range(46):
                turn, lean = k * 2.39996, 0.15 + 0.95 * ((k * 7) % 23) / 23
                length = 0.75 + 0.3 * ((k * 5) % 11) / 11
                blade = []
                for step in range(5):
                    t = step / 4
                    out, up = length * t * math.sin(lean * (0.4 + t)), length * t * math.cos(
                        lean * (0.4 + t)
                    )
                    wide = 0.045 * math.sin(math.pi * (0.12 + 0.86 * t))
                    for w in (-wide, wide):
                        blade.append(
                            (
                                out * math.cos(turn) - w * math.sin(turn),
                                out * math.sin(turn) + w * math.cos(turn),
                                0.58 + up,
                            )
                        )
                leaves.add(
                    blade, [(2 * s, 2 * s + 1, 2 * s + 3, 2 * s + 2) for s in range(4)], place
                )
    pots.object("Pots", clay)
    leaves.object("Leaves", leaf)


def add_floor(slabs, border) -> None:
    """Tiles in the court between bands of plain stone, one step below the galleries."""
    parts, rim = m.Parts(), m.Parts()
    x, y = COURT_X, COURT_Y
    parts.quad((-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0))
    parts.object("Court Floor", slabs)
    outer = GALLERY + WALL
    height = 0.12
    for low, high in (
        ((-x - outer, y - 0.35, -0.1), (x + outer, y + outer, height)),
        ((-x - outer, -y - outer, -0.1), (x + outer, -y + 0.35, height)),
        ((x - 0.35, -y + 0.35, -0.1), (x + outer, y - 0.35, height)),
        ((-x - outer, -y + 0.35, -0.1), (-x + 0.35, y - 0.35, height)),
    ):
        rim.box(low, high)
    rim.object("Gallery Paving", border)


def sphere_path(frame: int) -> c.Vector:
    """Centre of the flying sphere: straight along the hall, then up over the camera.

    In the camera's frame the way is (ahead, aside, above), two parabolas that meet at the covering frame. The centre
    never comes nearer than 1.9 m, so that the camera stays outside."""
    if frame <= COVER_FRAME:
        t = (COVER_FRAME - frame) / (COVER_FRAME - 1)
        ahead, above = 2.0 + 17.5 * t, -1.9 * t * (1 - t) + 0.15
        aside = 0.9 * t
    else:
        t = (frame - COVER_FRAME) / (FRAMES - COVER_FRAME)
        ahead, aside, above = 2.0 - 2.0 * t, 0.0, 0.15 + 5.5 * t - 0.5 * t * t
    eye = c.Vector(CAMERA)
    forward = (c.Vector(TARGET) - eye).normalized()
    left = c.Vector((0.0, 0.0, 1.0)).cross(forward).normalized()
    return eye + forward * ahead + left * aside + forward.cross(left) * above


def add_sphere(flying: bool) -> None:
    """The dark-blue sphere, at rest in the middle of the hall or on its way."""
    blue = c.material("Sphere Blue", (0.016, 0.035, 0.17))
    if not flying:
        c.add_sphere("Sphere", (-3.2, 0.2, 1.35), 1.0, blue)
        return
    sphere = c.add_sphere("Sphere", sphere_path(1), SPHERE_RADIUS, blue)
    c.key_linear(
        sphere, "location", [(frame, sphere_path(frame)) for frame in range(1, FRAMES + 1)]
    )


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution, FRAMES)
    c.add_sky(scene, horizon=(0.62, 0.74, 0.88), zenith=(0.16, 0.34, 0.70))
    wall = textures.bricks(
        "Court Ashlar",
        (0.66, 0.54, 0.38),
        (0.58, 0.46, 0.33),
        (0.36, 0.28, 0.2),
        (0.62, 0.3),
        0.008,
    )
    plaster = textures.mottled(
        "Gallery Plaster", (0.60, 0.43, 0.28), (0.48, 0.32, 0.2), 0.8, ambient=0.62
    )
    trim = textures.mottled("Trim Stone", (0.72, 0.65, 0.54), (0.58, 0.5, 0.4), 0.35)
    inner = textures.mottled(
        "Inner Stone", (0.62, 0.54, 0.43), (0.5, 0.43, 0.34), 0.35, ambient=0.6
    )
    column = textures.mottled("Column Stone", (0.74, 0.67, 0.56), (0.6, 0.52, 0.42), 0.25)
    marble = textures.mottled("Slim Column Stone", (0.62, 0.42, 0.34), (0.5, 0.33, 0.27), 0.2)
    vault = c.material("Vault Plaster", (0.56, 0.47, 0.36), ambient_scale=0.55)
    wood = c.material("Door Wood", (0.13, 0.075, 0.04), ambient_scale=0.6)
    beam = c.material("Beam Wood", (0.2, 0.12, 0.07), ambient_scale=0.7)
    slabs = textures.tiles(
        "Court Tiles", (0.62, 0.56, 0.47), (0.36, 0.27, 0.22), (0.2, 0.17, 0.15), 0.8
    )
    paving = textures.bricks(
        "Gallery Paving", (0.46, 0.4, 0.33), (0.4, 0.34, 0.28), (0.24, 0.2, 0.17), (0.9, 0.9), 0.01,
        shift=0.0, ambient=0.7,
    )  # fmt: skip
    terracotta = textures.mottled("Roof Tiles", (0.6, 0.27, 0.15), (0.42, 0.18, 0.1), 0.3)
    gold = (0.62, 0.45, 0.16)
    drapes = [
        textures.stripes(f"Drape {name}", colour, gold, 1.05, 0.07)
        for name, colour in (
            ("Red", (0.42, 0.035, 0.03)),
            ("Green", (0.04, 0.24, 0.09)),
            ("Blue", (0.04, 0.09, 0.36)),
        )
    ]
    add_floor(slabs, paving)
    add_columns(column, marble)
    add_arcades(wall, trim)
    add_balustrade(trim)
    add_galleries(plaster, vault, inner, wood, beam)
    add_roof(terracotta)
    add_drapes(*drapes)
    add_lamps(c.material("Bronze", (0.16, 0.12, 0.06)))
    add_pots(c.material("Clay", (0.5, 0.24, 0.13)), c.material("Leaf", (0.09, 0.22, 0.05)))
    add_sphere(arguments.flying)
    c.add_sun(scene, azimuth_degrees=-62.0, height_degrees=58.0)
    c.add_camera(scene, CAMERA, TARGET, LENS_MM)


if __name__ == "__main__":
    c.run(__file__, __doc__, build, options)
