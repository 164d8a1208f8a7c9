# SPDX-License-Identifier: GPL-3.0-or-later
"""What has changed since an export began, in words."""

from __future__ import annotations

from .options import options_of
from .settings import Settings

_CHANGED = {
    "linked": "a file that the scene uses (a library, a picture, a cache)",
    "first_frame": "the first of --frames",
    "version": "the version of the add-on",
    "blender": "the version of Blender",
    "static": "whether nothing moves in --frames",
}


def _called(key: str) -> str:
    """A member of the fingerprint in words."""
    for item, known in options_of(Settings):
        if item.name == key:
            return known.changed or known.flag
    return _CHANGED.get(key, key)


def difference(old: dict, new: dict) -> str | None:
    """First difference of two fingerprints in words, or None."""
    for key in sorted(set(old) | set(new)):
        if old.get(key) != new.get(key):
            if key in ("source", "linked"):
                return f"{_called(key)} has changed"
            return f"{_called(key)} was {_shown(old.get(key))} and now is {_shown(new.get(key))}"
    return None


def _shown(value) -> str:
    return ",".join(map(str, value)) if isinstance(value, list) else str(value)
