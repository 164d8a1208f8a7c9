# SPDX-License-Identifier: MIT
"""Materials of the procedural scenes: matt, lit by one sun, with ambient light as emission for the camera alone."""

from __future__ import annotations

import bpy

RGB = tuple[float, float, float]

AMBIENT_UP: RGB = (0.27, 0.31, 0.38)  # light from the sky, for normals that point up
AMBIENT_DOWN: RGB = (0.15, 0.13, 0.11)  # light from the ground, for normals that point down


def _ambient_by_normal(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """Mix of ground and sky light by the height of the geometric normal."""
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    ramp = tree.nodes.new("ShaderNodeMapRange")
    ramp.inputs["From Min"].default_value = -1.0
    mix = tree.nodes.new("ShaderNodeMixRGB")
    mix.inputs["Color1"].default_value = (*AMBIENT_DOWN, 1.0)
    mix.inputs["Color2"].default_value = (*AMBIENT_UP, 1.0)
    tree.links.new(geometry.outputs["Normal"], separate.inputs[0])
    tree.links.new(separate.outputs["Z"], ramp.inputs["Value"])
    tree.links.new(ramp.outputs["Result"], mix.inputs["Fac"])
    return mix.outputs["Color"]


def matt(
    tree: bpy.types.NodeTree,
    albedo: RGB | bpy.types.NodeSocket,
    ambient_scale: float = 1.0,
    lit: bool = True,
) -> bpy.types.NodeSocket:
    """Adds a matt surface to a material's nodes: diffuse under the sun plus albedo * ambient for the camera.

    ``ambient_scale`` darkens surfaces that see little of the sky; ``lit=False`` leaves the sun out.
    """

    def colour(target: bpy.types.NodeSocket) -> None:
        if isinstance(albedo, bpy.types.NodeSocket):
            tree.links.new(albedo, target)
        else:
            target.default_value = (*albedo, 1.0)

    tint = tree.nodes.new("ShaderNodeMixRGB")
    tint.label = "Albedo"  # by which ``paint`` finds it
    tint.blend_type = "MULTIPLY"
    tint.inputs["Fac"].default_value = 1.0
    colour(tint.inputs["Color1"])
    tree.links.new(_ambient_by_normal(tree), tint.inputs["Color2"])
    camera_ray = tree.nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"]
    strength = tree.nodes.new("ShaderNodeMath")
    strength.operation = "MULTIPLY"
    strength.inputs[1].default_value = ambient_scale
    tree.links.new(camera_ray, strength.inputs[0])
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(tint.outputs["Color"], emission.inputs["Color"])
    tree.links.new(strength.outputs[0], emission.inputs["Strength"])
    if not lit:
        return emission.outputs[0]
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    colour(diffuse.inputs["Color"])
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(diffuse.outputs[0], add.inputs[0])
    tree.links.new(emission.outputs[0], add.inputs[1])
    return add.outputs[0]


def no_light_source(surface: bpy.types.Material) -> None:
    """Its emission lights nothing: picked as a light it would be sampled at random."""
    if hasattr(surface.cycles, "emission_sampling"):  # since 3.5
        surface.cycles.emission_sampling = "NONE"
    else:
        surface.cycles.sample_as_light = False


def material(
    name: str, albedo: RGB, ambient_scale: float = 1.0, lit: bool = True
) -> bpy.types.Material:
    """Solid matt colour; see ``matt``."""
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    result.diffuse_color = (*albedo, 1.0)
    no_light_source(result)
    tree = result.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(matt(tree, albedo, ambient_scale, lit), output.inputs["Surface"])
    return result


def cut_out_by(
    tree: bpy.types.NodeTree, shader: bpy.types.NodeSocket, alpha: bpy.types.NodeSocket
) -> bpy.types.NodeSocket:
    """The shader where ``alpha`` is above one half, nothing elsewhere."""
    threshold = tree.nodes.new("ShaderNodeMath")
    threshold.operation = "GREATER_THAN"
    threshold.inputs[1].default_value = 0.5
    clear = tree.nodes.new("ShaderNodeBsdfTransparent")
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(alpha, threshold.inputs[0])
    tree.links.new(threshold.outputs[0], mix.inputs["Fac"])
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(shader, mix.inputs[2])
    return mix.outputs[0]


def cut_out(surface: bpy.types.Material, image: bpy.types.Image) -> None:
    """Lets a material exist only where the image's alpha is above one half (uv map of the mesh)."""
    tree = surface.node_tree
    output = tree.get_output_node("ALL")
    shader = output.inputs["Surface"].links[0].from_socket
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    cut = cut_out_by(tree, shader, texture.outputs["Alpha"])
    tree.links.new(cut, output.inputs["Surface"])


def paint(surface: bpy.types.Material, colour: bpy.types.NodeSocket) -> None:
    """Lets a socket give the albedo, under the sun and in the ambient light alike."""
    tree = surface.node_tree
    for node in tree.nodes:
        if node.label == "Albedo":
            tree.links.new(colour, node.inputs["Color1"])
        elif node.bl_idname == "ShaderNodeBsdfDiffuse":
            tree.links.new(colour, node.inputs["Color"])


def textured(surface: bpy.types.Material, image: bpy.types.Image) -> None:
    """Lets an image give the albedo (uv map of the mesh)."""
    texture = surface.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    paint(surface, texture.outputs["Color"])


def make_checkered(surface: bpy.types.Material, other: RGB, scale: float) -> None:
    """Turns a solid material into checks of its own and another colour, in the object's own space."""
    tree = surface.node_tree
    diffuse = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfDiffuse")
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = scale
    checker.inputs["Color1"].default_value = diffuse.inputs["Color"].default_value
    checker.inputs["Color2"].default_value = (*other, 1.0)
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Object"], checker.inputs["Vector"])
    paint(surface, checker.outputs["Color"])
