# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the open scene stands: its frame, the camera that looks, and what is known of the frames around."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import bpy

from .camera import Frame, JitterCamera
from .cuts import CameraCuts
from .movement import FrameState, frame_state
from .views import ViewSet


class Stage:
    """Moves one scene through the frames of a shot.

    ``resting`` is the one frame that stands for all of a static shot, None where something moves. ``details``: states
    hold what is needed to find wrong motion."""

    def __init__(
        self,
        scene: bpy.types.Scene,
        frame: Frame,
        cuts: CameraCuts,
        resting: int | None,
        details: bool,
    ) -> None:
        self.scene, self.frame, self.cuts = scene, frame, cuts
        self._resting, self._details = resting, details
        self._cameras: dict[str, JitterCamera] = {}
        self._second_cameras: dict[str, JitterCamera] = {}
        self._view_sets: dict[str, ViewSet] = {}
        self._states: dict[int, FrameState] = {}

    def state(self, number: int) -> FrameState:
        """State of a frame; evaluates it unless it is known."""
        number = number if self._resting is None else self._resting
        if number not in self._states:
            state = frame_state(self.scene, number, self.frame, self.cuts, self._details)
            self._states = {key: value for key, value in self._states.items() if key > number - 3}
            self._states[number] = state
        return self._states[number]

    def instances_change(self, number: int) -> bool:
        """True when an instance of the frame is missing in the one before or after."""
        now = self.state(number).instances
        return bool(now) and not (
            now <= self.state(number - 1).instances and now <= self.state(number + 1).instances
        )

    def go_to(self, number: int) -> None:
        """Brings the scene to a frame unless it stands there."""
        shown = number if self._resting is None else self._resting
        if self.scene.frame_current != shown or self.scene.frame_subframe != 0.0:
            self.scene.frame_set(shown)

    def aim(
        self,
        number: int,
        shift: tuple[float, float] = (0.0, 0.0),
        movement: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Gives the scene the frame's jittered camera; both in pixels, y down, as JitterCamera.aim takes them."""
        source = self.cuts.turn_to(number)
        if source.name_full not in self._cameras:
            self._cameras[source.name_full] = JitterCamera(self.scene, source, "AA Resolve Camera")
        camera = self._cameras[source.name_full]
        self.scene.camera = camera.object
        bpy.context.view_layer.update()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        camera.aim(self.frame, depsgraph, *shift, premultiplied=movement)

    @contextlib.contextmanager
    def second_sight(
        self, number: int, shift: tuple[float, float], aside: float, scale: float
    ) -> Iterator[None]:
        """Within this context an orthographic frame is seen by a camera that rides, from ``aside`` of the jittered
        one; its lens, which says nothing of its picture, shows a scene unit at depth ``scale`` as large as it does.
        """
        source = self.cuts.at(number)
        name = source.name_full
        if name not in self._second_cameras:
            self._second_cameras[name] = JitterCamera(
                self.scene, source, "AA Resolve Second Sight", rides=True
            )
        camera, previous = self._second_cameras[name], self.scene.camera
        self.scene.camera = camera.object
        bpy.context.view_layer.update()
        camera.aim(self.frame, bpy.context.evaluated_depsgraph_get(), *shift, aside=aside)
        data = camera.object.data
        data.sensor_width = data.sensor_height = 100.0
        data.lens = data.sensor_width * scale / data.ortho_scale
        try:
            yield
        finally:
            self.scene.camera = previous

    def views(self, number: int, positions: list[tuple[float, float]]) -> ViewSet:
        """The sub-sample cameras of a frame's camera."""
        source = self.cuts.at(number)
        if source.name_full not in self._view_sets:
            self._view_sets[source.name_full] = ViewSet(self.scene, source, positions)
        return self._view_sets[source.name_full]
