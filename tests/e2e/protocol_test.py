"""The protocols of `run` and `sweep`: one displayed space, a full history, 8-bit images; against figures computed here."""

from __future__ import annotations

import csv
import json
import math
from array import array
from pathlib import Path

import exr_pixels
from program import ProgramTest, main

FRAME = "000016"


def shown(values: list[float], scale: float = 1.0) -> list[float]:
    return [min(max(v * scale, 0.0), 1.0) for v in values]


def rounded(values: list[float]) -> list[float]:
    return [math.floor(255 * v + 0.5) / 255 for v in values]


def pixels(file: Path) -> list[float]:
    """All values, in the file's order: line by line, channel by channel."""
    return list(array("f", exr_pixels.parts_of(Path(file))[""]))


def psnr(test: list[float], truth: list[float]) -> float:
    return 10 * math.log10(len(test) / sum((t - r) ** 2 for t, r in zip(test, truth)))


class Protocol(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.count = 0

    def synth(self, scene: str, name: str, *more: object, frames: int = 16) -> Path:
        shot = self.folder / name
        self.aaresolve(
            "synth", scene, "-o", shot, "--size", "64x40", "--frames", frames, "-q", *more
        )
        return shot

    def run_shot(
        self, shot: Path, *methods: str, options: tuple = (), command: str = "run"
    ) -> Path:
        self.count += 1
        out = self.folder / f"out{self.count}"
        words = [w for m in methods for w in ("-m", m)]
        self.said = self.aaresolve(command, shot, *words, "-o", out, *options)
        return out

    def results(self, out: Path) -> dict:
        return json.loads((out / "results.json").read_text())

    def figures(self, out: Path) -> dict[str, float]:
        return self.figures_of(self.results(out))

    def figures_of(self, results: dict) -> dict[str, float]:
        return {m["text"]: m["pooled"]["psnr"] for m in results["methods"] if m["pooled"]}

    def test_identity_compares_the_clamped_values(self) -> None:
        shot = self.synth("circles", "shot", "--for", "noaa,accum")
        plain = self.run_shot(shot, "noaa", "accum")
        noaa, truth = pixels(plain / f"noaa/{FRAME}.exr"), pixels(plain / f"truth/{FRAME}.exr")
        self.assertGreater(
            abs(self.figures(plain)["noaa"] - psnr(noaa, truth)), 0.5, "sRGB is another space"
        )
        self.assertNotIn("clipped", self.results(plain)["truth"])
        for exposure in (0, 1):
            out = self.run_shot(
                shot,
                "noaa",
                "accum",
                options=("--display", "identity", "--exposure", exposure, "--write", "exr,png"),
            )
            t, r = shown(noaa, 2**exposure), shown(truth, 2**exposure)
            self.assertAlmostEqual(self.figures(out)["noaa"], psnr(t, r), 4)
            self.assertEqual(
                t, pixels(out / f"noaa/{FRAME}.exr"), "the EXR holds the displayed values"
            )
            self.assertEqual(r, pixels(out / f"truth/{FRAME}.exr"))
            n = len(truth) // 3
            clipped = sum(
                any(truth[c * n + i] * 2**exposure > 1 for c in range(3)) for i in range(n)
            )
            self.assertEqual(self.results(out)["truth"]["clipped"], {"pixels": clipped, "of": n})
            self.assertIn(f"{clipped} of {n} pixels", self.said.stdout)
            self.assertEqual(clipped > 0, exposure == 1, "one case must clip, one must not")
            # What PNG and EXR show is the same, and `compare` agrees in the same space.
            done = self.aaresolve(
                "compare",
                out / f"noaa/{FRAME}.png",
                out / f"noaa/{FRAME}.exr",
                "--display",
                "identity",
                "--q8",
                "--metrics",
                "mse",
                "--json",
            )
            self.assertEqual(json.loads(done.stdout)["pooled"]["mse"], 0)
            done = self.aaresolve(
                "compare",
                out / f"noaa/{FRAME}.exr",
                out / f"truth/{FRAME}.exr",
                "--display",
                "identity",
                "--json",
            )
            self.assertAlmostEqual(
                json.loads(done.stdout)["pooled"]["psnr"], self.figures(out)["noaa"], 9
            )

    def test_linear_and_encoded_blends_are_one_in_one_space(self) -> None:
        methods = ["msaa", "ssaa", "csaa", "t2msaa", "accum", "smaa1x", "fxaa311", "smaaS2x"]
        shot = self.synth("clutter", "shot", "--subsamples", "d3d2", "--subsample-color", frames=2)

        def spec(m: str, space: str) -> str:
            extra = ",slots=2" if m == "csaa" else ""
            return f"{m}:{'blendSpace' if m[0] in 'sf' and m != 'ssaa' else 'space'}={space}{extra}"

        both = [spec(m, s) for m in methods for s in ("linear", "encoded")]
        same = self.figures(self.run_shot(shot, *both, options=("-q", "--display", "identity")))
        other = self.figures(self.run_shot(shot, *both, options=("-q",)))
        for m in methods:
            self.assertAlmostEqual(same[spec(m, "linear")], same[spec(m, "encoded")], 3, m)
            self.assertGreater(abs(other[spec(m, "linear")] - other[spec(m, "encoded")]), 0.005, m)

    def test_quantise_rounds_what_is_compared_and_nothing_else(self) -> None:
        shot = self.synth("circles", "shot", "--for", "noaa,accum")
        exact = self.run_shot(
            shot, "noaa", "accum", options=("-q", "--display", "identity", "--write", "exr,png")
        )
        coarse = self.run_shot(
            shot,
            "noaa",
            "accum",
            options=("-q", "--display", "identity", "--quantise", 8, "--write", "exr,png"),
        )
        t, r = pixels(exact / f"accum/{FRAME}.exr"), pixels(exact / f"truth/{FRAME}.exr")
        self.assertAlmostEqual(self.figures(coarse)["accum"], psnr(rounded(t), rounded(r)), 3)
        self.assertNotEqual(self.figures(coarse)["accum"], self.figures(exact)["accum"])
        for name in (f"accum/{FRAME}.exr", f"accum/{FRAME}.png", f"truth/{FRAME}.exr"):
            self.assertEqual((exact / name).read_bytes(), (coarse / name).read_bytes(), name)
        self.assertEqual(self.results(coarse)["run"]["quantiseBits"], 8)
        self.assertIsNone(self.results(exact)["run"]["quantiseBits"])

    def test_full_history_is_a_longer_shot(self) -> None:
        methods = ("noaa", "accum", "taaSimplest", "uncharted", "taaSimplest+motionBlur=1")
        shot = self.synth("circles", "shot")
        first = self.run_shot(shot, *methods)
        full = self.run_shot(shot, *methods, options=("--history", "full", "--write-frames", "all"))
        self.assertIn("warm-up 1/10 frame 1", self.said.stderr)
        self.assertIn("warm-up 10/10 frame 16", self.said.stderr)
        self.assertIn("176/176", self.said.stderr)
        a, b = self.figures(first), self.figures(full)
        self.assertEqual(a["accum"], b["accum"], "the same set of samples")
        self.assertEqual(a["noaa"], b["noaa"])
        self.assertGreater(
            abs(a["taaSimplest"] - b["taaSimplest"]), 0.05, "the history must matter"
        )
        # By hand: the shot's frames eleven times, numbered on.
        manifest = json.loads((shot / "shot.json").read_text())
        once = manifest["frames"]
        manifest["frames"] = [
            {**f, "frame": f["frame"] + 16 * k, "reset": False} for k in range(11) for f in once
        ]
        (shot / "shot.json").write_text(json.dumps(manifest))
        by_hand = self.run_shot(shot, *methods, options=("-q", "--write-frames", "all"))
        for text in ("taaSimplest", "uncharted", "taaSimplest+motionBlur=1"):
            for k in range(16):
                long = by_hand / text / f"{161 + k:06d}.exr"
                self.assertEqual(
                    long.read_bytes(),
                    (full / text / f"{1 + k:06d}.exr").read_bytes(),
                    f"{text} {k}",
                )
        results = self.results(full)
        self.assertEqual((results["run"]["history"], results["run"]["warmUpFrames"]), ("full", 160))
        self.assertEqual([f["frame"] for f in results["methods"][2]["frames"]], list(range(1, 17)))
        self.assertFalse(
            any("convergenceFrames" in m.get("temporal", {}) for m in results["methods"])
        )

    def test_whole_passes_over_the_chosen_frames(self) -> None:
        shot = self.synth("circles", "shot", "--period", "4", "--for", "taaSimplest", frames=16)
        for frames, chosen, warm in (("", 16, 48), ("5-7", 3, 42), ("2", 1, 40)):
            out = self.run_shot(
                shot, "taaSimplest", options=("-q", "--history", "full", "--frames", frames)
            )
            results = self.results(out)
            self.assertEqual(results["run"]["warmUpFrames"], warm)
            self.assertEqual(len(results["methods"][0]["frames"]), chosen)
        # A method that keeps no history has nothing to warm up.
        out = self.run_shot(shot, "noaa", "accum", options=("--history", "full"))
        self.assertEqual(self.results(out)["run"]["warmUpFrames"], 0)
        self.assertNotIn("warm-up", self.said.stderr)

    def test_ramp_sets_the_parameter_where_there_is_one(self) -> None:
        shot = self.synth("moving", "shot", "--for", "uncharted,t2msaa,noaa", frames=5)
        out = self.run_shot(
            shot,
            "uncharted",
            "unchartedNorm:warmup=none",
            "t2msaa",
            "noaa",
            options=("--history", "ramp"),
        )
        parameters = {m["text"]: m["parameters"] for m in self.results(out)["methods"]}
        self.assertEqual(parameters["uncharted"]["warmup"], "ramp")
        self.assertEqual(parameters["unchartedNorm:warmup=none"]["warmup"], "none")
        self.assertIn("no ramp in t2msaa; run", self.said.stderr)
        explicit = self.run_shot(shot, "uncharted:warmup=ramp", options=("-q",))
        self.assertEqual(
            self.figures(explicit)["uncharted:warmup=ramp"], self.figures(out)["uncharted"]
        )

    def test_sweep_takes_the_same(self) -> None:
        shot = self.synth("circles", "shot", "--for", "noaa,uncharted")
        options = ("-q", "--display", "identity", "--history", "full", "--quantise", 8)
        out = self.run_shot(
            shot, "uncharted", command="sweep", options=(*options, "--vary", "kmin=0.5,0.9")
        )
        texts = [m["text"] for m in self.results(out)["methods"]]
        again = self.run_shot(shot, *texts, options=options)
        self.assertEqual(self.figures(out), self.figures(again))
        self.assertEqual(
            self.results(out)["run"]["display"],
            {"exposureEv": 0.0, "toneMap": "none", "transfer": "identity"},
        )
        self.assertEqual(self.results(out)["run"]["warmUpFrames"], 160)
        with (out / "results.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(
            {row["protocol"] for row in rows},
            {"display=identity exposure=0 toneMap=none history=full quantise=8"},
        )

    def test_a_region_is_judged_as_the_picture_and_said(self) -> None:
        shot = self.synth("circles", "shot", "--for", "noaa,accum")
        region = "20,8,30,25"
        out = self.run_shot(
            shot, "noaa", "accum", options=("-q", "--region", region, "--metrics", "fmagMse")
        )
        self.assertEqual(self.results(out)["run"]["region"], [20, 8, 30, 25])
        words = "region of 30 x 25 px at 20, 8"
        self.assertIn(words, self.said.stdout)
        self.assertIn("region=20,8,30,25", (out / "results.csv").read_text())
        # The written pictures are whole; `compare` of their region finds the same.
        wanted = ("psnr", "ssimLuma", "fmagMse")
        done = self.aaresolve(
            "compare",
            out / f"noaa/{FRAME}.exr",
            out / f"truth/{FRAME}.exr",
            "--region",
            region,
            "--metrics",
            ",".join(wanted),
            "--json",
        )
        noaa = self.results(out)["methods"][0]
        for figure in wanted:
            self.assertAlmostEqual(
                json.loads(done.stdout)["pooled"][figure], noaa["pooled"][figure], 9
            )
            self.assertEqual(noaa["pooled"][figure], noaa["frames"][-1]["metrics"][figure])
        # Maps are of the region, too, and those of `compare`.
        out = self.run_shot(
            shot, "noaa", options=("-q", "--region", region, "--maps", "ssim,fourier")
        )
        for kind in ("ssim", "fourier"):
            self.assertIn(f"maps/{kind}: ", self.said.stdout)
            self.assertIn("black", self.results(out)["run"]["maps"][kind])
            one = self.folder / f"{kind}.png"
            pair = (out / f"noaa/{FRAME}.exr", out / f"truth/{FRAME}.exr")
            self.aaresolve("compare", *pair, "--region", region, "--map", one, "--map-of", kind)
            self.assertEqual(one.read_bytes(), (out / f"maps/{kind}/noaa/{FRAME}.png").read_bytes())
        self.refused(2, "compare", *pair, "--map-of", "ssim", says=("--map-of", "--map FILE"))
        self.aaresolve("sheet", out, "-o", self.folder / "region.png")
        self.aaresolve("report", out, "-o", self.folder / "region.html")
        self.assertIn(words, (self.folder / "region.html").read_text())
        for wrong in ("60,0,5,5", "0,0,0,5", "1,2,3"):
            says = ("--region", "64 x 40 px" if wrong != "1,2,3" else "X,Y,WIDTH,HEIGHT")
            options = ("-m", "noaa", "-o", self.folder / "none", "--region", wrong)
            self.refused(2, "run", shot, *options, says=says)
        self.assertFalse((self.folder / "none").exists())

    def test_a_method_stands_in_for_the_truth_and_is_said(self) -> None:
        shot = self.synth(
            "moving",
            "shot",
            "--subsamples",
            "d3d8",
            "--subsample-color",
            "--for",
            "noaa,msaa",
            frames=2,
        )
        out = self.run_shot(
            shot, "noaa", "fxaa311", options=("-q", "--reference", "msaa", "--write", "exr")
        )
        results = self.results(out)
        self.assertEqual(results["run"]["reference"], "msaa")
        self.assertEqual(results["truth"]["noiseMse"], 0)
        self.assertEqual([m["text"] for m in results["methods"]], ["noaa", "fxaa311", "msaa"])
        self.assertIsNone(results["methods"][2]["pooled"])
        words = "reference: msaa, a method of this run and not the truth"
        self.assertIn(words, self.said.stdout)
        done = self.aaresolve("compare", out / "noaa", out / "msaa", "--json")
        self.assertAlmostEqual(
            json.loads(done.stdout)["pooled"]["psnr"], self.figures_of(results)["noaa"], 9
        )
        self.aaresolve("sheet", out, "-o", self.folder / "reference.png")
        self.aaresolve("report", out, "-o", self.folder / "reference.html")
        page = (self.folder / "reference.html").read_text()
        self.assertIn("msaa gets wrong counts as right", page)
        self.assertIn("against msaa (not the truth)", page)
        words = ("judged against msaa", "no images of the truth")
        question = ("-o", self.folder / "survey.html", "-Q", "pair noaa truth")
        self.refused(3, "survey", "make", out, *question, says=words)
        plain = self.synth("circles", "plain", "--for", "noaa", frames=2)
        out = self.folder / "none"
        options = ("-m", "noaa", "-o", out, "--reference", "msaa")
        self.refused(3, "run", plain, *options, says=("'msaa'", "subsamples"))

    def test_best_worst_and_average_over_frames(self) -> None:
        shot = self.synth("moving", "shot", "--for", "noaa,fxaa311", frames=5)
        out = self.run_shot(shot, "noaa", "fxaa311", options=("-q", "--over-frames"))
        for method in self.results(out)["methods"]:
            for figure in ("mse", "psnr", "ssimLuma"):
                values = {f["frame"]: f["metrics"][figure] for f in method["frames"]}
                best, worst = sorted(values, key=values.get, reverse=figure != "mse")[
                    :: len(values) - 1
                ]
                found = method["overFrames"][figure]
                self.assertEqual((found["bestFrame"], found["worstFrame"]), (best, worst))
                self.assertEqual((found["best"], found["worst"]), (values[best], values[worst]))
                self.assertAlmostEqual(found["mean"], sum(values.values()) / 5, 12)
            psnr_of = method["overFrames"]["psnr"]
            words = (
                "psnr {best:.2f} dB / {worst:.2f} dB / {mean:.2f} dB ({bestFrame}, {worstFrame})"
            )
            self.assertIn(words.format(**psnr_of), self.said.stdout)
            self.assertIn("ssimLuma", self.said.stdout)

    def test_memory_counts_what_is_read_and_written(self) -> None:
        done = self.aaresolve(
            "bench", "-m", "noaa", "-m", "gbaa", "--size", "64x36", "--frames", 1, "--json"
        )
        noaa, gbaa = json.loads(done.stdout)["methods"]
        self.assertEqual(noaa["inputBytes"], 64 * 36 * 12)
        self.assertEqual(gbaa["inputBytes"] - noaa["inputBytes"], 64 * 36 * 8, "the edges pass")
        self.assertEqual(gbaa["targetBytes"], 64 * 36 * 12)

    def test_sheet_and_report_say_it(self) -> None:
        shot = self.synth("circles", "shot", "--for", "noaa,uncharted")
        out = self.run_shot(
            shot,
            "noaa",
            "uncharted",
            options=("-q", "--display", "identity", "--history", "full", "--quantise", 8),
        )
        words = "displayed values, full history, 8-bit"
        self.assertIn(words, self.said.stdout)
        self.aaresolve("sheet", out, "-o", self.folder / "sheet.png")
        self.aaresolve("report", out, "-o", self.folder / "report.html")
        self.assertIn(words, (self.folder / "report.html").read_text())
        # A run from before the protocol could be chosen.
        old = self.results(out)
        for member in ("history", "warmUpFrames", "quantiseBits"):
            del old["run"][member]
        del old["run"]["display"]["transfer"], old["truth"]["clipped"]
        (out / "results.json").write_text(json.dumps(old))
        self.aaresolve("sheet", out, "-o", self.folder / "old.png")
        self.aaresolve("report", out, "-o", self.folder / "old.html")
        self.assertIn(
            "sRGB-encoded values, history from the first frame",
            (self.folder / "old.html").read_text(),
        )
        self.assertNotEqual(
            (self.folder / "old.png").read_bytes(), (self.folder / "sheet.png").read_bytes()
        )

    def test_the_headline_of_the_thesis(self) -> None:
        """Master beats no anti-aliasing at rest, its baseline with the published sharpening does not; un-jittering decides."""
        least = {"half_planes": 2.5, "thin_lines": 0.5, "hairs": 3.5}
        for scene, gain in least.items():
            shot = self.folder / scene
            size = ("--size", "256x144", "--frames", 16, "--jitter", "thesis")
            self.aaresolve("synth", scene, "-o", shot, "-q", *size)
            methods = ("noaa", "master", "master:unjitter=off", "uncharted")
            out = self.run_shot(
                shot,
                *methods,
                options=("-q", "--display", "identity", "--history", "full", "--write", "none"),
            )
            psnr_of = self.figures(out)
            over = {m: psnr_of[m] - psnr_of["noaa"] for m in methods}
            self.assertGreater(over["master"], gain, f"{scene}: {over}")
            self.assertGreater(over["master"], over["master:unjitter=off"] + 2, f"{scene}: {over}")
            self.assertLess(over["uncharted"], 0, f"{scene}: {over}")

    def test_filter_in_one_space(self) -> None:
        shot = self.synth("clutter", "shot", "--jitter", "none", frames=1)
        frame = next(shot.rglob("*.exr"))
        run = self.run_shot(shot, "noaa", options=("-q", "--write-frames", "all"))
        frame = run / "noaa/000001.exr"
        files = {}
        for space in ("linear", "encoded"):
            for display in ("identity", "srgb"):
                file = self.folder / f"{space}.{display}.exr"
                self.aaresolve(
                    "filter", f"smaa1x:blendSpace={space}", frame, file, "--display", display
                )
                files[space, display] = pixels(file)
        self.assertEqual(files["linear", "identity"], files["encoded", "identity"])
        self.assertNotEqual(files["linear", "srgb"], files["encoded", "srgb"])

    def test_usage(self) -> None:
        moving = self.synth("moving", "moving", "--for", "uncharted", frames=2)
        out = self.folder / "none"
        for command, more in (("run", ()), ("sweep", ("--vary", "kmin=0.5"))):
            says = ("--history full", "static shot")
            self.refused(
                2,
                command,
                moving,
                "-m",
                "uncharted",
                *more,
                "-o",
                out,
                "--history",
                "full",
                says=says,
            )
        self.refused(
            2, "run", moving, "-m", "noaa", "-o", out, "--display", "linear", says=("--display",)
        )
        self.refused(
            2, "run", moving, "-m", "noaa", "-o", out, "--history", "all", says=("--history",)
        )
        self.refused(
            2, "run", moving, "-m", "noaa", "-o", out, "--quantise", 10, says=("--quantise",)
        )
        self.assertFalse(out.exists(), "a refused run leaves nothing behind")


main()
