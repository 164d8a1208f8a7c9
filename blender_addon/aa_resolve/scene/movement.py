# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves: whether all frames of a shot show the same, and the state of one frame by which wrong motion is found.

Decided from the open scene alone, with the sentence that explains it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field

import bpy
import numpy as np

from . import camera as cam
from .cuts import CameraCuts
from .ownership import has_animation
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


@dataclass
class FrameState:
    """What one frame shows, as far as later decisions need it."""

    camera: cam.CameraState
    camera_name: str
    hidden: frozenset[str] = frozenset()
    vertices: dict[str, int] = field(default_factory=dict)
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
    """Name of the first animated data-block that changes what no place or vertex tells: colours, volumes."""
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
        digest.update(bytes([item.hide_render]))
        if item.type in _GEOMETRY_TYPES:
            key = (item.name_full, item.data.as_pointer() if item.data else 0)
            if key not in shapes:
                shapes[key] = _shape_digest(item)
            digest.update(shapes[key])
    return digest.digest()


def _shape_digest(item: bpy.types.Object) -> bytes:
    digest = hashlib.sha256()
    mesh = item.to_mesh() if item.type in _MESHES else None
    if mesh is not None:
        places = np.empty(len(mesh.vertices) * 3, np.float32)
        mesh.vertices.foreach_get("co", places)
        digest.update(places.tobytes())
        item.to_mesh_clear()
    if item.type in _POINTS and "position" in item.data.attributes:
        points = item.data.attributes["position"].data
        places = np.empty(len(points) * 3, np.float32)
        points.foreach_get("vector", places)
        digest.update(places.tobytes())
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
        state.vertices = {
            item.name_full: _vertex_count(item.evaluated_get(depsgraph))
            for item in scene.objects
            if (item.type == "MESH" and (item.modifiers or item.data.shape_keys))
            or (item.type in _POINTS and item.modifiers)
        }
        state.instances = frozenset(
            (instance.object.original.name_full, instance.random_id & 0xFFFFFFFF)
            for instance in depsgraph.object_instances
            if instance.is_instance and instance.object
        )
    return state


def _vertex_count(item: bpy.types.Object) -> int:
    """Vertices of an evaluated mesh, points of hair curves or of a point cloud."""
    return len(item.data.vertices if item.type == "MESH" else item.data.points)


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
