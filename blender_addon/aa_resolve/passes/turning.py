# SPDX-License-Identifier: GPL-3.0-or-later
"""Orthographic cameras that turn: how deep each point lay a frame ago, seen along the axis of now (for ``motion``).

The vectors of a camera at rest (scene/camera.py) tell where a point was, but not how deep, and a camera that looked
another way saw the depth as a place. A second render knows it: its camera rides, so the vectors hold the place that
the *previous* camera gave the point, which lies on the line of all depths. Blender 4.3 takes that camera for a
perspective one; the place then is a direction from where the camera stood, so it stands aside, where no line of
depths runs through it. Two coordinates for one unknown: by what is left over the data tell which of the two it was.
"""

from __future__ import annotations

import numpy as np

from ..scene import lighting, rendering
from ..scene.camera import BACKGROUND_DEPTH, CameraState, sample_positions, unproject
from .exposure import Exposure

_TURNED = 1.0e-6  # sine of the angle below which the axis counts as the same
_SAME_DEPTH = 1.0e-4  # relative: the second camera meets the same surface up to rounding
_MAGNIFICATION = 4.0  # at least, of most of what is seen, should the second camera be a perspective one: never near 1


def is_turned(now: CameraState, before: CameraState) -> bool:
    """True when two orthographic cameras look along different axes."""
    if now.kind != "orthographic" or before.kind != "orthographic":
        return False
    turn = before.view[:3, :3] @ now.view[:3, :3].T
    return float(np.abs(turn[:2, 2]).max()) > _TURNED


def depth_before(exposure: Exposure, vector: np.ndarray) -> np.ndarray:
    """H x W: depth of the shown points in the frame before, along the current axis; infinite where it is not known.

    ``vector`` is the Vector pass of the camera at rest."""
    plan, frame = exposure.plan, exposure.plan.frame
    now, before = exposure.now.camera, exposure.before.camera
    surface = exposure.depth < BACKGROUND_DEPTH
    depth = exposure.depth.astype(np.float64)
    if not surface.any():
        return depth
    width, middle = 2.0 / now.projection[0, 0], float(np.median(depth[surface]))
    aside, scale = width + middle, _MAGNIFICATION * max(width, middle)
    rendering.request_passes(plan.view_layer, {"Vector", "Depth", "IndexOB"})
    with (
        exposure.stage.second_sight(exposure.number, exposure.offset, aside, scale),
        lighting.no_light(plan.light, plan.scene),
    ):
        layers = rendering.render(plan.scene, plan.view_layer, plan.folder)

    x, y = sample_positions(frame, *exposure.offset)
    to_before = before.view @ np.linalg.inv(now.view)
    # A point is start + depth x axis for the camera before.
    start = unproject(x + vector[..., 0], y - vector[..., 1], np.zeros_like(depth), frame, now)
    start = start @ to_before[:3, :3].T + to_before[:3, 3]
    axis = -to_before[:3, 2]
    second = layers.get("Vector")
    place = unproject(x + second[..., 0], y - second[..., 1], np.zeros_like(depth), frame, now)
    # Orthographic: place = start + depth x axis. Perspective, from ``aside``: scale x (start + depth x axis - aside)
    # = ahead x (place - aside) with ahead = -(start + depth x axis).z
    seen = (place[..., :2] - (aside, 0.0)) / scale
    lines = (
        (np.broadcast_to(axis[:2], seen.shape), place[..., :2] - start[..., :2]),
        (axis[:2] + seen * axis[2], (aside, 0.0) - start[..., :2] - seen * start[..., 2:]),
    )
    found, left = [], []
    for slope, value in lines:
        square = (slope * slope).sum(axis=-1)
        depths = (slope * value).sum(axis=-1) / np.where(square > 0.0, square, 1.0)
        found.append(depths)
        left.append(np.abs(slope * depths[..., None] - value)[surface].mean())
    depths = found[int(np.argmin(left))]
    same = (layers.get("IndexOB")[..., 0] == exposure.main.get("IndexOB")[..., 0]) & (
        np.abs(layers.get("Depth")[..., 0] - depth) <= _SAME_DEPTH * np.abs(depth)
    )
    return np.where(surface & ~same, np.inf, np.where(surface, depths, depth))
