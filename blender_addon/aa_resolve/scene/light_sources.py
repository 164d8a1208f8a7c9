# SPDX-License-Identifier: GPL-3.0-or-later
"""What shines in a scene, and why its own light is noisy at few samples."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator

import bpy

from .. import compat
from .ownership import is_animated
from .shader_nodes import nodes_within


_EMITTERS = frozenset(
    {
        "ShaderNodeEmission",
        "ShaderNodeVolumePrincipled",
        "ShaderNodeVolumeCoefficients",  # since 4.5
        "ShaderNodeScript",  # may do anything
    }
)


def lights_of(
    scene: bpy.types.Scene, also: Collection[bpy.types.Object] = ()
) -> list[bpy.types.Object]:
    """Light objects that render in the present frame, or at some time (``also``), wherever they are linked or instanced
    from."""
    shown = set(scene.objects)
    lights = [item for item in _lamps() if not item.hide_render or item in also]
    if not shown.issuperset(lights):
        users = bpy.data.user_map()
        lights = [
            item for item in lights if item in shown or not shown.isdisjoint(_showing(item, users))
        ]
    return lights


def _lamps() -> list[bpy.types.Object]:
    """All light objects of the file, in one order, shown or not."""
    return [
        item
        for item in sorted(bpy.data.objects, key=lambda item: item.name_full)
        if item.type == "LIGHT" and item.users > 0 and not is_portal(item)
    ]


def switched_on(scene: bpy.types.Scene, frames: Collection[int]) -> set[bpy.types.Object]:
    """Lights that are hidden in the present frame and shown in one of ``frames``."""
    hidden = {item for item in _lamps() if item.hide_render and is_animated(item, "hide_render")}
    found = set()
    if hidden:
        present = scene.frame_current
        for number in frames:
            scene.frame_set(number)
            found |= {item for item in hidden if not item.hide_render}
        scene.frame_set(present)
    return found


def instancers_of(lights: list[bpy.types.Object]) -> set[bpy.types.Object]:
    """Objects that may instance one of the lights, themselves or through others."""
    users = bpy.data.user_map() if lights else {}
    reached = (user for item in lights for user in _showing(item, users))
    return {user for user in reached if isinstance(user, bpy.types.Object) and _instances(user)}


def shown_several_times(lights: list[bpy.types.Object]) -> list[str]:
    """Names of the lights that shine at several places at once in the present frame: of those the samples pick one."""
    places = dict.fromkeys(lights, 0)
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        item = instance.object.original
        if item in places:
            # Cycles leaves out what its parent puts on its vertices or faces, and renders its instances alone.
            replaced = item.parent and item.parent.instance_type in ("VERTS", "FACES")
            places[item] += bool(instance.is_instance or not replaced)
    return sorted(item.name for item, count in places.items() if count > 1)


def is_portal(item: bpy.types.Object) -> bool:
    """True for an area light that only shows Cycles where light of the world comes in."""
    return item.type == "LIGHT" and item.data.type == "AREA" and item.data.cycles.is_portal


_INSTANCING = (
    bpy.types.Object,
    bpy.types.Collection,
    bpy.types.NodeTree,
    bpy.types.ParticleSettings,
)


def _showing(
    item: bpy.types.Object, users: dict[bpy.types.ID, set[bpy.types.ID]]
) -> Iterator[bpy.types.ID]:
    """What may show the item: by its collection, particles, nodes or faces, through any number of others. What only
    points at it counts too: rendering a light that is not there costs time alone.
    """
    seen: set[bpy.types.ID] = {item}
    waiting: list[bpy.types.ID] = [item]
    while waiting:
        shown = waiting.pop()
        near = set(users.get(shown, ()))
        if isinstance(shown, bpy.types.Object) and shown.parent and _instances(shown.parent):
            near.add(shown.parent)
        for user in near - seen:
            if isinstance(user, _INSTANCING):
                seen.add(user)
                waiting.append(user)
                yield user


def _instances(item: bpy.types.Object) -> bool:
    return item.instance_type != "NONE" or any(
        modifier.type in ("NODES", "PARTICLE_SYSTEM") for modifier in item.modifiers
    )


def emissive_materials() -> list[bpy.types.Material]:
    """Materials whose nodes can emit light."""
    found = []
    for material in bpy.data.materials:
        tree = compat.shader_tree(material)
        if tree and _emits(tree):
            found.append(material)
    return found


def _emits(tree: bpy.types.NodeTree) -> bool:
    for node in nodes_within(tree):
        if node.bl_idname in _EMITTERS:
            return True
        if node.bl_idname == "ShaderNodeBsdfPrincipled":
            socket = compat.emission_color(node)
            strength = node.inputs.get("Emission Strength")
            if socket and (strength is None or strength.is_linked or strength.default_value > 0.0):
                if socket.is_linked or max(socket.default_value[:3]) > 0.0:
                    return True
    return False


def noise_causes(scene: bpy.types.Scene, samples: int) -> list[str]:
    """Why this scene's own light is noisy at few samples, one clause per cause."""
    causes = []
    if not compat.is_cycles_available():
        return causes
    lights = lights_of(scene)
    if len(lights) > 1:
        names = ", ".join(f"'{item.name}'" for item in lights)
        causes.append(f"{len(lights)} lights (each sample picks one of {names} at random)")
    for item in lights:
        light = item.data
        if light.type == "AREA":
            causes.append(f"area light '{item.name}' (each sample sees one point of it)")
        elif light.type == "SUN" and light.angle > 0.0:
            causes.append(
                f"sun '{item.name}' with an angle of {math.degrees(light.angle):.2g} degrees (soft shadows)"
            )
        elif light.type in ("POINT", "SPOT") and light.shadow_soft_size > 0.0:
            causes.append(
                f"{light.type.lower()} light '{item.name}' with a radius of {light.shadow_soft_size:.2g} m "
                "(soft shadows)"
            )
    world = scene.world
    if world and world.cycles_visibility.diffuse:
        causes.append("light from the world (each sample sees one direction of it)")
    if (
        scene.cycles.max_bounces > 0
        and scene.cycles.diffuse_bounces + scene.cycles.glossy_bounces > 0
    ):
        causes.append("indirect light (each sample follows one path)")
    emitters = [material.name for material in emissive_materials() if material.users]
    if emitters:
        causes.append(f"meshes that emit light ({', '.join(emitters)})")
    return causes if samples < 64 else []
