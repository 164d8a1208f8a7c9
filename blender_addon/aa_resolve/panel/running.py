# SPDX-License-Identifier: GPL-3.0-or-later
"""The one job that may run, and how the panel comes to know of it.

A timer asks the job what happened. It is no modal operator: those end when another file is opened, take Esc away from
the animation player, and hold up Blender's automatic saving for as long as they run."""

from __future__ import annotations

import os

import bpy

from .job import Job

_TIMER_SECONDS = 0.2


class State:
    """The one job that may run, and what it left."""

    running: Job | None = None
    result: str = ""
    failed: bool = False  # the result is an error
    notes: tuple[str, ...] = ()  # of the last export
    playing: bool = False  # an animation was being played when the timer looked last
    estimate: str = ""
    estimate_for: tuple = ()  # what the estimate holds for: watch.wish_of


def begin(job: Job) -> None:
    """Starts a job; the window stays free."""
    State.running = job
    State.result, State.failed, State.notes = "", False, ()
    job.start()
    if not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=_TIMER_SECONDS, persistent=True)


def wait(job: Job, pause) -> None:
    """Runs a job to its end; ``pause`` is called between two looks at it."""
    State.result, State.failed, State.notes = "", False, ()
    job.start()
    while job.poll():
        pause()
    _take_result(job)


def cancel() -> None:
    """Stops the running job; finished frames stay."""
    job = State.running
    if job is None:
        return
    State.running = None
    job.cancel()
    State.result = "Stopped. Finished frames are valid; with the file saved, the export resumes."
    State.failed = False
    _status(None)
    redraw()


def _tick() -> float | None:
    job = State.running
    if job is None:
        return None
    State.playing = is_playing()
    alive = job.poll()
    if alive:
        _status(f"AA Resolve: {job.message}")
        redraw()
        return _TIMER_SECONDS
    State.running = None
    _status(None)
    _take_result(job)
    redraw()
    return None


def _take_result(job: Job) -> None:
    State.result, State.failed = job.error or job.message, bool(job.error)
    State.notes = tuple(dict.fromkeys(job.notes))


def stop() -> None:
    """Ends everything, for when the add-on goes."""
    if State.running is not None:
        State.running.cancel()
        State.running = None
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)


def _status(text: str | None) -> None:
    for window in bpy.context.window_manager.windows:
        # A timer has no window of its own, and after File > New Blender 4.3 ends with a fault where it needs one.
        with bpy.context.temp_override(window=window):
            window.workspace.status_text_set(text)


def is_playing() -> bool:
    """True while an animation is played in some window."""
    return any(window.screen.is_animation_playing for window in bpy.context.window_manager.windows)


def redraw(kinds: tuple[str, ...] = ("PROPERTIES", "PREFERENCES")) -> None:
    """Asks Blender to draw the panel again."""
    manager = bpy.context.window_manager
    for window in manager.windows if manager else ():
        for area in window.screen.areas:
            if area.type in kinds:
                area.tag_redraw()


def shot_folder(scene: bpy.types.Scene) -> str:
    """Folder of the shot; empty where none can be meant: ``why_no_folder``."""
    return "" if why_no_folder(scene) else _meant_folder(scene)


def why_no_folder(scene: bpy.types.Scene) -> str:
    """What to do so that the shot has a folder; empty where it has one. Blender's own working folder is never meant."""
    out = scene.aa_resolve.out
    if out.startswith("//"):
        return "" if bpy.data.filepath else "Save the file first, or choose a folder for the shot"
    if not out:
        return "Choose a folder for the shot"
    if not os.path.isabs(_meant_folder(scene)):
        return f"Choose a folder for the shot: '{out}' is no whole path; beside the file it is called '//{out}'"
    return ""


def _meant_folder(scene: bpy.types.Scene) -> str:
    return os.path.normpath(os.path.expanduser(bpy.path.abspath(scene.aa_resolve.out)))


def results_folder(shot: str) -> str:
    """Folder of what ``aaresolve run`` writes of a shot."""
    return f"{shot}_results"
