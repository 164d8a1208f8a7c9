# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that are not what their meshes say: cut-outs, displacement, half transparency, hair."""

from __future__ import annotations

import bpy

from .. import compat
from .ownership import is_animated, may_render
from .shader_nodes import nodes_within


def lost_under_override() -> str | None:
    """Name of a material through which a camera ray can pass, or that moves or bends the surface it is on; else None.

    All that is lost under an override material. Of whatever is used: nodes, view layers and instances give materials
    to what has no slot for them, and what is hidden now may be seen later."""
    for material in bpy.data.materials:
        if material.users > int(material.use_fake_user) and compat.shader_tree(material):
            if _makes_geometry(material.node_tree):
                return material.name
    return None


_SEE_THROUGH = (
    "ShaderNodeBsdfTransparent",
    "ShaderNodeHoldout",
    "ShaderNodeBsdfRayPortal",  # since 4.2
    "ShaderNodeScript",  # may do anything
)


def _makes_geometry(tree: bpy.types.NodeTree) -> bool:
    """True where the nodes may decide depth, normal or id of what is seen."""
    for node in nodes_within(tree):
        if node.bl_idname in _SEE_THROUGH or _bends_normals(node):
            return True
        if node.bl_idname == "ShaderNodeBsdfPrincipled":
            alpha = node.inputs["Alpha"]
            if alpha.is_linked or alpha.default_value < 1.0 or is_animated(alpha, "default_value"):
                return True
        if node.bl_idname == "ShaderNodeOutputMaterial":
            if node.inputs["Displacement"].is_linked:
                return True
            if node.inputs["Volume"].is_linked and not node.inputs["Surface"].is_linked:
                return True
    return False


def _bends_normals(node: bpy.types.Node) -> bool:
    """True for a shader that gets a normal from nodes, such as Bump: the frame's normals show it."""
    return any(socket.type == "SHADER" for socket in node.outputs) and any(
        socket.is_linked and socket.name.endswith("Normal") for socket in node.inputs
    )


def notes_on_edges() -> list[str]:
    """Sentences about surfaces whose edges are not those of a mesh."""
    notes = []
    hairy = [
        item.name
        for item in bpy.data.objects
        if may_render(item)
        and (
            item.type == "CURVES"
            or any(
                system.settings.type == "HAIR" and system.settings.render_type == "PATH"
                for system in item.particle_systems
            )
        )
    ]
    if hairy:
        notes.append(f"strands of {', '.join(hairy)} have no edges: they are no triangles")
    displaced = [
        material.name
        for material in bpy.data.materials
        if material.users
        and compat.shader_tree(material)
        and compat.displacement_method(material) != "BUMP"
        and any(
            node.bl_idname == "ShaderNodeOutputMaterial" and node.inputs["Displacement"].is_linked
            for node in material.node_tree.nodes
        )
    ]
    if displaced:
        notes.append(
            f"edges of {', '.join(displaced)} are those before displacement, which only the renderer knows"
        )
    return notes


def semi_transparent_note() -> list[str]:
    """Sentences about materials whose alpha is neither 0 nor 1: one sample picks a layer at random."""
    notes = []
    for material in bpy.data.materials:
        if not (compat.shader_tree(material) and material.users):
            continue
        for node in material.node_tree.nodes:
            if node.bl_idname == "ShaderNodeBsdfPrincipled":
                alpha = node.inputs["Alpha"]
                if not alpha.is_linked and 0.0 < alpha.default_value < 1.0:
                    notes.append(
                        f"material '{material.name}' is half transparent (alpha {alpha.default_value:.2g}): noisy at "
                        "few samples; its geometry counts as solid from alpha 0.5"
                    )
    return notes
