# SPDX-License-Identifier: GPL-3.0-or-later
"""One row of the table of what a scene may contain."""

from __future__ import annotations

import fnmatch
from dataclasses import dataclass

SHOWN = "as rendered"  # the shot holds it as Cycles shows it, all passes are right
HANDLED = "handled"  # the exporter changes it in memory, so that all passes are right
NOTED = "noted"  # exported, and a sentence says what is different
REFUSED = "refused"  # nothing is exported, exit code 3
NOTHING = "no effect"  # not in a picture of Cycles without compositor


@dataclass(frozen=True)
class Feature:
    """One row. ``names`` are Blender's identifiers, or patterns of them; ``by`` is the function that sees to it."""

    kind: str
    names: str
    treatment: str
    what: str
    by: str = ""

    def covers(self, name: str) -> bool:
        return any(fnmatch.fnmatchcase(name, pattern) for pattern in self.names.split())
