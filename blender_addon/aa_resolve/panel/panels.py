# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the Render properties. Drawing reads what the scene holds and what watch.py knows, and nothing else."""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import bpy

from .. import compat, registry
from . import outcome, parameters, preferences, watch
from .operators import (
    AA_RESOLVE_OT_cancel,
    AA_RESOLVE_OT_compare,
    AA_RESOLVE_OT_estimate,
    AA_RESOLVE_OT_export,
    AA_RESOLVE_OT_open_report,
    AA_RESOLVE_OT_open_sheet,
    AA_RESOLVE_OT_preview_light,
)
from .parameters import AA_RESOLVE_OT_reset_parameters
from .preferences import AA_RESOLVE_OT_preferences
from .presets import (
    BUILT_IN,
    AA_RESOLVE_MT_presets,
    AA_RESOLVE_OT_add_preset,
    AA_RESOLVE_OT_choose_family,
    AA_RESOLVE_OT_choose_set,
    AA_RESOLVE_OT_use_preset,
)
from .properties import families, method_property, unfold_property
from .running import State
from .words import draw_text, fits


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
        facts = watch.of(context.scene)
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        draw_text(layout, context, facts.engine, icon="INFO")
        row = layout.row(align=True)
        for kind, known in BUILT_IN.items():
            row.operator(AA_RESOLVE_OT_use_preset.bl_idname, text=known.title).kind = kind
        column = layout.column()
        column.prop(settings, "out")
        column.column(heading="Range").prop(settings, "use_scene_range", text="Scene")
        if not settings.use_scene_range:
            row = column.row(align=True)
            row.prop(settings, "first", text="Frames")
            row.prop(settings, "last", text="")
        elif context.scene.frame_step > 1:
            draw_text(
                column,
                context,
                f"In the scene's steps of {context.scene.frame_step}: no frame has the one before it, so every frame "
                "starts anew for methods that accumulate",
                icon="INFO",
            )
        if settings.view_layer or sum(layer.use for layer in context.scene.view_layers) > 1:
            column.prop_search(settings, "view_layer", context.scene, "view_layers")
        column.prop(settings, "use_resolution")
        if settings.use_resolution:
            column.prop(settings, "resolution", text="Pixels")
        if facts.changes:
            box = layout.box()
            draw_text(
                box,
                context,
                f"'No Noise' changes the look: {'; '.join(facts.changes)}",
                icon="LIGHT",
            )
            box.operator(AA_RESOLVE_OT_preview_light.bl_idname, icon="HIDE_OFF")
        if State.running is not None:
            _draw_running(layout, context)
            return
        draw_text(layout, context, facts.shot.text, icon="ERROR" if facts.shot.refused else "INFO")
        if facts.shot.other_scene or settings.same_scene:
            layout.column(heading="The Shot Is of").prop(settings, "same_scene", text="Same Scene")
        column = layout.column(align=True)
        large = column.row()
        large.scale_y = 1.3
        large.operator(AA_RESOLVE_OT_compare.bl_idname, icon="VIEWZOOM")
        row = column.row(align=True)
        row.operator(AA_RESOLVE_OT_export.bl_idname, icon="RENDER_ANIMATION")
        row.operator(AA_RESOLVE_OT_estimate.bl_idname, icon="TIME")
        _draw_program(layout, context)
        draw_text(layout, context, State.estimate, icon="TIME")
        draw_text(layout, context, State.result, icon="ERROR" if State.failed else "INFO")


def _draw_running(layout, context) -> None:
    running = State.running
    box = layout.box()
    compat.draw_progress(box, running.fraction)
    draw_text(box, context, running.message)
    box.operator(AA_RESOLVE_OT_cancel.bl_idname, icon="CANCEL")


def _draw_program(layout, context) -> None:
    """What keeps the methods from running, where something does."""
    _, problem = preferences.verdict()
    if problem:
        box = layout.box()
        draw_text(box, context, problem, icon="ERROR")
        box.operator(AA_RESOLVE_OT_preferences.bl_idname, icon="PREFERENCES")


class AA_RESOLVE_PT_notes(_Panel, bpy.types.Panel):
    bl_label = "Notes of the Export"
    bl_parent_id = "AA_RESOLVE_PT_main"

    @classmethod
    def poll(cls, _context) -> bool:
        return bool(State.notes)

    def draw(self, context) -> None:
        for note in State.notes:
            draw_text(self.layout, context, note, icon="DOT")


class AA_RESOLVE_PT_results(_Panel, bpy.types.Panel):
    bl_label = "Results"
    bl_parent_id = "AA_RESOLVE_PT_main"

    @classmethod
    def poll(cls, context) -> bool:
        return watch.of(context.scene).outcome is not None

    def draw(self, context) -> None:
        found = watch.of(context.scene).outcome
        layout = self.layout
        if found.trouble:
            draw_text(layout, context, found.trouble, icon="ERROR")
        elif found.older_than_shot:
            draw_text(layout, context, "The shot is newer than these results", icon="INFO")
        if found.best:
            column = layout.column()
            column.label(text=f"Nearest to the truth, of {found.methods} methods:")
            for place, rank in enumerate(found.best, 1):
                for line in outcome.lines_of(place, rank):
                    draw_text(column, context, line, icon="BLANK1")
        row = layout.row(align=True)
        row.operator(AA_RESOLVE_OT_open_sheet.bl_idname, icon="IMAGE_DATA")
        row.operator(AA_RESOLVE_OT_open_report.bl_idname, icon="URL")


class AA_RESOLVE_PT_methods(_Panel, bpy.types.Panel):
    bl_label = "Methods"
    bl_parent_id = "AA_RESOLVE_PT_main"

    def draw(self, context) -> None:
        settings = context.scene.aa_resolve
        layout = self.layout
        row = layout.row(align=True)
        for kind, text in (("ALL", "All"), ("NONE", "None"), ("RUNNABLE", "What the Shot Serves")):
            row.operator(AA_RESOLVE_OT_choose_set.bl_idname, text=text).kind = kind
        layout.prop(context.window_manager, "aa_resolve_search", text="", icon="VIEWZOOM")
        wanted = context.window_manager.aa_resolve_search.lower()
        if wanted:
            found = [
                (name, method)
                for name, method in registry.load_methods().items()
                if wanted in name.lower() or wanted in method["title"].lower()
            ]
            _draw_methods(layout, context, dict(found))
            if not found:
                layout.label(text="No method is called so")
        choices = settings.choices()
        if choices:
            passes = registry.required_passes(choices)
            draw_text(layout, context, f"Passes: {', '.join(sorted(passes))}")
        else:
            draw_text(layout, context, "Choose at least one method", icon="ERROR")


def _draw_methods(layout, context, methods: dict[str, dict]) -> None:
    """One line per method: its switch and, where it has any, its parameters to unfold."""
    settings = context.scene.aa_resolve
    column = layout.column(align=True)
    margin = 130  # of the switch and of what is to the right
    for name, method in methods.items():
        row = column.row(align=True)
        # A title that is cut off tells several methods apart no longer; their ids do, and stay short.
        text = method["title"] if fits(context, method["title"], margin) else name
        row.prop(settings, method_property(name), text=text)
        if name not in parameters.GROUPS or not getattr(settings, method_property(name)):
            continue
        changed = len(settings.changed_parameters(name))
        unfolded = getattr(settings, unfold_property(name))
        more = row.row(align=True)
        more.alignment = "RIGHT"
        more.prop(
            settings,
            unfold_property(name),
            text=f"{changed} changed" if changed else "",
            icon="DOWNARROW_HLT" if unfolded else "PREFERENCES",
            emboss=False,
        )
        if unfolded:
            _draw_parameters(column.box(), settings, name)


def _draw_parameters(layout, settings, method: str) -> None:
    table = parameters.table_of(method)
    group = getattr(settings, parameters.widgets_property(method))
    values = group.values()
    layout.use_property_split = True
    layout.use_property_decorate = False
    column = layout.column(align=True)
    for name, item in table.items():
        row = column.row(align=True)
        field = row.row(align=True)
        field.active = parameters.has_effect(item, values, table)
        field.prop(group, parameters.widget_name(name))
        reset = row.row(align=True)
        if name in values:
            button = reset.operator(
                AA_RESOLVE_OT_reset_parameters.bl_idname, text="", icon="LOOP_BACK", emboss=False
            )
            button.method, button.parameter = method, name
        else:
            reset.label(text="", icon="BLANK1")
    if values:
        button = layout.operator(
            AA_RESOLVE_OT_reset_parameters.bl_idname,
            text=f"Reset {len(values)} changed",
            icon="LOOP_BACK",
        )
        button.method, button.parameter = method, ""


class _FamilyPanel(_Panel):
    """The methods of one family, folded away behind their count."""

    bl_label = ""
    bl_parent_id = "AA_RESOLVE_PT_methods"
    bl_options = {"DEFAULT_CLOSED"}
    family = ""

    @classmethod
    def poll(cls, context) -> bool:
        return not context.window_manager.aa_resolve_search

    def draw_header(self, context) -> None:
        methods = families()[self.family]
        chosen = sum(name in methods for name in context.scene.aa_resolve.chosen())
        title = self.family.replace("-", " ").capitalize()
        self.layout.label(text=f"{title}: {chosen} of {len(methods)} chosen")

    def draw_header_preset(self, _context) -> None:
        row = self.layout.row(align=True)
        for text, chosen in (("All", True), ("None", False)):
            button = row.operator(AA_RESOLVE_OT_choose_family.bl_idname, text=text)
            button.family, button.chosen = self.family, chosen

    def draw(self, context) -> None:
        _draw_methods(self.layout, context, families()[self.family])


def _family_panel(family: str) -> type:
    name = f"AA_RESOLVE_PT_family_{family.replace('-', '_')}"
    return type(name, (_FamilyPanel, bpy.types.Panel), {"family": family, "bl_idname": name})


FAMILY_PANELS = [_family_panel(family) for family in families()]


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
        layout.prop(settings, "texture_filter", text="Textures")
        if settings.applies("mip_bias"):
            layout.prop(settings, "mip_bias", text="Mip Bias")
        column = layout.column(heading="Jitter of")
        column.enabled = settings.applies("unjitter_textures")
        column.prop(settings, "unjitter_textures", text="Edges Only")
        layout.prop(settings, "lighting")
        if settings.applies("ambient"):
            layout.column(heading="Ambient").prop(settings, "use_ambient", text="Own")
            if settings.use_ambient:
                layout.prop(settings, "ambient", text="Colour")
        noise = watch.of(context.scene).noise
        if noise:
            draw_text(layout, context, f"Noisy because of {'; '.join(noise)}", icon="INFO")
        row = layout.row()
        row.enabled = settings.applies("pattern")
        row.prop(settings, "pattern", text="Pattern")
        layout.prop(settings, "color_type", text="Type")
        layout.column(heading="Old Shot").prop(settings, "overwrite", text="Replace")
