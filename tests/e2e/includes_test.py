"""The rooms of the program: which folder may include which, read from the includes, and no cycle among files."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from graph import cycles_of
from program import ROOT, ProgramTest, main

# From the lowest room to the highest; a file includes its own room and lower ones.
ROOMS = (
    "kernels",
    "formats",
    "documents",
    "image",
    "shot",
    "shot/synth",
    "shot/import",
    "shot/check",
    "metrics",
    "methods",
    "methods/reference",
    "methods/spatial",
    "methods/geometry",
    "methods/temporal",
    "methods/stages",
    "gpu",
    "gpu/forms/reference",
    "gpu/forms/spatial",
    "gpu/forms/geometry",
    "gpu/forms/temporal",
    "study",
    "report/web",
    "report",
    "cli",
)
# Lists of everything in the rooms above them: they are known by their functions alone.
LISTS = {"methods/registry.cpp", "methods/stage.cpp"}


def includes_of(file: Path) -> list[str]:
    return re.findall(r'^#include "([^"]+)"', file.read_text(encoding="utf-8"), re.MULTILINE)


def room_of(path: str) -> str:
    return str(Path(path).parent)


def complaints(folder: Path) -> list[str]:
    """One line per include that runs upward, per unknown room and per cycle."""
    found: list[str] = []
    graph: dict[str, list[str]] = {}
    files = [f for f in sorted(folder.rglob("*")) if f.suffix in (".h", ".cpp")]
    for file in files:
        name = str(file.relative_to(folder))
        graph[name] = [i for i in includes_of(file) if (folder / i).exists()]
        if name.endswith("_test.cpp") or re.search(
            r"_(testing|test_frames|reference)\.h$|methods_under_test\.h$", name
        ):
            continue  # tests may see everything
        if room_of(name) not in ROOMS:
            found.append(f"{name}: its folder is no room of {__file__}")
            continue
        for include in graph[name]:
            if room_of(include) not in ROOMS or name in LISTS:
                continue
            if ROOMS.index(room_of(include)) > ROOMS.index(room_of(name)):
                found.append(f"{name}: includes {include}, of a higher room")
    return found + [f"cycle: {' -> '.join(cycle)}" for cycle in cycles_of(graph)]


class Includes(ProgramTest):
    def test_run_downward_and_in_no_circle(self) -> None:
        self.assertEqual(complaints(ROOT / "resolver"), [])

    def test_a_wrong_one_is_named(self) -> None:
        copy = self.folder / "resolver"
        shutil.copytree(ROOT / "resolver", copy)
        lower = copy / "image/plane.h"
        lower.write_text('#include "study/run.h"\n' + lower.read_text())
        said = complaints(copy)
        self.assertTrue(any("image/plane.h: includes study/run.h" in line for line in said), said)
        self.assertTrue(any(line.startswith("cycle: ") for line in said), said)


main()
