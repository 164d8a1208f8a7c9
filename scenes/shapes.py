# SPDX-License-Identifier: MIT
"""Shapes of the procedural scenes, from plain numbers. Metres, z up."""

from __future__ import annotations

import math
from typing import Iterable, Sequence

import bpy
from mathutils import Vector

Point2 = tuple[float, float]


def tube_parts(
    points: Sequence[Sequence[float]], radius: float, sides: int, first: int
) -> tuple[list[Vector], list[tuple[int, ...]]]:
    """Vertices and faces of a tube along a polyline, its vertices counted from ``first``; the ends are closed."""
    path = [Vector(point) for point in points]
    vertices: list[Vector] = []
    side = (path[1] - path[0]).orthogonal().normalized()
    for index, point in enumerate(path):
        ahead = path[min(index + 1, len(path) - 1)] - path[max(index - 1, 0)]
        axis = ahead.normalized()
        side = (
            side - axis * side.dot(axis)
        ).normalized()  # carried along, so that the tube does not twist
        other = axis.cross(side)
        for step in range(sides):
            angle = 2.0 * math.pi * step / sides
            vertices.append(point + (side * math.cos(angle) + other * math.sin(angle)) * radius)
    faces: list[tuple[int, ...]] = []
    for index in range(len(path) - 1):
        low, high = first + index * sides, first + (index + 1) * sides
        for step in range(sides):
            following = (step + 1) % sides
            faces.append((low + step, low + following, high + following, high + step))
    last = first + (len(path) - 1) * sides
    faces.append(tuple(first + step for step in reversed(range(sides))))
    faces.append(tuple(last + step for step in range(sides)))
    return vertices, faces


def add_tubes(
    name: str, paths: Iterable[Sequence[Sequence[float]]], radius: float, sides: int, surface
) -> bpy.types.Object:
    """One object made of tubes along polylines."""
    vertices: list = []
    faces: list = []
    for path in paths:
        tube_vertices, tube_faces = tube_parts(path, radius, sides, len(vertices))
        vertices += tube_vertices
        faces += tube_faces
    return add_mesh(name, vertices, faces, surface)


def add_mesh(
    name: str,
    vertices: Iterable[Sequence[float]],
    faces: Iterable[Sequence[int]],
    surface: bpy.types.Material,
    smooth: bool = False,
) -> bpy.types.Object:
    """Object from plain vertices (metres) and faces, counter-clockwise seen from outside."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(vertex) for vertex in vertices], [], [tuple(face) for face in faces])
    mesh.materials.append(surface)
    if smooth:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.validate()
    mesh.update()
    result = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(result)
    return result


def box_parts(
    low: Sequence[float], high: Sequence[float]
) -> tuple[list[Point2], list[tuple[int, ...]]]:
    """Vertices and faces of an axis-aligned box."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    vertices = [
        (x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0),
        (x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1),
    ]  # fmt: skip
    faces = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return vertices, faces


def add_boxes(
    name: str, boxes: Iterable[tuple[Sequence[float], Sequence[float]]], surface
) -> bpy.types.Object:
    """One object made of several boxes, each given by its low and high corner."""
    vertices: list = []
    faces: list = []
    for low, high in boxes:
        box_vertices, box_faces = box_parts(low, high)
        faces += [tuple(index + len(vertices) for index in face) for face in box_faces]
        vertices += box_vertices
    return add_mesh(name, vertices, faces, surface)


def add_box(name: str, low: Sequence[float], high: Sequence[float], surface) -> bpy.types.Object:
    """One box between two corners."""
    return add_boxes(name, [(low, high)], surface)


def add_cylinder(
    name: str,
    start: Sequence[float],
    end: Sequence[float],
    radius: float,
    sides: int,
    surface,
    smooth: bool = False,
) -> bpy.types.Object:
    """Capped cylinder (a prism of ``sides`` sides) from ``start`` to ``end``."""
    axis = Vector(end) - Vector(start)
    rotation = axis.to_track_quat("Z", "Y").to_matrix()
    vertices = []
    for base in (Vector(start), Vector(end)):
        for side in range(sides):
            angle = 2.0 * math.pi * side / sides
            vertices.append(
                base + rotation @ Vector((radius * math.cos(angle), radius * math.sin(angle), 0.0))
            )
    faces = [
        (side, (side + 1) % sides, sides + (side + 1) % sides, sides + side)
        for side in range(sides)
    ]
    faces.append(tuple(reversed(range(sides))))
    faces.append(tuple(range(sides, 2 * sides)))
    return add_mesh(name, vertices, faces, surface, smooth)


def add_revolved(
    name: str,
    start: Sequence[float],
    direction: Sequence[float],
    profile: Sequence[Point2],
    sides: int,
    surface,
) -> bpy.types.Object:
    """Closed outline turned about an axis: a hollow body of flat faces.

    ``profile``: (way along the axis from ``start``, distance from the axis), in metres, from the end of the outside back
    to its beginning and then along the inside, so that faces look outwards."""
    rotation = Vector(direction).to_track_quat("Z", "Y").to_matrix()
    vertices = []
    for way, radius in profile:
        for side in range(sides):
            angle = 2.0 * math.pi * side / sides
            ring = Vector((radius * math.cos(angle), radius * math.sin(angle), way))
            vertices.append(Vector(start) + rotation @ ring)
    faces = []
    for index in range(len(profile)):
        here, there = index * sides, (index + 1) % len(profile) * sides
        for side in range(sides):
            following = (side + 1) % sides
            faces.append((here + side, there + side, there + following, here + following))
    return add_mesh(name, vertices, faces, surface)


def add_squares(name: str, placements, surface) -> bpy.types.Object:
    """One object of squares, each from (centre, right, up); the whole image covers each."""
    vertices: list = []
    faces: list = []
    for centre, right, up in placements:
        first = len(vertices)
        vertices += [
            centre - right - up,
            centre + right - up,
            centre + right + up,
            centre - right + up,
        ]
        faces.append((first, first + 1, first + 2, first + 3))
    result = add_mesh(name, vertices, faces, surface)
    layer = result.data.uv_layers.new(name="UVMap")
    for index, corner in enumerate(((0, 0), (1, 0), (1, 1), (0, 1)) * len(faces)):
        layer.data[index].uv = corner
    return result


def add_sphere(
    name: str, centre: Sequence[float], radius: float, surface, segments: int = 40, rings: int = 24
) -> bpy.types.Object:
    """Smooth sphere about the object's origin.

    40 x 24 faces stay below 1024, the size from which Blender sums normals in several threads, in an order
    that changes from run to run: the same file gives the same picture, bit for bit."""
    vertices: list[tuple[float, float, float]] = [(0.0, 0.0, radius)]
    for ring in range(1, rings):
        polar = math.pi * ring / rings
        for segment in range(segments):
            azimuth = 2.0 * math.pi * segment / segments
            vertices.append(
                (
                    radius * math.sin(polar) * math.cos(azimuth),
                    radius * math.sin(polar) * math.sin(azimuth),
                    radius * math.cos(polar),
                )
            )
    vertices.append((0.0, 0.0, -radius))
    south = len(vertices) - 1
    faces: list[tuple[int, ...]] = []
    for segment in range(segments):
        following = (segment + 1) % segments
        faces.append((0, 1 + segment, 1 + following))
        for ring in range(rings - 2):
            upper, lower = 1 + ring * segments, 1 + (ring + 1) * segments
            faces.append((upper + segment, lower + segment, lower + following, upper + following))
        last = 1 + (rings - 2) * segments
        faces.append((last + segment, south, last + following))
    result = add_mesh(name, vertices, faces, surface, smooth=True)
    result.location = centre
    return result


def arch_points(centre_x: float, spring_z: float, half_width: float, steps: int) -> list[Point2]:
    """Half circle (x, z) from the right springing over the crown to the left one."""
    points = []
    for step in range(steps + 1):
        angle = math.pi * step / steps
        points.append(
            (centre_x + half_width * math.cos(angle), spring_z + half_width * math.sin(angle))
        )
    return points


def add_arch_wall(
    name: str,
    x_range: tuple[float, float],
    z_range: tuple[float, float],
    y_range: tuple[float, float],
    openings: Sequence[tuple[float, float, float, float]],
    surface: bpy.types.Material,
    steps: int = 24,
) -> bpy.types.Object:
    """Upright slab in the xz-plane with arched openings.

    ``openings``: (centre x, half width, sill z, springing z), from left to right, not touching each other. The
    front lies at the smaller y. Made of vertical strips, so that every face is convex."""
    y_front, y_back = y_range
    z_low, z_high = z_range
    vertices: list[tuple[float, float, float]] = []
    faces: list[tuple[int, ...]] = []

    def slab(outline: Sequence[Point2]) -> None:
        """Prism from an outline that runs counter-clockwise seen from the front (x right, z up)."""
        first, count = len(vertices), len(outline)
        vertices.extend((x, y_front, z) for x, z in outline)
        vertices.extend((x, y_back, z) for x, z in outline)
        faces.append(tuple(first + index for index in range(count)))
        faces.append(tuple(first + count + index for index in reversed(range(count))))
        for index in range(count):
            following = (index + 1) % count
            faces.append(
                (first + following, first + index, first + count + index, first + count + following)
            )

    left = x_range[0]
    for centre, half_width, sill, spring in openings:
        slab(
            [
                (left, z_low),
                (centre - half_width, z_low),
                (centre - half_width, z_high),
                (left, z_high),
            ]
        )
        if sill > z_low:
            slab(
                [
                    (centre - half_width, z_low),
                    (centre + half_width, z_low),
                    (centre + half_width, sill),
                    (centre - half_width, sill),
                ]
            )
        crown = list(reversed(arch_points(centre, spring, half_width, steps)))  # from left to right
        for (x0, z0), (x1, z1) in zip(crown, crown[1:]):
            slab([(x0, z0), (x1, z1), (x1, z_high), (x0, z_high)])
        left = centre + half_width
    slab([(left, z_low), (x_range[1], z_low), (x_range[1], z_high), (left, z_high)])
    return add_mesh(name, vertices, faces, surface)


def add_text(
    name: str, body: str, location: Sequence[float], size: float, surface, align: str = "CENTER"
) -> bpy.types.Object:
    """Flat letters of Blender's built-in font in the xz-plane, facing -y; ``size`` in metres."""
    curve = bpy.data.curves.new(name, "FONT")
    curve.body = body
    curve.size = size
    curve.align_x = align
    curve.align_y = "CENTER"
    curve.materials.append(surface)
    result = bpy.data.objects.new(name, curve)
    result.location = location
    result.rotation_euler = (math.pi / 2.0, 0.0, 0.0)
    bpy.context.scene.collection.objects.link(result)
    return result
