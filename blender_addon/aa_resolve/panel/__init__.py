# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender shows: the panel, its properties and operators, and the child processes that do the work."""

from __future__ import annotations

import bpy
from bpy.props import PointerProperty

from . import operators, panels
from .operators import State
from .properties import AAResolveSettings

_CLASSES = (
    AAResolveSettings,
    operators.AAResolvePreferences,
    operators.AA_RESOLVE_OT_export,
    operators.AA_RESOLVE_OT_estimate,
    operators.AA_RESOLVE_OT_compare,
    operators.AA_RESOLVE_OT_open_report,
    panels.AA_RESOLVE_MT_presets,
    panels.AA_RESOLVE_OT_add_preset,
    panels.AA_RESOLVE_PT_main,
    panels.AA_RESOLVE_PT_methods,
    panels.AA_RESOLVE_PT_quality,
)


def register() -> None:
    """Registers every class and the scene's settings."""
    for item in _CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Scene.aa_resolve = PointerProperty(type=AAResolveSettings)


def unregister() -> None:
    """Ends a running job and takes everything away again."""
    if State.running is not None:
        State.running.cancel()
        State.running = None
    del bpy.types.Scene.aa_resolve
    for item in reversed(_CLASSES):
        bpy.utils.unregister_class(item)
