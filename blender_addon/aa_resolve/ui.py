# SPDX-License-Identifier: GPL-3.0-or-later
"""Panel, operators and presets in the Render properties.

The window never freezes: an export runs in a child process on a copy of the open file, a timer shows its progress,
Esc ends it. Without a window (``blender -b``) the same operators wait for the end.
"""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import os
import time

import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
    StringProperty,
)

from . import compat, job, jitter, registry

_PRESETS = "aa_resolve"
_TIMER_SECONDS = 0.2


def method_property(identity: str) -> str:
    """Name of the property that chooses a method."""
    return f"method_{identity}"


def _tooltip(method: dict) -> str:
    parameters = "; ".join(
        f"{item['name']} = {item['default']}: {item.get('help', '')}"
        for item in method["parameters"]
    )
    text = method.get("summary") or method["title"]
    text += f"\nReads: {', '.join(method['passes'])}"
    if method.get("source"):
        text += f"\nSource: {method['source']}"
    return text + (f"\nParameters: {parameters}" if parameters else "")


class AAResolveSettings(bpy.types.PropertyGroup):
    """What the panel shows; kept in the scene."""

    out: StringProperty(
        name="Shot",
        description="Folder of the shot; an interrupted export resumes there",
        subtype="DIR_PATH",
        default="//shot",
    )
    use_scene_range: BoolProperty(
        name="Scene Range", description="Export the scene's frame range", default=False
    )
    first: IntProperty(name="First", description="First frame", default=1)
    last: IntProperty(name="Last", description="Last frame", default=16)
    use_resolution: BoolProperty(
        name="Own Resolution", description="Export at another size than the scene's", default=False
    )
    resolution: IntVectorProperty(
        name="Resolution",
        description="Width and height, pixels",
        size=2,
        default=(480, 270),
        min=4,
        max=65536,
    )
    samples: IntProperty(
        name="Shading Samples",
        description="Samples per pixel, all at one point: geometry stays aliased, shading noise is averaged",
        default=1,
        min=1,
        max=65536,
    )
    truth_samples: IntProperty(
        name="Truth Samples",
        description="Samples per pixel in each of the two halves of the ground truth",
        default=256,
        min=1,
        max=1048576,
    )
    truth: EnumProperty(
        name="Truth",
        description="Which frames get ground truth; a shot at rest needs one for all its frames",
        items=(
            ("ALL", "Every Frame", "Truth for every frame"),
            ("ENDS", "First, Middle, Last", "Truth for three frames"),
            ("NONE", "None", "No ground truth: nothing can be measured"),
        ),
        default="ENDS",
    )
    jitter: EnumProperty(
        name="Jitter",
        description="Where in the pixel each frame is sampled",
        items=[(name, name, text) for name, text in jitter.SEQUENCES.items()],
        default="halton23",
    )
    period: IntProperty(
        name="Period",
        description="Frames after which the jitter repeats",
        default=16,
        min=1,
        max=1048576,
    )
    pattern: EnumProperty(
        name="Sub-samples",
        description="Pattern of the geometry within a pixel, for methods that read it",
        items=[
            (name, name.upper(), f"{len(jitter.pattern_positions(name))} points per pixel")
            for name in jitter.D3D_PATTERNS[1:]
        ],
        default="d3d8",
    )
    lighting: EnumProperty(
        name="Light",
        description="Light of colour and truth alike",
        items=(
            (
                "noise-free",
                "Free of Noise",
                "Lights without size, ambient in place of the world's light, no bounces",
            ),
            ("as-is", "As It Is", "The scene's own light; noise has to be averaged by samples"),
        ),
        default="noise-free",
    )
    use_ambient: BoolProperty(
        name="Own Ambient",
        description="Set the ambient instead of taking the mean of the world",
        default=False,
    )
    ambient: FloatVectorProperty(
        name="Ambient",
        description="Ambient radiance, linear",
        subtype="COLOR",
        size=3,
        min=0.0,
        soft_max=1.0,
        default=(0.2, 0.2, 0.2),
    )
    color_type: EnumProperty(
        name="Colour",
        description="Type of colour in the files",
        items=(
            ("float", "Float", "32 bits"),
            ("half", "Half", "16 bits: smaller, error up to 2.4e-4"),
        ),
        default="float",
    )
    overwrite: BoolProperty(
        name="Replace Other Export",
        description="Replace an export with other settings",
        default=False,
    )

    def chosen(self) -> list[str]:
        """Ids of the methods that are ticked."""
        return [
            name for name in registry.load_methods() if getattr(self, method_property(name), False)
        ]

    def options(self, out: str) -> list[str]:
        """The command line that exports what the panel shows."""
        scene = self.id_data
        first, last = (
            (scene.frame_start, scene.frame_end)
            if self.use_scene_range
            else (self.first, self.last)
        )
        methods = self.chosen()
        choices = [registry.MethodChoice(name) for name in methods]
        options = ["--out", out, "--frames", f"{first}-{last}", "--for", ",".join(methods)]
        options += ["--samples", str(self.samples), "--truth-samples", str(self.truth_samples)]
        middle = (first + last) // 2
        truth = {"ALL": "all", "NONE": "none", "ENDS": f"{first},{middle},{last}"}[self.truth]
        options += ["--truth-frames", truth]
        if registry.required_passes(choices, "jittered"):
            options += ["--jitter", self.jitter, "--period", str(self.period)]
        options += ["--lighting", self.lighting, "--color-type", self.color_type]
        if self.use_resolution:
            options += ["--resolution", *map(str, self.resolution)]
        if self.use_ambient and self.lighting == "noise-free":
            options += ["--ambient", *(f"{value:.6g}" for value in self.ambient)]
        if reads_subsamples(methods):
            options += ["--subsamples", self.pattern]
        if self.overwrite:
            options.append("--overwrite")
        return options


def _add_method_properties() -> None:
    """One switch per method of the registry, with its description as the tooltip."""
    for name, method in registry.load_methods().items():
        AAResolveSettings.__annotations__[method_property(name)] = BoolProperty(
            name=method["title"],
            description=_tooltip(method),
            default=name in ("noaa", "taaSimplest"),
        )


def reads_subsamples(methods: list[str]) -> bool:
    """True when one of the methods reads sub-samples."""
    known = registry.load_methods()
    return any({"subsamples", "subsampleColor"} & set(known[name]["passes"]) for name in methods)


class AAResolvePreferences(bpy.types.AddonPreferences):
    """Where the resolver lies."""

    bl_idname = __package__
    resolver: StringProperty(
        name="aaresolve",
        description="The resolver's program; empty: the one on the PATH",
        subtype="FILE_PATH",
    )

    def draw(self, _context) -> None:
        self.layout.prop(self, "resolver")


def _preferences() -> AAResolvePreferences | None:
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


class _State:
    """The one job that may run, and what it left."""

    running: job.Job | None = None
    result: str = ""
    estimate: str = ""
    report: str = ""


class _JobOperator:
    """Runs a job: modal with a window, waiting without one."""

    def make_job(self, context) -> job.Job | None:
        """The job to run; None after an error was reported."""
        raise NotImplementedError

    def finish(self, context, finished: job.Job) -> None:
        """After the last step went well."""

    @classmethod
    def poll(cls, _context) -> bool:
        return _State.running is None

    def execute(self, context):
        running = self.make_job(context)
        if running is None:
            return {"CANCELLED"}
        running.start()
        while running.poll():
            time.sleep(0.05)
        return self._close(context, running)

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        running = self.make_job(context)
        if running is None:
            return {"CANCELLED"}
        _State.running = running
        running.start()
        manager = context.window_manager
        self._timer = manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        manager.modal_handler_add(self)
        manager.progress_begin(0, 100)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        running = _State.running
        if event.type == "ESC" and event.value == "PRESS":
            running.cancel()
            _State.result = (
                "Stopped. Finished frames are valid; with the file saved, the export resumes."
            )
            self._leave(context)
            self.report({"WARNING"}, _State.result)
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        alive = running.poll()
        context.window_manager.progress_update(int(100 * running.fraction))
        context.workspace.status_text_set(f"AA Resolve: {running.message}   (Esc stops)")
        _redraw(context)
        if alive:
            return {"RUNNING_MODAL"}
        self._leave(context)
        return self._close(context, running)

    def _leave(self, context) -> None:
        _State.running = None
        manager = context.window_manager
        manager.event_timer_remove(self._timer)
        manager.progress_end()
        context.workspace.status_text_set(None)
        _redraw(context)

    def _close(self, context, finished: job.Job):
        if finished.error:
            _State.result = finished.error
            self.report({"ERROR"}, finished.error)
            return {"CANCELLED"}
        _State.result = finished.message
        self.finish(context, finished)
        self.report({"INFO"}, _State.result)
        return {"FINISHED"}

    def export_step(
        self, context, title: str, extra: list[str], out: str
    ) -> tuple[str, job.Step] | None:
        """Copies the open file and makes the command that exports it."""
        settings = context.scene.aa_resolve
        if not settings.chosen():
            self.report({"ERROR"}, "Choose at least one method")
            return None
        identity = job.identity_of_open_file()
        folder, blend = job.copy_of_open_file()
        options = [*settings.options(out), *extra]
        if identity:
            options += ["--source", identity]
        return folder, job.Step(title, job.export_command(blend, options))


def _redraw(context) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


def _out(context) -> str:
    return os.path.normpath(bpy.path.abspath(context.scene.aa_resolve.out))


class AA_RESOLVE_OT_export(_JobOperator, bpy.types.Operator):
    """Export the frames as a shot for aaresolve. The open file is not changed"""

    bl_idname = "aa_resolve.export"
    bl_label = "Export Shot"

    def make_job(self, context):
        step = self.export_step(context, "Export", [], _out(context))
        return job.Job([step[1]], step[0]) if step else None


class AA_RESOLVE_OT_estimate(_JobOperator, bpy.types.Operator):
    """Render one frame and a little of its truth, and say how long the export will take"""

    bl_idname = "aa_resolve.estimate"
    bl_label = "Estimate Time"

    def make_job(self, context):
        step = self.export_step(context, "Measuring one frame", ["--estimate"], _out(context))
        return job.Job([step[1]], step[0]) if step else None

    def finish(self, _context, finished):
        _State.estimate = finished.message


class AA_RESOLVE_OT_compare(_JobOperator, bpy.types.Operator):
    """Export the shot, run the chosen methods on it and show the contact sheet"""

    bl_idname = "aa_resolve.compare"
    bl_label = "Export and Compare"

    def make_job(self, context):
        preferences = _preferences()
        resolver = job.find_resolver(preferences.resolver if preferences else "")
        if resolver is None:
            self.report(
                {"ERROR"},
                "aaresolve was not found: put it on the PATH or name it in the add-on's preferences",
            )
            return None
        shot = _out(context)
        self._results = shot + "_results"
        step = self.export_step(context, "Export", [], shot)
        if step is None:
            return None
        methods = [part for name in context.scene.aa_resolve.chosen() for part in ("-m", name)]
        steps = [
            step[1],
            job.Step("Running the methods", [resolver, "run", shot, *methods, "-o", self._results]),
            job.Step(
                "Making the contact sheet",
                [resolver, "sheet", self._results, "-o", os.path.join(self._results, "sheet.png")],
            ),
            job.Step(
                "Writing the report",
                [
                    resolver,
                    "report",
                    self._results,
                    "-o",
                    os.path.join(self._results, "report.html"),
                ],
            ),
        ]
        return job.Job(steps, step[0])

    def finish(self, context, _finished):
        report = os.path.join(self._results, "report.html")
        _State.report = report if os.path.exists(report) else ""
        _show_image(context, os.path.join(self._results, "sheet.png"))
        _State.result = f"Results: {self._results}"


def _show_image(context, path: str) -> None:
    """Loads a picture and shows it in every open image editor."""
    image = bpy.data.images.load(path, check_existing=True)
    image.reload()
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = image


class AA_RESOLVE_OT_open_report(bpy.types.Operator):
    """Open the report in the web browser"""

    bl_idname = "aa_resolve.open_report"
    bl_label = "Open Report"

    @classmethod
    def poll(cls, _context) -> bool:
        return bool(_State.report) and os.path.exists(_State.report)

    def execute(self, _context):
        bpy.ops.wm.path_open(filepath=_State.report)
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
    preset_defines = ["settings = bpy.context.scene.aa_resolve"]
    preset_subdir = _PRESETS

    @property
    def preset_values(self) -> list[str]:
        names = [
            name for name in AAResolveSettings.__annotations__ if name not in ("out", "overwrite")
        ]
        return [f"settings.{name}" for name in names]


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
        column.prop(settings, "use_scene_range")
        if not settings.use_scene_range:
            row = column.row(align=True)
            row.prop(settings, "first", text="Frames")
            row.prop(settings, "last", text="")
        column.prop(settings, "use_resolution")
        if settings.use_resolution:
            column.prop(settings, "resolution", text="")
        running = _State.running
        if running is not None:
            compat.draw_progress(layout, running.fraction, running.message)
            layout.label(text="Esc stops; finished frames stay", icon="INFO")
            return
        row = layout.row(align=True)
        row.operator(AA_RESOLVE_OT_export.bl_idname, icon="RENDER_ANIMATION")
        row.operator(AA_RESOLVE_OT_compare.bl_idname, icon="VIEWZOOM")
        row = layout.row(align=True)
        row.operator(AA_RESOLVE_OT_estimate.bl_idname, icon="TIME")
        row.operator(AA_RESOLVE_OT_open_report.bl_idname, icon="URL")
        for text in (_State.estimate, _State.result):
            if text:
                layout.label(text=text)


class AA_RESOLVE_PT_methods(_Panel, bpy.types.Panel):
    bl_label = "Methods"
    bl_parent_id = "AA_RESOLVE_PT_main"

    def draw(self, context) -> None:
        settings = context.scene.aa_resolve
        families: dict[str, list[str]] = {}
        for name, method in registry.load_methods().items():
            families.setdefault(method["family"], []).append(name)
        for family, names in families.items():
            box = self.layout.box()
            box.label(text=family.replace("-", " ").capitalize())
            grid = box.grid_flow(columns=2, even_columns=True, align=True)
            for name in names:
                grid.prop(settings, method_property(name))
        chosen = settings.chosen()
        if chosen:
            passes = registry.required_passes([registry.MethodChoice(name) for name in chosen])
            self.layout.label(text=f"Passes: {', '.join(sorted(passes))}")


class AA_RESOLVE_PT_quality(_Panel, bpy.types.Panel):
    bl_label = "Sampling and Light"
    bl_parent_id = "AA_RESOLVE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context) -> None:
        settings = context.scene.aa_resolve
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("truth", "truth_samples", "samples"):
            layout.prop(settings, name)
        chosen = [registry.MethodChoice(name) for name in settings.chosen()]
        column = layout.column()
        column.enabled = bool(registry.required_passes(chosen, "jittered"))
        column.prop(settings, "jitter")
        column.prop(settings, "period")
        layout.prop(settings, "lighting")
        if settings.lighting == "noise-free":
            layout.prop(settings, "use_ambient")
            if settings.use_ambient:
                layout.prop(settings, "ambient")
        row = layout.row()
        row.enabled = reads_subsamples(settings.chosen())
        row.prop(settings, "pattern")
        layout.prop(settings, "color_type")
        layout.prop(settings, "overwrite")


_CLASSES = (
    AAResolveSettings,
    AAResolvePreferences,
    AA_RESOLVE_OT_export,
    AA_RESOLVE_OT_estimate,
    AA_RESOLVE_OT_compare,
    AA_RESOLVE_OT_open_report,
    AA_RESOLVE_MT_presets,
    AA_RESOLVE_OT_add_preset,
    AA_RESOLVE_PT_main,
    AA_RESOLVE_PT_methods,
    AA_RESOLVE_PT_quality,
)


def register() -> None:
    """Registers every class and the scene's settings."""
    _add_method_properties()
    for item in _CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Scene.aa_resolve = PointerProperty(type=AAResolveSettings)


def unregister() -> None:
    """Ends a running job and takes everything away again."""
    if _State.running is not None:
        _State.running.cancel()
        _State.running = None
    del bpy.types.Scene.aa_resolve
    for item in reversed(_CLASSES):
        bpy.utils.unregister_class(item)
