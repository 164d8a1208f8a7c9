# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene asks for that a shot cannot hold: refused, or switched off (in memory) with a sentence that says so."""

from __future__ import annotations

import bpy

from .. import compat
from ..errors import SceneError
from .ownership import is_animated, may_render, own

GREASE_PENCIL = ("GPENCIL", "GREASEPENCIL")  # the latter since 4.3
_LONGEST_LAYER_NAME = 24  # bytes; ".Denoising Albedo.s15.R" follows it
_WITHOUT_SURFACE = {
    "VOLUME": "volume {} has no surface: its depth, normal and motion are those behind it",
    "POINTCLOUD": "points of {} have no edges: they are no triangles",
}


def layer_of(scene: bpy.types.Scene, name: str | None) -> bpy.types.ViewLayer:
    """The view layer of that name; without one the only layer in use. Raises SceneError where there is none."""
    if name is not None:
        chosen = scene.view_layers.get(name)
        if chosen is None:
            known = ", ".join(layer.name for layer in scene.view_layers)
            raise SceneError(f"--view-layer: the scene has no layer '{name}' (found: {known})")
        return chosen
    used = [layer for layer in scene.view_layers if layer.use]
    if len(used) > 1:
        names = ", ".join(layer.name for layer in used)
        raise SceneError(
            f"the scene renders {len(used)} view layers ({names}): choose one with --view-layer"
        )
    return used[0] if used else scene.view_layers[0]


def refuse_unsuitable(
    scene: bpy.types.Scene, layer_name: str | None
) -> tuple[bpy.types.ViewLayer, list[str]]:
    """The view layer to render and one sentence for everything that will be switched off.

    Raises SceneError for what cannot be exported."""
    notes = []
    if not compat.is_cycles_available():
        raise SceneError("Cycles is not enabled: switch on the add-on 'Cycles Render Engine'")
    space = compat.render_in_rec709()
    if space:
        notes.append(
            f"rendered in linear BT.709, which a shot holds; the file computes in {space}, where saturated light and "
            "colours multiply to others"
        )
    render = scene.render
    if render.use_multiview:
        raise SceneError(
            "the scene renders stereo views: switch Stereoscopy off, a shot holds one camera"
        )
    chosen = layer_of(scene, layer_name)
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
    if len(bpy.data.objects) > 32767:
        raise SceneError(
            f"{len(bpy.data.objects)} objects: Cycles tells at most 32767 apart; join some"
        )
    return chosen, notes


def switch_off(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> list[str]:
    """Switches off, in memory, what a shot cannot hold; sentences about that, and about what it holds differently.

    The export owns the name of the view layer: a file's channels have 63 bytes for it and all else.
    """
    if len(view_layer.name.encode()) > _LONGEST_LAYER_NAME:
        view_layer.name = "AA Resolve"
    told = []
    objects = sorted(bpy.data.objects, key=lambda item: item.name_full)
    for item in objects:
        if item.type == "CAMERA":
            if item.data.dof.use_dof or is_animated(item.data.dof, "use_dof"):
                own(item.data.dof, use_dof=False)
                told.append(
                    f"depth of field of camera '{item.name}' is switched off: a shot is sharp everywhere"
                )
    rendered = [item for item in objects if may_render(item)]
    sketches = [item for item in rendered if item.type in GREASE_PENCIL]
    for item in sketches:
        own(item, hide_render=True)
    if sketches:
        told.append(
            f"Grease Pencil {_some(sketches)} is left out: it is drawn over the finished picture, without depth and id"
        )
    catchers = [
        item
        for item in objects
        if item.type != "LIGHT"  # there it means whether catchers see the light
        and (item.is_shadow_catcher or is_animated(item, "is_shadow_catcher"))
    ]
    for item in catchers:
        own(item, is_shadow_catcher=False)
    if catchers:
        told.append(
            f"{_some(catchers)} catches shadows only in the scene; in the shot it is an ordinary surface"
        )
    holdouts = [item for item in rendered if item.is_holdout or is_animated(item, "is_holdout")]
    if holdouts or _any_layer(view_layer.layer_collection, "holdout"):
        told.append(
            f"holdouts ({_some(holdouts) if holdouts else 'a collection'}) are holes of the picture: black, and with the "
            "depth, id and motion of the background"
        )
    for kind, what in _WITHOUT_SURFACE.items():
        found = [item for item in rendered if item.type == kind]
        if found:
            told.append(f"{what.format(_some(found))}")
    foggy = sorted(
        material.name
        for material in bpy.data.materials
        if material.users and _has_volume(compat.shader_tree(material))
    )
    if foggy:
        told.append(
            f"the volume of material {', '.join(foggy[:4])} has no surface: its depth, normal and motion are those of "
            "the mesh around it, or behind it"
        )
    world = compat.world_of(scene, view_layer)
    if world and _has_volume(compat.shader_tree(world)):
        told.append(
            "the world's volume has no surface: depth, normal and motion are those behind it"
        )
    return told


def _has_volume(tree: bpy.types.NodeTree | None) -> bool:
    return tree is not None and any(
        node.bl_idname in ("ShaderNodeOutputMaterial", "ShaderNodeOutputWorld")
        and node.inputs["Volume"].is_linked
        for node in tree.nodes
    )


def _any_layer(layer: bpy.types.LayerCollection, name: str) -> bool:
    """True when a collection of the layer that is not excluded has the switch on."""
    if layer.exclude:
        return False
    return getattr(layer, name) or any(_any_layer(child, name) for child in layer.children)


def _some(items: list[bpy.types.Object]) -> str:
    """Up to four names, and how many further ones there are."""
    shown = ", ".join(f"'{item.name}'" for item in items[:4])
    return shown + (f" and {len(items) - 4} more" if len(items) > 4 else "")
