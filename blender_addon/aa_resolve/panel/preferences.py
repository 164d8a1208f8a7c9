# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences: where the program lies, and whether it can serve."""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import threading

import bpy
from bpy.props import StringProperty

from .. import ADDON_VERSION, compat, program
from . import running
from .words import draw_text

ADDON = __package__.rpartition(".")[0]  # as Blender knows it; the room of this file is below
_SOURCES = {
    program.PREFERENCE: "named here",
    program.BUNDLE: "it came with the add-on",
    program.PATH: "on the PATH",
}
_POLL_SECONDS = 0.1


class _Check:
    """What was found for the path of the preferences. Asking a program for its version may take a while: a thread
    does it."""

    path: str | None = None  # that was asked for
    found: program.Program | None = None
    problem: str = ""
    thread: threading.Thread | None = None


def preferred() -> str:
    """The path of the preferences, absolute; empty where none is set."""
    addon = bpy.context.preferences.addons.get(ADDON)
    path = addon.preferences.resolver if addon and addon.preferences else ""
    return bpy.path.abspath(path) if path else ""


def check() -> None:
    """Looks for the program again; ``verdict`` says what came of it."""
    path = preferred()

    def ask() -> None:
        program.look_again()
        found, problem = program.find(path), program.problem(path)
        if _Check.path == path:
            _Check.found, _Check.problem = found, problem

    _Check.path, _Check.found, _Check.problem = path, None, ""
    _Check.thread = threading.Thread(target=ask, daemon=True)
    _Check.thread.start()
    if not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=_POLL_SECONDS, persistent=True)


def wait_for_check() -> None:
    """Until the check is over."""
    if _Check.thread is not None:
        _Check.thread.join()


def _tick() -> float | None:
    if _Check.thread is not None and _Check.thread.is_alive():
        return _POLL_SECONDS
    running.redraw()
    return None


def verdict() -> tuple[str, str]:
    """What was found and what is wrong, each a sentence or empty; both empty while a check runs."""
    if _Check.path != preferred():
        check()
    if _Check.thread is not None and _Check.thread.is_alive():
        return "", ""
    found = _Check.found
    if found is None:
        return "", _Check.problem
    text = f"Found: {program.NAME} {found.version} ({_SOURCES[found.source]}), {found.path}"
    return text, _Check.problem


def stop() -> None:
    """Leaves nothing behind."""
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    _Check.path = None


class AAResolvePreferences(bpy.types.AddonPreferences):
    """Where the program lies."""

    bl_idname = ADDON
    resolver: StringProperty(
        name="Program",
        description="The program aaresolve; empty: the one that came with the add-on, else the one on the PATH",
        subtype="FILE_PATH",
        options=compat.path_options(),
    )

    def draw(self, context) -> None:
        layout = self.layout
        row = layout.row(align=True)
        row.prop(self, "resolver")
        button = row.row(align=True)
        button.ui_units_x = 5
        button.operator(AA_RESOLVE_OT_check_program.bl_idname, text="Check", icon="FILE_REFRESH")
        found, problem = verdict()
        if found:
            draw_text(layout, context, found, icon="CHECKMARK")
        if problem:
            draw_text(layout, context, problem, icon="ERROR")
        if not found and not problem:
            layout.label(text="Looking for the program ...")
        layout.label(text=f"Add-on: version {ADDON_VERSION}", icon="BLANK1")


class AA_RESOLVE_OT_check_program(bpy.types.Operator):
    """Look for the program aaresolve again and ask it for its version"""

    bl_idname = "aa_resolve.check_program"
    bl_label = "Check Program"

    def execute(self, _context):
        check()
        if bpy.app.background:
            wait_for_check()
            found, problem = verdict()
            self.report({"WARNING"} if problem else {"INFO"}, problem or found)
        return {"FINISHED"}


class AA_RESOLVE_OT_preferences(bpy.types.Operator):
    """Open the add-on's preferences, where the program is named"""

    bl_idname = "aa_resolve.preferences"
    bl_label = "Preferences"

    def execute(self, _context):
        bpy.ops.preferences.addon_show(module=ADDON)
        return {"FINISHED"}
