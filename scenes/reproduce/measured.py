# SPDX-License-Identifier: MIT
"""The command line of pages whose figures are measured in pieces: PROGRAM OUT DOCS [--pieces N] | --page-only DOCS."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Callable

# (program, out, docs, pieces at most): writes the document to docs and returns True when no piece is missing.
Measure = Callable[[Path, Path, Path, "int | None"], bool]


def main(
    argv: list[str], about: str, name: str, measure: Measure, write: Callable[[dict, Path], None]
) -> int:
    """``name``: of the document DOCS/name.json, from which ``write`` makes the page."""
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("places", nargs="+", type=Path, metavar="PROGRAM OUT DOCS")
    parser.add_argument("--pieces", type=int, help="measurements now; all of them without it")
    parser.add_argument("--page-only", action="store_true", help=f"from {name}.json as it is")
    a = parser.parse_args(argv)
    docs = a.places[-1]
    if not a.page_only:
        program, out, _ = a.places
        if not measure(program.resolve(), out.resolve(), docs, a.pieces):
            print("more to measure: call again")
            return 0
    write(json.loads((docs / f"{name}.json").read_text()), docs)
    return 0


def write_document(docs: Path, name: str, content: dict) -> None:
    document = {"format": f"aaresolve-{name}", "version": 1, **content}
    (docs / f"{name}.json").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
