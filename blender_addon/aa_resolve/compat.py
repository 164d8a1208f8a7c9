# SPDX-License-Identifier: GPL-3.0-or-later
"""The only file that knows Blender versions: pass names and the properties that were renamed or moved."""

from __future__ import annotations

import math

import bpy

VERSION: tuple[int, int, int] = bpy.app.version

# Pass name in the shot exporter -> names in multilayer EXRs of Blender 3.x/4.x and of 5.x.
PASS_NAMES: dict[str, tuple[str, ...]] = {
    "Combined": ("Combined",),
    "Depth": ("Depth",),
    "Normal": ("Normal",),
    "Vector": ("Vector",),
    "Position": ("Position",),
    "IndexOB": ("IndexOB", "Object Index"),
    "DiffCol": ("DiffCol", "Diffuse Color"),
    "GlossCol": ("GlossCol", "Glossy Color"),
    "TransCol": ("TransCol", "Transmission Color"),
    "Emit": ("Emit", "Emission"),
    "Env": ("Env", "Environment"),
    "Denoising Albedo": ("Denoising Albedo",),
    "Denoising Normal": ("Denoising Normal",),
}


def set_if_present(owner, name: str, value) -> bool:
    """Sets a property that only some versions have; True when it exists."""
    if hasattr(owner, name):
        setattr(owner, name, value)
        return True
    return False


def set_no_light_sampling(material: bpy.types.Material) -> None:
    """Emission of this material is no longer picked as a light."""
    cycles = material.cycles
    if not set_if_present(cycles, "emission_sampling", "NONE"):  # since 3.5
        set_if_present(cycles, "sample_as_light", False)


def emission_color(node: bpy.types.Node) -> bpy.types.NodeSocket | None:
    """The socket of a Principled BSDF that colours its emission."""
    return node.inputs.get("Emission") or node.inputs.get("Emission Color")  # the latter since 4.0


def panorama_settings(camera: bpy.types.Camera):
    """Owner of ``panorama_type``: Cycles' own settings before 4.4, the camera since."""
    return camera if hasattr(camera, "panorama_type") else camera.cycles


def name_aov_output(node: bpy.types.Node, name: str) -> None:
    """Connects an AOV Output node to the AOV of that name."""
    if not set_if_present(
        node, "aov_name", name
    ):  # since 4.2 the label and the output's name are apart
        node.name = name


def strips(scene: bpy.types.Scene) -> list:
    """Strips of the sequencer."""
    editor = scene.sequence_editor
    if editor is None:
        return []
    return list(getattr(editor, "strips_all", None) or getattr(editor, "sequences_all", []))


def set_multilayer_exr(settings) -> None:
    """Image settings for one multilayer EXR with every pass and view in the same part."""
    set_if_present(
        settings, "media_type", "MULTI_LAYER_IMAGE"
    )  # since 5.0 it decides which formats there are
    settings.file_format = "OPEN_EXR_MULTILAYER"
    set_if_present(settings, "use_exr_interleave", True)  # else, since 5.0, a part for every pass


def displacement_method(material: bpy.types.Material) -> str:
    """``BUMP`` where displacement only bends normals: Cycles' own setting before 4.1, the material's since."""
    owner = material if hasattr(material, "displacement_method") else material.cycles
    return owner.displacement_method


def set_compositing(scene: bpy.types.Scene, enabled: bool) -> None:
    """Compositor and sequencer on or off for renders."""
    scene.render.use_compositing = enabled
    scene.render.use_sequencer = enabled


def compositor_in_use(scene: bpy.types.Scene) -> bool:
    """True when renders of this scene pass through compositor nodes."""
    if hasattr(scene, "compositing_node_group"):  # since 5.0
        return scene.render.use_compositing and scene.compositing_node_group is not None
    return scene.render.use_compositing and scene.use_nodes and scene.node_tree is not None


def action_curves(animation_data) -> list:
    """The F-curves of the current action, whatever way this version stores them."""
    action = animation_data.action if animation_data else None
    if action is None:
        return []
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    curves = []
    for layer in action.layers:  # since 5.0
        for strip in layer.strips:
            bag = strip.channelbag(animation_data.action_slot)
            if bag:
                curves += list(bag.fcurves)
    return curves


def remove_curve(animation_data, curve) -> None:
    """Takes one F-curve out of the current action."""
    action = animation_data.action
    if hasattr(action, "fcurves"):
        action.fcurves.remove(curve)
        return
    for layer in action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(animation_data.action_slot)
            if bag and curve in list(bag.fcurves):
                bag.fcurves.remove(curve)
                return


def shading_limits(mesh: bpy.types.Mesh) -> tuple[bool, float]:
    """Whether edges marked sharp break smooth shading, and the angle between faces (radians) beyond which all do."""
    if hasattr(mesh, "use_auto_smooth"):  # before 4.1
        return mesh.use_auto_smooth, mesh.auto_smooth_angle if mesh.use_auto_smooth else math.pi
    return True, math.pi  # there a modifier turns the angle into marks


def is_cycles_available() -> bool:
    """True when the Cycles add-on is enabled."""
    return hasattr(bpy.types.Scene, "cycles")


def draw_progress(layout: bpy.types.UILayout, fraction: float) -> None:
    """A progress bar, or its percentage where layouts have none (before 4.0)."""
    if hasattr(layout, "progress"):
        layout.progress(factor=fraction, text=f"{100 * fraction:.0f} %")
    else:
        filled = int(round(20 * fraction))
        layout.label(text=f"[{'#' * filled}{'.' * (20 - filled)}] {100 * fraction:.0f} %")
