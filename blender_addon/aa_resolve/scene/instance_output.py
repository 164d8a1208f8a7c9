# SPDX-License-Identifier: GPL-3.0-or-later
"""The output (AOV) of every material that tells instances apart: Object Info > Random, weighted by the opacity.

Outputs add up along a ray that passes cut-outs; without the weight a leaf's hole would add the leaf's number to that
of what shows through."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

import bpy

from .. import compat

CHANNEL = "AA Instance"


def override_material() -> bpy.types.Material:
    """A surface that neither reflects nor emits: only its geometry is of interest. A shader that never emits would not
    do: beside an AOV, Cycles takes it for no surface at all."""
    name = "AA Resolve Geometry"
    material = bpy.data.materials.get(name)
    if material is None:
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(_black(tree).socket, output.inputs["Surface"])
    return material


def give_every_mesh_a_material() -> None:
    """Cycles' default surface has no nodes to put an output in; this is what it looks like."""
    plain: bpy.types.Material | None = None
    for mesh in list(bpy.data.meshes) + list(bpy.data.curves) + list(bpy.data.metaballs):
        if not any(mesh.materials):
            if plain is None:
                plain = bpy.data.materials.new("AA Resolve Plain")
                plain.diffuse_color = (0.8, 0.8, 0.8, 1.0)
            if len(mesh.materials):
                mesh.materials[0] = plain
            else:
                mesh.materials.append(plain)


def add_output(material: bpy.types.Material) -> bool:
    """Adds the AOV; False when the material's opacity could not be followed."""
    if material.is_grease_pencil:
        return True
    if not material.use_nodes or material.node_tree is None:
        color = tuple(material.diffuse_color)
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = color
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    tree = material.node_tree
    if any(node.bl_idname == "ShaderNodeOutputAOV" and node.name == CHANNEL for node in tree.nodes):
        return True
    output = tree.get_output_node("CYCLES")
    if output is None:  # nothing for Cycles, but perhaps for Eevee: a black surface
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        output.target = "CYCLES"
    opacity: Value = 1.0
    if output.inputs["Surface"].is_linked:
        followed = _opacity_of_input(tree, output.inputs["Surface"])
        if followed is None:
            return False
        opacity = followed
    if not _is_volume_alone(output):
        _keep_surface(tree, output)
    information = tree.nodes.new("ShaderNodeObjectInfo")
    random = Output(information, list(information.outputs.keys()).index("Random"))
    product = random if opacity == 1.0 else _math(tree, "MULTIPLY", random, opacity)
    aov = tree.nodes.new("ShaderNodeOutputAOV")
    aov.name = aov.label = CHANNEL
    compat.name_aov_output(aov, CHANNEL)
    tree.links.new(product.socket, aov.inputs["Value"])
    return True


def _is_volume_alone(output: bpy.types.Node) -> bool:
    return output.inputs["Volume"].is_linked and not output.inputs["Surface"].is_linked


def _keep_surface(tree: bpy.types.NodeTree, output: bpy.types.Node) -> None:
    """Adds a black surface to one that Cycles may find to be nothing, such as an emission of strength 0. That is as
    solid as any other until it has an AOV; with one, rays pass through it."""
    surface = output.inputs["Surface"]
    if not _may_be_nothing(surface):
        return
    black = _black(tree)
    if surface.is_linked and not surface.links[0].is_muted:
        shown = Output.of(surface.links[0].from_socket)
        both = Output(tree.nodes.new("ShaderNodeAddShader"), 0)
        tree.links.new(shown.socket, both.node.inputs[0])
        tree.links.new(black.socket, both.node.inputs[1])
        black = both
    tree.links.new(black.socket, output.inputs["Surface"])


def _may_be_nothing(socket: bpy.types.NodeSocket) -> bool:
    """True unless a shader's input surely gets a shader that Cycles does not optimize away."""
    if not socket.is_linked:
        return True
    node = socket.links[0].from_node
    if node.mute or socket.links[0].is_muted:
        return True
    if node.bl_idname in ("ShaderNodeEmission", "ShaderNodeGroup", "ShaderNodeBackground"):
        return True
    if node.bl_idname in ("NodeReroute", "ShaderNodeMixShader", "ShaderNodeAddShader"):
        shaders = [item for item in node.inputs if item.type == "SHADER"]
        return any(map(_may_be_nothing, shaders))
    return False


def _black(tree: bpy.types.NodeTree) -> Output:
    node = tree.nodes.new("ShaderNodeBsdfDiffuse")
    node.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    return Output(node, 0)


@dataclass(frozen=True)
class Output:
    """An output of a node. Sockets are looked up when they are used: every change of a tree may make them anew, and
    Blender ends at the touch of one that is gone."""

    node: bpy.types.Node
    index: int

    @classmethod
    def of(cls, socket: bpy.types.NodeSocket) -> Output:
        """By a socket that was just looked up."""
        return cls(socket.node, list(socket.node.outputs).index(socket))

    @property
    def socket(self) -> bpy.types.NodeSocket:
        """The socket as it is now."""
        return self.node.outputs[self.index]


Value = Union[float, Output]


def _math(tree: bpy.types.NodeTree, operation: str, *values: Value) -> Output:
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = operation
    for index, value in enumerate(values):
        if isinstance(value, Output):
            tree.links.new(value.socket, node.inputs[index])
        else:
            node.inputs[index].default_value = value
    return Output(node, 0)


def _input(socket: bpy.types.NodeSocket) -> Value:
    """What a number's input gets."""
    if socket.is_linked:
        return Output.of(socket.links[0].from_socket)
    return float(socket.default_value)


def _opacity_of_input(
    tree: bpy.types.NodeTree, socket: bpy.types.NodeSocket | None
) -> Value | None:
    """Opacity of the shader that an input gets; nothing is black."""
    if socket is None or not socket.is_linked or socket.links[0].is_muted:
        return 1.0
    return _opacity(tree, socket.links[0].from_socket)


def _opacity(tree: bpy.types.NodeTree, socket: bpy.types.NodeSocket) -> Value | None:
    """Opacity of a shader; None where a node group hides it."""
    node = socket.node
    if node.mute:  # it hands on one of its inputs
        passed = (link.from_socket for link in node.internal_links if link.to_socket == socket)
        return _opacity_of_input(tree, next(passed, None))
    if node.bl_idname in (
        "ShaderNodeBsdfTransparent",
        "ShaderNodeHoldout",
        "ShaderNodeBsdfRayPortal",  # since 4.2
    ):
        return 0.0
    if node.bl_idname == "ShaderNodeBsdfPrincipled":
        return _input(node.inputs["Alpha"])
    if node.bl_idname == "NodeReroute":
        return _opacity_of_input(tree, node.inputs[0])
    if node.bl_idname == "ShaderNodeGroup":
        return None
    if node.bl_idname in ("ShaderNodeMixShader", "ShaderNodeAddShader"):
        shaders = [index for index, item in enumerate(node.inputs) if item.type == "SHADER"]
        parts = [_opacity_of_input(tree, node.inputs[index]) for index in shaders]
        if None in parts:
            return None
        if parts[0] == parts[1] == 1.0:
            return 1.0
        if node.bl_idname == "ShaderNodeAddShader":
            # What lets through in either lets through.
            both = _math(tree, "SUBTRACT", _math(tree, "ADD", *parts), 1.0)
            return _math(tree, "MAXIMUM", both, 0.0)
        weight = _input(node.inputs[0])
        first = _math(tree, "MULTIPLY", parts[0], _math(tree, "SUBTRACT", 1.0, weight))
        return _math(tree, "MULTIPLY_ADD", parts[1], weight, first)
    return 1.0
