"""The rooms of the add-on: which files may import which, read from the imports, wherever in a file they stand."""

from __future__ import annotations

import ast
import shutil
from pathlib import Path

from graph import cycles_of
from program import ROOT, ProgramTest, main

ADDON = ROOT / "blender_addon/aa_resolve"
# Room -> what its files may import beside each other: rooms, and files of the top.
MAY_IMPORT = {
    "scene": {"compat", "errors", "exr"},
    "passes": {"compat", "errors", "exr", "plan", "registry", "scene"},
}
# Files of the top -> rooms that they may import beside the top; all others know scene and passes.
TOP_MAY_IMPORT = {"__init__": {"panel"}}


def imports_of(file: Path, folder: Path) -> set[str]:
    """Files of the add-on (``scene/camera``) that a file imports, inside of functions as well."""
    here = file.relative_to(folder).with_suffix("").parts
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if not isinstance(node, ast.ImportFrom) or node.level == 0:
            continue
        base = [*here[: len(here) - node.level], *(node.module or "").split(".")]
        base = [part for part in base if part]
        for name in node.names:
            target = folder.joinpath(*base, name.name)
            if not base and not target.with_suffix(".py").exists() and not target.is_dir():
                continue  # a constant of __init__, which loads nothing else: test_the_entry_loads_nothing
            if target.with_suffix(".py").exists():
                found.add("/".join([*base, name.name]))
            elif (target / "__init__.py").exists():
                found.add("/".join([*base, name.name, "__init__"]))
            elif folder.joinpath(*base).is_dir():  # a name that the package itself holds
                found.add("/".join([*base, "__init__"]))
            else:
                found.add("/".join(base))
    return found


def room_of(file: str) -> str:
    return file.split("/")[0] if "/" in file else ""


def problems_of(folder: Path) -> list[str]:
    """One sentence per import that runs against the order of the rooms, and per cycle of files."""
    graph = {
        file.relative_to(folder).with_suffix("").as_posix(): imports_of(file, folder)
        for file in sorted(folder.rglob("*.py"))
    }
    problems = []
    for file, targets in graph.items():
        room = room_of(file)
        if room == "panel":
            continue
        for target in sorted(targets):
            to = room_of(target)
            if room:
                allowed = to == room or (to or target) in MAY_IMPORT[room]
            else:
                allowed = to in {"", "scene", "passes"} | TOP_MAY_IMPORT.get(file, set())
            if not allowed:
                problems.append(f"{file}.py imports {target}.py: not from '{room or 'the top'}'")
    return problems + [f"cycle of imports: {' -> '.join(cycle)}" for cycle in cycles_of(graph)]


class Rooms(ProgramTest):
    def test_imports_keep_the_order_of_the_rooms(self) -> None:
        self.assertEqual(problems_of(ADDON), [])

    def test_every_room_is_read(self) -> None:
        """The reading of imports finds them, and no room is without a rule."""
        rooms = {path.name for path in ADDON.iterdir() if (path / "__init__.py").exists()}
        self.assertEqual(rooms, {*MAY_IMPORT, "panel"})
        self.assertIn("passes/exposure", imports_of(ADDON / "picture.py", ADDON))
        self.assertIn("scene/camera", imports_of(ADDON / "passes/motion.py", ADDON))
        self.assertIn(
            "panel/__init__", imports_of(ADDON / "__init__.py", ADDON), "inside of a function"
        )

    def test_the_entry_loads_nothing(self) -> None:
        """What any file may ask of __init__ is there before it imports: it does so inside of functions only."""
        top = ast.parse((ADDON / "__init__.py").read_text()).body
        loaded = [node for node in top if isinstance(node, (ast.Import, ast.ImportFrom))]
        self.assertEqual([node.module for node in loaded], ["__future__"])

    def test_what_runs_backwards_is_named(self) -> None:
        """For each rule an import that breaks it."""
        for number, (file, line, says) in enumerate(
            (
                (
                    "scene/camera.py",
                    "from ..panel import job",
                    "scene/camera.py imports panel/job.py",
                ),
                (
                    "scene/camera.py",
                    "from ..passes.table import TABLE",
                    "scene/camera.py imports passes/table.py",
                ),
                (
                    "scene/shapes.py",
                    "from .. import registry",
                    "scene/shapes.py imports registry.py",
                ),
                (
                    "passes/color.py",
                    "def f():\n    from ..panel import job",
                    "passes/color.py imports panel/job.py",
                ),
                ("export.py", "from .panel.job import Job", "export.py imports panel/job.py"),
                ("passes/base.py", "from .table import TABLE", "passes/base -> passes/table"),
                ("errors.py", "from . import compat\nfrom .exr import Part", "exr -> errors"),
            )
        ):
            folder = self.folder / str(number)
            shutil.copytree(ADDON, folder)
            with (folder / file).open("a") as source:
                source.write(f"\n{line}\n")
            self.assertIn(says, "\n".join(problems_of(folder)))


main()
