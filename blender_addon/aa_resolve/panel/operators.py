# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators: export, estimate, export and compare, preview of the light, cancel, open what was found.

The window never freezes: the work runs in child processes on a copy of the open file. Without a window
(``blender -b``) the same operators wait for the end.
"""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import os
import shutil
import time
import types
from dataclasses import dataclass, field

import bpy
from bpy.props import BoolProperty

from .. import program
from ..options import options_of
from ..settings import Settings
from . import job, preferences, running, watch, windows
from .running import State

_PREVIEW_PIXELS = 480  # of the longer side
_PREVIEW_SAMPLES = 32  # per half of the truth, which is what is shown
_SIDE_BY_SIDE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "side_by_side.py")


class JobOperator:
    """Runs a job: beside the window where there is one, waiting without."""

    def make_job(self, context) -> job.Job | None:
        """The job to run; None after an error was reported."""
        raise NotImplementedError

    @classmethod
    def poll(cls, _context) -> bool:
        return State.running is None

    def execute(self, context):
        made = self.make_job(context)
        if made is None:
            return {"CANCELLED"}
        running.wait(made, lambda: time.sleep(0.05))
        if State.failed:
            self.report({"ERROR"}, State.result)
            return {"CANCELLED"}
        self.report({"INFO"}, State.result)
        return {"FINISHED"}

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        made = self.make_job(context)
        if made is None:
            return {"CANCELLED"}
        running.begin(made)
        return {"FINISHED"}

    def shot_folder(self, context) -> str:
        """Folder of the shot; empty after an error was reported."""
        folder = running.shot_folder(context.scene)
        if not folder:
            self.report({"ERROR"}, running.why_no_folder(context.scene))
        return folder

    def copy(self) -> tuple[str, str] | None:
        """Folder and path of a copy of the open file; None after an error was reported."""
        painted = job.unsaved_images()
        if painted:
            names = ", ".join(f"'{name}'" for name in painted)
            self.report({"ERROR"}, f"Save what was painted first: {names} (Image > Save, or Pack)")
            return None
        return job.copy_of_open_file()

    def export_step(
        self, context, title: str, extra: list[str], out: str
    ) -> tuple[str, job.Step] | None:
        """Copies the open file and makes the command that exports it."""
        settings = context.scene.aa_resolve
        if not settings.chosen():
            self.report({"ERROR"}, "Choose at least one method")
            return None
        identity = job.identity_of_open_file()
        copy = self.copy()
        if copy is None:
            return None
        folder, blend = copy
        options = [*settings.options(out), *extra]
        if identity:
            options += ["--source", identity]
        return folder, job.Step(title, job.export_command(blend, options))


class AA_RESOLVE_OT_export(JobOperator, bpy.types.Operator):
    """Export the frames as a shot for aaresolve. The open file is not changed"""

    bl_idname = "aa_resolve.export"
    bl_label = "Export Shot"

    def make_job(self, context):
        out = self.shot_folder(context)
        step = self.export_step(context, "Export", [], out) if out else None
        return job.Job([step[1]], step[0]) if step else None


class AA_RESOLVE_OT_estimate(JobOperator, bpy.types.Operator):
    """Render one frame and a little of its truth, and say how long the export will take"""

    bl_idname = "aa_resolve.estimate"
    bl_label = "Estimate Time"

    def make_job(self, context):
        out = self.shot_folder(context)
        step = (
            self.export_step(context, "Measuring one frame", ["--estimate"], out) if out else None
        )
        if step is None:
            return None
        wish = watch.wish_of(context.scene)

        def finish(finished: job.Job) -> str:
            State.estimate, State.estimate_for = finished.message, wish
            return ""

        return job.Job([step[1]], step[0], finish)


@dataclass
class _Served:
    """Those of the chosen methods that the exported shot can serve: whether it moves, say, is known only then."""

    program: str
    shot: str
    texts: list[str]
    left_out: dict[str, str] = field(default_factory=dict)  # method -> why

    def words(self) -> list[str]:
        """The methods as `run` takes them. Raises RuntimeError where there are none."""
        names = [text.partition(":")[0] for text in self.texts]
        answers = program.why_not(self.program, self.shot, names)
        self.left_out = {name: reason for name, reason in answers.items() if reason}
        served = [text for text in self.texts if text.partition(":")[0] not in self.left_out]
        if not served:
            raise RuntimeError(f"No chosen method can run on this shot{self.without()}")
        return [word for text in served for word in ("-m", text)]

    def without(self) -> str:
        """What was left out, as the end of a sentence."""
        told = [f"{name} ({reason})" for name, reason in self.left_out.items()]
        return f"; without {', '.join(told)}" if told else ""


class AA_RESOLVE_OT_compare(JobOperator, bpy.types.Operator):
    """Export the shot, run the chosen methods on it and show the contact sheet"""

    bl_idname = "aa_resolve.compare"
    bl_label = "Export and Compare"

    def make_job(self, context):
        preferred = preferences.preferred()
        found = program.find(preferred)
        if found is None:
            self.report({"ERROR"}, program.problem(preferred))
            return None
        if program.problem(preferred):  # of another version
            self.report({"WARNING"}, program.problem(preferred))
        shot = self.shot_folder(context)
        step = self.export_step(context, "Export", [], shot) if shot else None
        if step is None:
            return None
        results = running.results_folder(shot)
        sheet = os.path.join(results, "sheet.png")
        report = os.path.join(results, "report.html")
        methods = _Served(found.path, shot, context.scene.aa_resolve.method_texts())
        steps = [
            step[1],
            job.Step(
                "Running the methods",
                lambda: [found.path, "run", shot, *methods.words(), "-o", results],
            ),
            job.Step("Making the contact sheet", [found.path, "sheet", results, "-o", sheet]),
            job.Step("Writing the report", [found.path, "report", results, "-o", report]),
        ]

        def finish(_finished: job.Job) -> str:
            windows.show(sheet)
            return f"Results: {os.path.basename(results)}, beside the shot{methods.without()}"

        return job.Job(steps, step[0], finish)


class AA_RESOLVE_OT_preview_light(JobOperator, bpy.types.Operator):
    """Render the present frame small, with the scene's own light and without noise, and show both beside each other"""

    bl_idname = "aa_resolve.preview_light"
    bl_label = "Preview Light"

    def make_job(self, context):
        scene = context.scene
        copy = self.copy()
        if copy is None:
            return None
        folder, blend = copy
        frame = str(scene.frame_current)
        looks = {"as-is": "The scene's own light", "noise-free": "No Noise"}
        steps, pictures = [], []
        for lighting, title in looks.items():
            out = os.path.join(folder, lighting)
            words = ["--out", out, "--for", "noaa", "--frames", frame, "--truth-frames", frame]
            words += ["--truth-samples", str(_PREVIEW_SAMPLES), "--lighting", lighting]
            words += _said("resolution", use_resolution=True, resolution=_preview_size(scene))
            if scene.aa_resolve.view_layer:
                words += _said("view_layer", view_layer=scene.aa_resolve.view_layer)
            if lighting == "noise-free" and scene.aa_resolve.use_ambient:
                words += _said("ambient", use_ambient=True, ambient=scene.aa_resolve.ambient)
            steps.append(job.Step(f"{title}: one frame", job.export_command(blend, words)))
            pictures += [os.path.join(out, "truth", f"{scene.frame_current:06d}.exr"), title]
        name = f"aa_resolve_light_{os.getpid()}.png"
        made, kept = os.path.join(folder, name), os.path.join(bpy.app.tempdir, name)
        steps.append(
            job.Step(
                "Both beside each other",
                job.script_command(blend, _SIDE_BY_SIDE, [*pictures, made]),
            )
        )

        def finish(_finished: job.Job) -> str:
            shutil.copyfile(made, kept)
            windows.show(kept)
            return ""

        return job.Job(steps, folder, finish)


def _said(name: str, **panel) -> list[str]:
    """The words of one option for what a panel would hold."""
    known = next(option for field, option in options_of(Settings) if field.name == name)
    return [known.flag, *known.words(types.SimpleNamespace(**panel))]


def _preview_size(scene: bpy.types.Scene) -> tuple[int, int]:
    settings = scene.aa_resolve
    width, height = scene.render.resolution_x, scene.render.resolution_y
    if settings.use_resolution:
        width, height = settings.resolution
    share = min(1.0, _PREVIEW_PIXELS / max(width, height))
    return max(4, round(width * share)), max(4, round(height * share))


class AA_RESOLVE_OT_cancel(bpy.types.Operator):
    """Stop the running work. Finished frames stay valid, and an export of a saved file goes on from there"""

    bl_idname = "aa_resolve.cancel"
    bl_label = "Cancel"

    by_key: BoolProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def poll(cls, _context) -> bool:
        return State.running is not None

    def invoke(self, context, _event):
        # Esc comes here after the player, which it has stopped by then.
        if self.by_key and (
            running.is_playing() or State.playing or context.space_data.context != "RENDER"
        ):
            return {"PASS_THROUGH"}
        return self.execute(context)

    def execute(self, _context):
        running.cancel()
        return {"FINISHED"}


class _OpenFile:
    """Opens one of the files of the last results."""

    name = ""

    @classmethod
    def poll(cls, context) -> bool:
        found = watch.of(context.scene).outcome
        return found is not None and cls.name in found.files


class AA_RESOLVE_OT_open_report(_OpenFile, bpy.types.Operator):
    """Open the report in the web browser"""

    bl_idname = "aa_resolve.open_report"
    bl_label = "Open Report"
    name = "report.html"

    def execute(self, context):
        path = os.path.join(watch.of(context.scene).outcome.folder, self.name)
        bpy.ops.wm.path_open(filepath=path)
        return {"FINISHED"}


class AA_RESOLVE_OT_open_sheet(_OpenFile, bpy.types.Operator):
    """Show the contact sheet in a window of its own"""

    bl_idname = "aa_resolve.open_sheet"
    bl_label = "Open Sheet"
    name = "sheet.png"

    def execute(self, context):
        windows.show(os.path.join(watch.of(context.scene).outcome.folder, self.name))
        return {"FINISHED"}


_keys: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


def add_keys() -> None:
    """Esc over the properties editor stops the work; anywhere else it keeps its meaning."""
    keys = bpy.context.window_manager.keyconfigs.addon if bpy.context.window_manager else None
    if keys is None:
        return
    keymap = keys.keymaps.new(name="Property Editor", space_type="PROPERTIES")
    item = keymap.keymap_items.new(AA_RESOLVE_OT_cancel.bl_idname, "ESC", "PRESS")
    item.properties.by_key = True
    _keys.append((keymap, item))


def remove_keys() -> None:
    """Takes the key away again."""
    for keymap, item in _keys:
        keymap.keymap_items.remove(item)
    _keys.clear()
