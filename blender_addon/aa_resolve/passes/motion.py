# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact motion from Blender's Vector pass and the cameras' matrices, and where the camera jumps.

Positions are pixels of the exported picture, x right, y **down**; motion is current - previous, without jitter."""

from __future__ import annotations

import math

import numpy as np

from .camera import BACKGROUND_DEPTH, CameraState, Frame, same_camera, sample_positions, unproject

# Motion of a pixel whose surface had no place in the previous picture: far outside, so that every temporal
# method takes it for a disocclusion instead of fetching somebody else's colour.
NO_PREVIOUS_POSITION_PX = 1.0e6


def motion_from_vector(
    vector: np.ndarray,
    depth: np.ndarray,
    frame: Frame,
    jitter: tuple[float, float],
    now: CameraState,
    before: CameraState,
) -> np.ndarray:
    """Motion current - previous (H x W x 2, pixels, y down) from Blender's Vector pass.

    Vector.XY is previous - current with y up, both seen through the *current* projection: a change of lens, of
    orthographic scale or of shift is missing and comes in here, where the previous position is taken back to a
    direction and projected with the previous camera's own matrix. Background has no vector; it is a direction at
    infinity that only the rotation moves (0 for an orthographic camera, whose background shows one direction).
    """
    x, y = sample_positions(frame, *jitter)
    vector_x, vector_y = vector[:, :, 0].astype(np.float64), vector[:, :, 1].astype(np.float64)
    motion = np.empty((frame.height, frame.width, 2), np.float64)
    if np.array_equal(now.projection, before.projection):
        motion[:, :, 0], motion[:, :, 1] = -vector_x, vector_y
    else:
        previous_x, previous_y = x + vector_x, y - vector_y
        ndc_x, ndc_y = 2.0 * previous_x / frame.width - 1.0, 1.0 - 2.0 * previous_y / frame.height
        a, b = now.projection, before.projection
        column = 2 if now.kind == "perspective" else 3
        sign = 1.0 if now.kind == "perspective" else -1.0
        ndc_x = (ndc_x + sign * a[0, column]) / a[0, 0] * b[0, 0] - sign * b[0, column]
        ndc_y = (ndc_y + sign * a[1, column]) / a[1, 1] * b[1, 1] - sign * b[1, column]
        motion[:, :, 0] = x - (ndc_x + 1.0) * 0.5 * frame.width
        motion[:, :, 1] = y - (1.0 - ndc_y) * 0.5 * frame.height
    background = depth >= BACKGROUND_DEPTH
    if background.any():
        motion[background] = background_motion(frame, jitter, now, before)[background]
    return motion.astype(np.float32) + np.float32(0.0)  # no negative zeros


def background_motion(
    frame: Frame, jitter: tuple[float, float], now: CameraState, before: CameraState
) -> np.ndarray:
    """Motion (H x W x 2, pixels, y down) of what lies infinitely far away."""
    motion = np.zeros((frame.height, frame.width, 2), np.float64)
    if now.kind != "perspective" or before.kind != "perspective" or same_camera(now, before):
        return motion
    x, y = sample_positions(frame, *jitter)
    direction = np.empty((frame.height, frame.width, 3), np.float64)
    direction[:, :, 0] = (2.0 * x / frame.width - 1.0 + now.projection[0, 2]) / now.projection[0, 0]
    direction[:, :, 1] = (1.0 - 2.0 * y / frame.height + now.projection[1, 2]) / now.projection[
        1, 1
    ]
    direction[:, :, 2] = -1.0
    turned = direction @ (before.view[:3, :3] @ now.view[:3, :3].T).T
    ahead = -turned[:, :, 2]
    visible = ahead > 1e-9
    safe = np.where(visible, ahead, 1.0)
    ndc_x = turned[:, :, 0] / safe * before.projection[0, 0] - before.projection[0, 2]
    ndc_y = turned[:, :, 1] / safe * before.projection[1, 1] - before.projection[1, 2]
    motion[:, :, 0] = x - (ndc_x + 1.0) * 0.5 * frame.width
    motion[:, :, 1] = y - (1.0 - ndc_y) * 0.5 * frame.height
    motion[~visible] = NO_PREVIOUS_POSITION_PX
    return motion


_LOST_SHARE = 0.5  # of the picture
_DISTANCE_RATIO = 2.0
_SAME_PLACE_PX = 1.0


def cut_between(
    now: CameraState,
    before: CameraState,
    frame: Frame,
    jitter: tuple[float, float],
    depth: np.ndarray,
    motion: np.ndarray | None,
) -> bool:
    """True when the camera jumps, so that the previous picture is no history of this one. Within one camera; a change
    of the camera object is a cut in any case.

    It jumps when it changes its kind, turns by more than half its field of view, or moves so far that more than half
    of what the picture shows was outside of the previous one, or at rest and at less than half or more than twice its
    distance. ``motion`` (H x W x 2) counts movements of objects in: a camera that follows something fast does not
    jump. Without it everything is taken to be at rest."""
    if now.kind != before.kind:
        return True
    if same_camera(now, before):
        return False
    turn = now.view[:3, :3] @ before.view[:3, :3].T
    angle = math.acos(max(-1.0, min(1.0, (np.trace(turn) - 1.0) / 2.0)))
    limit = math.radians(30.0)
    if now.kind == "perspective":
        limit = math.atan(1.0 / min(now.projection[0, 0], now.projection[1, 1]))
    if angle > limit:
        return True
    x, y = sample_positions(frame, *jitter)
    to_before = before.view @ np.linalg.inv(now.view)
    points = unproject(x, y, depth.astype(np.float64), frame, now)
    points = points @ to_before[:3, :3].T + to_before[:3, 3]
    distance = -points[..., 2]
    clip = points @ before.projection[[0, 1, 3], :3].T + before.projection[[0, 1, 3], 3]
    with np.errstate(divide="ignore", invalid="ignore"):
        resting_x = (clip[..., 0] / clip[..., 2] + 1.0) * 0.5 * frame.width
        resting_y = (1.0 - clip[..., 1] / clip[..., 2]) * 0.5 * frame.height
    past_x, past_y = (resting_x, resting_y) if motion is None else (x - motion[..., 0], y - motion[..., 1])
    lost = ~((past_x >= 0.0) & (past_x <= frame.width) & (past_y >= 0.0) & (past_y <= frame.height))
    if now.kind == "perspective":
        resting = np.hypot(past_x - resting_x, past_y - resting_y) < _SAME_PLACE_PX
        with np.errstate(divide="ignore"):
            ratio = np.maximum(distance / depth, depth / distance)
        lost |= resting & ((distance <= 0.0) | (ratio > _DISTANCE_RATIO))
        if motion is None:
            lost |= distance <= 0.0
    return float(lost.mean()) > _LOST_SHARE
