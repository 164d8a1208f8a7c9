# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene seen from several points of every pixel, by one multi-view render.

K cameras, one call of Cycles: bit-identical to K renders at a fraction of their cost, because the scene is
transferred once."""

from __future__ import annotations

import itertools

import bpy

from . import camera as cam
from . import rendering
from .ownership import own

_PREFIX = "AA Resolve View"


class ViewSet:
    """K jittered cameras on one source camera, rendered as K views."""

    def __init__(
        self, scene: bpy.types.Scene, source: bpy.types.Object, positions: list[tuple[float, float]]
    ) -> None:
        self.scene = scene
        self.positions = positions
        self.names = tuple(f"s{index:02d}" for index in range(len(positions)))
        start = _free_start()
        self.cameras = [cam.JitterCamera(scene, source, f"{start}.{name}") for name in self.names]

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
        own(render, use_multiview=True)
        render.views_format = "MULTIVIEW"
        render.image_settings.views_format = "MULTIVIEW"
        for view in render.views:
            view.use = False
        for name in self.names:
            render.views.new(name).camera_suffix = f".{name}"
        try:
            self.scene.camera = self.cameras[0].object
            return rendering.render(self.scene, view_layer, folder, self.names)
        finally:
            self.scene.camera = previous
            for name in self.names:  # looked up again: a render lies between
                render.views.remove(render.views[name])
            for view in render.views:
                view.use = True
            own(render, use_multiview=False)
            render.image_settings.views_format = "INDIVIDUAL"


def _free_start() -> str:
    """With what the names of a set's cameras begin. By their ends Blender finds the camera of a view: it must not have
    to make them unique or shorter, as it would with the name of the source in them."""
    taken = {item.name for item in bpy.data.objects}
    starts = (f"{_PREFIX} {number}" for number in itertools.count(1))
    return next(one for one in starts if not any(name.startswith(f"{one}.") for name in taken))
