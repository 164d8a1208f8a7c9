# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene contains that an export must know: what moves, what has cut-outs, what must be refused.

Every decision is made from the open scene alone and comes with the sentence that explains it.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field

import bpy
import numpy as np

from . import camera as cam
from . import compat
from .errors import SceneError

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
}


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


def refuse_unsuitable(
    scene: bpy.types.Scene, layer_name: str | None
) -> tuple[bpy.types.ViewLayer, list[str]]:
    """The view layer to render and one sentence for everything that will be switched off.

    Raises SceneError for what cannot be exported."""
    notes = []
    if not compat.is_cycles_available():
        raise SceneError("Cycles is not enabled: switch on the add-on 'Cycles Render Engine'")
    render = scene.render
    if render.use_multiview:
        raise SceneError(
            "the scene renders stereo views: switch Stereoscopy off, a shot holds one camera"
        )
    used = [layer for layer in scene.view_layers if layer.use]
    if layer_name is not None:
        chosen = scene.view_layers.get(layer_name)
        if chosen is None:
            known = ", ".join(layer.name for layer in scene.view_layers)
            raise SceneError(
                f"--view-layer: the scene has no layer '{layer_name}' (found: {known})"
            )
    elif len(used) > 1:
        names = ", ".join(layer.name for layer in used)
        raise SceneError(
            f"the scene renders {len(used)} view layers ({names}): choose one with --view-layer NAME"
        )
    else:
        chosen = used[0] if used else scene.view_layers[0]
    if render.engine != "CYCLES":
        notes.append(f"rendered with Cycles; the scene is set to {render.engine}")
    if render.use_motion_blur:
        notes.append("motion blur is switched off: a shot holds sharp frames and their motion")
    if compat.compositor_in_use(scene):
        notes.append("the compositor is switched off: a shot holds the picture before it")
    if render.use_sequencer and compat.strips(scene):
        notes.append("the sequencer is switched off: a shot shows the 3D scene")
    if scene.cycles.use_denoising:
        notes.append("the denoiser is switched off")
    if render.use_freestyle:
        notes.append("Freestyle lines are switched off: they are drawn after rendering")
    if render.use_border:
        notes.append("the shot shows the render border only")
    for item in bpy.data.objects:
        if item.type == "CAMERA" and item.data.dof.use_dof:
            item.data.dof.use_dof = False
            notes.append(
                f"depth of field of camera '{item.name}' is switched off: a shot is sharp everywhere"
            )
        if item.type == "VOLUME" and not item.hide_render:
            notes.append(
                f"volume '{item.name}' has no surface: its depth, normal and motion are those behind it"
            )
    if len(bpy.data.objects) > 32767:
        raise SceneError(
            f"{len(bpy.data.objects)} objects: Cycles tells at most 32767 apart; join some"
        )
    return chosen, notes


def show_what_renders(scene: bpy.types.Scene) -> None:
    """Makes the evaluated scene that Python sees agree with what the renderer sees (in memory only)."""
    for item in bpy.data.objects:
        if item.library is None:
            item.hide_viewport = False
            for modifier in item.modifiers:
                modifier.show_viewport = modifier.show_render
            if item.name in bpy.context.view_layer.objects:
                item.hide_set(False)
    for collection in bpy.data.collections:
        if collection.library is None and not collection.hide_render:
            collection.hide_viewport = False
    for particles in bpy.data.particles:
        if particles.library is None:
            particles.display_percentage = 100


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


def _shading_that_changes() -> str | None:
    """Name of the first animated data-block that changes colours rather than places."""
    for collection in (bpy.data.materials, bpy.data.lights, bpy.data.worlds):
        for block in collection:
            tree = getattr(block, "node_tree", None) if getattr(block, "use_nodes", False) else None
            if _is_keyed(block) or (tree and (_is_keyed(tree) or _uses_moving_images(tree))):
                return f"'{block.name}' is animated"
    for group in bpy.data.node_groups:
        if _is_keyed(group) or _uses_moving_images(group):
            return f"node group '{group.name}' is animated"
    return None


def _own_handlers(handlers: list) -> bool:
    return any(
        not (handler.__module__ or "").startswith(("cycles", "bl_", "rigify"))
        for handler in handlers
    )


def _may_move(scene: bpy.types.Scene) -> bool:
    """False when nothing in the file can depend on the frame: then no frame needs to be evaluated to know it."""
    if scene.rigidbody_world is not None:
        return True
    if _own_handlers(bpy.app.handlers.frame_change_pre) or _own_handlers(
        bpy.app.handlers.frame_change_post
    ):
        return True
    for collection in (
        bpy.data.objects, bpy.data.meshes, bpy.data.curves, bpy.data.armatures, bpy.data.cameras, bpy.data.lattices,
        bpy.data.shape_keys, bpy.data.metaballs, bpy.data.scenes,
    ):  # fmt: skip
        if any(_is_keyed(block) for block in collection):
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
        node.bl_idname in ("GeometryNodeInputSceneTime", "GeometryNodeSimulationInput")
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
    mesh = item.to_mesh() if item.type in ("MESH", "CURVE", "SURFACE", "META", "FONT") else None
    if mesh is not None:
        places = np.empty(len(mesh.vertices) * 3, np.float32)
        mesh.vertices.foreach_get("co", places)
        digest.update(places.tobytes())
        item.to_mesh_clear()
    for system in item.particle_systems:
        places = np.empty(len(system.particles) * 3, np.float32)
        system.particles.foreach_get("location", places)
        digest.update(places.tobytes())
    return digest.digest()


def frame_state(
    scene: bpy.types.Scene, frame_number: int, frame: cam.Frame, cuts: cam.CameraCuts, details: bool
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
            item.name_full: len(item.evaluated_get(depsgraph).data.vertices)
            for item in scene.objects
            if item.type == "MESH" and (item.modifiers or item.data.shape_keys)
        }
        state.instances = frozenset(
            (instance.object.original.name_full, instance.random_id & 0xFFFFFFFF)
            for instance in depsgraph.object_instances
            if instance.is_instance and instance.object
        )
    return state


def find_motion(
    scene: bpy.types.Scene, frames: list[int], frame: cam.Frame, cuts: cam.CameraCuts
) -> Motion:
    """Whether the picture (camera, places, shapes, colours) is the same in all ``frames``."""
    if len(frames) == 1:
        return (
            Motion(False, "one frame") if _may_move(scene) else Motion(True, "nothing is animated")
        )
    changing = _shading_that_changes()
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


def has_cutouts() -> str | None:
    """Name of a material through which a camera ray can pass, or that moves the surface it is on; else None.

    Both are lost under an override material."""
    for item in bpy.data.objects:
        if item.hide_render:
            continue
        for slot in item.material_slots:
            material = slot.material
            if (
                material
                and material.use_nodes
                and material.node_tree
                and _is_see_through(material.node_tree, set())
            ):
                return material.name
    return None


def _is_see_through(tree: bpy.types.NodeTree, seen: set[str]) -> bool:
    if tree.name in seen:
        return False
    seen.add(tree.name)
    for node in tree.nodes:
        if node.bl_idname in ("ShaderNodeBsdfTransparent", "ShaderNodeHoldout"):
            return True
        if node.bl_idname == "ShaderNodeBsdfPrincipled":
            alpha = node.inputs["Alpha"]
            if alpha.is_linked or alpha.default_value < 1.0:
                return True
        if node.bl_idname == "ShaderNodeOutputMaterial" and node.inputs["Displacement"].is_linked:
            return True
        if (
            node.bl_idname == "ShaderNodeGroup"
            and node.node_tree
            and _is_see_through(node.node_tree, seen)
        ):
            return True
    return False


def notes_on_edges() -> list[str]:
    """Sentences about surfaces whose edges are not those of a mesh."""
    notes = []
    hairy = [
        item.name
        for item in bpy.data.objects
        if not item.hide_render
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
        and material.use_nodes
        and material.node_tree
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
        if not (material.use_nodes and material.node_tree and material.users):
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
