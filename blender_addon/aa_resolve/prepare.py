# SPDX-License-Identifier: GPL-3.0-or-later
"""From the open scene to a plan: the scene is checked, brought (in memory) to the light model, and every pass that it
cannot need is left out, with a note that says why."""

from __future__ import annotations

import bpy

from . import jitter, registry
from .errors import SceneError, UsageError
from .passes.geometry import ObjectId
from .passes.subsamples import are_shaded
from .passes.table import passes_named
from .plan import Plan
from .progress import Progress
from .scene import camera as cam
from .scene import (
    instances,
    lighting,
    linked,
    movement,
    ownership,
    render_levels,
    rendering,
    scripts,
    simulations,
    suitability,
    surfaces,
    textures,
)
from .scene.cuts import CameraCuts
from .scene.ownership import own
from .settings import Settings


def make_plan(scene: bpy.types.Scene, settings: Settings, progress: Progress) -> Plan:
    """Checks the scene, brings it to the light model and says what is left out, and why.

    Raises SceneError for what a shot cannot hold."""
    ownership.begin()
    scene = linked.local(scene)
    view_layer, notes = suitability.refuse_unsuitable(scene, settings.view_layer)
    notes += linked.notes_on_missing() + scripts.notes_on_blocked()
    notes += suitability.switch_off(scene, view_layer)
    rendering.prepare(scene, view_layer)
    rendering.own_samples(scene)
    if settings.resolution:
        width, height = settings.resolution
        own(scene.render, resolution_x=width, resolution_y=height, resolution_percentage=100)
    frame = cam.frame_of(scene)
    cuts = CameraCuts(scene)
    cuts.at(settings.first_frame)
    if settings.jitter_projection == "pre":
        _refuse_other_than_perspective(cuts, settings.frames)
    notes += render_levels.show_what_renders(scene, view_layer)
    cuts.bring_in(scene, view_layer)
    notes += cuts.readers.notes()
    notes += simulations.run(scene, settings.frames)
    motion = _motion_of(scene, settings, frame, cuts)
    passes_of = {"frames": set(settings.passes), "centre": set(settings.centre_passes)}
    left_out = _drop_what_rests(passes_of, motion) if motion.static else []
    wanted = passes_of["frames"] | passes_of["centre"]
    passes = passes_named(wanted)
    own_geometry = surfaces.lost_under_override()
    if registry.reads_subsamples(wanted) and not are_shaded(passes):
        if own_geometry is None:
            left_out.append(
                "shading of sub-samples (override material: no cut-outs, displacement or bump)"
            )
        else:
            notes.append(
                f"sub-samples use the real materials: '{own_geometry}' has cut-outs, displacement or bump"
            )
    if any(item.from_meshes for item in passes):
        notes += surfaces.notes_on_edges()
    notes += surfaces.semi_transparent_note()
    scene.frame_set(settings.first_frame)
    folder = rendering.temporary_folder()
    light = lighting.set_up(
        scene, view_layer, settings.lighting, settings.ambient, folder, settings.frames
    )
    lighting.check_visibility_animation(light)
    left_out += light.left_out(frozenset().union(*(item.cycles for item in passes)))
    ids = instances.ObjectIds(scene, view_layer, settings.instance_ids)
    if settings.instance_ids and not ids.tells_instances and ObjectId.name in wanted:
        left_out.append("ids of instances (nothing is instanced)")
    reading = textures.TextureReading(
        settings.texture_filter, settings.mip_bias, settings.unjitter_textures
    )
    notes += reading.notes + ownership.notes() + scripts.hold_against_handlers()
    if left_out:
        notes.append("left out: " + "; ".join(left_out))
    for note in notes + light.notes + ids.notes:
        progress.say("note", f"note: {note}", note=note)
    positions = jitter.pattern_positions(settings.pattern)
    plan = Plan(
        scene,
        settings,
        view_layer,
        frame,
        cuts,
        passes_of,
        motion.static,
        own_geometry,
        positions,
        light,
        ids,
        reading,
        folder,
    )
    known = sorted(plan.passes)
    progress.say("plan", f"passes: {', '.join(known)}", passes=known, static=plan.static)
    return plan


def _motion_of(
    scene: bpy.types.Scene, settings: Settings, frame: cam.Frame, cuts: CameraCuts
) -> movement.Motion:
    """Whether something moves in a new shot, or in one that is added to: one that moves stays one that does, and one at
    rest becomes one where the frames that it has rest indeed."""
    if settings.moves:
        return movement.Motion(False, "the shot was begun as one that moves")
    motion = movement.find_motion(scene, settings.frames, frame, cuts)
    had = settings.rested
    if motion.static or len(had) < 2 or movement.find_motion(scene, had, frame, cuts).static:
        return motion
    raise UsageError(
        f"--out: the frames of '{settings.out}' show one and the same, and something moves in them ({motion.reason}); "
        "choose a new folder, or replace it with --overwrite"
    )


def _refuse_other_than_perspective(cuts: CameraCuts, frames: list[int]) -> None:
    for number in frames:
        if cuts.at(number).data.type != "PERSP":
            raise SceneError(
                f"--jitter-projection pre: camera '{cuts.at(number).name}' is not a perspective one, "
                "and the error that it reproduces is one of perspective"
            )


def _drop_what_rests(passes_of: dict[str, set[str]], motion: movement.Motion) -> list[str]:
    """Takes the passes out that say nothing of a shot at rest; returns what was left out."""
    left_out = []
    for item in passes_named(passes_of["frames"] | passes_of["centre"]):
        if item.from_frame_before:
            left_out.append(
                f"{item.name} ({motion.reason}: the shot is static, one truth serves all frames)"
            )
            for passes in passes_of.values():
                passes.discard(item.name)
    return left_out
