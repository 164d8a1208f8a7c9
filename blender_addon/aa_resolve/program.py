# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the program ``aaresolve`` is: the one named in the preferences, else the one that came with the add-on, else
the one on the PATH; and whether it can serve. Nothing here needs a window, or Blender.
"""

from __future__ import annotations

import functools
import json
import os
import re
import shutil
import stat
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass

from . import ADDON_VERSION

NAME = "aaresolve"
# The folder that `make bundle` makes, bin/aaresolve in it starting libexec/aaresolve; only the zip for Linux has it.
BUNDLED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bundle", "bin", NAME)
_TIMEOUT_SECONDS = 20

PREFERENCE, BUNDLE, PATH = "preference", "bundled", "path"
_ELSEWHERE = "name another in the add-on's preferences"
_WHAT_TO_DO = {
    PREFERENCE: "choose the program aaresolve in the add-on's preferences, or leave the field empty",
    BUNDLE: f"install the add-on's zip again, or {_ELSEWHERE}",
    PATH: f"install it again, or {_ELSEWHERE}",
}


@dataclass(frozen=True)
class Program:
    """A program that runs and says its version."""

    path: str
    version: str
    source: str  # PREFERENCE, BUNDLE or PATH


def find(preferred: str = "") -> Program | None:
    """The program to use; None when there is none that runs, and ``problem`` says why.

    ``preferred`` is the preference, an absolute path or empty. When it is wrong nothing takes its place unasked. Cheap
    enough to be called at each redraw: a file is started once and again when it changes."""
    path, source = _place(preferred)
    if not path or _obstacle(path):
        return None
    version, _ = _asked(path)
    return Program(path, version, source) if version else None


def problem(preferred: str = "") -> str:
    """What is wrong and what to do, in one sentence; empty when all is well. A program of another version than the
    add-on's is found and a problem as well."""
    path, source = _place(preferred)
    if not path:
        return (
            f"{NAME} was not found: install the add-on's zip for Linux, which brings it, put it on the PATH, or name it"
            " in the add-on's preferences"
        )
    why = _obstacle(path)
    version = ""
    if not why:
        version, why = _asked(path)
    if why:
        return f"{path}: {why}; {_WHAT_TO_DO[source]}"
    if version != ADDON_VERSION:
        return f"{path}: is version {version}, but the add-on is version {ADDON_VERSION}: install both of one version"
    return ""


def why_not(path: str, shot: str, methods: Sequence[str] = ()) -> dict[str, str]:
    """Of every method, or of those named, why the program cannot run it on a shot; empty where it can. Raises
    RuntimeError with the program's own words."""
    try:
        ended = subprocess.run(
            [path, "list", *methods, "--shot", shot, "--json"],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            encoding="utf-8",
            errors="replace",
            timeout=_TIMEOUT_SECONDS,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise RuntimeError(f"{path}: {error}") from error
    if ended.returncode != 0:
        raise RuntimeError(ended.stderr.strip() or f"{path}: ended with code {ended.returncode}")
    return {method["id"]: method["whyNot"] for method in json.loads(ended.stdout)["methods"]}


def look_again() -> None:
    """Forgets what programs answered, for one whose libraries changed though its file did not."""
    _answer.cache_clear()


def _place(preferred: str) -> tuple[str, str]:
    """Path and source of the program that is meant, whether it works or not; an empty path: none."""
    if preferred:
        return os.path.expanduser(preferred), PREFERENCE
    if os.path.exists(BUNDLED):
        return BUNDLED, BUNDLE
    return shutil.which(NAME) or "", PATH


def _obstacle(path: str) -> str:
    """Why the file cannot be started at all; empty when it can."""
    if not os.path.exists(path):
        return "there is no such file"
    if os.path.isdir(path):
        return f"is a folder; expected the program {NAME}"
    if path == BUNDLED:
        _make_executable(path)
        _make_executable(os.path.join(os.path.dirname(os.path.dirname(path)), "libexec", NAME))
    if not os.access(path, os.X_OK):
        return "is not an executable file"
    return ""


def _make_executable(path: str) -> None:
    """Gives a file the right to be executed, which every Blender's unpacking of a zip takes away (3.4 to 5.2)."""
    if os.access(path, os.X_OK):
        return
    try:
        mode = os.stat(path).st_mode
        os.chmod(path, mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)
    except OSError:
        pass  # what cannot be changed is told apart afterwards, by what it does


def _asked(path: str) -> tuple[str, str]:
    """Version of the program, or an empty one and why there is none."""
    try:
        state = os.stat(path)
    except OSError as error:
        return "", f"cannot be read: {error.strerror}"
    return _answer(path, state.st_mtime_ns, state.st_size)


@functools.lru_cache(maxsize=8)
def _answer(path: str, _changed_ns: int, _size: int) -> tuple[str, str]:
    try:
        ended = subprocess.run(
            [path, "--version"],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_TIMEOUT_SECONDS,
        )
    except OSError as error:
        return "", f"cannot be started: {error.strerror}"
    except subprocess.TimeoutExpired:
        return "", f"did not say its version within {_TIMEOUT_SECONDS} seconds"
    said = ended.stdout.strip()
    if ended.returncode == 0 and re.fullmatch(r"\d+\.\d+\.\d+", said):
        return said, ""
    lines = [line.strip() for line in (ended.stderr + "\n" + said).splitlines() if line.strip()]
    told = f"'{lines[0][:200]}'" if lines else f"nothing, and ended with code {ended.returncode}"
    return "", f"is not {NAME}, or cannot run here: asked for its version it said {told}"
