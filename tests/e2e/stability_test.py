"""`aaresolve stability`: what it prints, what it writes, and what the report shows of it."""

from __future__ import annotations

import json
import signal
import subprocess

from json_schema import Schema
from program import LIMIT_S, PROGRAM, ROOT, ProgramTest, main

SMALL = "--size 48x27 --frames 8 --long-frames 128 -q".split()


class Stability(ProgramTest):
    def test_tables_file_and_report(self) -> None:
        shot, run = self.folder / "shot", self.folder / "run"
        self.synth("moving", shot, (48, 32), 4)
        methods = ("-m", "noaa,fxaa311,uncharted,karis:alpha=0.2")
        self.aaresolve("run", shot, *methods, "-o", run, "-q")
        self.aaresolve("report", run, "-o", self.folder / "before.html")
        self.assertNotIn("stability-data", (self.folder / "before.html").read_text())
        said = self.aaresolve("stability", *methods, *SMALL, "--device", "cpu", "-o", run).stdout
        for words in (
            "float lanes",
            "16-bit history",
            "light of 1e-6 to 1e6",
            "stall, codes",
            "recovers after",
            "karis:alpha=0.2",
            "GPU forms left out: --device cpu.",
        ):
            self.assertIn(words, said)
        file = run / "stability.json"
        written = json.loads(file.read_text())
        schema = Schema(json.loads((ROOT / "docs/schema/stability.schema.json").read_text()))
        self.assertEqual(schema.faults(written), [])
        noaa, fxaa, uncharted, karis = written["methods"]
        self.assertEqual((noaa["float"]["max"], noaa["amplification"]["largest"]), (0, 1))
        self.assertNotIn("settling", fxaa)
        self.assertEqual(sorted(uncharted["settling"]), ["16f", "32f", "8"])
        self.assertEqual(sorted(karis["settling"]), ["16f", "32f"])
        self.assertGreater(uncharted["history8"]["max"], uncharted["history16"]["max"])
        self.assertEqual(len(karis["amplification"]["most"]), 8)
        # The same figures for any number of threads, printed as written.
        again = self.aaresolve(
            "stability", *methods, *SMALL, "--device", "cpu", "--json", "-j", 1
        ).stdout
        self.assertEqual(again, file.read_text())
        self.aaresolve("report", run, "-o", self.folder / "after.html")
        page = (self.folder / "after.html").read_text()
        self.assertIn("stability-data", page)
        self.assertIn("The accuracy that speed costs", page)
        file.write_text('{"format": "aaresolve-stability", "version": 2, "methods": []}')
        self.refused(3, "report", run, says=("stability.json", "run `aaresolve stability` again"))

    def test_on_a_shot(self) -> None:
        shot = self.folder / "shot"
        self.synth("moving", shot, (40, 24), 3)
        options = ("--long-frames", 128, "--device", "cpu", "-q", "--json")
        found = json.loads(self.aaresolve("stability", shot, *options).stdout)
        self.assertEqual(found["material"]["shot"], "moving")
        self.assertEqual(found["material"]["resolution"], [40, 24])
        self.assertEqual(found["material"]["frames"], 3)
        served = {m["method"] for m in found["methods"]}
        self.assertIn("karis", served)
        self.assertNotIn("msaa", served)  # the shot has no sub-samples
        self.refused(3, "stability", shot, "-m", "msaa", "-q", says=("msaa", "subsample"))

    def test_shaders_where_there_is_a_device(self) -> None:
        found = json.loads(self.aaresolve("stability", "-m", "noaa,karis", *SMALL, "--json").stdout)
        if "device" not in found:
            self.assertTrue(found["noDevice"])
            self.skipTest("no graphics device: " + found["noDevice"])
        karis = found["methods"][1]
        self.assertLess(karis["gpuExact"]["max"], 1e-3)
        self.assertGreater(karis["gpuFast"]["max"], karis["gpuExact"]["max"])

    def test_an_interrupted_study_replaces_no_whole_one(self) -> None:
        file = self.folder / "out" / "stability.json"
        small = ("stability", "--device", "cpu", *SMALL[:-1], "-o", file.parent)
        self.aaresolve(*small, "-m", "noaa")
        whole = file.read_bytes()
        long = ("stability", "--device", "cpu", *SMALL[:-1], "-j", 1)

        def interrupted() -> str:
            call = subprocess.Popen(
                [PROGRAM, *map(str, long), "-o", file.parent],
                stderr=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                text=True,
            )
            said = call.stderr.readline()  # the first of many methods is done
            call.send_signal(signal.SIGINT)
            said += call.communicate(timeout=LIMIT_S)[1]
            self.assertEqual(call.returncode, 130, said)
            return said

        self.assertIn(f"{file}: kept, for this study was interrupted", interrupted())
        self.assertEqual(file.read_bytes(), whole)
        file.unlink()
        self.assertNotIn("kept", interrupted())
        self.assertFalse(json.loads(file.read_text())["complete"])
        self.assertNotIn("kept", interrupted(), "over one that was interrupted, too")

    def test_a_folder_that_cannot_be_written_is_said_first(self) -> None:
        (self.folder / "file").touch()
        out = ("-o", self.folder / "file" / "out")
        long = ("--long-frames", 1000000)  # hours
        self.refused(1, "stability", "-m", "inside", *long, *out, says=("not a writable folder",))
        self.refused(1, "angles", "-m", "inside", "--angles", 3600, "--offsets", 256, "--frames", 1024, *out, says=("not a writable folder",))  # fmt: skip

    def test_wrong_usage(self) -> None:
        self.aaresolve("stability", "--frames", 1, expect=2)
        self.aaresolve("stability", "--json", "--markdown", expect=2)
        self.aaresolve("stability", "-m", "nosuch", expect=2)
        self.aaresolve("stability", self.folder / "none", expect=3)


if __name__ == "__main__":
    main()
