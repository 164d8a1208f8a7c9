# SPDX-License-Identifier: GPL-3.0-or-later
"""What has changed since an export began, in words."""

from __future__ import annotations

import dataclasses
import json

from .options import options_of
from .settings import Settings

UNNAMED_SCENE = "which scene of the file it shows is not noted in it"  # of an earlier version
_CHANGED = {
    "scene": "the scene",
    "linked": "a file that the scene uses (a library, a picture, a cache)",
    "first_frame": "the first of --frames",
    "version": "the version of the add-on",
    "blender": "the version of Blender",
    "static": "whether nothing moves in the shot",
}


def _called(key: str) -> str:
    """A member of the fingerprint in words."""
    for item, known in options_of(Settings):
        if item.name == key:
            return known.changed or known.flag
    return _CHANGED.get(key, key)


def difference(old: dict, new: dict) -> str | None:
    """First difference of two fingerprints in words, or None.

    An option that one of them does not name is younger than the shot (or, of a shot made by a newer add-on, not known
    here): its default is what the shot was made with."""
    usual = _defaults()
    for key in sorted(set(old) | set(new)):
        before, now = (known.get(key, usual.get(key)) for known in (old, new))
        if before != now:
            if key == "scene" and not before:
                return UNNAMED_SCENE
            if key in ("source", "linked"):
                return f"{_called(key)} has changed"
            return f"{_called(key)} was {_shown(key, before)} and now is {_shown(key, now)}"
    return None


def reason_against(stored: dict, content: dict) -> str | None:
    """Why an export cannot join a shot, in words, or None. One at rest goes on as one that moves: its frames stay what
    they are."""
    return difference({**stored, "static": stored["static"] and content["static"]}, content)


def _defaults() -> dict:
    """Every option's default by its field's name, as a fingerprint holds it."""
    known = {item.name: item.default for item, _ in options_of(Settings)}
    known["scene"] = Settings.scene
    return json.loads(json.dumps({k: v for k, v in known.items() if v is not dataclasses.MISSING}))


def _shown(key: str, value) -> str:
    """A value as the command line has it; of a flag without one, whether it is there."""
    for item, known in options_of(Settings):
        if item.name == key and value is None and known.none:
            return known.none
        if item.name == key and isinstance(value, bool):
            return "off" if value == item.default else "on"
    between = "x" if key == "resolution" else ","
    return between.join(map(str, value)) if isinstance(value, list) else str(value)
