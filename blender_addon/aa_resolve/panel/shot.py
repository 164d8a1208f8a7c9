# SPDX-License-Identifier: GPL-3.0-or-later
"""What the shot's folder holds already, and what the next export would render; adding.py knows it."""

from __future__ import annotations

import functools
import os
from dataclasses import dataclass

import bpy

from ..adding import missing
from ..command_line import build_parser, settings_from
from ..errors import SceneError, UsageError, way_out
from ..identity import file_identity
from ..options import as_labels
from ..scene.suitability import layer_of
from ..settings import Settings
from ..store import Store
from .job import has_unsaved_changes

_LARGEST_BYTES = 200_000_000  # of a .blend that is read only to see whether it changed


@dataclass(frozen=True)
class Told:
    """A sentence for the panel; ``refused``: the export would end with it."""

    text: str = ""
    refused: bool = False
    other_scene: bool = False  # the file is not the one that the shot was made of


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
        layer_of(scene, wanted.view_layer)
        if stored is None:
            return Told()
        if settings.overwrite:
            return Told("The old shot will be replaced")
        found = missing(wanted, store)
        if found.changed:
            text = store.other_settings(found.changed)
            vouch = "--same-scene" in text or identity != stored.content["source"]
            return Told(as_labels(text, Settings), True, vouch)
    except (UsageError, SceneError, OSError) as error:
        return Told(as_labels(way_out(error)[0], Settings), True)
    text = f"The shot has {found.sentence().removeprefix('kept: ')}"
    if found.work and has_unsaved_changes() and not settings.same_scene:
        text += (
            ". The file has unsaved changes: 'Same Scene' adds to the shot where no picture shows them; otherwise save, "
            "and begin another shot"
        )
        return Told(text, True, True)
    return Told(text)
