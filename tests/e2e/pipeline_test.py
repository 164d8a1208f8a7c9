"""From a synthetic shot to a contact sheet and a report; same bits for any thread count and instruction set."""

from __future__ import annotations

import csv
import importlib.util
import json
import math

from program import ROOT, ProgramTest, digests, main


class Pipeline(ProgramTest):
    def test_synth_check_run_sheet_report(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("circles", shot, (96, 64), 16, "--for", "noaa,accum,fxaa311,unchartedNorm")
        self.aaresolve("check", shot)
        self.aaresolve(
            "run",
            shot,
            "-m",
            "noaa",
            "-m",
            "accum",
            "-m",
            "fxaa311:preset=39",
            "-m",
            "unchartedNorm",
            "-o",
            out,
            "-q",
        )
        results = json.loads((out / "results.json").read_text())
        psnr = {m["text"]: m["pooled"]["psnr"] for m in results["methods"]}
        self.assertGreater(psnr["fxaa311:preset=39"], psnr["noaa"] + 1)
        # The mean of 16 frames, judged over all frames of the shot, must be far better than one sample.
        self.assertGreater(psnr["accum"], psnr["noaa"] + 3)
        rows = list(csv.DictReader((out / "results.csv").open()))
        self.assertGreaterEqual(len(rows), 4 * 16)
        self.aaresolve("sheet", out, "-o", self.folder / "sheet.png")
        self.assertEqual((self.folder / "sheet.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.aaresolve("report", out, "-o", self.folder / "report.html")
        html = (self.folder / "report.html").read_text()
        self.assertNotIn(
            "http://",
            html.replace("http://www.w3.org", ""),
            "the report must load nothing from the network",
        )
        self.assertIn("unchartedNorm", html)

    def test_a_trace_shows_the_stages_of_a_run(self) -> None:
        shot, trace = self.folder / "shot", self.folder / "trace.json"
        self.synth("moving", shot, (48, 32), 3, "--for", "fxaa311,taaSimplest")
        command = ("run", shot, "-m", "fxaa311", "-m", "taaSimplest", "-q", "--write", "png")
        self.aaresolve(*command, "-o", self.folder / "out", "--trace", trace)
        events = json.loads(trace.read_text())["traceEvents"]
        spans = [e for e in events if e["ph"] == "X"]
        count = {
            stage: sum(e["cat"] == stage for e in spans) for stage in {e["cat"] for e in spans}
        }
        methods = 3  # noaa joins them
        self.assertEqual(count["decode"], 3)
        self.assertEqual(count["truth"], 3)
        self.assertGreaterEqual(count["prepare"], 3)
        for stage in ("resolve", "judge", "write"):
            self.assertEqual(count[stage], 3 * methods, stage)
        self.assertTrue(all(e["dur"] >= 0 and e["ts"] >= 0 for e in spans))
        named = {e["tid"] for e in events if e["ph"] == "M"}
        self.assertTrue({e["tid"] for e in spans} <= named)
        # On one thread nothing overlaps but what lies in something else, and nothing here does.
        self.aaresolve(*command, "-o", self.folder / "one", "--trace", trace, "-j", 1)
        spans = [e for e in json.loads(trace.read_text())["traceEvents"] if e["ph"] == "X"]
        self.assertEqual(len({e["tid"] for e in spans}), 1)
        spans.sort(key=lambda e: e["ts"])
        for one, next_one in zip(spans, spans[1:]):
            self.assertLessEqual(one["ts"] + one["dur"], next_one["ts"] + 1)
        self.refused(
            *(1, *command, "-o", self.folder / "late", "--trace", self.folder / "none/trace.json"),
            says=("trace.json", "cannot be written"),
        )
        self.assertFalse((self.folder / "late").exists(), "told before the run, not after it")

    def test_same_bits_for_threads_and_instruction_sets(self) -> None:
        shot = self.folder / "shot"
        self.synth("moving", shot, (90, 50), 5, "--for", "uncharted,fxaa311")
        images = []
        for name, options in {
            "a": ("-j", 1, "--isa", "v2"),
            "b": ("-j", 2),
            "c": ("-j", 2, "--precision", "scalar"),
        }.items():
            out = self.folder / name
            self.aaresolve(
                "run",
                shot,
                "-m",
                "uncharted",
                "-m",
                "fxaa311",
                "-o",
                out,
                "-q",
                "--write-frames",
                "all",
                *options,
            )
            images.append(digests(out))
        self.assertEqual(len(images[0]), 20)  # noaa, two methods and the truth
        self.assertEqual(images[0], images[1])
        self.assertEqual(images[0], images[2])

    def test_a_sequence_may_start_in_the_middle(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (48, 32), 6, "--for", "uncharted")
        self.aaresolve("run", shot, "-m", "uncharted", "-o", out, "-q", "--frames", "4-6")
        results = json.loads((out / "results.json").read_text())
        self.assertEqual([f["frame"] for f in results["methods"][0]["frames"]], [4, 5, 6])
        self.assertTrue(math.isfinite(results["methods"][0]["pooled"]["psnr"]))

    def test_addon_and_program_jitter_alike(self) -> None:
        """Sequences and sub-sample patterns exist in both; the same name means the same places."""
        spec = importlib.util.spec_from_file_location(
            "addon_jitter", ROOT / "blender_addon/aa_resolve/jitter.py"
        )
        addon = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(addon)
        listed = self.aaresolve("synth", "--list").stdout.split("jitter sequences:")[1]
        self.assertEqual(
            [line.split()[0] for line in listed.splitlines() if line.strip()], list(addon.SEQUENCES)
        )
        pattern = dict.fromkeys((*addon.D3D_PATTERNS, "grid3"))
        for name in addon.SEQUENCES:
            shot = self.folder / name
            wanted = next(iter(pattern), "d3d8")
            pattern.pop(wanted, None)
            self.synth(
                "moving", shot, (8, 8), 9, "--jitter", name, "--period", "7", "--subsamples", wanted
            )
            manifest = json.loads((shot / "shot.json").read_text())
            for index, entry in enumerate(manifest["frames"]):
                there = addon.jitter_at(name, index, manifest["jitter"]["period"])
                for one, other in zip(entry["jitter"], there):
                    self.assertAlmostEqual(one, other, 12, f"{name} {index}")
            self.assertEqual(manifest["jitter"]["start"], addon.start_of(name), name)
            self.assertEqual(
                manifest["subsamples"]["positions"],
                [list(p) for p in addon.pattern_positions(wanted)],
            )


main()
