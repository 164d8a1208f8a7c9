# SPDX-License-Identifier: GPL-3.0-or-later
"""What tells one scene from another: the bytes of its file, and of the scripts that Blender ran on it before."""

from __future__ import annotations

import hashlib
import os
import sys
from dataclasses import dataclass

import bpy

_SCRIPT, _EXPRESSION, _TEXT = ("-P", "--python"), ("--python-expr",), ("--python-text",)
_EXPORTER = [
    "aa_resolve",
    "headless.py",
]  # the last two parts of its path, wherever it is installed


@dataclass(frozen=True)
class Script:
    """One that Blender's command line names before the exporter."""

    name: str
    content: bytes


def file_identity(path: str) -> str:
    """SHA-256 of the .blend, or ``unsaved`` for a scene without a file."""
    if not path:
        return "unsaved"
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()


def scene_identity() -> str:
    """That of the open file; where scripts ran on it, of both: what a script changes, Blender does not notice."""
    file = file_identity(bpy.data.filepath)
    scripts = scripts_before(sys.argv)
    if not scripts:
        return file
    digest = hashlib.sha256(file.encode())
    for script in scripts:
        digest.update(hashlib.sha256(script.content).digest())
    return digest.hexdigest()


def scripts_before(words: list[str]) -> list[Script]:
    """The scripts of Blender's command line up to the exporter."""
    words = words[: words.index("--")] if "--" in words else words
    found = []
    for flag, value in zip(words, words[1:]):
        if flag in _SCRIPT:
            if os.path.realpath(value).split(os.sep)[-2:] == _EXPORTER:
                break
            found.append(Script(os.path.basename(value), _content_of(value)))
        elif flag in _EXPRESSION:
            found.append(Script(flag, value.encode()))
        elif flag in _TEXT:
            found.append(Script(value, value.encode()))  # the text itself lies in the file
    return found


def _content_of(path: str) -> bytes:
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:  # Blender could not run it either
        return path.encode()
