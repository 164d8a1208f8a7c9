# SPDX-License-Identifier: MIT
"""Markdown pages: headings, sentences, tables."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Iterable


class Page:
    """One page of docs/results, written at once under a temporary name."""

    def __init__(self, title: str) -> None:
        self.lines = [f"# {title}", ""]

    def say(self, *sentences: str) -> None:
        """A paragraph."""
        self.lines += [" ".join(s for s in sentences if s), ""]

    def heading(self, text: str) -> None:
        self.lines += [f"## {text}", ""]

    def points(self, items: Iterable[str]) -> None:
        self.lines += [*(f"- {item}" for item in items), ""]

    def picture(self, file: str, text: str) -> None:
        self.lines += [f"![{text}]({file})", ""]

    def table(self, head: list[str], rows: list[list[str]]) -> None:
        """First column left, the others right-aligned."""
        align = ["---"] + ["---:"] * (len(head) - 1)
        for row in [head, align, *rows]:
            self.lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |")
        self.lines.append("")

    def write(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_suffix(f".{os.getpid()}.tmp")
        temporary.write_text("\n".join(self.lines).rstrip() + "\n", encoding="utf-8")
        temporary.replace(path)


def code(method: str) -> str:
    return f"`{method}`"
