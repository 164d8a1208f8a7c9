# SPDX-License-Identifier: GPL-3.0-or-later
"""What a shot's light and renderer change of the look that the artist knows, in sentences."""

from __future__ import annotations

import bpy

from .. import compat
from ..scene.light_sources import emissive_materials, lights_of

_NAMES = 3  # more than these are counted, not named


def _named(names: list[str]) -> str:
    shown = ", ".join(f"'{name}'" for name in names[:_NAMES])
    more = len(names) - _NAMES
    return f"{shown} and {more} more" if more > 0 else shown


def changes_without_noise(scene: bpy.types.Scene) -> list[str]:
    """What 'No Noise' changes of this scene's light, one clause per change; what it does is scene/lighting.py."""
    if not compat.is_cycles_available():
        return []
    changes = []
    lights = lights_of(scene)
    areas = [item.name for item in lights if item.data.type == "AREA"]
    soft = [item.name for item in lights if item.data.type != "AREA" and _has_size(item.data)]
    if areas:
        changes.append(f"area light {_named(areas)} shines from its centre")
    if soft:
        changes.append(f"{_named(soft)} without size: hard shadows")
    if scene.world and scene.world.cycles_visibility.diffuse:
        changes.append("even ambient light in place of the world's")
    if scene.cycles.max_bounces > 0:
        changes.append("no bounces: no indirect light, nothing in mirrors and glass")
    glowing = [material.name for material in emissive_materials() if material.users]
    if glowing:
        changes.append(f"glowing material {_named(glowing)} lights nothing else")
    return changes


def _has_size(light: bpy.types.Light) -> bool:
    return (light.angle if light.type == "SUN" else light.shadow_soft_size) > 0.0


_OTHER_ENGINES = {
    "WORKBENCH": "viewport colours and studio light give way to the scene's materials and lights",
    "EEVEE": "shadows, reflections and refraction are traced, and what only EEVEE knows (bloom, Shader to RGB, "
    "light probes, its own blend modes) is not in the picture",
}


def other_engine(scene: bpy.types.Scene) -> str:
    """What changes because Cycles renders the shot; empty where the scene is set to Cycles."""
    if not compat.is_cycles_available():
        return "Cycles renders the shot, and it is switched off: enable the add-on Cycles Render Engine"
    engine = scene.render.engine
    if engine == "CYCLES":
        return ""
    for kind, text in _OTHER_ENGINES.items():
        if kind in engine:
            return f"The scene is set to {kind.capitalize() if kind != 'EEVEE' else kind}, the shot is rendered by Cycles: {text}"
    return f"The scene is set to {engine}, the shot is rendered by Cycles and may look different"
