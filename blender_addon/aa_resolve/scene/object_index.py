# SPDX-License-Identifier: GPL-3.0-or-later
"""Object Index (``pass_index``), by which renders tell objects apart: the scene's own, for the nodes and drivers that
read it, when the export sets another."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from .. import compat
from .scripts import drivers
from .shader_nodes import feed_instead

_OWN = "AA Resolve Own Index"  # custom property of objects
_INDEX, _NODE_OUTPUT = "pass_index", "Object Index"


def keep_own() -> None:
    """Lets nodes and drivers read the objects' present indices, whatever is set after this."""
    trees = {tree for tree in _shader_trees() if any(map(_reads_index, tree.nodes))}
    targets = [
        target
        for _, curve in drivers()
        for variable in curve.driver.variables
        for target in variable.targets
        if target.data_path == _INDEX and isinstance(target.id, bpy.types.Object)
    ]
    if not trees and not targets:
        return
    for item in bpy.data.objects:
        item[_OWN] = item.pass_index
        item.update_tag()  # a driver that meets an object without the property is given up
    for target in targets:
        target.data_path = f'["{_OWN}"]'
    for tree in trees:
        for node in filter(_reads_index, list(tree.nodes)):
            _read_own(tree, node)


def _shader_trees() -> Iterator[bpy.types.NodeTree]:
    for owner in (*bpy.data.materials, *bpy.data.lights):  # lights are objects to nodes since 5.0
        tree = compat.shader_tree(owner)
        if tree:
            yield tree
    yield from (tree for tree in bpy.data.node_groups if tree.bl_idname == "ShaderNodeTree")


def _reads_index(node: bpy.types.Node) -> bool:
    if node.bl_idname == "ShaderNodeAttribute":
        return node.attribute_type != "GEOMETRY" and node.attribute_name == _INDEX
    return node.bl_idname == "ShaderNodeObjectInfo" and node.outputs[_NODE_OUTPUT].is_linked


def _read_own(tree: bpy.types.NodeTree, node: bpy.types.Node) -> None:
    if node.bl_idname == "ShaderNodeAttribute":
        node.attribute_name = _OWN
        return
    attribute = tree.nodes.new("ShaderNodeAttribute")
    attribute.attribute_type, attribute.attribute_name = "OBJECT", _OWN
    # One of three equal components: their mean, which Fac is, may be rounded.
    separate = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(attribute.outputs["Vector"], separate.inputs[0])
    feed_instead(tree, node, _NODE_OUTPUT, separate)
