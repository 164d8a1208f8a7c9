# SPDX-License-Identifier: GPL-3.0-or-later
"""What reads the scene's active camera: while a shot is made that is the jittered one, which rides on the user's at place
0 and whose lens is shifted. Here drivers, constraints and nodes are made to read the user's own."""

from __future__ import annotations

import re
from dataclasses import dataclass

import bpy

from .changing import constraints_of
from .scripts import drivers

# Constraints that take the active camera where they have none of their own.
_TRACKING = ("FOLLOW_TRACK", "OBJECT_SOLVER")
_IN_PYTHON = re.compile(r"\.camera\b")


@dataclass(frozen=True)
class _Variable:
    """A variable of a driver, by names: drivers that the export owns are removed later."""

    owner: bpy.types.ID
    driven: str
    index: int
    name: str
    path: str  # from the camera on

    def point_at(self, camera: bpy.types.Object) -> None:
        animation = self.owner.animation_data
        curve = animation.drivers.find(self.driven, index=self.index) if animation else None
        variable = curve.driver.variables.get(self.name) if curve else None
        if variable is None:
            return
        variable.type = "SINGLE_PROP"
        target = variable.targets[0]
        target.id_type = "OBJECT"
        target.id = camera
        target.data_path = self.path


class CameraReaders:
    """Everything that reads the active camera of a scene."""

    def __init__(self, scene: bpy.types.Scene) -> None:
        self._variables = []
        self._by_python = set()
        for block, curve in drivers():
            for variable in curve.driver.variables:
                path = _path_from_camera(scene, variable)
                if path:
                    known = (curve.id_data, curve.data_path, curve.array_index, variable.name)
                    self._variables.append(_Variable(*known, path))
            if curve.driver.type == "SCRIPTED" and _IN_PYTHON.search(curve.driver.expression):
                self._by_python.add(f"{block.name}.{curve.data_path}")
        self._constraints = [
            constraint
            for item in bpy.data.objects
            for constraint in constraints_of(item)
            if constraint.type in _TRACKING and constraint.camera is None
        ]
        self._sockets = [
            socket
            for tree in bpy.data.node_groups
            for node in list(tree.nodes)
            if node.bl_idname == "GeometryNodeInputActiveCamera"
            for socket in _cut_off(tree, node)
        ]
        self._shown: bpy.types.Object | None = None

    def notes(self) -> list[str]:
        """A sentence about those that cannot be helped."""
        if not self._by_python:
            return []
        return [
            f"Python of drivers reads the active camera ({', '.join(sorted(self._by_python)[:4])}): it finds the export's, "
            "which hangs on the scene's own at place 0; let a variable read it instead"
        ]

    def show(self, camera: bpy.types.Object) -> None:
        """Makes all of them read this camera."""
        if camera == self._shown:
            return
        self._shown = camera
        for variable in self._variables:
            variable.point_at(camera)
        for constraint in self._constraints:
            constraint.camera = camera
        for socket in self._sockets:
            socket.default_value = camera


def _path_from_camera(scene: bpy.types.Scene, variable: bpy.types.DriverVariable) -> str:
    """What a variable reads of the scene's camera, as a path from there; empty where it reads something else."""
    target = variable.targets[0]
    if variable.type == "CONTEXT_PROP":  # since 4.0
        if target.context_property != "ACTIVE_SCENE":
            return ""
    elif variable.type != "SINGLE_PROP" or target.id != scene:
        return ""
    found = re.fullmatch(r"camera(?:\.|(?=\[))(.+)", target.data_path)
    return found[1] if found else ""


def _cut_off(tree: bpy.types.NodeTree, node: bpy.types.Node) -> list[bpy.types.NodeSocket]:
    """Sockets that a node Active Camera was linked to, and that hold an object themselves from now on."""
    held = []
    for link in list(node.outputs[0].links):
        if link.to_node.type != "REROUTE":
            held.append(link.to_socket)
            tree.links.remove(link)
    return held
