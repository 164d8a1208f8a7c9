# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender shows: the panel, its properties and operators, and the child processes that do the work."""

from __future__ import annotations

import bpy
from bpy.props import PointerProperty, StringProperty

from . import operators, panels, parameters, preferences, presets, running, watch, windows
from .properties import AAResolveSettings

_CLASSES = (
    *parameters.GROUPS.values(),
    AAResolveSettings,
    preferences.AA_RESOLVE_OT_check_program,
    preferences.AA_RESOLVE_OT_preferences,
    preferences.AAResolvePreferences,
    operators.AA_RESOLVE_OT_export,
    operators.AA_RESOLVE_OT_estimate,
    operators.AA_RESOLVE_OT_compare,
    operators.AA_RESOLVE_OT_preview_light,
    operators.AA_RESOLVE_OT_cancel,
    operators.AA_RESOLVE_OT_open_report,
    operators.AA_RESOLVE_OT_open_sheet,
    parameters.AA_RESOLVE_OT_reset_parameters,
    presets.AA_RESOLVE_OT_use_preset,
    presets.AA_RESOLVE_OT_choose_family,
    presets.AA_RESOLVE_OT_choose_set,
    presets.AA_RESOLVE_MT_presets,
    presets.AA_RESOLVE_OT_add_preset,
    panels.AA_RESOLVE_PT_main,
    panels.AA_RESOLVE_PT_notes,
    panels.AA_RESOLVE_PT_results,
    panels.AA_RESOLVE_PT_methods,
    *panels.FAMILY_PANELS,
    panels.AA_RESOLVE_PT_quality,
)


def register() -> None:
    """Registers every class, the scene's settings, and what watches files and keys."""
    for item in _CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Scene.aa_resolve = PointerProperty(type=AAResolveSettings)
    bpy.types.WindowManager.aa_resolve_search = StringProperty(
        name="Search",
        description="Show the methods with this in their name",
        options={"TEXTEDIT_UPDATE"},
    )
    operators.add_keys()
    watch.start()


def unregister() -> None:
    """Ends a running job and takes everything away again."""
    running.stop()
    watch.stop()
    windows.stop()
    preferences.stop()
    operators.remove_keys()
    del bpy.types.WindowManager.aa_resolve_search
    del bpy.types.Scene.aa_resolve
    for item in reversed(_CLASSES):
        bpy.utils.unregister_class(item)
