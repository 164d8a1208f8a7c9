# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry (and colour) at several points of every pixel, by one multi-view render.

K cameras, one call of Cycles: bit-identical to K renders at a fraction of their cost, because the scene is
transferred once. Where colour is not asked for, lights are off, and an override material without emission replaces
all shading unless the scene has cut-outs or displacement, which an override would lose.
"""

from __future__ import annotations

import bpy
import numpy as np

from . import camera as cam
from . import lighting, rendering

_PREFIX = "AA Resolve View"


class ViewSet:
    """K jittered cameras on one source camera, rendered as K views."""

    def __init__(
        self, scene: bpy.types.Scene, source: bpy.types.Object, positions: list[tuple[float, float]]
    ) -> None:
        self.scene = scene
        self.positions = positions
        self.names = tuple(f"s{index:02d}" for index in range(len(positions)))
        self.cameras = []
        for name in self.names:
            camera = cam.JitterCamera(scene, source, f"{_PREFIX} {source.name}.{name}")
            # The name must end with the suffix of its view, also where Blender had to make it unique.
            camera.object.name = f"{_PREFIX} {source.name[:20]}.{name}"
            self.cameras.append(camera)

    def aim(
        self,
        frame: cam.Frame,
        depsgraph: bpy.types.Depsgraph,
        jitter: tuple[float, float],
        premultiplied: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Places all sub-samples of the current frame: each at its position beside the jitter (JitterCamera.aim)."""
        for camera, (x, y) in zip(self.cameras, self.positions):
            camera.aim(frame, depsgraph, jitter[0] + x, jitter[1] + y, premultiplied)

    def render(self, view_layer: bpy.types.ViewLayer, folder: str) -> rendering.Layers:
        """Renders all views with the current passes, lights and materials."""
        render = self.scene.render
        previous = self.scene.camera
        render.use_multiview = True
        render.views_format = "MULTIVIEW"
        render.image_settings.views_format = "MULTIVIEW"
        for view in render.views:
            view.use = False
        added = []
        for name in self.names:
            view = render.views.new(name)
            view.camera_suffix = f".{name}"
            added.append(view)
        try:
            self.scene.camera = self.cameras[0].object
            return rendering.render(self.scene, view_layer, folder, self.names)
        finally:
            self.scene.camera = previous
            for view in added:
                render.views.remove(view)
            for view in render.views:
                view.use = True
            render.use_multiview = False
            render.image_settings.views_format = "INDIVIDUAL"


def override_material() -> bpy.types.Material:
    """A surface that neither reflects nor emits: only its geometry is of interest."""
    name = "AA Resolve Geometry"
    material = bpy.data.materials.get(name)
    if material is None:
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        emission = tree.nodes.new("ShaderNodeEmission")
        emission.inputs["Strength"].default_value = 0.0
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def geometry_dissimilarity(
    point_a: np.ndarray,
    normal_a: np.ndarray,
    point_b: np.ndarray,
    normal_b: np.ndarray,
    depth: np.ndarray,
) -> np.ndarray:
    """SADP, the sum of absolute dot products (Reshetov 2012): 0 within a plane, sqrt 2 across a right angle, 2 for
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


_SADP_FLOOR = 0.2  # methods/05-geometry.md 5.5: below it everything counts as one surface
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


def uses_override(wants_color: bool, cutout: str | None) -> bool:
    """True when the override material serves: only geometry is wanted and nothing would be lost."""
    return not wants_color and cutout is None


def no_lights(plan: lighting.LightPlan, scene: bpy.types.Scene) -> lighting.only_light:
    """Context in which no light shines, so that shading costs nothing."""
    every = lighting.LightPlan(plan.model, lighting.lights_of(scene))
    return lighting.only_light(every, None)
