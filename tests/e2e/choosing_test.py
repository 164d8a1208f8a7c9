"""Methods by name, by set and with commas, in every command that takes them; what a shot can run; noaa beside others."""

from __future__ import annotations

import json
import os

from program import ProgramTest, main

FAMILIES = ("reference", "spatial", "geometry", "temporal")


class Choosing(ProgramTest):
    def texts(self, out: object) -> list[str]:
        return [m["text"] for m in json.loads((out / "results.json").read_text())["methods"]]

    def known(self, *words: str) -> list[dict]:
        return json.loads(self.aaresolve("list", "--json", *words).stdout)["methods"]

    def test_run_takes_commas_and_sets_and_adds_noaa(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth(
            "moving", shot, (48, 32), 2, "--for", "fxaa311,uncharted:kmin=0.9,clipTarget=mean"
        )
        variant = "uncharted:kmin=0.9,clipTarget=mean"
        chosen = ("-m", f"fxaa311,{variant}", "-m", "mlaa")
        done = self.aaresolve("run", shot, *chosen, "-o", out)
        self.assertEqual(self.texts(out), ["noaa", "fxaa311", variant, "mlaa"])
        self.assertIn("noaa is run as well", done.stderr)
        done = self.aaresolve("run", shot, *chosen, "-o", self.folder / "bare", "-q", "--no-noaa")
        self.assertEqual(self.texts(self.folder / "bare"), ["fxaa311", variant, "mlaa"])
        self.assertNotIn("noaa", done.stderr)
        done = self.aaresolve("run", shot, "-m", "mlaa,noaa", "-o", self.folder / "named")
        self.assertEqual(self.texts(self.folder / "named"), ["mlaa", "noaa"])
        self.assertNotIn("as well", done.stderr)

    def test_what_a_shot_can_run(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (48, 32), 2, "--for", "taaSimplest,fxaa311")
        listed = json.loads(self.aaresolve("list", "--json", "--shot", shot).stdout)["methods"]
        why = {m["id"]: m["whyNot"] for m in listed}
        self.assertEqual(why["taaSimplest"], "")
        self.assertIn("depth", why["uncharted"])
        self.assertIn("at the pixel centres lack", why["msaa"])
        self.assertIn("subsamples", why["msaa"])
        self.assertTrue(
            why["accum"].startswith("averages the frames of a static shot"), why["accum"]
        )
        can = [name for name, reason in why.items() if not reason]
        shown = self.aaresolve("list", "--shot", shot).stdout
        self.assertIn(f"{shot} can run {len(can)} of {len(why)} methods", shown)
        done = self.aaresolve("run", shot, "-m", "runnable", "-o", out, "-q", "--write", "none")
        self.assertEqual(self.texts(out), can)
        self.assertIn("accum", done.stderr)
        self.aaresolve("run", shot, "-m", "runnable:temporal", "-o", self.folder / "t", "-q")
        temporal = [m["id"] for m in self.known("temporal") if m["id"] in can]
        self.assertEqual(self.texts(self.folder / "t"), ["noaa", *temporal])
        said = ("'temporal' holds", "uncharted", "runnable:temporal", "list --shot")
        self.refused(3, "run", shot, "-m", "temporal", "-o", out, says=said)
        said = ("'msaa'", "at the pixel centres", "subsamples", "--for msaa")
        self.refused(3, "run", shot, "-m", "msaa", "-o", out, says=said)
        self.assertEqual(self.texts(out), can, "a refusal must leave the results as they were")

    def test_the_check_of_a_shot_tells_its_two_samplings_apart(self) -> None:
        shot = self.folder / "shot"
        self.synth("moving", shot, (48, 32), 2, "--for", "uncharted,fxaa311")
        self.assertIn("motion; at the pixel centres: color", self.aaresolve("check", shot).stdout)

    def test_every_other_command_takes_them_too(self) -> None:
        shot = self.folder / "shot"
        self.synth("moving", shot, (48, 32), 2, "--for", "spatial,karis")
        plan = json.loads(
            self.aaresolve("plan", "--json", "noaa,uncharted:kmin=0.9", "mlaa").stdout
        )
        self.assertEqual(list(plan["methods"]), ["noaa", "uncharted:kmin=0.9", "mlaa"])
        self.assertEqual(plan["passes"], ["color", "depth", "motion"])
        size = ("--size", "48x32", "--frames", "2", "--repeats", "1")
        timed = json.loads(self.aaresolve("bench", "-m", "noaa,fxaa311", *size, "--json").stdout)
        self.assertEqual([r["method"] for r in timed["methods"]], ["noaa", "fxaa311"])
        self.aaresolve("bench", "-m", "runnable:spatial", "--shot", shot, "--repeats", "1")
        samples = self.folder / "samples"  # without a colour of whole pixels
        pattern = ("--subsamples", "d3d4", "--subsample-color")
        self.synth("moving", samples, (48, 32), 2, *pattern, "--for", "smaa4x")
        self.aaresolve("bench", "-m", "smaa4x", "--shot", samples, "--repeats", "1")
        small = ("--size", "24x24", "--angles", "4", "--offsets", "1", "--json")
        study = json.loads(self.aaresolve("angles", "-m", "noaa,mlaa", *small).stdout)
        self.assertEqual([m["text"] for m in study["methods"]], ["noaa", "mlaa"])
        out = self.folder / "sweep"
        vary = ("--vary", "alpha=0.1,0.2", "-o", out, "-q", "--write", "none")
        self.aaresolve("sweep", shot, "-m", "karis,salvi", "--with", "noaa,mlaa", *vary)
        self.assertEqual(self.texts(out)[:3], ["noaa", "mlaa", "karis:alpha=0.1"])
        self.assertEqual(len(self.texts(out)), 6)
        self.refused(2, "filter", "noaa,mlaa", "a.png", "b.png", says=("one method",))
        self.refused(2, "plan", "runnable", says=("there is none here",))

    def test_tables_hold_what_was_measured(self) -> None:
        """No column of what was not measured, and MB of 10^6 bytes, by `bench` as by `run`."""
        size = ("--size", "480x270", "--frames", "1", "--repeats", "1")
        bench = ("bench", "-m", "smaa1x", *size)
        (whole,) = [r for r in json.loads(self.aaresolve(*bench, "--json").stdout)["methods"]]
        table = self.aaresolve(*bench, "--no-error").stdout
        self.assertNotIn("nan", table)
        self.assertNotIn("error", table)
        state = f"{whole['stateBytes'] / 1e6:.2f}"
        self.assertNotEqual(state, f"{whole['stateBytes'] / 2**20:.2f}")
        self.assertEqual(table.splitlines()[-1].split()[-2], state)
        self.assertIn("max error", self.aaresolve(*bench).stdout)
        plain = self.folder / "plain"
        self.synth("half_plane", plain, (16, 16), 1, "--offset", "1000", "--for", "noaa,smaa1x")
        told = self.aaresolve("bench", "-m", "noaa", "--shot", plain, "--repeats", "1").stdout
        self.assertIn("0.0 % edge pixels", told)
        self.assertNotIn("nan", told)
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (480, 270), 1, "--for", "smaa1x")
        table = self.aaresolve("run", shot, "-m", "smaa1x", "-o", out, "-q").stdout
        row = next(w for w in table.splitlines() if w.startswith("smaa1x")).split()
        self.assertEqual(row[-1], f"{self.method(out)['stateBytes'] / 1e6:.2f}")
        self.assertEqual(row[-2], f"{self.method(out)['inputBytes'] / 1e6:.2f}")

    def method(self, out: object) -> dict:
        methods = json.loads((out / "results.json").read_text())["methods"]
        return next(m for m in methods if m["id"] == "smaa1x")

    def test_list_finds_what_people_call_it(self) -> None:
        temporal = [m["id"] for m in self.known("temporal")]
        self.assertEqual([m["id"] for m in self.known("taa")], temporal)
        fxaa = [m["id"] for m in self.known("fxaa")]
        self.assertTrue(len(fxaa) > 2 and all(name.startswith("fxaa") for name in fxaa), fxaa)
        self.assertEqual([m["id"] for m in self.known("noaa,mlaa")], ["noaa", "mlaa"])
        self.assertEqual(sum(len(self.known(family)) for family in FAMILIES), len(self.known()))
        self.refused(2, "list", "qqqq", says=("unknown method 'qqqq'",))
        self.refused(2, "plan", "fxaa", says=("there are fxaa1, fxaa311", "aaresolve list fxaa"))

    def test_pictures_of_one_kind_only(self) -> None:
        shot = self.folder / "shot"
        self.synth("circles", shot, (48, 32), 2, "--for", "noaa")
        for kinds in ("png", "exr", "exr,png", "none"):
            out = self.folder / kinds
            self.aaresolve("run", shot, "-m", "noaa", "-o", out, "-q", "--write", kinds)
            found = {p.suffix for p in out.rglob("*") if p.suffix in (".png", ".exr")}
            self.assertEqual(
                found, set() if kinds == "none" else {f".{k}" for k in kinds.split(",")}
            )
            truth = json.loads((out / "results.json").read_text())["truth"].get("images", {})
            for image in truth.values() if isinstance(truth, dict) else truth:
                self.assertTrue(
                    (out / (image if isinstance(image, str) else image[1])).exists(), image
                )
        self.aaresolve("report", self.folder / "png")
        self.aaresolve("sheet", self.folder / "png")

    def test_paths_that_are_no_utf8(self) -> None:
        folder = os.fsencode(self.folder) + b"/caf\xe9"
        os.mkdir(folder)
        name = os.fsdecode(folder)
        self.synth("circles", self.folder / "shot", (48, 32), 1, "--for", "noaa")
        os.rename(self.folder / "shot", f"{name}/shot")
        any_bytes = {"errors": "replace"}  # of a path that is printed as it is
        self.aaresolve(
            "run", f"{name}/shot", "-m", "noaa", "-o", f"{name}/out", "-q", "--write", "png", **any_bytes
        )  # fmt: skip
        self.aaresolve(
            "run", f"{name}/shot", "-m", "noaa", "-o", f"{name}/out2", "-q", "--json", **any_bytes
        )
        images = [os.path.join(f"{name}/out/noaa", f) for f in os.listdir(f"{name}/out/noaa")]
        compared = json.loads(self.aaresolve("compare", images[0], images[0], "--json").stdout)
        self.assertIn("caf\ufffd", compared["a"])
        json.loads(self.aaresolve("check", f"{name}/shot", "--json").stdout)
        json.loads(self.aaresolve("list", "--shot", f"{name}/shot", "--json").stdout)
        self.aaresolve("report", f"{name}/out", **any_bytes)
        page = f"{name}/survey.html"
        self.aaresolve(
            "survey", "make", f"{name}/out", "-Q", "rating noaa", "-o", page, **any_bytes
        )
        with open(f"{name}/survey.key.json", encoding="utf-8") as key:
            json.load(key)


main()
