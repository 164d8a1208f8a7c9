# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion since the frame before (pass ``motion``): Blender's Vector pass, made exact by the cameras' matrices.

Positions are pixels of the exported picture, x right, y **down**; motion is current - previous, without jitter."""

from __future__ import annotations

import numpy as np

from ..scene import lighting, rendering
from ..scene.camera import (
    BACKGROUND_DEPTH,
    CameraState,
    Frame,
    same_camera,
    sample_positions,
    unproject,
)
from . import turning
from .base import Pass
from .exposure import Exposure
from .geometry import ids_of

# Motion of a pixel whose surface had no place in the previous picture: far outside, so that every temporal
# method takes it for a disocclusion instead of fetching somebody else's colour.
NO_PREVIOUS_POSITION_PX = 1.0e6


class Motion(Pass):
    """H x W x 2 pixels, with NO_PREVIOUS_POSITION_PX where Cycles' vector is known to be wrong."""

    name = "motion"
    cycles = frozenset({"Vector", "IndexOB", "Depth"})
    from_frame_before = True

    def reads(self, exposure: Exposure) -> frozenset[str]:
        # With motion vectors Cycles shows only instances that exist in the frames before and after as well.
        return self.cycles - {"Vector"} if exposure.instances_change else self.cycles

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        ids = ids_of(exposure)
        with exposure.watch.of(self.name):
            apart = exposure.instances_change
            vector = _vectors_apart(exposure) if apart else exposure.main.get("Vector")
            now, before = exposure.now.camera, exposure.before.camera
            exposure.vectors = motion_from_vector(
                vector,
                exposure.depth,
                exposure.plan.frame,
                exposure.offset,
                now,
                before,
                turning.depth_before(exposure, vector) if turning.is_turned(now, before) else None,
            )
        wrong = _is_wrong(exposure, ids)
        vectors = np.where(wrong[..., None], np.float32(NO_PREVIOUS_POSITION_PX), exposure.vectors)
        if wrong.any():
            exposure.notes["motion_invalid"] = {
                "objects": sorted(set(exposure.plan.ids.names(ids[wrong]).values())),
                "pixels": int(wrong.sum()),
                "value": NO_PREVIOUS_POSITION_PX,
            }
        return dict(zip(self.facts.channels, np.moveaxis(vectors, -1, 0)))


def _vectors_apart(exposure: Exposure) -> np.ndarray:
    """Vector pass of a render of its own; no place in the picture where that shows something else."""
    plan = exposure.plan
    rendering.request_passes(plan.view_layer, {"Vector", "Depth", "IndexOB"})
    with lighting.no_light(plan.light, plan.scene):
        layers = rendering.render(plan.scene, plan.view_layer, plan.folder)
    same = (layers.get("IndexOB") == exposure.main.get("IndexOB")) & (
        layers.get("Depth") == exposure.main.get("Depth")
    )
    return np.where(same, layers.get("Vector"), NO_PREVIOUS_POSITION_PX)


def _is_wrong(exposure: Exposure, ids: np.ndarray) -> np.ndarray:
    """H x W: True where Cycles' vector is known to be wrong.

    Objects that were hidden in the previous frame, instances that were not there, and meshes whose vertices changed in
    number or are joined in another way.
    """
    now, before, known = exposure.now, exposure.before, exposure.plan.ids
    changed = [
        key for key, now_is in now.topology.items() if before.topology.get(key, now_is) != now_is
    ]
    instances = [key for key in changed if known.of_instances([key])]
    names = {name for name in before.hidden if name not in now.hidden}
    names |= {key[0] for key in changed if key not in instances}
    indices = [index for index, name in known.table.items() if name in names]
    index = np.rint(exposure.main.get("IndexOB")[:, :, 0]).astype(np.int64)
    new = known.of_instances([*(now.instances - before.instances), *instances])
    lost = (np.abs(exposure.vectors) > NO_PREVIOUS_POSITION_PX / 2.0).any(-1)
    return np.isin(index, indices) | np.isin(ids, new) | lost


def motion_from_vector(
    vector: np.ndarray,
    depth: np.ndarray,
    frame: Frame,
    jitter: tuple[float, float],
    now: CameraState,
    before: CameraState,
    depth_before: np.ndarray | None = None,
) -> np.ndarray:
    """Motion current - previous (H x W x 2, pixels, y down) from Blender's Vector pass.

    Vector.XY is previous - current with y up. The jittered camera (scene/camera.py) keeps back what versions disagree
    about; it comes in here:
    - perspective: both positions are seen through the *current* projection. The previous one is taken back to a
      direction and projected with the previous camera's own matrix.
    - orthographic: both are seen by the *current* camera. The previous one is taken back to a point and projected by
      the previous camera. Where that looked another way the point's depth counts, as the current camera would have
      measured it: ``depth_before`` (H x W), without which it is that of now.

    Background has no vector; it is a direction at infinity that only the rotation moves (0 for an orthographic
    camera, whose background shows one direction).
    """
    x, y = sample_positions(frame, *jitter)
    vector_x, vector_y = vector[:, :, 0].astype(np.float64), vector[:, :, 1].astype(np.float64)
    motion = np.empty((frame.height, frame.width, 2), np.float64)
    a, b = now.projection, before.projection
    rests = np.array_equal(a, b) and (
        now.kind == "perspective" or np.array_equal(now.view, before.view)
    )
    if rests or now.kind != before.kind:
        motion[:, :, 0], motion[:, :, 1] = -vector_x, vector_y
    elif now.kind == "perspective":
        previous_x, previous_y = x + vector_x, y - vector_y
        ndc_x, ndc_y = 2.0 * previous_x / frame.width - 1.0, 1.0 - 2.0 * previous_y / frame.height
        ndc_x = (ndc_x + a[0, 2]) / a[0, 0] * b[0, 0] - b[0, 2]
        ndc_y = (ndc_y + a[1, 2]) / a[1, 1] * b[1, 1] - b[1, 2]
        motion[:, :, 0] = x - (ndc_x + 1.0) * 0.5 * frame.width
        motion[:, :, 1] = y - (1.0 - ndc_y) * 0.5 * frame.height
    else:
        along = depth.astype(np.float64) if depth_before is None else depth_before
        points = unproject(x + vector_x, y - vector_y, along, frame, now)
        to_before = before.view @ np.linalg.inv(now.view)
        points = points @ to_before[:3, :3].T + to_before[:3, 3]
        ndc_x = points[..., 0] * b[0, 0] + b[0, 3]
        ndc_y = points[..., 1] * b[1, 1] + b[1, 3]
        motion[:, :, 0] = x - (ndc_x + 1.0) * 0.5 * frame.width
        motion[:, :, 1] = y - (1.0 - ndc_y) * 0.5 * frame.height
        motion[~np.isfinite(along)] = NO_PREVIOUS_POSITION_PX
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
