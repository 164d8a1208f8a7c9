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
import numpy as np

from . import camera as cam
from .cuts import CameraCuts
from .ownership import has_animation, is_animated_within
from .scripts import foreign_handlers

# Modifiers that can change a mesh although nothing in the file is keyed.
_TIME_MODIFIERS = {
    "CLOTH", "SOFT_BODY", "FLUID", "DYNAMIC_PAINT", "OCEAN", "WAVE", "BUILD", "EXPLODE", "PARTICLE_SYSTEM",
    "PARTICLE_INSTANCE", "MESH_CACHE", "MESH_SEQUENCE_CACHE", "COLLISION",
}  # fmt: skip
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


def _is_keyed(owner: bpy.types.ID | None) -> bool:
    animation = owner.animation_data if owner is not None else None
    return animation is not None and (
        animation.action is not None or len(animation.drivers) > 0 or len(animation.nla_tracks) > 0
    )


def _uses_moving_images(tree: bpy.types.NodeTree) -> bool:
    for node in tree.nodes:
        image = getattr(node, "image", None)
        if image is not None and image.source in ("MOVIE", "SEQUENCE"):
            return True
    return False


def _shading_that_changes(scene: bpy.types.Scene) -> str | None:
    """Name of the first thing that changes what neither places nor meshes tell: colours, volumes, nodes."""
    for collection in (bpy.data.materials, bpy.data.lights, bpy.data.worlds):
        for block in collection:
            tree = getattr(block, "node_tree", None) if getattr(block, "use_nodes", False) else None
            if _is_keyed(block) or (tree and (_is_keyed(tree) or _uses_moving_images(tree))):
                return f"'{block.name}' is animated"
    if has_animation(scene):  # exposure, film; not what the exporter has set itself
        return f"a setting of scene '{scene.name}' is animated"
    for volume in bpy.data.volumes:
        if volume.is_sequence:
            return f"volume '{volume.name}' is a sequence of files"
    for group in bpy.data.node_groups:
        if _is_keyed(group) or _uses_moving_images(group):
            return f"node group '{group.name}' is animated"
    for (
        item
    ) in bpy.data.objects:  # what the nodes write of instances, nobody but the renderer can read
        for modifier in item.modifiers:
            if modifier.type == "NODES" and modifier.node_group:
                if _reads_time(modifier.node_group, set()) or is_animated_within(modifier):
                    return f"the nodes of '{item.name}' are animated"
    if any(settings.type == "EMITTER" for settings in bpy.data.particles):
        for block in (*bpy.data.materials, *bpy.data.node_groups):
            tree = block if isinstance(block, bpy.types.NodeTree) else block.node_tree
            if tree and any(node.bl_idname == "ShaderNodeParticleInfo" for node in tree.nodes):
                return f"'{block.name}' looks as old as its particles"
    return None


def _may_move(scene: bpy.types.Scene) -> bool:
    """False when nothing in the file can depend on the frame: then no frame needs to be evaluated to know it."""
    if scene.rigidbody_world is not None:
        return True
    if foreign_handlers():
        return True
    for name in (
        "objects", "meshes", "curves", "armatures", "cameras", "lattices", "shape_keys", "metaballs", "scenes",
        "hair_curves", "pointclouds", "volumes", "grease_pencils", "grease_pencils_v3",
    ):  # fmt: skip
        if any(_is_keyed(block) for block in getattr(bpy.data, name, ())):
            return True
    if len(bpy.data.cache_files):
        return True
    for item in bpy.data.objects:
        if item.particle_systems or any(
            modifier.type in _TIME_MODIFIERS for modifier in item.modifiers
        ):
            return True
        for modifier in item.modifiers:
            if (
                modifier.type == "NODES"
                and modifier.node_group
                and _reads_time(modifier.node_group, set())
            ):
                return True
    return False


def _reads_time(tree: bpy.types.NodeTree, seen: set[str]) -> bool:
    if tree.name in seen:
        return False
    seen.add(tree.name)
    return any(
        node.bl_idname
        in ("GeometryNodeInputSceneTime", "GeometryNodeSimulationInput", "GeometryNodeBake")
        or (
            node.bl_idname == "GeometryNodeGroup"
            and node.node_tree
            and _reads_time(node.node_tree, seen)
        )
        for node in tree.nodes
    )


def _picture_digest(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> bytes:
    """Digest of every place and every vertex of the evaluated scene."""
    digest = hashlib.sha256()
    shapes: dict[tuple[str, int], bytes] = {}
    for instance in depsgraph.object_instances:
        item = instance.object
        if item.type not in _GEOMETRY_TYPES and item.type not in ("LIGHT", "CAMERA", "EMPTY"):
            continue
        digest.update(item.name_full.encode())
        digest.update(np.array(instance.matrix_world, np.float32).tobytes())
        digest.update(_appearance(item))
        if item.type in _GEOMETRY_TYPES:
            key = (item.name_full, item.data.as_pointer() if item.data else 0)
            if key not in shapes:
                shapes[key] = _shape_digest(item)
            digest.update(shapes[key])
    return digest.digest()


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
        item.to_mesh_clear()
    if item.type in _POINTS:
        _add_attributes(digest, item.data)
    for system in item.particle_systems:
        places = np.empty(len(system.particles) * 3, np.float32)
        system.particles.foreach_get("location", places)
        digest.update(places.tobytes())
    return digest.digest()


def frame_state(
    scene: bpy.types.Scene, frame_number: int, frame: cam.Frame, cuts: CameraCuts, details: bool
) -> FrameState:
    """Evaluates a frame. ``details`` adds hidden objects, vertex counts and instances, by which wrong motion is
    found."""
    chosen = cuts.at(frame_number)
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
    if len(frames) == 1:
        return (
            Motion(False, "one frame") if _may_move(scene) else Motion(True, "nothing is animated")
        )
    changing = _shading_that_changes(scene)
    if changing:
        return Motion(False, changing)
    if not cuts.is_cut and not _may_move(scene):
        return Motion(True, "nothing is animated")
    first: tuple[bytes, cam.CameraState] | None = None
    for number in frames:
        state = frame_state(scene, number, frame, cuts, details=False)
        digest = _picture_digest(scene, bpy.context.evaluated_depsgraph_get())
        if first is None:
            first = digest, state.camera
        elif not cam.same_camera(first[1], state.camera):
            return Motion(False, f"the camera moves in frame {number}")
        elif digest != first[0]:
            return Motion(False, f"objects move in frame {number}")
    return Motion(True, f"nothing changes in frames {frames[0]}-{frames[-1]}")
