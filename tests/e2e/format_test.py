"""docs/format.md holds: what is written fits the schemas in docs/schema, and what does not fit them is refused.

The schemas are read by the checker beside this file, and by python3-jsonschema as well where a Python has it.
"""

from __future__ import annotations

import copy
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

from json_schema import Schema
from program import ROOT, ProgramTest, in_blender, main, run_blender

SECOND_OPINION = """
import json, sys, jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
errors = sorted(jsonschema.Draft202012Validator(schema).iter_errors(json.load(open(sys.argv[2]))), key=str)
sys.exit(errors[0].message[:200] if errors else 0)
"""


def python_with(*modules: str) -> str | None:
    """A Python that has these modules: this one, or the system's."""
    for python in (sys.executable, "/usr/bin/python3"):
        check = [python, "-c", "import " + ", ".join(modules)]
        if Path(python).exists() and not subprocess.run(check, capture_output=True).returncode:
            return python
    return None


JSONSCHEMA = python_with("jsonschema")


class Format(ProgramTest):
    def schema(self, name: str) -> Path:
        return ROOT / f"docs/schema/{name}.schema.json"

    def faults(self, name: str, document: Path) -> list[str]:
        found = Schema(json.loads(self.schema(name).read_text())).faults(
            json.loads(document.read_text())
        )
        if JSONSCHEMA:
            other = subprocess.run(
                [JSONSCHEMA, "-c", SECOND_OPINION, self.schema(name), document],
                capture_output=True,
                text=True,
            )
            self.assertEqual(bool(found), bool(other.returncode), f"{found[:3]} {other.stderr}")
        return found

    def fits(self, name: str, document: Path) -> None:
        self.assertEqual(self.faults(name, document)[:5], [], document)

    def test_shots_and_results_fit(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("two_planes", shot, (40, 24), 4, "--subsamples", "d3d4", "--subsample-color")
        self.fits("shot", shot / "shot.json")
        options = ("--metrics", "flip", "--maps", "error", "--region", "4,4,30,18", "-q")
        methods = (
            "-m",
            "noaa",
            "-m",
            "uncharted:kmin=0.5+fill=fxaa311",
            "-m",
            "uncharted",
            "-m",
            "msaa",
        )
        self.aaresolve("run", shot, *methods, *options, "-o", out)
        self.fits("results", out / "results.json")
        moving = self.folder / "moving"
        self.synth("moving", moving, (40, 24), 8, "--jitter", "none")
        self.fits("shot", moving / "shot.json")
        self.aaresolve("run", moving, "-m", "noaa", "-m", "karis", "-o", out, "-q", "--quantise", 8)
        self.fits("results", out / "results.json")
        self.aaresolve(
            "run", moving, "-m", "noaa", "-m", "karis", "-o", out, "-q", "--reference", "noaa"
        )
        self.fits("results", out / "results.json")
        vary = ("--vary", "alpha=0.1,0.2", "--with", "noaa")
        self.aaresolve("sweep", moving, "-m", "karis", *vary, "-o", out, "-q")
        self.fits("results", out / "results.json")

    def test_what_bench_measured_fits_and_names_the_machine(self) -> None:
        file = self.folder / "bench.json"
        size = ("--size", "48x32", "--size", "32x16", "--frames", 2, "--repeats", 1)
        said = self.aaresolve("bench", "-m", "noaa,karis", *size, "--every-isa", "--json").stdout
        file.write_text(said)
        self.fits("bench", file)
        bench = json.loads(said)
        sets = bench["machine"]["instructionSets"]
        self.assertTrue(bench["machine"]["processor"])
        self.assertEqual(
            [(r["method"], r["instructionSet"], r["resolution"]) for r in bench["methods"]],
            [(m, s, r) for r in ([48, 32], [32, 16]) for m in ("noaa", "karis") for s in sets],
        )
        for row in bench["methods"]:
            times = [row[f"nsPerPixel{which}"] for which in ("Min", "Low", "", "High")]
            self.assertEqual(times, sorted(times))
            self.assertGreater(row["wallNsPerPixel"], 0)
        errors = {(*r["resolution"], r["method"], r["maxError"]) for r in bench["methods"]}
        self.assertEqual(len(errors), 4, "every instruction set gives the same bits")
        for change in ({"load": {"processors": 2}}, {"machine": None}, {"threads": 0}):
            file.write_text(json.dumps(bench | change))
            self.assertTrue(self.faults("bench", file), change)
        small = ("bench", "-m", "noaa", "--size", "8x8")
        times_alone = json.loads(self.aaresolve(*small, "--no-error", "--json").stdout)
        self.assertNotIn("maxError", times_alone["methods"][0])
        self.refused(2, *small, "--every-isa", "--isa", "v2", says=("--isa",))
        self.refused(2, *small, "--no-error", "--markdown", says=("--no-error",))

    def test_an_export_fits(self) -> None:
        scene = self.folder / "scene.py"
        scene.write_text(
            "import bpy\nbpy.ops.wm.save_as_mainfile(filepath=%r)\n" % str(self.folder / "s.blend")
        )
        if not shutil.which(in_blender.blender()):
            self.skipTest("no Blender here: the exporter's shot.json is not looked at")
        made = run_blender("--factory-startup", "-P", scene)
        self.assertEqual(made.returncode, 0, made.stderr)
        shot = self.folder / "shot"
        exported = run_blender(
            self.folder / "s.blend",
            "-P",
            ROOT / "blender_addon/aa_resolve/headless.py",
            "--",
            *("--out", shot, "--resolution", "16x12", "--frames", "1-2", "--truth-samples", 2),
        )
        self.assertEqual(exported.returncode, 0, exported.stdout + exported.stderr)
        self.fits("shot", shot / "shot.json")

    def test_what_does_not_fit_is_refused(self) -> None:
        """The schema and the program agree on what is no shot."""
        shot = self.folder / "shot"
        self.synth("moving", shot, (16, 12), 3, "--subsamples", "d3d2")
        good = json.loads((shot / "shot.json").read_text())
        changes = {
            "format": lambda j: j.update(format="shot"),
            "version": lambda j: j.update(version=2),
            "resolution": lambda j: j.update(resolution=[16]),
            "resolution[1]": lambda j: j.update(resolution=[16, 0]),
            "fps": lambda j: j.update(fps="24"),
            "static": lambda j: j.update(static=1),
            "jitter.sequence": lambda j: j["jitter"].pop("sequence"),
            "jitter.period": lambda j: j["jitter"].update(period=0),
            "subsamples.positions": lambda j: j["subsamples"].pop("positions"),
            "frames": lambda j: j.update(frames=[]),
            "frames[1].file": lambda j: j["frames"][1].update(file="../x.exr"),
            "frames[0].frame": lambda j: j["frames"][0].pop("frame"),
            "frames[2].jitter": lambda j: j["frames"][2].update(jitter=[0.7, 0]),
            "frames[0].camera.view": lambda j: j["frames"][0]["camera"].update(view=[1] * 15),
            "frames[0].camera.kind": lambda j: j["frames"][0]["camera"].update(kind="fisheye"),
            "truth.halves": lambda j: j["truth"].update(halves=3),
        }
        for name, change in changes.items():
            with self.subTest(name):
                bad = copy.deepcopy(good)
                change(bad)
                (shot / "shot.json").write_text(json.dumps(bad))
                self.assertTrue(self.faults("shot", shot / "shot.json"), name)
                self.refused(3, "check", shot, "-q", says=(name.split("[")[0].split(".")[-1],))

    def test_the_page_shows_what_holds(self) -> None:
        """Its examples fit the schemas, and its tables name every member that a layout has."""
        page = (ROOT / "docs/format.md").read_text()
        examples = [json.loads(block) for block in re.findall(r"```json\n(.*?)```", page, re.S)]
        self.assertEqual(len(examples), 2)
        for name, example in zip(("shot", "layout"), examples):
            file = self.folder / f"{name}.json"
            file.write_text(json.dumps(example))
            self.fits(name, file)
        layout = json.loads(self.schema("layout").read_text())
        for part in ("depth", "motion", "normal"):
            for member in layout["$defs"][part]["properties"]:
                self.assertRegex(page, rf"`(\w+\.)?{member}`|\b{member}`", f"{part}.{member}")

    def test_the_example_writes_a_shot(self) -> None:
        python = python_with("numpy", "OpenImageIO")
        if not python:
            self.skipTest("no Python with numpy and OpenImageIO: the example is not run")
        shot, out = self.folder / "shot", self.folder / "out"
        script = ROOT / "docs/examples/write_shot.py"
        done = subprocess.run([python, script, shot], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.fits("shot", shot / "shot.json")
        self.assertIn("clean", self.aaresolve("check", shot, "-q").stdout)
        # The commands that its head shows.
        methods = re.search(r"aaresolve run SHOT (.*) -o OUT", script.read_text())[1].split()
        self.aaresolve("run", shot, *methods, "-o", out, "-q")
        psnr = {
            m["id"]: m["pooled"]["psnr"]
            for m in json.loads((out / "results.json").read_text())["methods"]
        }
        self.assertGreater(psnr["fxaa311"], psnr["noaa"] + 2)
        self.assertGreater(psnr["salvi"], psnr["noaa"] + 1.5)

    def test_an_engines_frames_become_the_same_shot(self) -> None:
        """A synthetic shot, described as if an engine had written it, gives the figures that it gave."""
        engine, shot = self.folder / "engine", self.folder / "shot"
        self.synth("moving", engine, (48, 32), 6)
        source = {"files": "frames/{frame}.exr"}
        layout = {
            "format": "aaresolve-frames",
            "version": 1,
            "name": "moving",
            "passes": {
                "color": source,
                "depth": {**source, "kind": "planar"},
                "object": source,
                "motion": {
                    **source,
                    "channels": ["motion.X", "motion.Y"],
                    "units": "px",
                    "means": "current-previous",
                    "y": "down",
                },
            },
            "centre": {"color": {"files": "centre/{frame}.exr"}},
            "truth": {half: {"files": "truth/{frame}.exr", "part": half} for half in ("a", "b")},
            "frames": json.loads((engine / "shot.json").read_text())["frames"],
        }
        layout["truth"].update(filter="box", filter_width=1)
        # A truth that is exact has equal halves, which an import of two would refuse.
        del layout["truth"]["b"]
        file = self.folder / "layout.json"
        file.write_text(json.dumps(layout))
        self.fits("layout", file)
        said = self.aaresolve("import", engine, "--layout", file, "-o", shot, "-q").stdout
        self.assertIn("6 imported, 0 kept", said)
        self.assertIn(
            "0 imported, 6 kept",
            self.aaresolve("import", engine, "--layout", file, "-o", shot, "-q").stdout,
        )
        self.fits("shot", shot / "shot.json")
        self.aaresolve("check", shot, "-q")
        figures = []
        for folder in (engine, shot):
            self.aaresolve(
                "run", folder, "-m", "noaa", "-m", "karis", "-o", self.folder / "out", "-q"
            )
            results = json.loads((self.folder / "out/results.json").read_text())
            figures.append(
                [(m["pooled"]["mse"], m["temporal"]["flickerMoving"]) for m in results["methods"]]
            )
        self.assertEqual(figures[0], figures[1])
        for change, fault in (
            (lambda j: j["passes"]["depth"].pop("kind"), "passes.depth.kind: expected planar"),
            (
                lambda j: j["passes"]["motion"].update(unit="px"),
                "unknown member 'unit'; did you mean 'units'?",
            ),
        ):
            bad = copy.deepcopy(layout)
            change(bad)
            file.write_text(json.dumps(bad))
            self.assertTrue(self.faults("layout", file))
            self.refused(
                3, "import", engine, "--layout", file, "-o", self.folder / "n", says=(fault,)
            )
        self.aaresolve("import", engine, "--layout", file, "-o", shot, "--static", expect=2)


if __name__ == "__main__":
    if not JSONSCHEMA:
        print("python3-jsonschema is missing: the schemas are read by the tests' own checker alone")
    main()
