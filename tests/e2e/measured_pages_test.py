"""Pages of what was measured follow from their files, which name machine, instruction sets and load; and a machine without a
device for shaders keeps the columns that another one measured."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys

from json_schema import Schema
from program import ROOT, ProgramTest, main

sys.path.insert(0, str(ROOT / "tests/gpu"))
sys.path.insert(0, str(ROOT / "scenes/reproduce"))

import keep_columns  # noqa: E402
import speed  # noqa: E402

RESULTS = ROOT / "docs/results"


class MeasuredPages(ProgramTest):
    def page_of(self, script: str, *names: str) -> str:
        docs = self.folder / "docs"
        docs.mkdir()
        for name in names:
            shutil.copy(RESULTS / name, docs)
        command = [sys.executable, ROOT / script, "--page-only", docs]
        done = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return (docs / names[0].replace(".json", ".md")).read_text()

    def test_speed(self) -> None:
        page = self.page_of("scenes/reproduce/speed.py", "speed.json")
        self.assertEqual(page, (RESULTS / "speed.md").read_text(), "make docs")
        schema = Schema(json.loads((ROOT / "docs/schema/bench.schema.json").read_text()))
        calls = json.loads((RESULTS / "speed.json").read_text())["calls"]
        for call in calls:
            self.assertEqual(schema.faults(call), [])
            self.assertIn(call["machine"]["processor"], page)
            self.assertEqual(call["methods"][0]["method"], "noaa")
        # A ratio is to the copy of its own call, whatever other calls measured.
        row = calls[0]["methods"][-1]
        sets = calls[0]["machine"]["instructionSets"]
        calls[1]["methods"][len(sets) - 1]["nsPerPixel"] *= 100
        said = "\n".join(speed.page_of({"calls": calls}).lines)
        base = calls[0]["methods"][len(sets) - 1]["nsPerPixel"]
        line = next(w for w in said.splitlines() if w.startswith(f"| `{row['method']}` |"))
        self.assertEqual(
            line.split("|")[2 * len(sets) + 1].strip(), f"{row['nsPerPixel'] / base:.1f}"
        )

    def test_growth(self) -> None:
        page = self.page_of("tests/bench/growth.py", "growth.json")
        self.assertEqual(page, (RESULTS / "growth.md").read_text(), "make docs")

    def test_costs_of_the_full_study(self) -> None:
        study = ROOT / "docs/farm.md"
        shutil.copy(study, self.folder)
        page = self.page_of("scenes/farm/costs.py", "farm-costs.json")
        self.assertEqual(page, (RESULTS / "farm-costs.md").read_text(), "make docs")
        self.assertEqual((self.folder / "farm.md").read_text(), study.read_text(), "make docs")

    def test_columns_of_shaders_are_kept(self) -> None:
        small = "--size 48x27 --frames 8 --long-frames 128 -q --markdown --device cpu".split()
        new = self.aaresolve("stability", "-m", "noaa,fxaa311", *small).stdout
        self.assertNotIn("GPU exact", new)
        before = (RESULTS / "stability.md").read_text()
        page = keep_columns.merged(before, new)
        device = keep_columns.MEASURED.search(before)[0]
        self.assertIn(device + " Measured earlier", page)
        columns = keep_columns.columns_of(page)
        self.assertEqual(columns["`fxaa311`"], keep_columns.columns_of(before)["`fxaa311`"])
        self.assertEqual(keep_columns.merged(page, new), page)
        self.assertEqual(keep_columns.merged(before, before), before, "a device has measured")
        self.assertEqual(keep_columns.merged("", new), new)


main()
