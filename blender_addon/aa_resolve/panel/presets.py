# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings to begin with: those that the add-on brings, the user's own, and whole families of methods."""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
from dataclasses import dataclass, field

import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import BoolProperty, EnumProperty, StringProperty

from .. import program, registry
from . import preferences, running
from .properties import STORED, families, method_property

_PRESETS = "aa_resolve"
_LONGER_SIDE = 480  # pixels of a quick look


@dataclass(frozen=True)
class Preset:
    """A start that the add-on brings. Parameters of methods, light and folder stay as they are."""

    title: str
    text: str  # the tooltip
    methods: tuple[str, ...]
    frames: int  # from the present one; 0: the scene's range
    small: bool
    values: dict[str, object] = field(default_factory=dict)


def _of_family(*wanted: str, without: tuple[str, ...] = ()) -> tuple[str, ...]:
    return tuple(
        name
        for name, method in registry.load_methods().items()
        if method["family"] in wanted and name not in without
    )


# Why these: a quick look answers in a minute or two what each way of anti-aliasing does to this scene, with one method
# of each kind that games ship (a filter of edges, a better one, accumulation, accumulation that rejects) beside none;
# truth of three frames is enough to rank them. A study of TAA needs truth of every frame, since flicker and ghosts are
# judged from frame to frame, and two periods of the jitter: one to fill the history, one to judge. Everything takes
# 4 sub-samples, as games render them: they serve every method but SMAA S2x, which is made for 2. The accumulation buffer
# is in neither: it refuses a shot that moves.
BUILT_IN = {
    "QUICK": Preset(
        "Quick Look",
        "Five methods of five kinds, 8 small frames from the present one, truth of three: a minute or two for a simple scene",
        ("noaa", "fxaa311", "smaa1x", "taaSimplest", "karis"),
        8,
        True,
        {"truth": "ENDS", "truth_samples": 64, "period": 8, "pattern": "AUTO"},
    ),
    "TAA": Preset(
        "TAA Study",
        "Every method that accumulates frames but SMAA 4x, 32 frames from the present one with truth of each: flicker, ghosts and "
        "convergence can be judged",
        ("noaa", *_of_family("temporal", without=("smaa4x",))),
        32,
        False,
        {"truth": "ALL", "truth_samples": 256, "period": 16, "pattern": "AUTO"},
    ),
    "EVERYTHING": Preset(
        "Everything",
        "Every method that one shot can serve, with 4 sub-samples, over the scene's range with truth of each frame: "
        "hours for a long range; estimate it first",
        tuple(name for name in registry.load_methods() if name not in ("accum", "smaaS2x")),
        0,
        False,
        {"truth": "ALL", "truth_samples": 256, "period": 16, "pattern": "d3d4"},
    ),
}


def _small_size(scene: bpy.types.Scene) -> tuple[int, int]:
    render = scene.render
    share = render.resolution_percentage / 100.0
    width, height = render.resolution_x * share, render.resolution_y * share
    share = min(1.0, _LONGER_SIDE / max(width, height))
    return max(4, round(width * share)), max(4, round(height * share))


def use(scene: bpy.types.Scene, preset: Preset) -> None:
    """Sets what a preset says."""
    settings = scene.aa_resolve
    for name in registry.load_methods():
        setattr(settings, method_property(name), name in preset.methods)
    settings.use_scene_range = not preset.frames
    if preset.frames:
        settings.first = scene.frame_current
        settings.last = scene.frame_current + preset.frames - 1
    settings.use_resolution = preset.small
    if preset.small:
        settings.resolution = _small_size(scene)
    for name, value in preset.values.items():
        setattr(settings, name, value)


class AA_RESOLVE_OT_use_preset(bpy.types.Operator):
    """Choose methods, frames, truth and sub-samples for a purpose"""

    bl_idname = "aa_resolve.use_preset"
    bl_label = "Start With"
    bl_options = {"REGISTER", "UNDO"}

    kind: EnumProperty(
        items=[(kind, known.title, known.text) for kind, known in BUILT_IN.items()],
        name="Preset",
    )

    @classmethod
    def description(cls, _context, properties) -> str:
        """The tooltip of one button."""
        return BUILT_IN[properties.kind].text

    def execute(self, context):
        use(context.scene, BUILT_IN[self.kind])
        return {"FINISHED"}


class AA_RESOLVE_OT_choose_family(bpy.types.Operator):
    """Choose all methods of this family, or none"""

    bl_idname = "aa_resolve.choose_family"
    bl_label = "Choose Family"
    bl_options = {"REGISTER", "UNDO"}

    family: StringProperty(options={"HIDDEN"})
    chosen: BoolProperty(name="Chosen", default=True)

    @classmethod
    def description(cls, _context, properties) -> str:
        """The tooltip of one button."""
        which = "all" if properties.chosen else "no"
        return f"Choose {which} methods of this family"

    def execute(self, context):
        for name in families()[self.family]:
            setattr(context.scene.aa_resolve, method_property(name), self.chosen)
        return {"FINISHED"}


class AA_RESOLVE_OT_choose_set(bpy.types.Operator):
    """Choose a set of methods"""

    bl_idname = "aa_resolve.choose_set"
    bl_label = "Choose Methods"
    bl_options = {"REGISTER", "UNDO"}

    kind: EnumProperty(
        items=[
            ("ALL", "All", "Choose every method"),
            ("NONE", "None", "Choose no method"),
            (
                "RUNNABLE",
                "What the Shot Serves",
                "Choose the methods that the shot in the folder can serve as it is: none of them needs anything "
                "rendered",
            ),
        ],
        name="Set",
    )

    @classmethod
    def description(cls, _context, properties) -> str:
        """The tooltip of one button."""
        return properties.bl_rna.properties["kind"].enum_items[properties.kind].description

    def execute(self, context):
        chosen = list(registry.load_methods()) if self.kind == "ALL" else []
        if self.kind == "RUNNABLE":
            wanted = preferences.preferred()
            found = program.find(wanted)
            if found is None:
                self.report({"ERROR"}, program.problem(wanted))
                return {"CANCELLED"}
            shot = running.shot_folder(context.scene)
            if not shot:
                self.report({"ERROR"}, running.why_no_folder(context.scene))
                return {"CANCELLED"}
            try:
                answers = program.why_not(found.path, shot)
            except RuntimeError as error:
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
            chosen = [name for name, reason in answers.items() if not reason]
        for name in registry.load_methods():
            setattr(context.scene.aa_resolve, method_property(name), name in chosen)
        return {"FINISHED"}


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
    preset_subdir = _PRESETS
    # In full, without ``preset_defines``: with Python 3.13 Blender 4.3 does not see the names that those define.
    preset_values = [
        f"bpy.context.scene.aa_resolve.{name}"
        for name in STORED
        if name not in ("out", "overwrite", "same_scene", "view_layer")
    ]
