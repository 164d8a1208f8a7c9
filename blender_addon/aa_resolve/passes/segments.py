# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges of all shown surfaces as segments in the picture (pass ``segments``, for GPAA).

[Persson 2011]. An edge of a mesh is kept where the picture may change across it:
  boundary    it has one triangle (or more than two)
  silhouette  one of its two triangles faces the camera, the other does not
  crease      the two differ in material, or are not coplanar and the shading breaks between them
Edges between coplanar triangles of one material are dropped, and so are those that smooth shading hides.

Both ends are clipped to the camera's near and far planes and to the picture extended by a few pixels, in homogeneous
coordinates, where all of it is linear. Positions are those of the un-jittered picture, pixels, y down; depth is planar.
Hidden edges stay in: the method's depth test drops them.

Order: from far to near by the mean depth of the ends, then by the ends themselves; of the two ends the left (upper) one
comes first. So the list depends on the picture alone, and "the last writer wins" lets the nearest edge win.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import compat
from ..scene import camera as cam
from ..scene import shapes
from ..scene.instances import ObjectIds
from .base import Pass
from .exposure import Exposure
from .geometry import shown_by

ROW = 4096  # entries per line of the part
_MARGIN_PX = 4.0  # a segment touches pixels beside itself: what ends just outside still counts
_COPLANAR = 0.99999  # cosine of the angle between two normals that count as one
_KEY_BASE = 1 << 32  # more than there are vertices


@dataclass
class Outline:
    """Edges of one mesh, object space: both ends (E x 2 x 3), the two triangles' planes (E x 2 x 4: normal, offset)
    and whether the edge is drawn whatever the view (E)."""

    ends: np.ndarray
    planes: np.ndarray
    always: np.ndarray


def outline_of(mesh: bpy.types.Mesh) -> Outline:
    """Edges of a mesh that may be seen: those between coplanar triangles of one material are left out."""
    places, corners, polygons = shapes.triangles_of(mesh)
    points = places[corners].astype(np.float64)
    normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    length = np.linalg.norm(normals, axis=1)
    solid = length > 0.0
    points, normals, polygons = points[solid], normals[solid] / length[solid, None], polygons[solid]
    # Vertices at one place are one: importers split them along seams of texture coordinates.
    welded = np.unique(places, axis=0, return_inverse=True)[1].reshape(-1)[corners]
    keys = _side_keys(welded[solid]).ravel()
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
    counts = np.diff(starts, append=len(keys))
    first = order[starts]
    second = np.where(counts > 1, order[np.minimum(starts + 1, len(keys) - 1)], first)
    one, other = first // 3, second // 3
    cosine = (normals[one] * normals[other]).sum(axis=1)
    material = _of_all(mesh.polygons, "material_index", np.int32)[polygons]
    joined = (counts == 2) & (material[one] == material[other])
    loops = _of_all(mesh.loop_triangles, "loops", np.int32, 3).reshape(-1, 3)[solid]
    normals_of_corners = compat.corner_normals(mesh)
    broken = _breaks_shading(
        normals_of_corners, loops.ravel(), welded[solid].ravel(), first, second
    )
    kept = ~joined | (cosine <= _COPLANAR)
    planes = np.concatenate([normals, -(normals * points[:, 0]).sum(axis=1)[:, None]], axis=1)
    triangle, side = one[kept], first[kept] % 3
    return Outline(
        np.stack([points[triangle, side], points[triangle, (side + 1) % 3]], axis=1),
        np.stack([planes[triangle], planes[other[kept]]], axis=1),
        (~joined | broken)[kept],
    )


def _side_keys(corners: np.ndarray) -> np.ndarray:
    """One number per side of each triangle (T x 3), the same for both directions; side k runs from corner k to k + 1."""
    corners = corners.astype(np.int64)
    following = np.roll(corners, -1, axis=1)
    return np.minimum(corners, following) * _KEY_BASE + np.maximum(corners, following)


def _of_all(items, name: str, kind, each: int = 1) -> np.ndarray:
    values = np.empty(len(items) * each, kind)
    items.foreach_get(name, values)
    return values


def _breaks_shading(
    normals: np.ndarray,
    loops: np.ndarray,
    places: np.ndarray,
    first: np.ndarray,
    second: np.ndarray,
) -> np.ndarray:
    """True for pairs of sides (3 x triangle + side each) whose triangles are shaded with different normals along them:
    at flat faces, sharp marks, and where custom normals say so.

    Normals by corner of the mesh, which ``loops`` gives for every corner of the triangles; ``places`` numbers where
    those lie, by which the ends of two sides are told apart."""
    beyond = np.where(np.arange(len(loops)) % 3 == 2, -2, 1) + np.arange(len(loops))
    turned = places.take(first) != places.take(second)
    pairs = (
        (first, np.where(turned, beyond.take(second), second)),
        (beyond.take(first), np.where(turned, second, beyond.take(second))),
    )
    broken = np.zeros(len(first), bool)
    for one, other in pairs:
        a = normals.take(loops.take(one), axis=0)
        b = normals.take(loops.take(other), axis=0)
        broken |= np.einsum("ij,ij->i", a, b) <= _COPLANAR
    return broken


class SegmentFinder:
    """Collects the edges of a frame."""

    def __init__(self, frame: cam.Frame, camera: cam.CameraState) -> None:
        self._camera = camera
        self._size = frame.width, frame.height
        half_w, half_h = frame.width / 2.0, frame.height / 2.0
        # View space -> (x w, y w, w) in pixels with y down.
        to_pixels = np.array([[half_w, 0, half_w], [0, -half_h, half_h], [0, 0, 1.0]])
        self._to_pixels = to_pixels @ camera.projection[[0, 1, 3], :]
        self._found: list[np.ndarray] = []

    def add(self, outline: Outline, matrix: np.ndarray) -> None:
        """Adds an object or instance with its world matrix."""
        to_view = self._camera.view @ matrix
        drawn = outline.always | self._is_silhouette(outline.planes, to_view)
        ends = outline.ends[drawn] @ to_view[:3, :3].T + to_view[:3, 3]
        self._found.append(self._clipped(ends))

    def _is_silhouette(self, planes: np.ndarray, to_view: np.ndarray) -> np.ndarray:
        """True where one triangle shows its front and the other its back."""
        if np.linalg.matrix_rank(to_view[:3, :3]) < 3:
            return np.ones(len(planes), bool)  # flattened by its scale: fronts and backs coincide
        from_view = np.linalg.inv(to_view)
        if self._camera.kind == "perspective":
            eye = from_view[:, 3]
        else:
            eye = from_view[:, 2]  # a direction: what looks along -z lies at infinity along z
        facing = planes @ eye > 0.0
        return facing[:, 0] != facing[:, 1]

    def _clipped(self, ends: np.ndarray) -> np.ndarray:
        """Segments (S x 6) of edges in view space (E x 2 x 3) as far as they lie in front of the camera and near the
        picture."""
        width, height = self._size
        places = ends @ self._to_pixels[:, :3].T + self._to_pixels[:, 3]
        points = np.concatenate([places, -ends[:, :, 2:]], axis=2)  # x w, y w, w, depth
        x, y, w, depth = np.moveaxis(points, 2, 0)
        begin, end = np.zeros(len(points)), np.ones(len(points))
        for inside in (
            depth - self._camera.near,
            self._camera.far - depth,
            x + _MARGIN_PX * w,
            (width + _MARGIN_PX) * w - x,
            y + _MARGIN_PX * w,
            (height + _MARGIN_PX) * w - y,
        ):
            a, b = inside[:, 0], inside[:, 1]
            with np.errstate(divide="ignore", invalid="ignore"):
                crossing = a / (a - b)
            begin = np.where((a < 0.0) & (b >= 0.0), np.maximum(begin, crossing), begin)
            end = np.where((a >= 0.0) & (b < 0.0), np.minimum(end, crossing), end)
            end = np.where((a < 0.0) & (b < 0.0), -1.0, end)
        seen = end > begin
        begin, end, points = begin[seen, None], end[seen, None], points[seen]
        along = points[:, 1] - points[:, 0]
        both = np.stack([points[:, 0] + begin * along, points[:, 0] + end * along], axis=1)
        # Ends that were not clipped stay what they are, to the bit.
        both[:, 1] = np.where(end == 1.0, points[:, 1], both[:, 1])
        both[:, :, :2] /= both[:, :, 2:3]
        return both[:, :, [0, 1, 3]].reshape(-1, 6)

    def segments(self) -> np.ndarray:
        """All segments (N x 6 float32: x, y, depth of one end and of the other) in their order."""
        found = np.concatenate(self._found or [np.empty((0, 6))]).astype(np.float32)
        swapped = (found[:, 0] > found[:, 3]) | (
            (found[:, 0] == found[:, 3]) & (found[:, 1] > found[:, 4])
        )
        found[swapped] = found[swapped][:, [3, 4, 5, 0, 1, 2]]
        found = found[(found[:, 0:2] != found[:, 3:5]).any(axis=1)]  # seen end-on it is a point
        mean_depth = found[:, 2].astype(np.float64) + found[:, 5]
        return found[np.lexsort((*found.T[::-1], -mean_depth))]


def find(
    frame: cam.Frame,
    camera: cam.CameraState,
    depsgraph: bpy.types.Depsgraph,
    ids: ObjectIds,
    shown: set[int],
) -> np.ndarray:
    """Segments of everything in the evaluated scene whose id is among ``shown``: an edge of
    what no sample shows could not blend any colour of the picture."""
    finder = SegmentFinder(frame, camera)
    for outline, matrix, _ in shapes.visible_shapes(depsgraph, ids, shown, outline_of):
        finder.add(outline, matrix)
    return finder.segments()


class Segments(Pass):
    """The list of segments as a small picture of its own."""

    name = "segments"
    cycles = frozenset({"IndexOB"})
    from_meshes = True

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        plan, shown = exposure.plan, shown_by(exposure)
        with exposure.watch.of(self.name):
            depsgraph = bpy.context.evaluated_depsgraph_get()
            found = find(plan.frame, exposure.now.camera, depsgraph, plan.ids, shown)
        return dict(zip(self.facts.channels, np.moveaxis(in_rows(found), -1, 0)))


def in_rows(segments: np.ndarray) -> np.ndarray:
    """N x 6 segments as H x W x 6: one entry per pixel, row by row, the rest of the last row (or the one entry of an
    empty list) filled with zeros, which no segment has as its depth."""
    count = max(1, len(segments))
    width = min(count, ROW)
    height = -(-count // width)
    entries = np.zeros((height * width, 6), np.float32)
    entries[: len(segments)] = segments
    return entries.reshape(height, width, 6)
