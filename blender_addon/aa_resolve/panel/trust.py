# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether this Blender runs the Python of the open file. It tells what it blocked, but not what it was allowed to run:
by its preferences, its command line, or the button that opens a file as trusted. A child process may run no more.

So nothing counts but what has run for certain: a script that came with the file, or a driver that needs permission."""

from __future__ import annotations

import builtins
import math

import bl_math
import bpy

from ..scene.scripts import python_drivers

_scripts_ran = False
# Names that Blender may let a driver use in a file that it does not trust, or nearly so.
_HARMLESS = {"bpy", "depsgraph", "frame", "noise", "self", *dir(bl_math), *dir(math)}
_HARMLESS |= {name for name in dir(builtins) if not name.startswith("_")}


def look_at_file() -> None:
    """To be called when a file was opened: its scripts have run by then or have been blocked."""
    global _scripts_ran
    scripts = [text for text in bpy.data.texts if text.use_module and text.name.endswith(".py")]
    _scripts_ran = bool(scripts) and not bpy.app.autoexec_fail


def runs_scripts() -> bool:
    """True where the open file's Python runs in this session."""
    if bpy.app.autoexec_fail:
        return False
    allowed = bpy.context.preferences.filepaths.use_scripts_auto_execute
    return allowed or _scripts_ran or _drivers_ran()


def _drivers_ran() -> bool:
    """True when a driver was evaluated by Python and all there are need permission; Blender begins with an empty
    namespace at each file, and notes in it the frame of an evaluation."""
    known = [curve.driver for _, curve in python_drivers()]
    return (
        "frame" in bpy.app.driver_namespace and bool(known) and all(map(_needs_permission, known))
    )


def _needs_permission(driver: bpy.types.Driver) -> bool:
    try:
        names = set(compile(driver.expression.strip(), "driver", "eval").co_names)
    except (SyntaxError, ValueError):
        return False
    return bool(names - _HARMLESS - {variable.name for variable in driver.variables})
