# SPDX-License-Identifier: GPL-3.0-or-later
"""Panel and presets in the Render properties."""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import textwrap

import bpy
from bl_operators.presets import AddPresetBase

from .. import compat, registry
from ..scene.light_sources import noise_causes
from .operators import (
    AA_RESOLVE_OT_compare,
    AA_RESOLVE_OT_estimate,
    AA_RESOLVE_OT_export,
    AA_RESOLVE_OT_open_report,
    State,
)
from .properties import AAResolveSettings, method_property

_PRESETS = "aa_resolve"


class AA_RESOLVE_MT_presets(bpy.types.Menu):
    """Stored settings"""

    bl_label = "AA Resolve Presets"
    preset_subdir = _PRESETS
    preset_operator = "script.execute_preset"
    draw = bpy.types.Menu.draw_preset


class AA_RESOLVE_OT_add_preset(AddPresetBase, bpy.types.Operator):
    """Store or remove a preset of these settings"""

    bl_idname = "aa_resolve.add_preset"
    bl_label = "Add AA Resolve Preset"
    preset_menu = "AA_RESOLVE_MT_presets"
    preset_defines = ["settings = bpy.context.scene.aa_resolve"]
    preset_subdir = _PRESETS

    @property
    def preset_values(self) -> list[str]:
        names = [
            name for name in AAResolveSettings.__annotations__ if name not in ("out", "overwrite")
        ]
        return [f"settings.{name}" for name in names]


def _letters(context, margin: int) -> int:
    """How many letters of mean width fit into a line of the panel beside ``margin`` (pixels at a scale of 1)."""
    scale = context.preferences.system.ui_scale
    return int((context.region.width - margin * scale) / (6.2 * scale))


def draw_text(layout: bpy.types.UILayout, context, text: str) -> None:
    """A sentence in as many lines as the width of the panel asks for: labels would cut it off."""
    letters = max(20, _letters(context, 50))
    column = layout.column(align=True)
    column.scale_y = 0.8
    for line in textwrap.wrap(text, letters):
        column.label(text=line)


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"


class AA_RESOLVE_PT_main(_Panel, bpy.types.Panel):
    bl_label = "AA Resolve"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, _context) -> None:
        row = self.layout.row(align=True)
        row.menu(AA_RESOLVE_MT_presets.__name__, text="", icon="PRESET")
        row.operator(AA_RESOLVE_OT_add_preset.bl_idname, text="", icon="ADD")
        row.operator(
            AA_RESOLVE_OT_add_preset.bl_idname, text="", icon="REMOVE"
        ).remove_active = True

    def draw(self, context) -> None:
        settings = context.scene.aa_resolve
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        column.prop(settings, "out")
        column.column(heading="Range").prop(settings, "use_scene_range", text="Scene")
        if not settings.use_scene_range:
            row = column.row(align=True)
            row.prop(settings, "first", text="Frames")
            row.prop(settings, "last", text="")
        column.prop(settings, "use_resolution")
        if settings.use_resolution:
            column.prop(settings, "resolution", text="Pixels")
        running = State.running
        if running is not None:
            compat.draw_progress(layout, running.fraction)
            draw_text(layout, context, running.message)
            draw_text(layout, context, "Esc stops; finished frames stay")
            return
        buttons = layout.grid_flow(
            columns=0, even_columns=True, align=True
        )  # one below the other where it is narrow
        buttons.operator(AA_RESOLVE_OT_export.bl_idname, icon="RENDER_ANIMATION")
        buttons.operator(AA_RESOLVE_OT_compare.bl_idname, text="Compare", icon="VIEWZOOM")
        buttons.operator(AA_RESOLVE_OT_estimate.bl_idname, icon="TIME")
        buttons.operator(AA_RESOLVE_OT_open_report.bl_idname, icon="URL")
        for text in (State.estimate, State.result):
            draw_text(layout, context, text)


class AA_RESOLVE_PT_methods(_Panel, bpy.types.Panel):
    bl_label = "Methods"
    bl_parent_id = "AA_RESOLVE_PT_main"

    def draw(self, context) -> None:
        settings = context.scene.aa_resolve
        families: dict[str, list[str]] = {}
        for name, method in registry.load_methods().items():
            families.setdefault(method["family"], []).append((name, method["title"]))
        letters = _letters(context, 64)
        for family, methods in families.items():
            box = self.layout.box()
            box.label(text=family.replace("-", " ").capitalize())
            grid = box.grid_flow(columns=0, even_columns=True, align=True)
            for name, title in methods:
                # A title that is cut off tells several methods apart no longer; their ids do, and stay short.
                text = title if len(title) <= letters else name
                grid.prop(settings, method_property(name), text=text)
        chosen = settings.chosen()
        if chosen:
            passes = registry.required_passes([registry.MethodChoice(name) for name in chosen])
            draw_text(self.layout, context, f"Passes: {', '.join(sorted(passes))}")


class AA_RESOLVE_PT_quality(_Panel, bpy.types.Panel):
    bl_label = "Sampling and Light"
    bl_parent_id = "AA_RESOLVE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context) -> None:
        settings = context.scene.aa_resolve
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        # Short labels: two fifths of a narrow editor hold eight letters. The tooltips say the rest.
        layout.prop(settings, "truth")
        layout.prop(settings, "truth_samples", text="Samples")
        layout.prop(settings, "samples", text="Shading")
        column = layout.column()
        column.enabled = settings.applies("jitter")
        column.prop(settings, "jitter")
        column.prop(settings, "period")
        layout.prop(settings, "lighting")
        if settings.applies("ambient"):
            layout.column(heading="Ambient").prop(settings, "use_ambient", text="Own")
            if settings.use_ambient:
                layout.prop(settings, "ambient", text="Colour")
        else:
            causes = noise_causes(context.scene, settings.samples)
            if causes:
                draw_text(layout, context, f"Noisy because of {'; '.join(causes)}")
        row = layout.row()
        row.enabled = settings.applies("pattern")
        row.prop(settings, "pattern", text="Pattern")
        layout.prop(settings, "color_type", text="Type")
        layout.column(heading="Old Shot").prop(settings, "overwrite", text="Replace")
