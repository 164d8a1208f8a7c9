# SPDX-License-Identifier: GPL-3.0-or-later
"""Which sub-samples lie on the surface of the centre sample: the mask of pass ``subsamples``.

[Reshetov 2012]: how unlike the geometry of two samples is, and one k-means step that parts
the sub-samples of a pixel into those like the centre and the others."""

from __future__ import annotations

import numpy as np

from ..scene import camera as cam


def geometry_dissimilarity(
    point_a: np.ndarray,
    normal_a: np.ndarray,
    point_b: np.ndarray,
    normal_b: np.ndarray,
    depth: np.ndarray,
) -> np.ndarray:
    """SADP, the sum of absolute dot products [Reshetov 2012]: 0 within a plane, sqrt 2 across a right angle, 2 for
    parallel surfaces one behind the other. Points and normals H x W x 3 in one space, float64.

    Coincident points have no direction: there 1 - a.b of the normals decides. A missing normal adds 1.
    """
    offset = point_b - point_a
    distance = np.sqrt((offset * offset).sum(axis=-1))
    near = distance < 1e-6 * np.maximum(1.0, depth)
    direction = offset / np.where(near, 1.0, distance)[..., None]
    result = np.abs((normal_a * direction).sum(-1)) + np.abs((normal_b * direction).sum(-1))
    missing = ((normal_a * normal_a).sum(-1) < 0.25) | ((normal_b * normal_b).sum(-1) < 0.25)
    result = np.where(missing, result + 1.0, result)
    return np.where(near, 1.0 - (normal_a * normal_b).sum(-1), result)


_SADP_FLOOR = 0.2  # [Reshetov 2012]: below it everything counts as one surface
_BAND_PIXELS = 8192  # what a band needs stays in the cache: whole pictures took twice as long


def surface_mask(
    centre: dict[str, np.ndarray],
    samples: list[dict[str, np.ndarray]],
    frame: cam.Frame,
    camera: cam.CameraState,
    jitter: tuple[float, float],
    positions: list[tuple[float, float]],
) -> np.ndarray:
    """H x W uint32: bit k is set where sub-sample k lies on the surface of the centre sample.

    One k-means step with two clusters on SADP (5.5.2); a sub-sample on another object is as far away as can be.
    ``centre`` and ``samples`` hold ``depth`` (H x W), ``normal`` (H x W x 3, world) and ``id`` (H x W).
    """
    height, width = centre["depth"].shape
    mask = np.empty((height, width), np.uint32)
    band = max(1, _BAND_PIXELS // width)
    for first in range(0, height, band):
        rows = slice(first, min(first + band, height))
        mask[rows] = _mask_of_rows(rows, centre, samples, frame, camera, jitter, positions)
    return mask


def _mask_of_rows(
    rows: slice,
    centre: dict[str, np.ndarray],
    samples: list[dict[str, np.ndarray]],
    frame: cam.Frame,
    camera: cam.CameraState,
    jitter: tuple[float, float],
    positions: list[tuple[float, float]],
) -> np.ndarray:
    """``surface_mask`` of some rows of the picture."""
    centre = {name: pixels[rows] for name, pixels in centre.items()}
    to_view = camera.view[:3, :3]

    def placed(
        sample: dict[str, np.ndarray], offset: tuple[float, float]
    ) -> tuple[np.ndarray, np.ndarray]:
        x, y = cam.sample_positions(frame, *offset)
        depth = sample["depth"].astype(np.float64)
        return (
            cam.unproject(x, y[rows], depth, frame, camera),
            sample["normal"].astype(np.float64) @ to_view.T,
        )

    centre_point, centre_normal = placed(centre, jitter)
    centre_empty = centre["depth"] >= cam.BACKGROUND_DEPTH
    distances = np.empty((len(samples), *centre["depth"].shape), np.float64)
    for index, (sample, (x, y)) in enumerate(zip(samples, positions)):
        sample = {name: pixels[rows] for name, pixels in sample.items()}
        point, normal = placed(sample, (jitter[0] + x, jitter[1] + y))
        apart = geometry_dissimilarity(centre_point, centre_normal, point, normal, centre["depth"])
        empty = sample["depth"] >= cam.BACKGROUND_DEPTH
        apart = np.where(empty & centre_empty, 0.0, np.where(empty | centre_empty, 2.0, apart))
        distances[index] = np.where(sample["id"] != centre["id"], 2.0, apart)
    farthest = distances.max(axis=0)
    similar = distances <= farthest / 2.0
    mean_similar = (distances * similar).sum(axis=0) / (
        similar.sum(axis=0) + 1.0
    )  # the centre itself counts, with 0
    others = len(samples) - similar.sum(axis=0)
    mean_other = (distances * ~similar).sum(axis=0) / np.maximum(others, 1)
    similar = np.abs(distances - mean_similar) <= np.abs(distances - mean_other)
    similar |= farthest < _SADP_FLOOR
    bits = (np.uint32(1) << np.arange(len(samples), dtype=np.uint32))[:, None, None]
    return (similar * bits).sum(axis=0).astype(np.uint32)
