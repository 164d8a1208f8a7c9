# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel says of the scene and of the shot's folder, found out beside the drawing.

Blender draws a panel at each movement of the mouse; nothing there may walk through the scene or read the disk. ``of``
hands out what is known; a timer renews it as long as somebody looks."""

from __future__ import annotations

import time
from dataclasses import dataclass

import bpy

from ..scene.light_sources import noise_causes
from . import look, outcome, running, shot, trust
from .running import State

_PERIOD_SECONDS = 0.5
_NOBODY_LOOKS_SECONDS = 3.0
_SHARE = 0.05  # of the time that looking may take
_LONGEST_PAUSE_SECONDS = 10.0


@dataclass(frozen=True)
class Facts:
    """What is known of one scene."""

    changes: tuple[str, ...] = ()  # of the light
    noise: tuple[str, ...] = ()  # why light as it is needs samples
    engine: str = ""
    shot: shot.Told = shot.Told()
    outcome: outcome.Outcome | None = None


_known: dict[str, Facts] = {}
_shots: dict[str, tuple[tuple, shot.Told]] = {}  # by folder: stamp and wish, what was told
_outcomes: dict[str, tuple[tuple, outcome.Outcome | None]] = {}  # by folder: stamp, what was read
_wishes: dict[str, tuple] = {}  # what the panel said when the scene was looked at
_looked = 0.0  # when the panel was drawn last
_pause_until = 0.0


def of(scene: bpy.types.Scene) -> Facts:
    """What is known of the scene, at once."""
    global _looked
    _looked = time.monotonic()
    if not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=0.01, persistent=True)
    return _known.get(scene.name, Facts())


def wish_of(scene: bpy.types.Scene) -> tuple:
    """What decides how long an export takes, as far as the panel and the scene's settings say it."""
    render = scene.render
    size = render.resolution_x, render.resolution_y, render.resolution_percentage
    layers = tuple(layer.name for layer in scene.view_layers if layer.use)
    words = scene.aa_resolve.options("", overwrite=[])
    return (bpy.data.filepath, scene.name, layers, *words, *size)


def _shown(scene: bpy.types.Scene) -> tuple:
    """What a user expects to be followed at once."""
    return (*wish_of(scene), scene.aa_resolve.out, scene.render.engine)


def look_now(scene: bpy.types.Scene) -> Facts:
    """Finds everything out, and drops an estimate that holds no longer."""
    if State.estimate and State.estimate_for != wish_of(scene):
        State.estimate = ""
    settings = scene.aa_resolve
    _wishes[scene.name] = _shown(scene)
    without_noise = settings.lighting == "noise-free"
    folder = running.shot_folder(scene)
    _known[scene.name] = Facts(
        tuple(look.changes_without_noise(scene)) if without_noise else (),
        () if without_noise else tuple(noise_causes(scene, settings.samples)),
        look.other_engine(scene),
        _shot_in(scene, folder) if folder else shot.Told(running.why_no_folder(scene), True),
        _outcome_of(folder) if folder else None,
    )
    return _known[scene.name]


def _shot_in(scene: bpy.types.Scene, folder: str) -> shot.Told:
    if State.running is not None:  # it changes with every picture
        return _shots.get(folder, ((), shot.Told()))[1]
    stamp = (*shot.stamp_of(folder), *wish_of(scene), scene.aa_resolve.overwrite)
    if _shots.get(folder, ((), None))[0] != stamp:
        _shots[folder] = stamp, shot.look(scene, folder)
    return _shots[folder][1]


def _outcome_of(shot_folder: str) -> outcome.Outcome | None:
    folder = running.results_folder(shot_folder)
    stamp = outcome.stamp_of(folder, shot_folder)
    if _outcomes.get(folder, ((), None))[0] != stamp:
        _outcomes[folder] = stamp, outcome.read(folder, shot_folder)
    return _outcomes[folder][1]


def _tick() -> float | None:
    global _pause_until
    now = time.monotonic()
    if now - _looked > _NOBODY_LOOKS_SECONDS:
        return None
    started = time.thread_time()
    changed = False
    for scene in _scenes_in_view():
        if now < _pause_until and _wishes.get(scene.name) == _shown(scene):
            continue
        before = _known.get(scene.name), State.estimate
        changed |= (look_now(scene), State.estimate) != before
        pause = min((time.thread_time() - started) / _SHARE, _LONGEST_PAUSE_SECONDS)
        _pause_until = time.monotonic() + pause
    if changed:
        running.redraw()
    return _PERIOD_SECONDS


def _scenes_in_view() -> set[bpy.types.Scene]:
    return {window.scene for window in bpy.context.window_manager.windows}


@bpy.app.handlers.persistent
def forget(*_file) -> None:
    """Another file: nothing that was found of the last one holds."""
    _known.clear()
    _wishes.clear()
    State.estimate = ""
    trust.look_at_file()
    if State.running is None:
        State.result, State.failed, State.notes = "", False, ()


def start() -> None:
    """Begins to notice other files."""
    bpy.app.handlers.load_post.append(forget)


def stop() -> None:
    """Leaves nothing behind."""
    if forget in bpy.app.handlers.load_post:
        bpy.app.handlers.load_post.remove(forget)
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    _known.clear()
    _wishes.clear()
    _shots.clear()
    _outcomes.clear()
