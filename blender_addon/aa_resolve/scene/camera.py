# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras: the shift that jitters a picture (or, as a labelled variant, a movement), and matrices without jitter.

Positions are pixels of the exported picture, x right, y **down**, origin at the top-left corner. Matrices are
row-major for column vectors: world -> view (the camera looks along -z) and view -> clip (OpenGL, z in -w..w).
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..errors import SceneError

BACKGROUND_DEPTH = 1.0e9  # anything at or beyond it is background (Cycles writes 1e10)


@dataclass(frozen=True)
class Frame:
    """Geometry of the exported picture: full size and the exported window (equal without border), pixels."""

    full_width: int
    full_height: int
    left: int
    top: int
    width: int
    height: int
    aspect_x: float
    aspect_y: float

    @property
    def is_cropped(self) -> bool:
        """True when only a border region is exported."""
        return (self.width, self.height) != (self.full_width, self.full_height)


def frame_of(scene: bpy.types.Scene) -> Frame:
    """Picture size as Blender computes it: sizes are truncated, the border is counted from the bottom."""
    render = scene.render
    width = int(render.resolution_x * render.resolution_percentage / 100)
    height = int(render.resolution_y * render.resolution_percentage / 100)
    left, right, bottom, top = 0, width, 0, height
    if render.use_border:
        left, right = _pixels(render.border_min_x, width), _pixels(render.border_max_x, width)
        bottom, top = _pixels(render.border_min_y, height), _pixels(render.border_max_y, height)
    if right - left < 1 or top - bottom < 1:
        raise SceneError("the render border is smaller than one pixel: enlarge it or switch it off")
    return Frame(
        width,
        height,
        left,
        height - top,
        right - left,
        top - bottom,
        render.pixel_aspect_x,
        render.pixel_aspect_y,
    )


def _pixels(share: float, whole: int) -> int:
    """A share of a side in whole pixels. In Blender's own floats 0.7 of 20 is 14; in longer ones it is less."""
    return int(np.float32(share) * np.float32(whole))


def jitter_to_shift(
    frame: Frame, data: bpy.types.Camera, jitter_x: float, jitter_y: float
) -> tuple[float, float]:
    """What to add to ``shift_x, shift_y`` so that samples move by the jitter (pixels, y down).

    Blender's shift is a fraction of the sensor side that the fit selects; the size of the sensor cancels out.
    """
    aspect = frame.aspect_y / frame.aspect_x
    fit = data.sensor_fit
    if fit == "AUTO":
        wide = frame.full_width * frame.aspect_x >= frame.full_height * frame.aspect_y
        fit = "HORIZONTAL" if wide else "VERTICAL"
    side = frame.full_width if fit == "HORIZONTAL" else aspect * frame.full_height
    return jitter_x / side, -jitter_y * aspect / side


def premultiplied_movement(frame: Frame, jitter_x: float, jitter_y: float) -> tuple[float, float]:
    """How far, in scene units to the right and up, a camera moves parallel to its picture in place of a jitter.

    The error of the T2MSAA/ASAA thesis, for its reproduction: the translation (-2 jx / W, +2 jy / H) of clip space was
    multiplied to the wrong side of the projection P and moved the geometry in view space. A point at depth z is then
    sampled at (jx P00 / z, jy P11 / z) pixels instead of at the jitter.
    """
    return 2.0 * jitter_x / frame.full_width, -2.0 * jitter_y / frame.full_height


@dataclass(frozen=True)
class CameraState:
    """A camera at one frame, without jitter."""

    kind: str  # perspective | orthographic
    view: np.ndarray  # 4 x 4, float64
    projection: np.ndarray  # 4 x 4, float64, of the exported window
    near: float
    far: float

    def as_manifest(self) -> dict:
        """The ``camera`` member of shot.json."""
        return {
            "kind": self.kind,
            "view": [float(value) for value in self.view.ravel()],
            "projection": [float(value) for value in self.projection.ravel()],
            "near": self.near,
            "far": self.far,
        }


def camera_state(
    camera: bpy.types.Object, frame: Frame, depsgraph: bpy.types.Depsgraph
) -> CameraState:
    """Matrices of ``camera`` at the scene's current frame."""
    data = camera.evaluated_get(depsgraph).data
    if data.type not in ("PERSP", "ORTHO"):
        raise SceneError(
            f"camera '{camera.name}' is of type {data.type}: a shot holds perspective and orthographic cameras only"
        )
    projection = np.array(
        camera.calc_matrix_camera(
            depsgraph,
            x=frame.full_width,
            y=frame.full_height,
            scale_x=frame.aspect_x,
            scale_y=frame.aspect_y,
        ),
        dtype=np.float64,
    )
    if frame.is_cropped:
        scale_x, scale_y = frame.full_width / frame.width, frame.full_height / frame.height
        offset_x = (frame.full_width - 2 * frame.left) / frame.width - 1.0
        offset_y = 1.0 - (frame.full_height - 2 * frame.top) / frame.height
        window = np.array(
            [[scale_x, 0, 0, offset_x], [0, scale_y, 0, offset_y], [0, 0, 1, 0], [0, 0, 0, 1.0]]
        )
        projection = window @ projection
    placement = np.array(camera.evaluated_get(depsgraph).matrix_world, dtype=np.float64)
    placement[:3, :3] /= np.linalg.norm(
        placement[:3, :3], axis=0
    )  # Cycles drops the scale of a camera, too
    kind = "perspective" if data.type == "PERSP" else "orthographic"
    return CameraState(
        kind, np.linalg.inv(placement), projection, float(data.clip_start), float(data.clip_end)
    )


def same_camera(a: CameraState, b: CameraState) -> bool:
    """True when both project every point to the same place, bit for bit."""
    return (
        a.kind == b.kind
        and np.array_equal(a.view, b.view)
        and np.array_equal(a.projection, b.projection)
    )


# What a camera's projection depends on. Read off the evaluated camera at every frame, whatever animates it.
_LENS = (
    "sensor_fit", "sensor_width", "sensor_height", "lens", "ortho_scale", "shift_x", "shift_y", "clip_start",
    "clip_end",
)  # fmt: skip


class JitterCamera:
    """A camera in the place of another one that looks through a displaced window; the user's camera is not touched.

    A perspective one rides: it is a child with identity placement, so it follows every animation and constraint and
    Cycles finds its true motion. Its lens rests: ``aim`` sets it to the current frame's. Else jitter would be
    overwritten where the shift is animated, and Cycles' motion vectors would depend on the version: 3.4 leaves every
    change of the projection out of them, 4.3 and 5.2 leave out that of shift and orthographic scale but count that of
    lens and sensor in. With a lens at rest they all leave out all of it, and passes/motion.py adds it.

    An orthographic one rests altogether, where ``aim`` puts it: 4.3 takes the past of an orthographic camera that
    moves for that of a perspective one. With a camera at rest all versions know the movement of objects, and
    passes/motion.py adds the camera's."""

    def __init__(
        self,
        scene: bpy.types.Scene,
        camera: bpy.types.Object,
        name: str,
        rides: bool | None = None,
    ) -> None:
        self.source = camera
        data = camera.data.copy()
        data.animation_data_clear()
        data.dof.use_dof = False  # where the user's is animated it may be on
        self.object = bpy.data.objects.new(name, data)
        self._rides = data.type != "ORTHO" if rides is None else rides
        if self._rides:
            self.object.parent = camera
        else:
            # Below an empty, because an object's own placement cannot hold the shear of a parent.
            self.object.parent = bpy.data.objects.new(f"{name} Place", None)
            scene.collection.objects.link(self.object.parent)
        scene.collection.objects.link(self.object)

    def aim(
        self,
        frame: Frame,
        depsgraph: bpy.types.Depsgraph,
        jitter_x: float,
        jitter_y: float,
        premultiplied: tuple[float, float] = (0.0, 0.0),
        aside: float = 0.0,
    ) -> None:
        """Displaces the samples by a jitter (pixels, y down) from the source camera at the current frame.

        ``premultiplied`` is a further jitter in pixels that moves the camera, as ``premultiplied_movement`` says. An
        orthographic camera may stand ``aside``, scene units to its right, and see the same.
        """
        placed = self.source.evaluated_get(depsgraph)
        data = self.object.data
        for name in _LENS:
            setattr(data, name, getattr(placed.data, name))
        shift_x, shift_y = jitter_to_shift(frame, data, jitter_x, jitter_y)
        data.shift_x += shift_x - (aside / data.ortho_scale if aside else 0.0)
        data.shift_y += shift_y
        if not self._rides:
            self.object.matrix_parent_inverse = placed.matrix_world
        # Scene units: the scale of a camera, or of what it hangs on, scales the place of its child.
        axes = [column.length for column in placed.matrix_world.to_3x3().col]
        right, up = premultiplied_movement(frame, *premultiplied)
        self.object.location = ((right + aside) / axes[0], up / axes[1], 0.0)


def sample_positions(
    frame: Frame, jitter_x: float, jitter_y: float
) -> tuple[np.ndarray, np.ndarray]:
    """x (1 x W) and y (H x 1) of the samples in the un-jittered picture, pixels."""
    x = np.arange(frame.width, dtype=np.float64)[None, :] + 0.5 + jitter_x
    y = np.arange(frame.height, dtype=np.float64)[:, None] + 0.5 + jitter_y
    return x, y


def unproject(
    x: np.ndarray, y: np.ndarray, depth: np.ndarray, frame: Frame, camera: CameraState
) -> np.ndarray:
    """View-space points (H x W x 3, metres) of planar depths seen at un-jittered pixel positions."""
    p = camera.projection
    ndc_x, ndc_y = 2.0 * x / frame.width - 1.0, 1.0 - 2.0 * y / frame.height
    points = np.empty((*depth.shape, 3), np.float64)
    if camera.kind == "perspective":
        points[..., 0] = (ndc_x + p[0, 2]) / p[0, 0] * depth
        points[..., 1] = (ndc_y + p[1, 2]) / p[1, 1] * depth
    else:
        points[..., 0] = (ndc_x - p[0, 3]) / p[0, 0] * np.ones_like(depth)
        points[..., 1] = (ndc_y - p[1, 3]) / p[1, 1] * np.ones_like(depth)
    points[..., 2] = -depth
    return points
