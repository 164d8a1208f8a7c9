# SPDX-License-Identifier: MIT
"""Shapes of buildings for the larger scenes: turned columns, mouldings, arches, vaults, cloth, roof tiles.

``Parts`` gathers vertices and faces; a shape is a function that adds to it, and one object is made of each. Faces are
flat, or smooth in objects below 1024 faces, the size from which Blender sums normals in an order that changes from run
to run. Edges stay sharp between smooth faces where the vertices are doubled.
"""

from __future__ import annotations

import math
from typing import Iterable, Sequence

import bpy
import common as c
import numpy as np

Point3 = Sequence[float]
Place = c.Matrix
Profile = Sequence[c.Point2]  # (radius or distance from the wall, height), from below upwards

SMOOTH_LIMIT = 1024  # faces


def at(x: float, y: float, z: float = 0.0, turn_degrees: float = 0.0) -> Place:
    """Place of a shape: turned about its upright axis, then moved."""
    return c.Matrix.Translation((x, y, z)) @ c.Matrix.Rotation(math.radians(turn_degrees), 4, "Z")


class Parts:
    """Vertices and faces of an object in the making."""

    def __init__(self) -> None:
        self.vertices: list[tuple[float, float, float]] = []
        self.faces: list[tuple[int, ...]] = []

    def add(
        self, vertices: Iterable[Point3], faces: Iterable[Sequence[int]], place: Place | None = None
    ) -> None:
        """Adds faces with vertices of their own."""
        first = len(self.vertices)
        if place is None:
            self.vertices.extend(tuple(vertex) for vertex in vertices)
        else:
            self.vertices.extend(tuple(place @ c.Vector(vertex)) for vertex in vertices)
        self.faces.extend(tuple(first + index for index in face) for face in faces)

    def quad(self, a: Point3, b: Point3, d: Point3, e: Point3, place: Place | None = None) -> None:
        """One face from four corners, counter-clockwise seen from outside."""
        self.add((a, b, d, e), ((0, 1, 2, 3),), place)

    def box(self, low: Point3, high: Point3, place: Place | None = None) -> None:
        """Axis-aligned box between two corners."""
        self.add(*c.box_parts(low, high), place)

    def object(
        self, name: str, surface: bpy.types.Material, smooth: bool = False
    ) -> bpy.types.Object:
        """Object of all parts, its uv map in metres laid from the side that each face looks to."""
        assert not smooth or len(self.faces) < SMOOTH_LIMIT, name
        result = c.add_mesh(name, self.vertices, self.faces, surface, smooth)
        lay_uv(result.data)
        return result


def lay_uv(mesh: bpy.types.Mesh) -> None:
    """uv map in metres: the two coordinates in which a face is seen largest (v is up on walls)."""
    layer = mesh.uv_layers.new(name="Metres")
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", positions)
    corner = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corner)
    normals = np.empty(3 * len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("normal", normals)
    count = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", count)
    # 0.001: a face at 45 degrees belongs to the same axis in every Blender
    weight = np.abs(normals.reshape(-1, 3)) + np.array([0.0, 0.001, 0.002], np.float32)
    axis = np.repeat(np.argmax(weight, axis=1), count)
    first, second = np.array([1, 0, 0])[axis], np.array([2, 2, 1])[axis]
    points = positions.reshape(-1, 3)[corner]
    rows = np.arange(len(points))
    uv = np.stack([points[rows, first], points[rows, second]], axis=1)
    layer.data.foreach_set("uv", uv.astype(np.float32).ravel())


def copy_of(original: bpy.types.Object, name: str, place: Place) -> bpy.types.Object:
    """Another object of the same mesh."""
    result = bpy.data.objects.new(name, original.data)
    result.matrix_world = place
    bpy.context.scene.collection.objects.link(result)
    return result


def lathe(parts: Parts, runs: Iterable[Profile], sides: int, place: Place | None = None) -> None:
    """Turns profiles about the upright axis. Within a run the surface can be smooth; runs do not share vertices, so
    that the edge between two of them is sharp."""
    for run in runs:
        vertices, faces = [], []
        for radius, z in run:
            for side in range(sides):
                angle = 2.0 * math.pi * side / sides
                vertices.append((radius * math.cos(angle), radius * math.sin(angle), z))
        for ring in range(len(run) - 1):
            low, high = ring * sides, (ring + 1) * sides
            for side in range(sides):
                following = (side + 1) % sides
                faces.append((low + side, low + following, high + following, high + side))
        parts.add(vertices, faces, place)


def round_moulding(radius: float, z: float, height: float, bulge: float, steps: int = 5) -> Profile:
    """Torus (bulge > 0) or hollow (bulge < 0) between z and z + height."""
    return [
        (
            radius + bulge * math.sin(math.pi * step / steps),
            z + height * (1 - math.cos(math.pi * step / steps)) / 2,
        )
        for step in range(steps + 1)
    ]


def column(
    parts: Parts, radius: float, height: float, sides: int, foot: float, head: float
) -> None:
    """Column on the origin: plinth and torus, a shaft that grows thinner, ring, bell and abacus.

    ``foot`` and ``head`` are the heights of its ends."""
    half = radius * 1.45
    parts.box((-half, -half, 0.0), (half, half, 0.4 * foot))
    lathe(
        parts,
        [
            round_moulding(radius * 1.22, 0.4 * foot, 0.32 * foot, radius * 0.18),
            [(radius * 1.22, 0.72 * foot), (radius * 1.1, 0.74 * foot)],
            round_moulding(radius * 1.08, 0.74 * foot, 0.2 * foot, radius * 0.1, 4),
            [(radius * 1.08, 0.94 * foot), (radius, foot)],
            [
                (radius * (1.0 - 0.14 * t * t), foot + (height - head - foot) * t)
                for t in (k / 6 for k in range(7))
            ],
            round_moulding(radius * 0.88, height - head, 0.12 * head, radius * 0.12, 4),
            [
                (radius * (0.86 + 0.5 * t**2.2), height - head * (0.88 - 0.6 * t))
                for t in (k / 5 for k in range(6))
            ],
        ],
        sides,
    )
    inner = half * 0.93
    parts.box((-inner, -inner, height - 0.28 * head), (inner, inner, height - 0.2 * head))
    parts.box((-half, -half, height - 0.2 * head), (half, half, height))


def run_of(parts: Parts, profile: Profile, length: float, place: Place) -> None:
    """Moulding along x: ``profile`` gives (distance to -y, z) from below upwards; both ends are closed."""
    count = len(profile)
    vertices = [(x, -out, z) for x in (0.0, length) for out, z in profile]
    vertices += [(x, 0.0, z) for x in (0.0, length) for z in (profile[0][1], profile[-1][1])]
    faces: list[tuple[int, ...]] = [
        (index, count + index, count + index + 1, index + 1) for index in range(count - 1)
    ]
    bottom, top = 2 * count, 2 * count + 1
    faces += [(bottom, bottom + 2, count, 0), (count - 1, 2 * count - 1, top + 2, top)]
    faces.append((bottom, *range(count), top))
    faces.append((*reversed(range(count, 2 * count)), bottom + 2, top + 2))
    parts.add(vertices, faces, place)


CORNICE: Profile = [
    (0.00, 0.00), (0.05, 0.00), (0.05, 0.06), (0.10, 0.06), (0.13, 0.09), (0.14, 0.13), (0.22, 0.13),
    (0.22, 0.22), (0.26, 0.25), (0.29, 0.30), (0.29, 0.34),
]  # fmt: skip
STRING_COURSE: Profile = [(0.0, 0.0), (0.04, 0.02), (0.07, 0.06), (0.07, 0.12), (0.03, 0.14)]


def arcade(
    parts: Parts,
    length: float,
    z_range: tuple[float, float],
    thick: float,
    openings: Sequence[tuple[float, float, float, float]],
    place: Place,
    steps: int = 20,
) -> None:
    """Upright wall along x with arched openings, its front at y = 0 and its back at ``thick``.

    ``openings``: (centre x, half width, sill z, springing z) from left to right. Has no faces inside the stone.
    """
    z_low, z_high = z_range

    def both(x0: float, z00: float, z01: float, x1: float, z10: float, z11: float) -> None:
        """Front and back between x0 (from z00 to z01) and x1 (from z10 to z11)."""
        parts.quad((x0, 0, z00), (x1, 0, z10), (x1, 0, z11), (x0, 0, z01), place)
        parts.quad((x1, thick, z10), (x0, thick, z00), (x0, thick, z01), (x1, thick, z11), place)

    def depth(a: c.Point2, b: c.Point2) -> None:
        """Reveal along the edge a-b of an opening, the opening lying to the left of it."""
        parts.quad(
            (a[0], 0, a[1]), (a[0], thick, a[1]), (b[0], thick, b[1]), (b[0], 0, b[1]), place
        )

    left = 0.0
    for centre, half, sill, spring in openings:
        both(left, z_low, z_high, centre - half, z_low, z_high)
        if sill > z_low:
            both(centre - half, z_low, sill, centre + half, z_low, sill)
            depth((centre + half, sill), (centre - half, sill))
        outline = c.arch_points(centre, spring, half, steps)
        path = [(centre + half, sill), *outline, (centre - half, sill)]
        for a, b in zip(path, path[1:]):
            if a != b:
                depth(b, a)
        for (x1, z1), (x0, z0) in zip(outline, outline[1:]):
            both(x0, z0, z_high, x1, z1, z_high)
        left = centre + half
    both(left, z_low, z_high, length, z_low, z_high)
    parts.quad(
        (0, 0, z_high), (length, 0, z_high), (length, thick, z_high), (0, thick, z_high), place
    )
    parts.quad((0, thick, z_low), (length, thick, z_low), (length, 0, z_low), (0, 0, z_low), place)
    for x, order in ((0.0, (0, 1, 2, 3)), (length, (3, 2, 1, 0))):
        corners = ((x, 0, z_low), (x, 0, z_high), (x, thick, z_high), (x, thick, z_low))
        parts.quad(*(corners[index] for index in order), place)


def archivolt(
    parts: Parts,
    centre: float,
    spring: float,
    inner: float,
    steps_out: Sequence[tuple[float, float]],
    place: Place,
    steps: int = 20,
) -> None:
    """Moulded band round an arch on the front of a wall (y = 0).

    ``steps_out``: (width, how far it stands out) of its bands from the opening outwards."""
    radius, previous = inner, 0.0
    rims = [c.arch_points(centre, spring, inner, steps)]
    for width, _ in steps_out:
        radius += width
        rims.append(c.arch_points(centre, spring, radius, steps))
    for band, (_, out) in enumerate(steps_out):
        low, high = rims[band], rims[band + 1]
        for k in range(steps):
            (ax, az), (bx, bz) = low[k], low[k + 1]
            (dx, dz), (ex, ez) = high[k + 1], high[k]
            parts.quad((ax, -out, az), (ex, -out, ez), (dx, -out, dz), (bx, -out, bz), place)
            parts.quad(
                (ax, -previous, az), (ax, -out, az), (bx, -out, bz), (bx, -previous, bz), place
            )
        previous = out
    for k in range(steps):
        (ax, az), (bx, bz) = rims[-1][k], rims[-1][k + 1]
        parts.quad((ax, -previous, az), (ax, 0, az), (bx, 0, bz), (bx, -previous, bz), place)


def groin_vault(parts: Parts, size: c.Point2, rise: float, place: Place, cells: int = 10) -> None:
    """Two crossing barrels over a rectangle about the origin, seen from below; z counts from the springing."""

    def height(u: float, v: float) -> float:
        return rise * math.sqrt(max(0.0, 1.0 - min(abs(u), abs(v)) ** 2))

    def point(i: int, j: int) -> Point3:
        u, v = 2.0 * i / cells - 1.0, 2.0 * j / cells - 1.0
        return (u * size[0] / 2, v * size[1] / 2, height(u, v))

    for i in range(cells):
        for j in range(cells):
            corners = (point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j))
            parts.quad(*corners, place)


def cloth(
    parts: Parts,
    width: float,
    drop: float,
    folds: int,
    depth: float,
    place: Place,
    gather: float = 0.0,
    cells: tuple[int, int] = (40, 14),
) -> None:
    """Cloth hung from a rod along x at z = 0: folds that deepen downwards; ``gather`` draws it together at its middle
    height by this share of its width."""
    columns, rows = cells
    vertices = []
    for row in range(rows + 1):
        t = row / rows
        narrow = 1.0 - gather * math.exp(-(((t - 0.6) / 0.22) ** 2))
        for column in range(columns + 1):
            s = column / columns
            wave = math.sin(2 * math.pi * folds * s + 0.6 * math.sin(5 * s + 2 * t))
            x = (s - 0.5) * width * narrow + 0.02 * math.sin(9 * t + 4 * s)
            hem = 0.04 * math.sin(7 * s) * t
            vertices.append((x, depth * (0.45 + 0.55 * t) * wave, -drop * t + hem))
    faces = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            faces.append((a + columns + 1, a + columns + 2, a + 1, a))
    parts.add(vertices, faces, place)


def tiled_slope(
    parts: Parts,
    width: float,
    run: float,
    rise: float,
    place: Place,
    tile: tuple[float, float] = (0.24, 0.36),
    arc: int = 3,
) -> None:
    """Roof of overlapping round tiles: from the eave along x (z = 0) it climbs to y = run, z = rise."""
    slope = math.hypot(run, rise)
    rows = max(1, round(slope / tile[1]))
    columns = max(1, round(width / tile[0]))
    along = c.Vector((0.0, run / slope, rise / slope))
    up = c.Vector((0.0, -rise / slope, run / slope))
    for row in range(rows):
        low, high = row / rows * slope, (row + 1.12) / rows * slope
        for column in range(columns):
            x0, wide = column / columns * width, width / columns
            ring = []
            for k in range(arc + 1):
                angle = math.pi * k / arc
                x = x0 + wide * (0.5 - 0.5 * math.cos(angle))
                ring.append((x, 0.26 * wide * math.sin(angle)))
            vertices = [
                c.Vector((x, 0, 0)) + along * distance + up * (h + lift)
                for distance, lift in ((low, 0.045), (high, 0.0))
                for x, h in ring
            ]
            faces = [(k, k + 1, arc + 2 + k, arc + 1 + k) for k in range(arc)]
            faces.append(tuple(reversed(range(arc + 1))))  # the tile's mouth at the eave
            parts.add(vertices, faces, place)
    corners = ((0, 0, 0), (width, 0, 0), (width, run, rise), (0, run, rise))
    parts.quad(*corners, place)
