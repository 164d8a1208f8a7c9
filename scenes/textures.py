# SPDX-License-Identifier: MIT
"""Textures made in code for the larger scenes: they colour a material of ``common.material``.

All are read at the mesh's uv map, which ``masonry.Parts`` lays out in metres, so that a brick is as large on every
wall. Sizes are metres, colours linear BT.709.
"""

from __future__ import annotations

import bpy
import common as c

Socket = bpy.types.NodeSocket
UNPAINTED: c.RGB = (0.5, 0.5, 0.5)  # albedo until the texture is painted on


def _uv(tree: bpy.types.NodeTree) -> Socket:
    return tree.nodes.new("ShaderNodeUVMap").outputs["UV"]


def _mix(tree: bpy.types.NodeTree, blend: str, share, first, second) -> Socket:
    """Mix node; each input is a socket, a number (the share) or a colour."""
    node = tree.nodes.new("ShaderNodeMixRGB")
    node.blend_type = blend
    for name, value in (("Fac", share), ("Color1", first), ("Color2", second)):
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, node.inputs[name])
        else:
            node.inputs[name].default_value = value if name == "Fac" else (*value, 1.0)
    return node.outputs["Color"]


def _noise(tree: bpy.types.NodeTree, size: float, detail: float, vector: Socket | None) -> Socket:
    """Soft grains of about ``size``, spread to the whole range from 0 to 1."""
    node = tree.nodes.new("ShaderNodeTexNoise")
    node.inputs["Scale"].default_value = 1.0 / size
    node.inputs["Detail"].default_value = detail
    tree.links.new(vector or _uv(tree), node.inputs["Vector"])
    spread = tree.nodes.new("ShaderNodeMapRange")
    spread.inputs["From Min"].default_value = 0.3
    spread.inputs["From Max"].default_value = 0.7
    tree.links.new(node.outputs[0], spread.inputs["Value"])
    return spread.outputs["Result"]


def mottled(
    name: str, light: c.RGB, dark: c.RGB, size: float, ambient: float = 1.0
) -> bpy.types.Material:
    """Plaster, weathered stone, earth: two colours mixed by soft noise."""
    surface = c.material(name, UNPAINTED, ambient)
    tree = surface.node_tree
    c.paint(surface, _mix(tree, "MIX", _noise(tree, size, 3.0, None), dark, light))
    return surface


def bricks(
    name: str,
    first: c.RGB,
    second: c.RGB,
    mortar: c.RGB,
    size: tuple[float, float],
    joint: float,
    shift: float = 0.5,
    ambient: float = 1.0,
) -> bpy.types.Material:
    """Courses of bricks, ashlar or slabs of ``size``; ``shift`` 0 lays joint under joint."""
    surface = c.material(name, UNPAINTED, ambient)
    tree = surface.node_tree
    node = tree.nodes.new("ShaderNodeTexBrick")
    node.offset = shift
    for key, value in (
        ("Color1", (*first, 1.0)),
        ("Color2", (*second, 1.0)),
        ("Mortar", (*mortar, 1.0)),
        ("Scale", 1.0),
        ("Mortar Size", joint),
        ("Mortar Smooth", 0.0),
        ("Brick Width", size[0]),
        ("Row Height", size[1]),
    ):
        node.inputs[key].default_value = value
    tree.links.new(_uv(tree), node.inputs["Vector"])
    shade = _mix(tree, "MIX", _noise(tree, 0.9, 2.0, None), (0.78, 0.78, 0.78), (1.08, 1.08, 1.08))
    c.paint(surface, _mix(tree, "MULTIPLY", 1.0, node.outputs["Color"], shade))
    return surface


def tiles(
    name: str, light: c.RGB, dark: c.RGB, joint: c.RGB, size: float, ambient: float = 1.0
) -> bpy.types.Material:
    """Floor of square tiles like a chess board with thin joints."""
    surface = c.material(name, UNPAINTED, ambient)
    tree = surface.node_tree
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = 1.0 / size
    checker.inputs["Color1"].default_value = (*light, 1.0)
    checker.inputs["Color2"].default_value = (*dark, 1.0)
    lift = tree.nodes.new("ShaderNodeVectorMath")  # half a cell up, away from the cell's border
    lift.inputs[1].default_value = (0.0, 0.0, 0.5 * size)
    tree.links.new(_uv(tree), lift.inputs[0])
    tree.links.new(lift.outputs[0], checker.inputs["Vector"])
    grid = tree.nodes.new("ShaderNodeTexBrick")
    grid.offset = 0.0
    for key, value in (
        ("Color1", (1.0, 1.0, 1.0, 1.0)),
        ("Color2", (0.84, 0.84, 0.84, 1.0)),
        ("Mortar", (0.0, 0.0, 0.0, 1.0)),
        ("Scale", 1.0),
        ("Mortar Size", 0.012),
        ("Mortar Smooth", 0.0),
        ("Brick Width", size),
        ("Row Height", size),
    ):
        grid.inputs[key].default_value = value
    tree.links.new(_uv(tree), grid.inputs["Vector"])
    stone = _mix(tree, "MULTIPLY", 1.0, checker.outputs["Color"], grid.outputs["Color"])
    veins = _mix(tree, "MIX", _noise(tree, 0.5, 3.0, None), (0.75,) * 3, (1.1,) * 3)
    stone = _mix(tree, "MULTIPLY", 1.0, stone, veins)
    c.paint(surface, _mix(tree, "MIX", grid.outputs["Fac"], stone, joint))
    return surface


def stripes(
    name: str, cloth: c.RGB, trim: c.RGB, period: float, share: float, ambient: float = 1.0
) -> bpy.types.Material:
    """Woven cloth: bands of ``trim`` across, each ``share`` of a period high (uv's v)."""
    surface = c.material(name, UNPAINTED, ambient)
    tree = surface.node_tree
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(_uv(tree), separate.inputs[0])
    previous = separate.outputs["Y"]
    for operation, operand in (("DIVIDE", period), ("FRACT", 0.0), ("LESS_THAN", share)):
        node = tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        node.inputs[1].default_value = operand
        tree.links.new(previous, node.inputs[0])
        previous = node.outputs[0]
    c.paint(surface, _mix(tree, "MIX", previous, cloth, trim))
    return surface


def add_cloudy_sky(
    scene: bpy.types.Scene, horizon: c.RGB, zenith: c.RGB, cloud: c.RGB, seed: float = 0.0
) -> None:
    """The gradient of ``common.add_sky`` with clouds in it, on a flat ceiling seen in perspective."""
    c.add_sky(scene, horizon, zenith)
    tree = scene.world.node_tree
    background = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBackground")
    clear = background.inputs["Color"].links[0].from_socket
    separate = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeSeparateXYZ")
    direction = separate.inputs[0].links[0].from_socket
    height = tree.nodes.new("ShaderNodeMath")
    height.operation = "MAXIMUM"
    height.inputs[1].default_value = 0.0
    tree.links.new(separate.outputs["Z"], height.inputs[0])
    lifted = tree.nodes.new("ShaderNodeMath")
    lifted.operation = "ADD"
    lifted.inputs[1].default_value = 0.22
    tree.links.new(height.outputs[0], lifted.inputs[0])
    ceiling = tree.nodes.new("ShaderNodeVectorMath")
    ceiling.operation = "DIVIDE"
    tree.links.new(direction, ceiling.inputs[0])
    tree.links.new(lifted.outputs[0], ceiling.inputs[1])
    shift = tree.nodes.new("ShaderNodeVectorMath")
    shift.inputs[1].default_value = (seed, 0.37 * seed, 0.0)
    tree.links.new(ceiling.outputs[0], shift.inputs[0])
    noise = tree.nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value = 1.3
    noise.inputs["Detail"].default_value = 5.0
    tree.links.new(shift.outputs[0], noise.inputs["Vector"])
    cover = tree.nodes.new("ShaderNodeMapRange")
    cover.inputs["From Min"].default_value = 0.47
    cover.inputs["From Max"].default_value = 0.66
    tree.links.new(noise.outputs[0], cover.inputs["Value"])
    tree.links.new(
        _mix(tree, "MIX", cover.outputs["Result"], clear, cloud), background.inputs["Color"]
    )
