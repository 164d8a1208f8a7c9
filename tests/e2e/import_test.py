"""Frames as Blender writes them become a shot, and the shot equals what the add-on exports of the same scene."""

from __future__ import annotations

import json
from pathlib import Path

from program import ROOT, ProgramTest, main, run_blender


class Import(ProgramTest):
    def blender(self, *arguments: object) -> str:
        done = run_blender(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr[-2000:])
        return done.stdout

    def test_equals_the_export(self) -> None:
        blend, native, exported, imported = (
            self.folder / n for n in ("scene.blend", "native", "exported", "imported")
        )
        here = Path(__file__).parent
        headless = ("--factory-startup", "--python-exit-code", 9, "-P")
        self.blender(*headless, here / "import_scene.py", "--", blend, native)
        self.blender(
            blend, "--python-exit-code", 9, "-P", ROOT / "blender_addon/aa_resolve/headless.py", "--",
            "--out", exported, "--for", "noaa", "--passes", "albedo,depth,normal,object,motion", "--jitter", "none",
            "--frames", "1-3", "--truth-frames", "none", "--lighting", "as-is",
        )  # fmt: skip

        # A plain import: everything but what only the matrices tell.
        plain = json.loads(
            self.aaresolve(
                "import", native / "frames", "-o", self.folder / "plain", "-q", "--json"
            ).stdout
        )
        self.assertEqual(
            plain["passes"], ["color", "albedo", "depth", "normal", "object", "motion"]
        )
        self.assertEqual(plain["warnings"], [])
        self.assertFalse(plain["static"])
        self.aaresolve("check", self.folder / "plain", "-q")

        done = self.aaresolve(
            "import", native / "frames", "-o", imported, "--camera", exported / "shot.json",
            "--truth", native / "a", native / "b", "--truth-filter", "box:1", "--name", "small", "--fps", "25",
        )  # fmt: skip
        self.assertIn("import 3/3 frame 3", done.stderr)
        self.assertIn("no subsamples", done.stdout)
        self.assertIn("geometry", done.stdout)
        self.aaresolve("check", imported, "-q")
        manifest = json.loads((imported / "shot.json").read_text())
        self.assertEqual([f["frame"] for f in manifest["frames"]], [1, 2, 3])
        self.assertEqual(manifest["truth"]["samples_per_half"], 64)
        self.assertEqual((manifest["name"], manifest["fps"]), ("small", 25))

        said = self.blender(*headless, here / "import_compare.py", "--", exported, imported)
        apart = json.loads([line for line in said.splitlines() if line.startswith("{")][-1])
        self.assertGreater(apart["fastest"], 1, "nothing moved, so nothing was compared")
        self.assertGreater(
            apart["background"], 0.3, "the sky did not move, so its motion was not compared"
        )
        self.assertLess(apart["motion"], 1e-3)
        self.assertLess(apart["depth"], 1e-5)
        self.assertLess(apart["normal"], 1e-4)
        self.assertLess(apart["albedo"], 1e-4)
        # The exporter numbers objects by itself: one id of one shot is one id of the other.
        pairs = apart["pairs"]
        self.assertEqual(len(pairs), 4)
        self.assertEqual(len({a for a, _ in pairs}), 4)
        self.assertEqual(len({b for _, b in pairs}), 4)
        self.assertIn([0, 0], pairs)

        # And it can be used.
        out = self.folder / "out"
        self.aaresolve(
            "run", imported, "-m", "noaa", "-m", "fxaa311", "-m", "unchartedNorm", "-o", out, "-q"
        )
        results = json.loads((out / "results.json").read_text())
        self.assertTrue(all(m["pooled"]["psnr"] > 10 for m in results["methods"]))

        # A second call has nothing to do; Cryptomatte tells the same objects apart.
        again = json.loads(self.aaresolve(
            "import", native / "frames", "-o", imported, "--camera", exported / "shot.json",
            "--truth", native / "a", native / "b", "-q", "--json").stdout)  # fmt: skip
        self.assertEqual((again["imported"], again["kept"]), (0, 3))
        self.aaresolve(
            "import", native / "frames", "-o", self.folder / "crypto", "--ids", "cryptomatte", "-q"
        )
        names = json.loads((self.folder / "crypto/shot.json").read_text())["objects"].values()
        self.assertEqual(sorted(names), ["Cube", "Plane", "Sphere"])
        self.aaresolve("check", self.folder / "crypto", "-q")

        # What is not ours stays as it is.
        self.refused(2, "import", native / "frames", "-o", exported, says=("holds no import",))
        self.refused(
            2,
            "import",
            native / "frames",
            "-o",
            imported,
            "--view-layer",
            "Nope",
            says=("'ViewLayer'", "--view-layer"),
        )
        self.refused(3, "import", self.folder, "-o", self.folder / "none", says=("holds no EXR",))


main()
