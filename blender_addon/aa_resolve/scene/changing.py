# SPDX-License-Identifier: GPL-3.0-or-later
"""What of a file may change with the frame, read off its data-blocks without evaluating any frame.

Where it is in doubt it may: a scene that rests and is taken for a moving one costs time, the other way round its pictures
are wrong."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from .. import compat
from .ownership import has_animation, is_animated_within
from .scripts import foreign_handlers
from .shader_nodes import nodes_within

# Modifiers that can change a mesh although nothing in the file is keyed.
_TIME_MODIFIERS = {
    "CLOTH", "SOFT_BODY", "FLUID", "DYNAMIC_PAINT", "OCEAN", "WAVE", "BUILD", "EXPLODE", "PARTICLE_SYSTEM",
    "PARTICLE_INSTANCE", "MESH_CACHE", "MESH_SEQUENCE_CACHE", "COLLISION",
}  # fmt: skip
_TIME_NODES = ("GeometryNodeInputSceneTime", "GeometryNodeSimulationInput", "GeometryNodeBake")
# Constraints that read a movie clip at the scene's frame.
_CLIP_CONSTRAINTS = {"FOLLOW_TRACK", "CAMERA_SOLVER", "OBJECT_SOLVER"}
# Lists of blocks that no picture shows.
_UNSEEN = {
    "actions", "brushes", "fonts", "libraries", "linestyles", "masks", "paint_curves", "palettes", "screens", "sounds",
    "speakers", "texts", "window_managers", "workspaces",
}  # fmt: skip


def may_move(scene: bpy.types.Scene) -> bool:
    """False when nothing in the file can depend on the frame: then no frame needs to be evaluated to know it."""
    if scene.rigidbody_world is not None or foreign_handlers() or len(bpy.data.cache_files):
        return True
    if any(_is_keyed(block) for block in _seen_blocks()):
        return True
    if any(_may_change(texture) for texture in bpy.data.textures):
        return True
    return any(_may_move_by_itself(item) for item in bpy.data.objects)


def _seen_blocks() -> Iterator[bpy.types.ID]:
    for known in bpy.data.bl_rna.properties:
        if known.type == "COLLECTION" and known.identifier not in _UNSEEN:
            yield from getattr(bpy.data, known.identifier)


def constraints_of(item: bpy.types.Object) -> Iterator[bpy.types.Constraint]:
    """Those of an object and of its bones."""
    for holder in (item, *(item.pose.bones if item.pose else ())):
        yield from holder.constraints


def _may_move_by_itself(item: bpy.types.Object) -> bool:
    if item.particle_systems:
        return True
    if any(constraint.type in _CLIP_CONSTRAINTS for constraint in constraints_of(item)):
        return True
    return any(
        modifier.type in _TIME_MODIFIERS or _nodes_read_time(modifier)
        for modifier in item.modifiers
    )


def unseen_change(scene: bpy.types.Scene) -> str | None:
    """Name of the first thing that changes what neither places nor shapes tell: colours, volumes, nodes."""
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
    for item in bpy.data.objects:
        for modifier in item.modifiers:
            if _changes_unseen(modifier):
                return f"modifier '{modifier.name}' of '{item.name}' is animated"
    for settings in bpy.data.particles:
        textures = (slot.texture for slot in settings.texture_slots if slot and slot.texture)
        if settings.type == "HAIR" and (_is_keyed(settings) or any(map(_may_change, textures))):
            return f"hair '{settings.name}' is animated"
    if any(settings.type == "EMITTER" for settings in bpy.data.particles):
        for block in (*bpy.data.materials, *bpy.data.node_groups):
            tree = _tree_of(block)
            if tree and any(node.bl_idname == "ShaderNodeParticleInfo" for node in tree.nodes):
                return f"'{block.name}' looks as old as its particles"
    return None


def _changes_unseen(modifier: bpy.types.Modifier) -> bool:
    """True where only the renderer can read what changes: what nodes write of instances, and smoke."""
    if modifier.type == "FLUID":
        return modifier.fluid_type == "DOMAIN" and modifier.domain_settings.domain_type == "GAS"
    if modifier.type != "NODES" or not modifier.node_group:
        return False
    pictures = (
        value for value in compat.inputs_of_nodes(modifier) if isinstance(value, bpy.types.Image)
    )
    return (
        _nodes_read_time(modifier)
        or is_animated_within(modifier)
        or any(_is_moving(picture) for picture in pictures)
    )


def _is_keyed(owner: bpy.types.ID) -> bool:
    animation = getattr(owner, "animation_data", None)  # some blocks have none
    return animation is not None and (
        animation.action is not None or len(animation.drivers) > 0 or len(animation.nla_tracks) > 0
    )


def _may_change(texture: bpy.types.Texture) -> bool:
    """True for a texture of modifiers, particles and force fields that may be another one in the next frame."""
    if _is_keyed(texture) or _is_moving(getattr(texture, "image", None)):
        return True
    tree = texture.node_tree if texture.use_nodes else None
    return tree is not None and (
        _is_keyed(tree)
        or _uses_moving_images(tree)
        or any(node.bl_idname == "TextureNodeCurveTime" for node in tree.nodes)
    )


def _is_moving(image: bpy.types.Image | None) -> bool:
    return image is not None and image.source in ("MOVIE", "SEQUENCE")


def _uses_moving_images(tree: bpy.types.NodeTree) -> bool:
    """True where a node holds a movie or a sequence, itself or in a socket."""
    for node in tree.nodes:
        values = [getattr(socket, "default_value", None) for socket in node.inputs]
        for value in (getattr(node, "image", None), *values):
            if isinstance(value, bpy.types.Image) and _is_moving(value):
                return True
    return False


def _nodes_read_time(modifier: bpy.types.Modifier) -> bool:
    tree = modifier.node_group if modifier.type == "NODES" else None
    return any(node.bl_idname in _TIME_NODES for node in nodes_within(tree))


def pointed_at() -> list[bpy.types.Object]:
    """Objects whose place or shape the nodes of a surface, the world or a modifier read, rendered or not."""
    found: set[bpy.types.Object] = set()
    for block in (*bpy.data.materials, *bpy.data.lights, *bpy.data.worlds, *bpy.data.node_groups):
        tree = _tree_of(block)
        for node in tree.nodes if tree else ():
            found.update(_objects_in(getattr(node, "object", None)))
            for socket in node.inputs:
                found.update(_objects_in(getattr(socket, "default_value", None)))
    for item in bpy.data.objects:
        for modifier in item.modifiers:
            if modifier.type == "NODES" and modifier.node_group:
                for value in compat.inputs_of_nodes(modifier):
                    found.update(_objects_in(value))
    return sorted(found, key=lambda item: item.name_full)


def _tree_of(block: bpy.types.ID) -> bpy.types.NodeTree | None:
    """That of a block with nodes, used or not; a group's is itself."""
    return block if isinstance(block, bpy.types.NodeTree) else block.node_tree


def _objects_in(value: object) -> list[bpy.types.Object]:
    if isinstance(value, bpy.types.Object):
        return [value]
    return list(value.all_objects) if isinstance(value, bpy.types.Collection) else []
