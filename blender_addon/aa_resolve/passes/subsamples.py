# SPDX-License-Identifier: GPL-3.0-or-later
"""Part ``subsamples`` of a frame: geometry, mask and colour at the positions of the shot's pattern.

Sub-sample k lies at the pixel centre + the frame's jitter + position k, as a GPU jitters all samples of a pixel
together; in frames at the pixel centres the jitter is 0."""

from __future__ import annotations

import contextlib

import bpy
import numpy as np

from . import camera as cam
from . import exr, lighting, rendering, subsamples
from .plan import Plan


def render(
    plan: Plan, views: subsamples.ViewSet, passes: set[str], offset: tuple[float, float]
) -> list[rendering.Layers]:
    """All sub-samples of the current frame: one render, or one per light where they are shaded."""
    bpy.context.view_layer.update()
    shift, movement = plan.settings.shift_and_movement(offset)
    views.aim(plan.frame, bpy.context.evaluated_depsgraph_get(), shift, movement)
    wants_color = "subsampleColor" in passes
    geometry = {"Depth", "Normal", "IndexOB"} if "subsamples" in passes else set()
    if not wants_color:
        rendering.request_passes(plan.view_layer, geometry)
        own_override = plan.view_layer.material_override
        with subsamples.no_lights(plan.light, plan.scene):
            if subsamples.uses_override(wants_color, plan.cutout):
                plan.view_layer.material_override = plan.ids.override()
            try:
                return [views.render(plan.view_layer, plan.folder)]
            finally:
                plan.view_layer.material_override = own_override
    renders = []
    lights = plan.light.lights if len(plan.light.lights) > 1 else [None]
    for index, light in enumerate(lights):
        wanted = plan.light.passes if index == 0 else plan.light.further_passes
        rendering.request_passes(plan.view_layer, wanted | (geometry if index == 0 else set()))
        one = lighting.only_light(plan.light, light) if light else contextlib.nullcontext()
        with one:
            renders.append(views.render(plan.view_layer, plan.folder))
    return renders


def make(
    plan: Plan,
    views: subsamples.ViewSet,
    renders: list[rendering.Layers],
    passes: set[str],
    centre: dict[str, np.ndarray],
    camera: cam.CameraState,
    offset: tuple[float, float],
) -> exr.Part:
    """The part from what ``render`` gave; ``centre`` holds depth, normal and id of the frame's own samples."""
    names: list[str] = []
    kinds: list[str] = []
    planes: list[np.ndarray] = []
    samples: list[dict[str, np.ndarray]] = []
    if "subsamples" in passes:
        samples = [
            {
                "depth": renders[0].get("Depth", view)[:, :, 0],
                "normal": renders[0].get("Normal", view),
                "id": plan.ids.resolve(renders[0], view),
            }
            for view in views.names
        ]
        names.append("mask")
        kinds.append("uint")
        planes.append(
            subsamples.surface_mask(centre, samples, plan.frame, camera, offset, plan.positions)
        )
    for index, view in enumerate(views.names):
        if samples:
            sample = samples[index]
            names += [f"{view}.Z", f"{view}.N.X", f"{view}.N.Y", f"{view}.N.Z", f"{view}.id"]
            kinds += ["float", "float", "float", "float", "uint"]
            planes += [sample["depth"], *np.moveaxis(sample["normal"], -1, 0), sample["id"]]
        if "subsampleColor" in passes:
            color = lighting.compose(plan.light, renders, view)
            names += [f"{view}.R", f"{view}.G", f"{view}.B"]
            kinds += [plan.settings.color_type] * 3
            planes += list(np.moveaxis(color[:, :, :3], -1, 0))
    return exr.Part("subsamples", tuple(names), tuple(kinds), planes, plan.settings.compression)
