# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene may contain, by Blender's own lists, and what becomes of it in a shot.

docs/scenes.md is written from this table (blender_addon/write_scenes_page.py), and a test asks every Blender whether it
knows a type, a modifier or a setting that the table does not. Knows no Blender itself."""

from __future__ import annotations

from . import feature_rows, setting_rows
from .feature import HANDLED, NOTED, NOTHING, REFUSED, SHOWN, Feature

FEATURES: tuple[Feature, ...] = feature_rows.ROWS + setting_rows.ROWS

TITLES = {
    "object": "Objects",
    "modifier": "Modifiers",
    "physics": "Physics",
    "light": "Lights",
    "camera": "Cameras",
    "setting": "Settings that can be keyed",
    "file": "Files, scripts and everything else",
}


def feature_of(kind: str, name: str) -> Feature | None:
    """The row of one of Blender's identifiers; of several the first."""
    return next((row for row in FEATURES if row.kind == kind and row.covers(name)), None)


def page() -> str:
    """docs/scenes.md."""
    lines = [
        "# What your scene may contain",
        "",
        "Written by `blender_addon/write_scenes_page.py`; a test compares the table with the lists of each Blender.",
        "The file is never changed: everything below happens in the copy that the export has open.",
        "",
        f"**{SHOWN}**: all passes are right without further ado. **{HANDLED}**: the export changes something so that they",
        f"are. **{NOTED}**: exported, and a line of the export says what is different. **{REFUSED}**: no shot is made and",
        f"the program ends with exit code 3. **{NOTHING}**: such a picture does not show it.",
    ]
    for kind, title in TITLES.items():
        lines += ["", f"## {title}", "", "| what | | how |", "|---|---|---|"]
        for row in FEATURES:
            if row.kind == kind:
                names = row.names if kind == "file" else f"`{'` `'.join(row.names.split())}`"
                lines.append(f"| {names} | {row.treatment} | {row.what} |")
    return "\n".join(lines) + "\n"
