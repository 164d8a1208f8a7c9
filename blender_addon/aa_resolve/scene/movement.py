# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves: whether all frames of a shot show the same, and the state of one frame by which wrong motion is found.

Decided from the open scene alone, with the sentence that explains it."""

from __future__ import annotations

import hashlib
import zlib
from dataclasses import dataclass, field
from typing import Union

import bpy
from idprop.types import IDPropertyArray
from mathutils import Matrix
import numpy as np

from .. import compat
from . import camera as cam
from .changing import may_move, pointed_at, unseen_change
from .cuts import CameraCuts

_GEOMETRY_TYPES = {
    "MESH",
    "CURVE",
    "SURFACE",
    "META",
    "FONT",
    "CURVES",
    "POINTCLOUD",
    "VOLUME",
    "GPENCIL",
    "GREASEPENCIL",
}
_WITH_NORMALS = (
    "DATA_TRANSFER",
    "NODES",
    "NORMAL_EDIT",
    "WEIGHTED_NORMAL",
)  # set shading apart from shape
_STRANDS = 5000  # of a system of hair are looked at, at least, where it has as many
_MESHES = ("MESH", "CURVE", "SURFACE", "META", "FONT")
_POINTS = ("CURVES", "POINTCLOUD")  # their places are an attribute


@dataclass
class Motion:
    """Result of looking for motion over a range of frames."""

    static: bool
    reason: str


Key = tuple[str, Union[int, None]]


@dataclass
class FrameState:
    """What one frame shows, as far as later decisions need it."""

    camera: cam.CameraState
    camera_name: str
    hidden: frozenset[str] = frozenset()
    # By name and, of an instance, its random id: what tells one mesh from another with other vertices.
    topology: dict[Key, tuple[int, ...]] = field(default_factory=dict)
    instances: frozenset[tuple[str, int]] = frozenset()  # source and random id


def _picture_digest(depsgraph: bpy.types.Depsgraph) -> bytes:
    """Digest of every place and every vertex of the evaluated scene, and of what its nodes look at."""
    digest = hashlib.sha256()
    shapes: dict[tuple[str, int], bytes] = {}
    instancers: dict[str, bytes] = {}

    def add(item: bpy.types.Object, place: Matrix) -> None:
        digest.update(item.name_full.encode())
        digest.update(np.array(place, np.float32).tobytes())
        digest.update(_appearance(item))
        if item.type in _GEOMETRY_TYPES:
            key = (item.name_full, item.data.as_pointer() if item.data else 0)
            if key not in shapes:
                shapes[key] = _shape_digest(item)
            digest.update(shapes[key])

    for instance in depsgraph.object_instances:
        item, instancer = instance.object, instance.parent
        if item.type in _GEOMETRY_TYPES or item.type in ("LIGHT", "CAMERA", "EMPTY"):
            add(item, instance.matrix_world)
        if instancer is not None and instancer.name_full not in instancers:
            instancers[instancer.name_full] = _appearance(instancer)
    for item in pointed_at():
        seen = item.evaluated_get(depsgraph)
        add(seen, seen.matrix_world)
    for looks in instancers.values():
        digest.update(looks)
    return digest.digest()


def _made_volume(depsgraph: bpy.types.Depsgraph) -> str | None:
    """Name of an object whose modifiers make a volume: of that nothing can be read."""
    for instance in depsgraph.object_instances:
        item = instance.object.original
        if instance.object.type == "VOLUME" and (item.type != "VOLUME" or len(item.modifiers)):
            return item.name
    return None


# What an object alone decides of how it looks.
_LOOKS = (
    "hide_render", "color", "is_holdout", "is_shadow_catcher", "visible_camera", "visible_diffuse", "visible_glossy",
    "visible_shadow", "visible_transmission", "visible_volume_scatter",
)  # fmt: skip


def _appearance(item: bpy.types.Object) -> bytes:
    """Everything but place and shape by which an object changes its picture; materials read its own properties."""
    looks = [tuple(item.color) if name == "color" else getattr(item, name) for name in _LOOKS]
    own = []
    for holder in filter(None, (item, item.data)):
        for name in sorted(holder.keys()):
            value = holder[name]
            if isinstance(value, IDPropertyArray):
                value = value.to_list()
            if isinstance(value, (bool, int, float, str, list)):
                own.append((name, value))
    return repr((looks, own)).encode()


# How the values of an attribute are read: name, type and number of each.
_ATTRIBUTE_VALUES = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "QUATERNION": ("value", np.float32, 4),
    "FLOAT4X4": ("value", np.float32, 16),
}


def _add_attributes(digest, data: bpy.types.ID) -> None:
    for attribute in data.attributes:
        if attribute.data_type not in _ATTRIBUTE_VALUES:
            continue
        name, kind, each = _ATTRIBUTE_VALUES[attribute.data_type]
        digest.update(attribute.name.encode())
        digest.update(_values(attribute.data, name, kind, each).tobytes())


def _values(items, name: str, kind: type, each: int = 1) -> np.ndarray:
    values = np.empty(len(items) * each, kind)
    items.foreach_get(name, values)
    return values


def _shape_digest(item: bpy.types.Object) -> bytes:
    digest = hashlib.sha256()
    mesh = item.to_mesh() if item.type in _MESHES else None
    if mesh is not None:
        digest.update(_values(mesh.vertices, "co", np.float32, 3).tobytes())
        digest.update(_values(mesh.loops, "vertex_index", np.int32).tobytes())
        digest.update(_values(mesh.polygons, "material_index", np.int32).tobytes())
        for layer in mesh.uv_layers:
            digest.update(_values(layer.data, "uv", np.float32, 2).tobytes())
        _add_attributes(digest, mesh)
        if any(modifier.type in _WITH_NORMALS for modifier in item.modifiers):
            digest.update(compat.corner_normals(mesh).tobytes())
        item.to_mesh_clear()
    if item.type in _POINTS:
        _add_attributes(digest, item.data)
    for system in item.particle_systems:
        places = np.empty(len(system.particles) * 3, np.float32)
        system.particles.foreach_get("location", places)
        digest.update(places.tobytes())
        if system.settings.type == "HAIR":
            digest.update(_strands(item, system).tobytes())
    return digest.digest()


def _strands(item: bpy.types.Object, system: bpy.types.ParticleSystem) -> np.ndarray:
    """Points along the strands of hair; of very many along some, evenly chosen."""
    strands = len(system.particles) + len(system.child_particles)
    chosen = range(0, strands, max(1, strands // _STRANDS))
    steps = range(2**system.settings.display_step + 1)
    points = [system.co_hair(item, particle_no=which, step=k) for which in chosen for k in steps]
    return np.array(points, np.float32)


def frame_state(
    scene: bpy.types.Scene, frame_number: int, frame: cam.Frame, cuts: CameraCuts, details: bool
) -> FrameState:
    """Evaluates a frame. ``details`` adds hidden objects, vertex counts and instances, by which wrong motion is
    found."""
    chosen = cuts.turn_to(frame_number)
    scene.frame_set(frame_number)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    state = FrameState(cam.camera_state(chosen, frame, depsgraph), chosen.name)
    if details:
        state.hidden = frozenset(
            item.name_full for item in bpy.data.objects if item.evaluated_get(depsgraph).hide_render
        )
        state.topology = _topologies(depsgraph)
        state.instances = frozenset(
            (instance.object.original.name_full, instance.random_id & 0xFFFFFFFF)
            for instance in depsgraph.object_instances
            if instance.is_instance and instance.object
        )
    return state


def _topologies(depsgraph: bpy.types.Depsgraph) -> dict[Key, tuple[int, ...]]:
    """Topology of everything that is shown. Text, curves and metaballs show the mesh that is made of them."""
    found: dict[Key, tuple[int, ...]] = {}
    known: dict[int, tuple[int, int]] = {}
    for instance in depsgraph.object_instances:
        item = instance.object
        if item is None or item.data is None or item.type not in ("MESH", *_POINTS):
            continue
        address = item.data.as_pointer()
        if address not in known:
            known[address] = _topology(item)
        random = instance.random_id & 0xFFFFFFFF if instance.is_instance else None
        key = item.original.name_full, random
        found[key] = found.get(key, ()) + known[address]  # a mesh and points may be one object's
    return found


def _topology(item: bpy.types.Object) -> tuple[int, int]:
    """Number of vertices or points, and a digest of how they are joined where that may change."""
    data = item.data
    if item.type != "MESH":
        return len(data.points), 0
    original = item.original
    if original.type == "MESH" and not original.modifiers:
        return len(data.vertices), 0
    return len(data.vertices), zlib.crc32(_values(data.loops, "vertex_index", np.int32).tobytes())


def find_motion(
    scene: bpy.types.Scene, frames: list[int], frame: cam.Frame, cuts: CameraCuts
) -> Motion:
    """Whether the picture (camera, places, shapes, colours) is the same in all ``frames``."""
    moves, changing = may_move(scene), unseen_change(scene)
    alone = len(frames) == 1
    if not moves and not changing and (alone or not cuts.is_cut):
        return Motion(True, "nothing is animated")
    if alone or changing:
        return Motion(False, changing or "one frame")
    first: tuple[bytes, cam.CameraState] | None = None
    for number in frames:
        state = frame_state(scene, number, frame, cuts, details=False)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        made = _made_volume(depsgraph)
        if made:
            return Motion(False, f"the volume of '{made}' may change")
        digest = _picture_digest(depsgraph)
        if first is None:
            first = digest, state.camera
        elif not cam.same_camera(first[1], state.camera):
            return Motion(False, f"the camera moves in frame {number}")
        elif digest != first[0]:
            return Motion(False, f"objects move in frame {number}")
    return Motion(True, f"nothing changes in frames {frames[0]}-{frames[-1]}")
