# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of failure that a user can cause, with their exit codes, and the one line that any failure ends with."""

from __future__ import annotations

import os
import traceback

TRACEBACK_VARIABLE = "AA_RESOLVE_TRACEBACK"
_ROOM = os.path.dirname(os.path.abspath(__file__))


class UsageError(Exception):
    """The command asks for something that does not exist or contradicts itself."""

    exit_code = 2


class SceneError(Exception):
    """The scene or a file cannot serve as asked; the message says what was found and what to do."""

    exit_code = 3


class Cancelled(Exception):
    """The user stopped the work; finished frames stay valid."""

    exit_code = 1

    def __init__(
        self, told: str = "stopped; finished frames are valid, the same command goes on from there"
    ) -> None:
        super().__init__(told)


def way_out(error: BaseException) -> tuple[str, int]:
    """The line that is told of an exception, and the exit code. What is none of the above is a fault of ours: 9."""
    if isinstance(error, (UsageError, SceneError, Cancelled)):
        return _in_one_line(str(error)), error.exit_code
    if isinstance(error, KeyboardInterrupt):
        return str(Cancelled()), Cancelled.exit_code
    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        reason = error.strerror or str(error) or type(error).__name__
        return _in_one_line(f"{place}{reason}"), SceneError.exit_code
    if isinstance(error, MemoryError):
        return (
            "out of memory: export at a smaller --resolution, or close other programs",
            SceneError.exit_code,
        )
    said = f": {error}" if str(error) else ""
    return (
        _in_one_line(
            f"a fault of AA Resolve, not of your scene: {type(error).__name__}{_place(error)}{said} "
            f"(report it with the lines that {TRACEBACK_VARIABLE}=1 adds)"
        ),
        9,
    )


def trace_of(error: BaseException) -> str:
    """The whole traceback where the environment asks for it, else nothing."""
    if not os.environ.get(TRACEBACK_VARIABLE):
        return ""
    return "".join(traceback.format_exception(type(error), error, error.__traceback__))


def _place(error: BaseException) -> str:
    """File and line of this package where an exception was last seen."""
    ours = [
        entry
        for entry in traceback.extract_tb(error.__traceback__)
        if entry.filename.startswith(_ROOM)
    ]
    if not ours:
        return ""
    return f" in {os.path.relpath(ours[-1].filename, _ROOM)}:{ours[-1].lineno}"


def _in_one_line(text: str) -> str:
    return " ".join(text.split())
