# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of everything that a frame shows, read once per mesh, however many instances show it."""

from __future__ import annotations

from typing import Callable, Iterator, TypeVar

import bpy
import numpy as np

from .instances import ObjectIds

_SURFACES = ("MESH", "CURVE", "SURFACE", "META", "FONT")
Shape = TypeVar("Shape")


def visible_shapes(
    depsgraph: bpy.types.Depsgraph,
    ids: ObjectIds,
    shown: set[int],
    read: Callable[[bpy.types.Mesh], Shape],
) -> Iterator[tuple[Shape, np.ndarray, int]]:
    """What ``read`` makes of the mesh, the world matrix (4 x 4, float64) and the id of all that has triangles and
    whose id is among ``shown``.

    Hair and volumes have no triangles."""
    known: dict[tuple[str, int], Shape | None] = {}
    for instance in depsgraph.object_instances:
        item = instance.object
        if item is None or item.type not in _SURFACES:
            continue
        identity = ids.identify(instance, shown)
        if identity is None:
            continue
        # Geometry nodes make instances of meshes that no object holds; those carry their generator's name.
        key = (item.name_full, item.data.as_pointer() if item.data else 0)
        if key not in known:
            mesh = item.to_mesh()
            known[key] = None if mesh is None else read(mesh)
            if mesh is not None:
                item.to_mesh_clear()
        shape = known[key]
        if shape is not None:
            yield shape, np.array(instance.matrix_world, np.float64), identity


def triangles_of(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places of the vertices (V x 3, object space, float32), vertices of each triangle (T x 3) and its polygon (T)."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    places = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.vertices.foreach_get("co", places)
    corners = np.empty(count * 3, np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    polygons = np.empty(count, np.int32)
    mesh.loop_triangles.foreach_get("polygon_index", polygons)
    return places.reshape(-1, 3), corners.reshape(count, 3), polygons
