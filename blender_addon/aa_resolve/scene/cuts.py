# SPDX-License-Identifier: GPL-3.0-or-later
"""Which camera looks at a frame, and whether it jumps from one frame to the next."""

from __future__ import annotations

import math

import bpy
import numpy as np

from ..errors import SceneError
from .active_camera import CameraReaders
from .camera import CameraState, Frame, same_camera, sample_positions, unproject


class CameraCuts:
    """Which camera looks at a frame: those bound to markers and not hidden in renders, else the scene's own.

    Takes the bindings out of the (open, never saved) scene: they would put the user's camera in the place of the
    jittered one at every change of frame."""

    def __init__(self, scene: bpy.types.Scene) -> None:
        self._default = scene.camera
        self._bound = sorted(
            (
                (marker.frame, marker.camera)
                for marker in scene.timeline_markers
                if marker.camera is not None and not marker.camera.hide_render
            ),
            key=lambda pair: pair[0],
        )
        for marker in scene.timeline_markers:
            marker.camera = None
        self.readers = CameraReaders(scene)

    def bring_in(self, scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> None:
        """Links the cameras that the view layer does not show, such as those of an excluded collection, to the scene's own
        collection: what Blender does not evaluate has no place in a frame."""
        for camera in {self._default, *(camera for _, camera in self._bound)} - {None}:
            if not camera.visible_get(view_layer=view_layer):
                if camera.name not in scene.collection.objects:
                    scene.collection.objects.link(camera)

    @property
    def is_cut(self) -> bool:
        """True when more than one camera may appear."""
        return len({camera.name_full for _, camera in self._bound}) > 1

    def at(self, frame: int) -> bpy.types.Object:
        """The camera of a frame."""
        before = [camera for marked, camera in self._bound if marked <= frame]
        chosen = before[-1] if before else (self._bound[0][1] if self._bound else self._default)
        if chosen is None:
            raise SceneError(
                "the scene has no camera: set one as active, or bind cameras to markers"
            )
        return chosen

    def turn_to(self, frame: int) -> bpy.types.Object:
        """The camera of a frame, which from now on is the active one for all that reads it."""
        chosen = self.at(frame)
        self.readers.show(chosen)
        return chosen


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
    past_x, past_y = (
        (resting_x, resting_y) if motion is None else (x - motion[..., 0], y - motion[..., 1])
    )
    lost = ~((past_x >= 0.0) & (past_x <= frame.width) & (past_y >= 0.0) & (past_y <= frame.height))
    if now.kind == "perspective":
        resting = np.hypot(past_x - resting_x, past_y - resting_y) < _SAME_PLACE_PX
        with np.errstate(divide="ignore"):
            ratio = np.maximum(distance / depth, depth / distance)
        lost |= resting & ((distance <= 0.0) | (ratio > _DISTANCE_RATIO))
        if motion is None:
            lost |= distance <= 0.0
    return float(lost.mean()) > _LOST_SHARE
