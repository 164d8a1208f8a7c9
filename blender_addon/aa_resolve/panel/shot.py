# SPDX-License-Identifier: GPL-3.0-or-later
"""What the shot's folder holds already, and what the next export would render; adding.py knows it."""

from __future__ import annotations

import functools
import os
from dataclasses import dataclass

import bpy

from ..adding import missing
from ..command_line import build_parser, file_identity, settings_from
from ..errors import SceneError, UsageError
from ..store import Store
from .job import has_unsaved_changes

_LARGEST_BYTES = 200_000_000  # of a .blend that is read only to see whether it changed


@dataclass(frozen=True)
class Told:
    """A sentence for the panel; ``refused``: the export would end with it."""

    text: str = ""
    refused: bool = False


def stamp_of(folder: str) -> tuple:
    """Changes when the shot, the open file, or whether it is saved changes."""
    return (
        _time(os.path.join(folder, "shot.json")),
        _time(os.path.join(folder, ".aa", "settings.json")),
        _time(bpy.data.filepath),
        has_unsaved_changes(),
    )


def _time(path: str) -> int:
    try:
        return os.stat(path).st_mtime_ns
    except OSError:
        return 0


@functools.lru_cache(maxsize=4)
def _identity(path: str, _changed_ns: int) -> str:
    return file_identity(path)


def look(scene: bpy.types.Scene, folder: str) -> Told:
    """What there is and what is missing; nothing where no shot has been begun and nothing speaks against one."""
    settings = scene.aa_resolve
    if not settings.chosen():
        return Told()  # the methods' own panel says so
    try:
        store = Store(folder, 0.0)
        stored = store.stored()
        identity = stored.content["source"] if stored else "unsaved"
        path = bpy.data.filepath
        if path and os.path.exists(path) and os.path.getsize(path) <= _LARGEST_BYTES:
            identity = _identity(path, _time(path))
        words = [*settings.options(folder), "--source", identity]
        wanted = settings_from(build_parser().parse_args(words), scene)
        if stored is None:
            return Told()
        if settings.overwrite:
            return Told("The old shot will be replaced")
        found = missing(wanted, store)
        if found.changed:
            return Told(store.other_settings(found.changed), True)
    except (UsageError, SceneError) as error:
        return Told(str(error), True)
    text = f"The shot has {found.sentence().removeprefix('kept: ')}"
    if found.work and has_unsaved_changes():
        text += ". Save the file first: only its saved state can be added to"
        return Told(text, True)
    return Told(text)
