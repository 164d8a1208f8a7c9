"""The page of `aaresolve stability --markdown`, with the shaders' columns of the page before where no device measured them.

usage: keep_columns.py PAGE < NEW_PAGE: writes PAGE

A machine without a Vulkan device leaves these columns out. They are then those of PAGE, with the name of the device that
they were measured on; a method that PAGE does not have gets "?".
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

COLUMNS = ("GPU exact", "GPU fast")
LEFT_OUT = re.compile(r"GPU forms left out: .*")
MEASURED = re.compile(r"GPU forms on .*?\.(?=\n| Measured)")


def cells(line: str) -> list[str]:
    return [c.strip() for c in line.strip().strip("|").split("|")]


def columns_of(page: str) -> dict[str, list[str]]:
    """By method the cells of the shaders' columns; the heads by "method"."""
    found: dict[str, list[str]] = {}
    places: list[int] | None = None
    for line in page.splitlines():
        if not line.startswith("|"):
            if found:
                return found
            places = None
            continue
        row = cells(line)
        if places is None and all(c in row for c in COLUMNS):
            places = [row.index(c) for c in COLUMNS]
        if places:
            found[row[0]] = [row[i] for i in places]
    return found


def merged(before: str, page: str) -> str:
    device, old = MEASURED.search(before), columns_of(before)
    if not LEFT_OUT.search(page) or not device or not old:
        return page
    page = LEFT_OUT.sub(
        lambda _: f"{device[0]} Measured earlier: where the rest was made there is no device.", page
    )
    lines, inside = [], False
    for line in page.splitlines():
        row = cells(line) if line.startswith("|") else []
        if row and "float lanes" in row:
            inside = True
        if inside and row:
            kept = old.get(row[0], ["?"] * len(COLUMNS))
            line = "| " + " | ".join([*row[:-1], *kept, row[-1]]) + " |"
            if set(row[0]) <= {"-", ":"}:
                line = "|" + "|".join([*row[:-1], *kept, row[-1]]) + "|"
        elif not row:
            inside = False
        lines.append(line)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    path = Path(sys.argv[1])
    text = merged(path.read_text(encoding="utf-8") if path.exists() else "", sys.stdin.read())
    path.write_text(text, encoding="utf-8")
