# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene asks for that a shot cannot hold: refused, or switched off (in memory) with a sentence that says so."""

from __future__ import annotations

import bpy

from .. import compat
from ..errors import SceneError
from .ownership import is_animated, own


def refuse_unsuitable(
    scene: bpy.types.Scene, layer_name: str | None
) -> tuple[bpy.types.ViewLayer, list[str]]:
    """The view layer to render and one sentence for everything that will be switched off.

    Raises SceneError for what cannot be exported."""
    notes = []
    if not compat.is_cycles_available():
        raise SceneError("Cycles is not enabled: switch on the add-on 'Cycles Render Engine'")
    render = scene.render
    if render.use_multiview:
        raise SceneError(
            "the scene renders stereo views: switch Stereoscopy off, a shot holds one camera"
        )
    used = [layer for layer in scene.view_layers if layer.use]
    if layer_name is not None:
        chosen = scene.view_layers.get(layer_name)
        if chosen is None:
            known = ", ".join(layer.name for layer in scene.view_layers)
            raise SceneError(
                f"--view-layer: the scene has no layer '{layer_name}' (found: {known})"
            )
    elif len(used) > 1:
        names = ", ".join(layer.name for layer in used)
        raise SceneError(
            f"the scene renders {len(used)} view layers ({names}): choose one with --view-layer NAME"
        )
    else:
        chosen = used[0] if used else scene.view_layers[0]
    if render.engine != "CYCLES":
        notes.append(f"rendered with Cycles; the scene is set to {render.engine}")
    if render.use_motion_blur:
        notes.append("motion blur is switched off: a shot holds sharp frames and their motion")
    if compat.compositor_in_use(scene):
        notes.append("the compositor is switched off: a shot holds the picture before it")
    if render.use_sequencer and compat.strips(scene):
        notes.append("the sequencer is switched off: a shot shows the 3D scene")
    if scene.cycles.use_denoising:
        notes.append("the denoiser is switched off")
    if render.use_freestyle:
        notes.append("Freestyle lines are switched off: they are drawn after rendering")
    if render.use_border:
        notes.append("the shot shows the render border only")
    for item in bpy.data.objects:
        if item.type == "CAMERA" and (
            item.data.dof.use_dof or is_animated(item.data.dof, "use_dof")
        ):
            own(item.data.dof, use_dof=False)
            notes.append(
                f"depth of field of camera '{item.name}' is switched off: a shot is sharp everywhere"
            )
        if item.type == "VOLUME" and not item.hide_render:
            notes.append(
                f"volume '{item.name}' has no surface: its depth, normal and motion are those behind it"
            )
    if len(bpy.data.objects) > 32767:
        raise SceneError(
            f"{len(bpy.data.objects)} objects: Cycles tells at most 32767 apart; join some"
        )
    return chosen, notes


def show_what_renders(scene: bpy.types.Scene) -> None:
    """Makes the evaluated scene that Python sees agree with what the renderer sees (in memory only)."""
    for item in bpy.data.objects:
        if item.library is None:
            item.hide_viewport = False
            for modifier in item.modifiers:
                modifier.show_viewport = modifier.show_render
            if item.name in bpy.context.view_layer.objects:
                item.hide_set(False)
    for collection in bpy.data.collections:
        if collection.library is None and not collection.hide_render:
            collection.hide_viewport = False
    for particles in bpy.data.particles:
        if particles.library is None:
            particles.display_percentage = 100
