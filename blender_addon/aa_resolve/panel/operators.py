# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators: export, estimate, export and compare, open the report.

The window never freezes: the work runs in child processes on a copy of the open file, a timer shows its progress, Esc
ends it. Without a window (``blender -b``) the same operators wait for the end.
"""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import os
import time

import bpy
from bpy.props import StringProperty

from . import job

ADDON = __package__.rpartition(".")[0]  # as Blender knows it; the room of this file is below
_TIMER_SECONDS = 0.2


class AAResolvePreferences(bpy.types.AddonPreferences):
    """Where the resolver lies."""

    bl_idname = ADDON
    resolver: StringProperty(
        name="aaresolve",
        description="The resolver's program; empty: the one on the PATH",
        subtype="FILE_PATH",
    )

    def draw(self, _context) -> None:
        self.layout.prop(self, "resolver")


def _preferences() -> AAResolvePreferences | None:
    addon = bpy.context.preferences.addons.get(ADDON)
    return addon.preferences if addon else None


class State:
    """The one job that may run, and what it left."""

    running: job.Job | None = None
    result: str = ""
    estimate: str = ""
    report: str = ""


class JobOperator:
    """Runs a job: modal with a window, waiting without one."""

    def make_job(self, context) -> job.Job | None:
        """The job to run; None after an error was reported."""
        raise NotImplementedError

    def finish(self, context, finished: job.Job) -> None:
        """After the last step went well."""

    @classmethod
    def poll(cls, _context) -> bool:
        return State.running is None

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
        State.running = running
        running.start()
        manager = context.window_manager
        self._timer = manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        manager.modal_handler_add(self)
        manager.progress_begin(0, 100)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        running = State.running
        if event.type == "ESC" and event.value == "PRESS":
            running.cancel()
            State.result = (
                "Stopped. Finished frames are valid; with the file saved, the export resumes."
            )
            self._leave(context)
            self.report({"WARNING"}, State.result)
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
        State.running = None
        manager = context.window_manager
        manager.event_timer_remove(self._timer)
        manager.progress_end()
        context.workspace.status_text_set(None)
        _redraw(context)

    def _close(self, context, finished: job.Job):
        if finished.error:
            State.result = finished.error
            self.report({"ERROR"}, finished.error)
            return {"CANCELLED"}
        State.result = finished.message
        self.finish(context, finished)
        self.report({"INFO"}, State.result)
        return {"FINISHED"}

    def export_step(
        self, context, title: str, extra: list[str], out: str
    ) -> tuple[str, job.Step] | None:
        """Copies the open file and makes the command that exports it."""
        settings = context.scene.aa_resolve
        if not settings.chosen():
            self.report({"ERROR"}, "Choose at least one method")
            return None
        if settings.out.startswith("//") and not bpy.data.filepath:
            self.report({"ERROR"}, "Save the file first, or choose a folder for the shot")
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


class AA_RESOLVE_OT_export(JobOperator, bpy.types.Operator):
    """Export the frames as a shot for aaresolve. The open file is not changed"""

    bl_idname = "aa_resolve.export"
    bl_label = "Export Shot"

    def make_job(self, context):
        step = self.export_step(context, "Export", [], _out(context))
        return job.Job([step[1]], step[0]) if step else None


class AA_RESOLVE_OT_estimate(JobOperator, bpy.types.Operator):
    """Render one frame and a little of its truth, and say how long the export will take"""

    bl_idname = "aa_resolve.estimate"
    bl_label = "Estimate Time"

    def make_job(self, context):
        step = self.export_step(context, "Measuring one frame", ["--estimate"], _out(context))
        return job.Job([step[1]], step[0]) if step else None

    def finish(self, _context, finished):
        State.estimate = finished.message


class AA_RESOLVE_OT_compare(JobOperator, bpy.types.Operator):
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
        State.report = report if os.path.exists(report) else ""
        _show_image(context, os.path.join(self._results, "sheet.png"))
        State.result = f"Results: {self._results}"


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
        return bool(State.report) and os.path.exists(State.report)

    def execute(self, _context):
        bpy.ops.wm.path_open(filepath=State.report)
        return {"FINISHED"}
