# SPDX-License-Identifier: GPL-3.0-or-later
"""Shorthand for building shader nodes in code, and walks along the links of nodes and into their groups."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from .. import compat

Socket = bpy.types.NodeSocket


class Builder:
    """Adds nodes to one tree; an input is a socket to link or a value to set."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self.tree = tree

    def node(self, kind: str, **values) -> bpy.types.Node:
        """A new node with these properties."""
        made = self.tree.nodes.new(kind)
        for name, value in values.items():
            setattr(made, name, value)
        return made

    def feed(self, socket: Socket, source) -> None:
        """Links a socket, or sets a value."""
        if isinstance(source, bpy.types.NodeSocket):
            self.tree.links.new(source, socket)
        else:
            socket.default_value = source

    def math(self, operation: str, *inputs) -> Socket:
        """Result of a Math node."""
        node = self.node("ShaderNodeMath", operation=operation)
        for socket, source in zip(node.inputs, inputs):
            self.feed(socket, source)
        return node.outputs[0]

    def vector(self, operation: str, *inputs) -> Socket:
        """Result of a Vector Math node: a number of DOT_PRODUCT and LENGTH, else a vector."""
        node = self.node("ShaderNodeVectorMath", operation=operation)
        for socket, source in zip(node.inputs, inputs):
            self.feed(socket, source)
        return node.outputs["Value" if operation in ("DOT_PRODUCT", "LENGTH") else "Vector"]

    def scale(self, vector, factor) -> Socket:
        """A vector times a number."""
        node = self.node("ShaderNodeVectorMath", operation="SCALE")
        self.feed(node.inputs[0], vector)
        self.feed(node.inputs["Scale"], factor)
        return node.outputs["Vector"]

    def turned(self, vector: Socket, start: str, end: str) -> Socket:
        """A direction of one space (WORLD, CAMERA) in another."""
        node = self.node(
            "ShaderNodeVectorTransform", vector_type="VECTOR", convert_from=start, convert_to=end
        )
        self.feed(node.inputs[0], vector)
        return node.outputs[0]

    def number(self, name: str) -> Socket:
        """A Value node that is found again by its name."""
        node = self.node("ShaderNodeValue", name=name)
        node.outputs[0].default_value = 0.0
        return node.outputs[0]

    def group(self, tree: bpy.types.NodeTree, **inputs) -> bpy.types.Node:
        """A node that shows a group."""
        node = self.node("ShaderNodeGroup", node_tree=tree)
        for name, source in inputs.items():
            self.feed(node.inputs[name], source)
        return node


def new_group(name: str, inputs: dict[str, str], outputs: dict[str, str]) -> bpy.types.NodeTree:
    """An empty group of shader nodes; sockets by name are "Vector", "Float" or "Color"."""
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for sockets, is_output in ((inputs, False), (outputs, True)):
        for title, kind in sockets.items():
            compat.add_group_socket(tree, f"NodeSocket{kind}", title, is_output)
    return tree


def feed_instead(
    tree: bpy.types.NodeTree, node: bpy.types.Node, name: str, other: bpy.types.Node, index: int = 0
) -> None:
    """Links all that an output of ``node`` feeds to an output of another node."""
    fed = [
        (link.to_node, list(link.to_node.inputs).index(link.to_socket))
        for link in node.outputs[name].links
    ]
    for fed_node, position in fed:  # sockets are looked up each time: a change may make them anew
        tree.links.new(other.outputs[index], fed_node.inputs[position])


def nodes_within(tree: bpy.types.NodeTree | None) -> Iterator[bpy.types.Node]:
    """The nodes of a tree of shader or geometry nodes, those of a group behind its node, each group once; of None, none."""
    yield from _nodes_of(tree, set())


def _nodes_of(tree: bpy.types.NodeTree | None, seen: set[int]) -> Iterator[bpy.types.Node]:
    if (
        tree is None or tree.as_pointer() in seen
    ):  # by address: groups of several libraries may have one name
        return
    seen.add(tree.as_pointer())
    for node in tree.nodes:
        yield node
        if node.bl_idname in ("ShaderNodeGroup", "GeometryNodeGroup"):
            yield from _nodes_of(node.node_tree, seen)


def upstream(socket: Socket) -> Iterator[bpy.types.Node]:
    """Every node of the tree on which an input depends, each once."""
    waiting = [link.from_node for link in socket.links]
    seen: set[str] = set()
    while waiting:
        node = waiting.pop()
        if node.name in seen:
            continue
        seen.add(node.name)
        yield node
        waiting += [link.from_node for item in node.inputs for link in item.links]
