# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame while its passes are made: the main render, and what several passes read."""

from __future__ import annotations

import contextlib
import time
from typing import Sequence

import numpy as np

from ..plan import Plan
from ..scene import lighting, rendering
from ..scene.stage import Stage


class Stopwatch:
    """Seconds by pass."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextlib.contextmanager
    def of(self, name: str):
        """Adds the time of the context to a pass."""
        started = time.perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - started


class Exposure:
    """Evaluates a frame, aims the jittered camera and renders all that the wanted passes read of it.

    ``offset`` is the jitter, pixels, y down; ``wanted`` are passes in the order in which they are made. Colour decides
    whether lights shine: passes that are added to a finished picture come from a render without them. The first pass
    that needs ids, motion or sub-samples makes them and keeps them here for the others."""

    def __init__(
        self, plan: Plan, stage: Stage, number: int, offset: tuple[float, float], wanted: Sequence
    ) -> None:
        self.plan, self.stage, self.number = plan, stage, number
        self.offset, self.wanted = offset, wanted
        self.watch = Stopwatch()
        self.notes: dict[
            str, object
        ] = {}  # members that passes add to the frame's entry in shot.json
        self.ids: np.ndarray | None = None  # H x W uint32
        self.vectors: np.ndarray | None = None  # H x W x 2: motion as Cycles knows it
        self.samples: list[
            rendering.Layers
        ] | None = None  # sub-samples, one render or one per light
        self.before = None if plan.static else stage.state(number - 1)
        self.now = stage.state(number)
        compares = any(item.from_frame_before for item in wanted)
        self.instances_change = compares and stage.instances_change(number)
        stage.go_to(number)
        stage.aim(number, *plan.settings.shift_and_movement(offset))
        plan.textures.aim(self.now.camera, plan.frame, offset)
        rendering.sample_points(plan.scene, plan.settings.samples)
        self.lit = any(item.shaded and not item.facts.per_sub_sample for item in wanted)
        self.color: np.ndarray | None = None  # H x W x 4, linear; None in a render without light
        with self.watch.of(wanted[0].facts.part):
            if self.lit:
                self.renders = render_lights(plan, self._cycles_passes())
                self.color = lighting.compose(plan.light, self.renders)
            else:
                self.renders = [render_unlit(plan, self._cycles_passes())]

    def _cycles_passes(self) -> set[str]:
        """Passes of Cycles that colour and the wanted passes are made from."""
        needed = set().union(*(item.reads(self) for item in self.wanted))
        if self.lit:
            needed |= self.plan.light.passes
            if not self.plan.static:
                needed.add("Depth")  # a jump of the camera is found by what the picture shows
        return needed - self.plan.light.empty_passes

    @property
    def main(self) -> rendering.Layers:
        """The render that holds everything but the light of further lamps."""
        return self.renders[0]

    @property
    def depth(self) -> np.ndarray | None:
        """Planar depth (H x W); None where nothing reads it."""
        return self.main.get("Depth")[:, :, 0] if self.main.has("Depth") else None

    @property
    def nonfinite_pixels(self) -> int:
        """Pixels whose colour, if there is one, is NaN or infinite."""
        if self.color is None:
            return 0
        return int((~np.isfinite(self.color)).any(axis=-1).sum())


def render_lights(plan: Plan, first_passes: set[str]) -> list[rendering.Layers]:
    """The current frame as the light model wants it: one render, or one per light."""
    rendering.request_passes(plan.view_layer, first_passes)
    if len(plan.light.lights) < 2:
        return [rendering.render(plan.scene, plan.view_layer, plan.folder)]
    renders = []
    for index, light in enumerate(plan.light.lights):
        if index == 1:
            rendering.request_passes(plan.view_layer, plan.light.further_passes)
        with lighting.only_light(plan.light, light):
            renders.append(rendering.render(plan.scene, plan.view_layer, plan.folder))
    return renders


def render_unlit(plan: Plan, passes: set[str]) -> rendering.Layers:
    """The current frame without any light: what its surfaces are, not how they look."""
    rendering.request_passes(plan.view_layer, passes)
    with lighting.no_light(plan.light, plan.scene):
        return rendering.render(plan.scene, plan.view_layer, plan.folder)
