# SPDX-License-Identifier: GPL-3.0-or-later
"""What an export says while it works: one line per step, or one JSON object per line.

Cycles and Blender write to standard output as they please. For the time of an export that stream is closed to
them; this package writes to a copy of it.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
from typing import IO

from .errors import SceneError


class Progress:
    """Progress to standard output, as text or JSON lines."""

    def __init__(self, as_json: bool) -> None:
        self.as_json = as_json
        with _output():
            sys.stdout.flush()
        self._stream: IO[str] = os.fdopen(os.dup(1), "w", encoding="utf-8")
        silence = os.open(os.devnull, os.O_WRONLY)
        os.dup2(silence, 1)
        os.close(silence)

    def say(self, event: str, text: str, **values) -> None:
        """One step: ``event`` and ``values`` for machines, ``text`` for people."""
        self._write(json.dumps({"event": event, **values, "text": text}) if self.as_json else text)

    def ask(self, question: str) -> None:
        """A question, whose answer follows on its line."""
        self._write(question, end="")

    def _write(self, text: str, end: str = "\n") -> None:
        with _output():
            self._stream.write(text + end)
            self._stream.flush()


@contextlib.contextmanager
def _output():
    """Within this context the system's errors are those of standard output."""
    try:
        yield
    except OSError as error:
        raise SceneError(f"standard output cannot be written: {error.strerror}") from error
