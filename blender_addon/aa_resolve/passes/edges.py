# SPDX-License-Identifier: GPL-3.0-or-later
"""Distance from every sample to the nearest edge of the triangle it shows (pass ``edges``, for GBAA).

[Persson 2011]. A GPU gets the distances from its rasteriser. Here the triangle behind each
pixel is found again: all evaluated triangles are set up in homogeneous coordinates ([Olano 1997]: no clipping),
and of those that cover a sample and carry its object id, the one at the depth of the depth pass is taken. Then, for
each of its edges with the normal (nx, ny) in the picture, the axis distance s is measured along the larger component,
from the sample to the edge, positive to the right and down; the edge with the smallest |s| is stored as (s, 0.5) or
(0.5, s). (0.5, 0.5) where there is none.

Diagonals of a polygon and edges between coplanar faces of one material are no edges of the picture and are left out.
All in numpy; time grows with the number of (triangle, pixel of its bounding box) pairs.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..scene import camera as cam
from ..scene import shapes
from ..scene.instances import ObjectIds
from .base import Pass
from .exposure import Exposure
from .geometry import ids_of, shown_by

_PAIRS_PER_BLOCK = 1 << 20
_COPLANAR = 0.99999  # cosine of the angle between two faces
_DEPTH_TOLERANCE = 1.0e-3  # relative: how far a triangle may lie from the depth pass
_INSIDE_TOLERANCE = 1.0e-5  # of the sum of barycentric weights
NO_EDGE = 0.5


@dataclass
class Triangles:
    """Evaluated triangles of one mesh: corners (T x 3 x 3, object space) and which sides count (T x 3).

    Side k runs from corner k to corner k + 1."""

    corners: np.ndarray
    sides: np.ndarray


def mesh_triangles(mesh: bpy.types.Mesh) -> Triangles:
    """Triangles of a mesh and their sides that are visible edges."""
    places, indices, polygon = shapes.triangles_of(mesh)
    corners = places[indices].astype(np.float64)
    return Triangles(corners, _visible_sides(mesh, indices, polygon))


def _visible_sides(mesh: bpy.types.Mesh, indices: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """T x 3: False for diagonals within a polygon and for edges between coplanar faces of one material."""
    following = np.roll(indices, -1, axis=1)
    low = np.minimum(indices, following).astype(np.int64)
    keys = (low * (len(mesh.vertices) + 1) + np.maximum(indices, following)).ravel()
    owners = np.repeat(polygon, 3)
    normals = np.empty(len(mesh.polygons) * 3, np.float32)
    mesh.polygons.foreach_get("normal", normals)
    normals = normals.reshape(-1, 3)
    materials = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", materials)
    order = np.argsort(keys, kind="stable")
    ordered = keys[order]
    shared = np.flatnonzero(ordered[1:] == ordered[:-1])
    first, second = order[shared], order[shared + 1]
    one, other = owners[first], owners[second]
    flat = (one == other) | (
        ((normals[one] * normals[other]).sum(axis=1) > _COPLANAR)
        & (materials[one] == materials[other])
    )
    visible = np.ones(keys.shape, bool)
    visible[first[flat]] = False
    visible[second[flat]] = False
    return visible.reshape(-1, 3)


class EdgeFinder:
    """Collects the triangles of a frame and measures distances for its samples."""

    def __init__(self, frame: cam.Frame, camera: cam.CameraState) -> None:
        self.frame, self.camera = frame, camera
        p = camera.projection
        half_w, half_h = frame.width / 2.0, frame.height / 2.0
        # View space -> (x w, y w, w) in pixels with y down.
        clip = p[[0, 1, 3], :]
        to_pixels = np.array([[half_w, 0, half_w], [0, -half_h, half_h], [0, 0, 1.0]])
        self._to_pixels = to_pixels @ clip
        self._corners: list[np.ndarray] = []
        self._sides: list[np.ndarray] = []
        self._ids: list[np.ndarray] = []

    def add(self, triangles: Triangles, matrix: np.ndarray, identity: int) -> None:
        """Adds an object or instance with its world matrix and id."""
        to_view = self.camera.view @ matrix
        self._corners.append(triangles.corners @ to_view[:3, :3].T + to_view[:3, 3])
        self._sides.append(triangles.sides)
        self._ids.append(np.full(len(triangles.corners), identity, np.uint32))

    def measure(
        self, ids: np.ndarray, depth: np.ndarray, jitter: tuple[float, float]
    ) -> tuple[np.ndarray, int]:
        """Distances (H x W x 2, pixels) from the samples, and how many surface pixels found no triangle."""
        height, width = ids.shape
        result = np.full((height, width, 2), NO_EDGE, np.float32)
        surface = depth < cam.BACKGROUND_DEPTH
        if not self._corners:
            return result, int(surface.sum())
        corners, sides = np.concatenate(self._corners), np.concatenate(self._sides)
        identities = np.concatenate(self._ids)
        matrix = self._to_pixels
        points = corners @ matrix[:, :3].T + matrix[:, 3]  # T x 3 x 3: x w, y w, w
        boxes, kept = self._boxes(points, jitter)
        points, corners, sides, identities = (
            points[kept],
            corners[kept],
            sides[kept],
            identities[kept],
        )
        lines = np.cross(points, np.roll(points, -1, axis=1))  # side k, through corners k and k + 1
        volume = (points[:, 0] * np.cross(points[:, 1], points[:, 2])).sum(axis=1)
        planes = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        offsets = (planes * corners[:, 0]).sum(axis=1)
        best = np.full(height * width, np.inf)
        chosen = np.full(height * width, -1, np.int64)
        sizes = (boxes[:, 1] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 2])
        flat_ids, flat_depth = ids.ravel(), depth.ravel().astype(np.float64)
        for begin, end in _blocks(sizes):
            triangle, x, y = _pairs(boxes[begin:end], sizes[begin:end])
            triangle += begin
            pixel = y * width + x
            wanted = flat_ids[pixel] == identities[triangle]
            triangle, pixel, x, y = triangle[wanted], pixel[wanted], x[wanted], y[wanted]
            position = np.stack([x + 0.5 + jitter[0], y + 0.5 + jitter[1], np.ones(len(x))], axis=1)
            weights = np.einsum("nkc,nc->nk", lines[triangle], position)
            weights *= np.sign(volume[triangle])[:, None]
            covered = (weights >= -_INSIDE_TOLERANCE * np.abs(weights).sum(axis=1)[:, None]).all(
                axis=1
            )
            triangle, pixel, position = triangle[covered], pixel[covered], position[covered]
            hit = self._depth(planes[triangle], offsets[triangle], position)
            with np.errstate(invalid="ignore", divide="ignore"):
                error = np.abs(hit / flat_depth[pixel] - 1.0)
            near = error < _DEPTH_TOLERANCE
            triangle, pixel, error = triangle[near], pixel[near], error[near]
            order = np.lexsort((triangle, error, pixel))
            pixel, triangle, error = pixel[order], triangle[order], error[order]
            leading = np.ones(len(pixel), bool)
            leading[1:] = pixel[1:] != pixel[:-1]
            pixel, triangle, error = pixel[leading], triangle[leading], error[leading]
            better = error < best[pixel]
            best[pixel[better]] = error[better]
            chosen[pixel[better]] = triangle[better]
        found = np.flatnonzero(chosen >= 0)
        result.reshape(-1, 2)[found] = _axis_distances(
            lines[chosen[found]],
            sides[chosen[found]],
            found % width + 0.5 + jitter[0],
            found // width + 0.5 + jitter[1],
        )
        return result, int(surface.sum() - len(found))

    def _boxes(
        self, points: np.ndarray, jitter: tuple[float, float]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Ranges of pixels (x0, x1, y0, y1; ends excluded) whose samples a triangle may cover, and which do at all.

        A triangle that passes the plane of the eye may cover any."""
        width, height = self.frame.width, self.frame.height
        w = points[:, :, 2]
        ahead = (w > 1e-6).all(axis=1)
        safe = np.where(w > 1e-6, w, 1.0)
        x, y = points[:, :, 0] / safe, points[:, :, 1] / safe
        boxes = np.empty((len(points), 4), np.int64)
        for column, (values, shift, size) in enumerate(
            ((x, jitter[0], width), (y, jitter[1], height))
        ):
            first = np.ceil(values.min(axis=1) - 0.5 - shift - 1e-6)
            last = np.floor(values.max(axis=1) - 0.5 - shift + 1e-6) + 1
            boxes[:, 2 * column] = np.where(ahead, np.clip(first, 0, size), 0)
            boxes[:, 2 * column + 1] = np.where(ahead, np.clip(last, 0, size), size)
        kept = (boxes[:, 1] > boxes[:, 0]) & (boxes[:, 3] > boxes[:, 2]) & (w > 1e-6).any(axis=1)
        return boxes[kept], kept

    def _depth(self, planes: np.ndarray, offsets: np.ndarray, position: np.ndarray) -> np.ndarray:
        """Planar depth at which rays through pixel positions meet the triangles' planes."""
        p = self.camera.projection
        ndc_x = 2.0 * position[:, 0] / self.frame.width - 1.0
        ndc_y = 1.0 - 2.0 * position[:, 1] / self.frame.height
        with np.errstate(divide="ignore", invalid="ignore"):
            if self.camera.kind == "perspective":
                x, y = (ndc_x + p[0, 2]) / p[0, 0], (ndc_y + p[1, 2]) / p[1, 1]
                return offsets / (planes[:, 0] * x + planes[:, 1] * y - planes[:, 2])
            x, y = (ndc_x - p[0, 3]) / p[0, 0], (ndc_y - p[1, 3]) / p[1, 1]
            return (planes[:, 0] * x + planes[:, 1] * y - offsets) / planes[:, 2]


def _blocks(sizes: np.ndarray):
    """Ranges of triangles whose boxes together hold a limited number of pixels."""
    sums = np.cumsum(sizes)
    begin, before = 0, 0
    while begin < len(sizes):
        end = max(begin + 1, int(np.searchsorted(sums, before + _PAIRS_PER_BLOCK, side="right")))
        yield begin, end
        begin, before = end, int(sums[end - 1])


def _pairs(boxes: np.ndarray, sizes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Every (triangle, x, y) of the boxes."""
    triangle = np.repeat(np.arange(len(boxes)), sizes)
    within = np.arange(len(triangle)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    columns = (boxes[:, 1] - boxes[:, 0])[triangle]
    return triangle, boxes[triangle, 0] + within % columns, boxes[triangle, 2] + within // columns


def _axis_distances(
    lines: np.ndarray, sides: np.ndarray, x: np.ndarray, y: np.ndarray
) -> np.ndarray:
    """The stored pair of each sample: the smallest axis distance of the sides that count, the first of equals."""
    value = lines[:, :, 0] * x[:, None] + lines[:, :, 1] * y[:, None] + lines[:, :, 2]
    along_x = np.abs(lines[:, :, 0]) > np.abs(lines[:, :, 1])
    major = np.where(along_x, lines[:, :, 0], lines[:, :, 1])
    usable = sides & (major != 0.0)
    distance = np.where(usable, -value / np.where(usable, major, 1.0), np.inf)
    index = np.argmin(np.abs(distance), axis=1)
    rows = np.arange(len(lines))
    distance, along_x = distance[rows, index], along_x[rows, index]
    exists = np.isfinite(distance)
    result = np.full((len(lines), 2), NO_EDGE, np.float32)
    result[exists & along_x, 0] = distance[exists & along_x]
    result[exists & ~along_x, 1] = distance[exists & ~along_x]
    return result


class Edges(Pass):
    """Distances to edges (H x W x 2, pixels)."""

    name = "edges"
    cycles = frozenset({"Depth", "IndexOB"})
    from_meshes = True
    from_jitter = True

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        plan, ids = exposure.plan, ids_of(exposure)
        with exposure.watch.of(self.name):
            finder = EdgeFinder(plan.frame, exposure.now.camera)
            depsgraph = bpy.context.evaluated_depsgraph_get()
            collect(finder, depsgraph, plan.ids, shown_by(exposure))
            distances, missing = finder.measure(ids, exposure.depth, exposure.offset)
        if missing:
            exposure.notes["pixels_without_edges"] = missing
        return dict(zip(self.facts.channels, np.moveaxis(distances, -1, 0)))


def collect(
    finder: EdgeFinder, depsgraph: bpy.types.Depsgraph, ids: ObjectIds, shown: set[int]
) -> None:
    """Adds everything of the evaluated scene that has triangles and whose id is ``shown``."""
    for triangles, matrix, identity in shapes.visible_shapes(depsgraph, ids, shown, mesh_triangles):
        finder.add(triangles, matrix, identity)
