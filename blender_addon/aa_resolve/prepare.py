# SPDX-License-Identifier: GPL-3.0-or-later
"""What an export renders, decided before its first picture: the scene is checked, brought to the light model, and
every pass that it cannot need is left out."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from . import analysis
from . import camera as cam
from . import instances, jitter, lighting, rendering, subsamples
from .errors import SceneError
from .report import Reporter
from .settings import Settings


@dataclass
class Plan:
    """The decisions; ``passes_of`` holds the shot's passes of jittered frames and of those at the pixel centres."""

    scene: bpy.types.Scene
    settings: Settings
    view_layer: bpy.types.ViewLayer
    frame: cam.Frame
    cuts: cam.CameraCuts
    passes_of: dict[str, set[str]]
    static: bool
    cutout: str | None  # material through which rays pass or that displaces its surface
    positions: list[tuple[float, float]]
    light: lighting.LightPlan
    ids: instances.ObjectIds
    folder: str

    @property
    def passes(self) -> set[str]:
        """Passes of either kind of frame."""
        return self.passes_of["frames"] | self.passes_of["centre"]

    @property
    def has_subsamples(self) -> bool:
        """True when the shot holds sub-samples."""
        return bool(self.passes & {"subsamples", "subsampleColor"})

    def cycles_passes(self, passes: set[str]) -> set[str]:
        """Passes of Cycles that colour and these passes of the shot are made from."""
        needed = set(self.light.passes)
        if passes & {"depth", "motion", "albedo", "subsamples", "edges"} or not self.static:
            needed.add("Depth")
        if passes & {"normal", "subsamples"}:
            needed.add("Normal")
        if passes & {"object", "subsamples", "edges", "segments"}:
            needed.add("IndexOB")
        if "motion" in passes:
            needed |= {"Vector", "IndexOB"}
        if "albedo" in passes:
            needed |= rendering.ALBEDO_PASSES
        return needed - self.light.empty_passes


def make_plan(scene: bpy.types.Scene, settings: Settings, reporter: Reporter) -> Plan:
    """Checks the scene, brings it (in memory) to the light model and says what is left out, and why."""
    view_layer, notes = analysis.refuse_unsuitable(scene, settings.view_layer)
    if settings.resolution:
        scene.render.resolution_x, scene.render.resolution_y = settings.resolution
        scene.render.resolution_percentage = 100
    frame = cam.frame_of(scene)
    cuts = cam.CameraCuts(scene)
    cuts.at(settings.frames[0])
    if settings.jitter_projection == "pre":
        for number in settings.frames:
            if cuts.at(number).data.type != "PERSP":
                raise SceneError(
                    f"--jitter-projection pre: camera '{cuts.at(number).name}' is not a perspective one, "
                    "and the error that it reproduces is one of perspective"
                )
    analysis.show_what_renders(scene)
    passes_of = {"frames": set(settings.passes), "centre": set(settings.centre_passes)}
    motion = analysis.find_motion(scene, settings.frames, frame, cuts)
    left_out = []
    if motion.static:
        if any("motion" in passes for passes in passes_of.values()):
            left_out.append(
                f"motion ({motion.reason}: the shot is static, one truth serves all frames)"
            )
        for passes in passes_of.values():
            passes.discard("motion")
    cutout = analysis.has_cutouts()
    wanted = passes_of["frames"] | passes_of["centre"]
    if wanted & {"subsamples", "subsampleColor"}:
        if subsamples.uses_override("subsampleColor" in wanted, cutout):
            left_out.append(
                "shading of sub-samples (override material: no cut-outs, no displacement)"
            )
        elif "subsampleColor" not in wanted:
            notes.append(
                f"sub-samples use the real materials: '{cutout}' has cut-outs or displacement"
            )
    if wanted & {"edges", "segments"}:
        notes += analysis.notes_on_edges()
    notes += analysis.semi_transparent_note()
    scene.frame_set(settings.frames[0])
    rendering.prepare(scene, view_layer)
    folder = lighting.temporary_folder()
    light = lighting.set_up(scene, settings.lighting, settings.ambient, folder)
    lighting.check_visibility_animation(light)
    left_out += light.left_out("albedo" in wanted)
    ids = instances.ObjectIds(scene, view_layer, settings.instance_ids)
    if settings.instance_ids and not ids.tells_instances and "object" in wanted:
        left_out.append("ids of instances (nothing is instanced)")
    if left_out:
        notes.append("left out: " + "; ".join(left_out))
    for note in notes + light.notes + ids.notes:
        reporter.say("note", f"note: {note}", note=note)
    positions = jitter.pattern_positions(settings.pattern)
    plan = Plan(
        scene,
        settings,
        view_layer,
        frame,
        cuts,
        passes_of,
        motion.static,
        cutout,
        positions,
        light,
        ids,
        folder,
    )
    known = sorted(plan.passes)
    reporter.say("plan", f"passes: {', '.join(known)}", passes=known, static=plan.static)
    return plan
