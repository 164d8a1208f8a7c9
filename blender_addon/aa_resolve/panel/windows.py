# SPDX-License-Identifier: GPL-3.0-or-later
"""A window of its own for a picture.

It belongs to a Blender of its own: a picture that an editor of this one shows, and that editor's window, are part of the
user's file and would be saved with it."""

from __future__ import annotations

import os
import subprocess

import bpy

_ROOM = os.path.dirname(os.path.abspath(__file__))
_SCRIPT = os.path.join(_ROOM, "picture_window.py")
_SHARE = 0.8  # of the main window's sides
_shown: dict[str, subprocess.Popen] = {}


def show(path: str) -> None:
    """Shows a picture, in the window that shows it already or in a new one; nothing without a window (``blender -b``)."""
    if bpy.app.background:
        return
    if not _renew(path):
        _shown[path] = _open(path)


def _renew(path: str) -> bool:
    """Lets the window of a picture read it again; False where there is none."""
    known = _shown.get(path)
    if known is None or known.poll() is not None:
        return False
    try:
        known.stdin.write(b"\n")
    except OSError:  # it is ending
        return False
    return True


def _open(path: str) -> subprocess.Popen:
    # What a Blender leaves of its last session lies in the folder for temporary files: not among the user's.
    rooms = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), bpy.app.tempdir)
    command = [bpy.app.binary_path, "--factory-startup", "--window-geometry", *_geometry()]
    return subprocess.Popen(
        [*command, "-P", _SCRIPT, "--", path],
        bufsize=0,
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, **rooms},
    )


def _geometry() -> list[str]:
    """In the middle of the main window: x, y, width and height."""
    window = next(iter(bpy.context.window_manager.windows))
    border = (1.0 - _SHARE) / 2.0
    x, y = window.x + border * window.width, window.y + border * window.height
    return [str(round(value)) for value in (x, y, _SHARE * window.width, _SHARE * window.height)]


def stop() -> None:
    """Closes every window that was opened here."""
    for known in _shown.values():
        known.kill()  # it has nothing to lose
        known.wait()
    _shown.clear()
