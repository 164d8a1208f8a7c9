"""Runs that can be trusted, and the gate: exit codes, what is named, JUnit; the samples in docs/ci do what they say."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

from program import PROGRAM, ROOT, ProgramTest, digests, main

try:
    import OpenImageIO as oiio
except ImportError:  # the package python3-openimageio
    oiio = None

CI = ROOT / "docs/ci"


def steps_of(file: Path) -> list[str]:
    """The shell lines of a workflow file, in order."""
    text = file.read_text()
    if file.name == "github.yml":
        blocks = re.findall(r"run: \|\n((?: {10}.*\n)+)", text)
        return [line.strip() for block in blocks for line in block.splitlines()]
    script = re.search(r"  script:\n((?:    - .*\n)+)", text)[1]
    return [line.strip().removeprefix("- ") for line in script.splitlines()]


def negated(file: Path, part: str) -> None:
    """Rewrites one part of a frame with the other sign."""
    source = oiio.ImageInput.open(str(file))
    specs, pixels = [], []
    while source.seek_subimage(len(specs), 0):
        specs.append(oiio.ImageSpec(source.spec()))
        own = specs[-1].getattribute("oiio:subimagename") == part
        pixels.append(source.read_image("float") * (-1 if own else 1))
    source.close()
    out = oiio.ImageOutput.create(str(file))
    out.open(str(file), tuple(specs))
    for k, plane in enumerate(pixels):
        if k:
            out.open(str(file), specs[k], "AppendSubimage")
        out.write_image(plane)
    out.close()


class Gate(ProgramTest):
    def results(self, folder: Path) -> dict:
        return json.loads((folder / "results.json").read_text())

    def made(self, name: str, *methods: str) -> Path:
        shot, out = self.folder / "shot", self.folder / name
        if not shot.exists():
            self.synth("half_planes", shot, (128, 72), 8, "--for", "karis,noaa")
        chosen = [word for m in methods or ("noaa", "karis") for word in ("-m", m)]
        self.aaresolve("run", shot, *chosen, "-o", out, "-q", "--write", "none")
        return out

    def regressed(self, name: str = "worse") -> Path:
        """As if the method had lost its history."""
        out = self.made(name, "noaa", "karis:alpha=1")
        document = self.results(out)
        document["methods"][1]["text"] = "karis"
        (out / "results.json").write_text(json.dumps(document))
        return out

    def test_an_unchanged_run_passes(self) -> None:
        base, now = self.made("base"), self.made("now")
        said = self.aaresolve("gate", base, now).stdout
        self.assertIn("passed: half_planes", said)
        self.assertNotIn("note", said)
        # A baseline may be the file alone, under any name.
        shutil.copy(base / "results.json", self.folder / "baseline.json")
        self.aaresolve("gate", self.folder / "baseline.json", now / "results.json")

    def test_what_got_worse_is_named(self) -> None:
        base, now = self.made("base"), self.regressed()
        done = self.aaresolve("gate", base, now, "--junit", self.folder / "gate.xml", expect=1)
        self.assertRegex(
            done.stdout, r"worse +karis +psnr [\d.]+ dB, was [\d.]+ dB: [\d.]+ dB worse \(95 %: "
        )
        self.assertIn("FAILED: half_planes", done.stdout)
        self.assertIn("its parameters were alpha=0.04 and are alpha=1", done.stdout)
        self.assertNotIn("worse      noaa", done.stdout)
        suites = xml.parse(self.folder / "gate.xml").getroot()
        failed = [c.get("name") for c in suites.iter("testcase") if c.find("failure") is not None]
        self.assertIn("psnr", failed)
        self.assertEqual(suites.get("failures"), str(len(failed)))
        self.assertEqual({s.get("name") for s in suites}, {"noaa", "karis"})
        told = json.loads(self.aaresolve("gate", base, now, "--json", expect=1).stdout)
        row = next(r for r in told["rows"] if r["method"] == "karis" and r["figure"] == "psnr")
        self.assertEqual(row["verdict"], "worse")
        # The line that makes the row again does.
        again = row["rerun"].replace("-m karis ", "-m karis:alpha=1 ")
        words = again.split()
        self.assertEqual(words[1:3], ["run", str(self.folder / "shot")])
        self.aaresolve(*words[1:], cwd=self.folder)
        self.assertEqual(
            self.results(self.folder / "karis_alpha=1_again")["methods"][-1]["pooled"]["psnr"],
            self.results(now)["methods"][1]["pooled"]["psnr"],
        )
        self.aaresolve(
            "gate",
            base,
            now,
            "--tol",
            "psnr=50,ssim=1,ssimRgb=1,tPsnr=50,flickerStatic=9999%,relMse=9999%,flip=9999%,"
            "flipMedian=9999%,flipFirstQuartile=9999%,flipThirdQuartile=9999%",
        )

    def moving(self, name: str, *methods: str, shot: Path | None = None) -> Path:
        """A run of the moving shot, or of what became of it, under the plain names of its methods."""
        if not (self.folder / "shot").exists():
            self.synth("moving", self.folder / "shot", (128, 72), 8, "--for", "karis,raptor")
        out = self.folder / name
        chosen = [word for m in methods or ("karis", "raptor") for word in ("-m", m)]
        self.aaresolve(
            "run", shot or self.folder / "shot", *chosen, "-o", out, "-q", "--write", "none"
        )
        document = self.results(out)
        for m in document["methods"]:
            m["text"] = m["text"].split(":")[0]
        (out / "results.json").write_text(json.dumps(document))
        return out

    @unittest.skipIf(oiio is None, "python3-openimageio is not installed")
    def test_faults_of_temporal_methods_are_named(self) -> None:
        """Faults that an engine's TAA is prone to, made for real; and what they do not touch stays."""
        base = self.moving("base")
        turned, mirrored = self.folder / "turned", self.folder / "mirrored"
        for copy in (turned, mirrored):
            shutil.copytree(self.folder / "shot", copy)
        shot = json.loads((turned / "shot.json").read_text())
        for frame in shot["frames"]:
            frame["jitter"] = [-x for x in frame["jitter"]]
        (turned / "shot.json").write_text(json.dumps(shot))
        for frame in (mirrored / "frames").iterdir():
            negated(frame, "motion")
        faults = {
            "no_clamp": (("karis", "raptor:constraint=none"), None, "raptor"),
            "jitter_sign": ((), turned, "karis"),
            "motion_sign": ((), mirrored, "karis"),
        }
        for fault, (methods, shot, named) in faults.items():
            with self.subTest(fault):
                now = self.moving(fault, *methods, shot=shot)
                said = self.aaresolve("gate", base, now, expect=1).stdout
                self.assertRegex(said, rf"worse +{named} +psnr [\d.]+ dB, was [\d.]+ dB: ")
                self.assertEqual(len(re.findall(rf"again: .* -m {named} ", said)), 1)
                if methods:  # the other method is as it was
                    other = ({"karis", "raptor"} - {named}).pop()
                    self.assertNotRegex(said, rf"(worse|missing|unresolved) +{other}")

    def test_an_unchanged_run_passes_every_time(self) -> None:
        """Times differ from run to run and processors are busy: only what decides may decide."""
        base = self.made("base")
        with contextlib.ExitStack() as noise:
            for _ in range(os.cpu_count() or 1):
                busy = subprocess.Popen([sys.executable, "-c", "while True: pass"])
                noise.callback(busy.wait)
                noise.callback(busy.kill)
            for _ in range(20):
                said = self.aaresolve("gate", base, self.made("now")).stdout
                self.assertRegex(said, r"passed: half_planes, \d+ rows: 0 worse, 0 missing")

    def test_what_cannot_be_compared(self) -> None:
        base = self.made("base")
        other = self.folder / "other"
        shot = self.folder / "shot"
        chosen = ("-m", "noaa", "-m", "karis", "-o", other, "-q", "--write", "none")
        self.aaresolve("run", shot, *chosen, "--quantise", 8)
        self.refused(3, "gate", base, other, says=("protocol", "quantise=8"))
        self.aaresolve("run", shot, *chosen, "--frames", "1-6")
        self.refused(
            3, "gate", base, other, says=("the frames: before 1,2,3,4,5,6,7,8, now 1,2,3,4,5,6",)
        )
        self.refused(3, "gate", base, self.folder / "nowhere", says=("no such file",))
        self.refused(2, "gate", base, other, "--tol", "pnsr=1", says=("did you mean 'psnr'?",))
        self.refused(1, "gate", base, base, "--junit", "/nowhere/x.xml", says=("/nowhere/x.xml",))
        fewer = self.made("fewer", "noaa")
        said = self.aaresolve("gate", base, fewer, expect=1).stdout
        self.assertRegex(said, r"missing +karis +the method is missing")
        self.assertIn("passed", self.aaresolve("gate", base, fewer, "--allow-missing").stdout)

    def test_an_interrupted_run_says_so_everywhere_and_goes_on(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (320, 180), 40, "--for", "karis,noaa,fxaa311")
        command = [
            "run",
            shot,
            "-m",
            "noaa",
            "-m",
            "karis",
            "-m",
            "fxaa311",
            "-o",
            out,
            "--write-frames",
            "all",
        ]
        # Not waited for a time, but for its progress: frame 5 is done.
        child = subprocess.Popen(
            [str(PROGRAM), *map(str, command)],
            stderr=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for line in child.stderr:
            if " 5/40 " in line:
                child.send_signal(signal.SIGINT)
                break
        said, _ = child.communicate(timeout=100)
        self.assertEqual(child.returncode, 130)
        self.assertRegex(said, r"interrupted after \d+ of 40 frames")
        document = self.results(out)
        done = len(document["methods"][0]["frames"])
        self.assertIs(document["run"]["complete"], False)
        self.assertEqual(document["run"]["framesAsked"], 40)
        self.assertLess(done, 40)
        words = f"interrupted after {done} of 40 frames"
        self.aaresolve("report", out, "-o", self.folder / "r.html")
        self.assertIn(words, (self.folder / "r.html").read_text())
        self.refused(3, "gate", out, out, says=(words, "--resume"))
        self.aaresolve("sheet", out)
        self.aaresolve(*command, "--resume", "-q")
        self.assertIs(self.results(out)["run"]["complete"], True)
        whole = self.folder / "whole"
        self.aaresolve(*[whole if word == out else word for word in command], "-q")
        pictures = digests(out, "0*.exr")
        self.assertEqual(pictures, digests(whole, "0*.exr"))
        self.assertEqual(len(pictures), 4 * 40)
        self.assertIn("passed", self.aaresolve("gate", whole, out).stdout)

    def test_methods_are_added_and_stale_ones_named(self) -> None:
        out = self.made("out")
        shot = self.folder / "shot"
        self.aaresolve("run", shot, "--add", "-m", "fxaa311", "-o", out, "-q", "--write", "none")
        self.assertEqual(
            [m["id"] for m in self.results(out)["methods"]], ["noaa", "karis", "fxaa311"]
        )
        self.refused(
            3, "run", shot, "--add", "-m", "mlaa", "-o", out, "-q", says=("write=none", "write=exr")
        )
        self.refused(
            3, "run", shot, "--add", "-m", "mlaa", "-o", self.folder / "new", says=("no such file",)
        )
        said = self.aaresolve("run", shot, "-m", "mlaa", "-o", out, "-q", "--write", "none").stderr
        self.assertIn("removed the pictures of karis and fxaa311, which this run has not", said)
        self.assertEqual([m["id"] for m in self.results(out)["methods"]], ["noaa", "mlaa"])

    def test_frames_made_elsewhere(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (64, 40), 4)
        self.aaresolve("run", shot, "-m", "karis", "-o", out, "-q", "--write-frames", "all")
        ours = self.results(out)["methods"][-1]
        self.refused(
            2, "run", shot, "--external", f"dlss={out}/karis", "-o", out, "-q", says=("lies in",)
        )
        self.assertTrue((out / "karis/000001.exr").exists(), "nothing was cleared")
        judged = self.folder / "judged"
        self.aaresolve(
            "run", shot, "-m", "noaa", "--external", f"dlss={out}/karis", "-o", judged, "-q"
        )
        row = self.results(judged)["methods"][1]
        self.assertEqual((row["id"], row["family"]), ("dlss", "external"))
        self.assertEqual(row["pooled"]["mse"], ours["pooled"]["mse"])
        self.assertEqual(row["temporal"]["flickerMoving"], ours["temporal"]["flickerMoving"])
        self.assertIn(f"--external dlss={out}/karis", row["rerun"])
        said = self.aaresolve("run", shot, "--external", f"dlss={out}/karis", "-o", judged, "-q")
        self.assertRegex(said.stdout, r"dlss +[\d.]+ +[+-][\d.]+ .* - +- +0.00 +0.00")
        self.aaresolve("sheet", judged)
        self.aaresolve("report", judged)
        self.refused(2, "run", shot, "-o", judged, says=("no method; give one by -m",))
        (out / "karis/000003.exr").unlink()
        self.refused(
            3,
            *("run", shot, "--external", f"dlss={out}/karis", "-o", judged, "-q"),
            says=("no picture of frame 3 among its 3 (1 to 4)",),
        )

    def test_folders_with_both_kinds_of_picture_are_compared(self) -> None:
        both, pngs = self.folder / "both", self.folder / "pngs"
        shot = self.folder / "small"
        self.synth("moving", shot, (24, 16), 2, "-q")
        for out, kinds in ((both, "exr,png"), (pngs, "png")):
            self.aaresolve(
                *("run", shot, "-m", "noaa,fxaa311", "-o", out, "-q"),
                *("--write", kinds, "--write-frames", "all"),
            )
        # EXR with EXR, which holds more; PNG where the other folder holds nothing else. What is not meant is not read.
        for name in ("noaa", "fxaa311"):
            (both / name / "000001.png").write_text("not read")
        said = json.loads(self.aaresolve("compare", both / "noaa", both / "fxaa311", "--json").stdout)  # fmt: skip
        self.assertEqual(said["frames"], 2)
        (both / "noaa/000002.exr").write_text("not read")
        shutil.copy(pngs / "noaa/000001.png", both / "noaa")
        said = json.loads(self.aaresolve("compare", both / "noaa", pngs / "noaa", "--json").stdout)
        self.assertEqual(said["pooled"]["mse"], 0)
        (both / "noaa/000001.exr").unlink()  # no longer every picture twice
        self.refused(
            3,
            "compare",
            both / "noaa",
            both / "fxaa311",
            says=("are both frame", "keep one of them"),
        )

    def test_frames_are_paired(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (32, 20), 3, "--for", "noaa")
        self.aaresolve("run", shot, "-m", "noaa", "-o", out, "-q", "--write-frames", "all")
        named, shifted = self.folder / "named", self.folder / "shifted"
        for folder, name in ((named, "taa_v2_%d.exr"), (shifted, "taa_%d.exr")):
            folder.mkdir()
            for i in (1, 2, 3):
                number = i + (7 if folder == shifted else 0)
                shutil.copy(out / f"noaa/{i:06}.exr", folder / (name % number))
        said = self.aaresolve("compare", named, out / "noaa").stdout
        self.assertIn("paired by number: taa_v2_1.exr with 000001.exr", said)
        self.assertIn("psnr Inf", said)
        told = json.loads(self.aaresolve("compare", out / "noaa", out / "noaa", "--json").stdout)
        self.assertEqual(told["pairedBy"], "name")
        self.refused(
            3, "compare", shifted, out / "noaa", says=("no frame of the number of", "--pair")
        )
        said = self.aaresolve("compare", shifted, out / "noaa", "--pair", "order").stdout
        self.assertIn("paired by order: taa_10.exr with 000001.exr", said)
        self.refused(3, "compare", named, out / "noaa", "--pair", "name", says=("of the name of",))
        (shifted / "taa_10.exr").unlink()
        self.refused(3, "compare", shifted, out / "noaa", "--pair", "order", says=("found 3",))
        shutil.copy(named / "taa_v2_1.exr", named / "b1.exr")
        self.refused(3, "compare", named, out / "noaa", says=("have the same number",))

    def test_provenance(self) -> None:
        first, second = (self.results(self.made(name)) for name in ("a", "b"))
        p = first["provenance"]
        self.assertRegex(p["date"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertIn(" run ", p["command"])
        self.assertEqual(p["shotPath"], str((self.folder / "shot").resolve()))
        self.assertEqual(p["folder"], os.getcwd())
        self.assertGreater(p["machine"]["cores"], 0)
        if (ROOT / ".git").exists():
            head = subprocess.run(
                ["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True
            )
            self.assertRegex(p["commit"], r"^[0-9a-f]{12,}$")
            self.assertEqual(len(head.stdout.strip()), 40)
        self.assertEqual(first["shot"]["hash"], second["shot"]["hash"])
        # All else is the same to the last bit, but times.
        for document in (first, second):
            del document["provenance"], document["run"]["load"]
            for m in document["methods"]:
                for name in [*m]:
                    if re.search("econds|timings|nsPerPixel", name):
                        del m[name]
                for f in m["frames"]:
                    for name in [*f]:
                        if "econds" in name:
                            del f[name]
        self.assertEqual(first, second)

    def test_the_samples_for_ci_do_what_they_say(self) -> None:
        project = self.folder / "project"
        (project / "ci").mkdir(parents=True)
        path = self.folder / "bin"
        path.mkdir()
        (path / "aaresolve").symlink_to(PROGRAM)
        environment = {**os.environ, "PATH": f"{path}:{os.environ['PATH']}"}
        # An engine: a synthetic shot, and the frames that a method of ours makes of it.
        (project / "ci/render.sh").write_text(
            "set -eu\n"
            'aaresolve synth half_planes -o "$1/raw" -q --size 96x54 --frames 6 --for noaa,karis\n'
            'aaresolve run "$1/raw" -m "${ENGINE:-karis}" -o "$1/made" -q --write-frames all\n'
            'cp -r "$1/made/$(echo "${ENGINE:-karis}" | tr : _)" "$1/engine"\n'
        )
        self.synth("half_planes", self.folder / "probe", (8, 8), 6, "--for", "noaa,karis")
        known = json.loads((self.folder / "probe/shot.json").read_text())["frames"]
        source = {"files": "raw/frames/{frame}.exr"}
        layout = {
            "format": "aaresolve-frames",
            "version": 1,
            "static": True,
            "passes": {"color": source, "depth": {**source, "kind": "planar"}},
            "centre": {"color": {"files": "raw/centre/{frame}.exr"}},
            "truth": {"a": {"files": "raw/truth/{frame}.exr"}, "filter": "box", "filter_width": 1},
            "jitter": {
                **{"sequence": "halton23", "units": "px", "y": "down", "of": "sample"},
                "offsets": [f["jitter"] for f in known],
            },
        }
        (project / "ci/layout.json").write_text(json.dumps(layout))

        def shell(line: str, **more: str) -> int:
            done = subprocess.run(
                ["sh", "-c", line],
                cwd=project,
                env={**environment, **more},
                capture_output=True,
                text=True,
            )
            self.said = done.stdout + done.stderr
            return done.returncode

        baseline = re.findall(r"^    (\S.*)$", (CI / "README.md").read_text(), re.M)
        self.assertIn("cp out/results.json ci/baseline.json", baseline)
        for line in baseline:
            self.assertEqual(shell(line), 0, f"{line}\n{self.said}")
        for file in (CI / "github.yml", CI / "gitlab-ci.yml"):
            for engine, expected in (("karis", 0), ("karis:alpha=1", 1)):
                for leftover in ("frames", "shot", "out"):
                    shutil.rmtree(project / leftover, ignore_errors=True)
                (project / "gate.xml").unlink(missing_ok=True)
                for line in steps_of(file):
                    code = shell(line, ENGINE=engine)
                    self.assertEqual(
                        code,
                        expected if " gate " in line else 0,
                        f"{file.name}: {line}\n{self.said}",
                    )
                    if " gate " in line and expected:
                        self.assertRegex(self.said, r"worse +engine +psnr")
                self.assertTrue((project / "report.html").exists())
                self.assertIn("engine", (project / "gate.xml").read_text())
        # The image: what it runs exists.
        dockerfile = (CI / "Dockerfile").read_text()
        self.assertIn("RUN make bundle", dockerfile)
        self.assertRegex((ROOT / "Makefile").read_text(), r"(?m)^bundle:")
        self.assertIn("-linux-x64", (ROOT / "packaging/bundle.py").read_text())
        for line in re.findall(r"^RUN (.*)$", dockerfile, re.M):
            self.assertEqual(shell(f"sh -n -c '{line}'"), 0, line)


main()
