# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes ``subsamples`` and ``subsampleColor``: geometry, mask and colour at the positions of the shot's pattern.

Sub-sample k lies at the pixel centre + the frame's jitter + position k, as a GPU jitters all samples of a pixel
together; in frames at the pixel centres the jitter is 0. Both passes come from the same views and share one part.
Where colour is not asked for, lights are off, and an override material without emission replaces all shading unless
the scene has cut-outs, displacement or bump, which an override would lose.
"""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterable

import bpy
import numpy as np

from ..plan import Plan
from ..scene import lighting, rendering
from ..scene.views import ViewSet
from .base import Pass
from .exposure import Exposure
from .geometry import ids_of
from .surface_mask import surface_mask


class Subsamples(Pass):
    """Depth, normal and id of every sub-sample, and the mask of those on the surface of the frame's own sample."""

    name = "subsamples"
    cycles = frozenset({"Depth", "Normal", "IndexOB"})

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        plan, main = exposure.plan, exposure.main
        centre = {"depth": exposure.depth, "normal": main.get("Normal"), "id": ids_of(exposure)}
        with exposure.watch.of(self.facts.part):
            views, renders = _views(exposure), _renders(exposure)
            samples = [
                {
                    "depth": renders[0].get("Depth", view)[:, :, 0],
                    "normal": renders[0].get("Normal", view),
                    "id": plan.ids.resolve(renders[0], view),
                }
                for view in views.names
            ]
            camera, offset = exposure.now.camera, exposure.offset
            mask = surface_mask(centre, samples, plan.frame, camera, offset, plan.positions)
            planes = dict(zip(self.facts.shared, (mask,)))
            for view, sample in zip(views.names, samples):
                values = (sample["depth"], *np.moveaxis(sample["normal"], -1, 0), sample["id"])
                planes.update(zip(self.facts.channels_of(view), values))
        return planes


class SubsampleColor(Pass):
    """Lit colour of every sub-sample."""

    name = "subsampleColor"
    shaded = True
    in_color_type = True

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        planes = {}
        with exposure.watch.of(self.facts.part):
            renders = _renders(exposure)
            for view in _views(exposure).names:
                color = lighting.compose(exposure.plan.light, renders, view)
                values = np.moveaxis(color[:, :, :3], -1, 0)
                planes.update(zip(self.facts.channels_of(view), values))
        return planes


def are_shaded(passes: Iterable[Pass]) -> bool:
    """True when one of the passes needs light at the sub-samples; else their geometry alone is rendered."""
    return any(item.shaded and item.facts.per_sub_sample for item in passes)


def _views(exposure: Exposure) -> ViewSet:
    return exposure.stage.views(exposure.number, exposure.plan.positions)


def _renders(exposure: Exposure) -> list[rendering.Layers]:
    """All sub-samples of the frame, rendered when a pass first asks."""
    if exposure.samples is None:
        wanted = [item for item in exposure.wanted if item.facts.per_sub_sample]
        views = _views(exposure)
        bpy.context.view_layer.update()
        shift, movement = exposure.plan.settings.shift_and_movement(exposure.offset)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        views.aim(exposure.plan.frame, depsgraph, shift, movement)
        geometry = set().union(*(item.cycles for item in wanted))
        render = render_shaded if are_shaded(wanted) else render_geometry
        exposure.samples = render(exposure.plan, views, geometry)
    return exposure.samples


def render_geometry(
    plan: Plan, views: ViewSet, geometry: Collection[str]
) -> list[rendering.Layers]:
    """One render of the views with these passes of Cycles, without light."""
    rendering.request_passes(plan.view_layer, geometry)
    own_override = plan.view_layer.material_override
    with lighting.no_light(plan.light, plan.scene):
        if plan.own_geometry is None:
            plan.view_layer.material_override = plan.ids.override()
        try:
            return [views.render(plan.view_layer, plan.folder)]
        finally:
            plan.view_layer.material_override = own_override


def render_shaded(plan: Plan, views: ViewSet, geometry: Collection[str]) -> list[rendering.Layers]:
    """One render of the views, or one per light; the first holds the passes of ``geometry`` as well."""
    renders = []
    lights = plan.light.lights if len(plan.light.lights) > 1 else [None]
    for index, light in enumerate(lights):
        wanted = plan.light.passes if index == 0 else plan.light.further_passes
        rendering.request_passes(plan.view_layer, wanted.union(geometry if index == 0 else ()))
        one = lighting.only_light(plan.light, light) if light else contextlib.nullcontext()
        with one:
            renders.append(views.render(plan.view_layer, plan.folder))
    return renders
