# SPDX-License-Identifier: GPL-3.0-or-later
"""The two kinds of failure that a user can cause, with their exit codes."""

from __future__ import annotations


class UsageError(Exception):
    """The command asks for something that does not exist or contradicts itself."""

    exit_code = 2


class SceneError(Exception):
    """The scene or a file cannot serve as asked; the message says what was found and what to do."""

    exit_code = 3


class Cancelled(Exception):
    """The user stopped the work; finished frames stay valid."""

    exit_code = 1
