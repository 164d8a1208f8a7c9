"""Metrics that need a viewer: where they are seen is chosen, stated, and the same in `run` and `compare`."""

from __future__ import annotations

import csv
import json
import shutil

from program import ProgramTest, main


class Perceptual(ProgramTest):
    def run_shot(self, scene: str, *options: object) -> dict:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth(scene, shot, (96, 64), 6)
        self.said = self.aaresolve("run", shot, "-o", out, "-q", *options).stdout
        self.out = out
        return json.loads((out / "results.json").read_text())

    def compared(self, *options: object) -> dict:
        folders = (self.out / "noaa", self.out / "truth")
        return json.loads(self.aaresolve("compare", *folders, "--json", *options).stdout)

    def test_a_run_states_where_it_was_seen(self) -> None:
        options = (
            "-m noaa -m karis --write-frames all --maps cvvdp --metrics flip,hdrFlip --flip-ppd 40"
        )
        seen = ("--metric-display", "standard_fhd", "--metric-fps", 60)
        results = self.run_shot("moving", *options.split(), *seen)
        shown = results["run"]["shownOn"]
        self.assertEqual((shown["display"], shown["framesPerSecond"]), ("standard_fhd", 60))
        self.assertAlmostEqual(shown["pixelsPerDegree"], 37.8, delta=0.1)
        self.assertEqual(results["run"]["flipPixelsPerDegree"], 40)
        self.assertIn("JOD as seen on standard_fhd (24-inch Full HD monitor", self.said)
        self.assertIn("60 frames per second", self.said)
        self.assertIn("FLIP as seen at 40 pixels per degree", self.said)
        for method in results["methods"]:
            frames = [f["metrics"]["cvvdp"] for f in method["frames"]]
            self.assertEqual(len(frames), 6)
            jod = method["pooled"]["cvvdp"]
            # Of all frames together: not their mean, and between the best and the worst.
            self.assertNotEqual(jod, sum(frames) / 6)
            self.assertTrue(min(frames) < jod < max(frames) < 10, (jod, frames))
            maps = sorted((self.out / "maps/cvvdp" / method["folder"]).iterdir())
            self.assertEqual(len(maps), 6)
            self.assertEqual(len({m.read_bytes() for m in maps}), 6)
        with (self.out / "results.csv").open() as file:
            pooled = [r for r in csv.DictReader(file) if r["frame"] == "pooled"]
        for row, method in zip(pooled, results["methods"]):
            self.assertAlmostEqual(float(row["cvvdp"]), method["pooled"]["cvvdp"], places=6)
        # The frames that it wrote say the same to `compare`, also at another distance.
        again = self.compared(
            "--metrics", "cvvdp,flip,hdrFlip,cvvdpTransient", *seen, "--flip-ppd", 40
        )
        noaa = results["methods"][0]["pooled"]
        for figure in ("cvvdp", "flip", "hdrFlip", "cvvdpTransient"):
            self.assertAlmostEqual(again["pooled"][figure], noaa[figure], places=4, msg=figure)
        self.assertEqual(again["shownOn"]["display"], "standard_fhd")
        usual = self.compared("--metrics", "cvvdp,flip")["pooled"]
        self.assertGreater(usual["cvvdp"], noaa["cvvdp"])
        self.assertLess(usual["flip"], noaa["flip"])
        page = self.folder / "report.html"
        self.aaresolve("report", self.out, "-o", page)
        self.assertIn("24-inch Full HD monitor", page.read_text())

    def test_a_static_shot_is_watched_as_a_whole(self) -> None:
        results = self.run_shot(
            "zone_plate", "-m", "karis", "--metrics", "cvvdp", "--write", "none"
        )
        method = next(m for m in results["methods"] if m["id"] == "karis")
        last = method["frames"][-1]["metrics"]
        self.assertEqual(method["pooled"]["psnr"], last["psnr"])
        self.assertNotEqual(method["pooled"]["cvvdp"], last["cvvdp"])
        self.assertEqual(results["run"]["shownOn"]["framesPerSecond"], 24)  # the shot's own

    def test_what_cannot_be_seen_is_refused(self) -> None:
        options = "-m noaa --metrics cvvdp --write exr,png --write-frames all"
        hdr = ("--metric-display", "standard_hdr_linear")
        results = self.run_shot("moving", *options.split(), *hdr)
        self.assertLess(results["methods"][0]["pooled"]["cvvdp"], 10)
        self.refused(
            2,
            *("run", self.folder / "shot", "-o", self.folder / "x", "-m", "noaa"),
            *("--metrics", "cvvdp", "--metric-display", "standard_fdh"),
            says=("standard_fdh", "did you mean 'standard_fhd'?"),
        )
        self.refused(
            2,
            *("run", self.folder / "shot", "-o", self.folder / "x", "-m", "noaa"),
            *("--metrics", "cvvdp", "--display", "identity", *hdr),
            says=("--metrics cvvdp", "linear light"),
        )
        codes = self.folder / "codes"
        codes.mkdir()
        for file in (self.out / "noaa").glob("*.png"):
            shutil.copy(file, codes)
        self.refused(
            2,
            *("compare", codes, codes, "--metrics", "cvvdp", *hdr),
            says=("linear light: two EXR files",),
        )
        shot = self.folder / "shot/shot.json"
        manifest = json.loads(shot.read_text())
        del manifest["frames"][3]["truth"]
        shot.write_text(json.dumps(manifest))
        self.refused(
            2,
            *("run", self.folder / "shot", "-o", self.folder / "x", "-m", "noaa"),
            *("--metrics", "cvvdp"),
            says=("--metrics cvvdp", "frame 4 has no truth"),
        )

    def test_figures_are_listed(self) -> None:
        listed = json.loads(self.aaresolve("list", "--metrics", "--json").stdout)
        by_name = {f["name"]: (m, f) for m in listed for f in m["figures"]}
        metric, figure = by_name["cvvdp"]
        self.assertTrue(metric["ofSequence"])
        self.assertEqual((figure["unit"], figure["better"]), ("JOD", "higher"))
        text = self.aaresolve("list", "--metrics").stdout
        for name in by_name:
            self.assertRegex(text, rf"(?m)^{name} ")
        self.refused(2, "list", "--metrics", "fxaa1", says=("leave out 'fxaa1'",))


main()
