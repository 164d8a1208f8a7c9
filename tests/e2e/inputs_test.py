"""What a command reads it does not write over, and what others made it does not clear: shots, results, keys, pictures."""

from __future__ import annotations

import json
import math
import os
import shutil
import stat
import subprocess

from program import PROGRAM, ProgramTest, digests, main


class Inputs(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.shot, self.out = self.folder / "shot", self.folder / "out"
        self.aaresolve("synth", "moving", "-o", self.shot, "--size", "64x36", "--frames", "2", "-q")
        self.aaresolve(
            "run", self.shot, "-m", "noaa,fxaa311", "-o", self.out, "--write", "exr,png", "-q"
        )

    def kept(self, code: int, says: str, *words: object, unchanged: list) -> None:
        before = [digests(p, "*.*") if p.is_dir() else p.read_bytes() for p in unchanged]
        done = self.aaresolve(*words, expect=code)
        self.assertIn(says, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        for path, was in zip(unchanged, before):
            self.assertEqual(
                digests(path, "*.*") if path.is_dir() else path.read_bytes(), was, path
            )

    def test_a_run_into_a_shot(self) -> None:
        link = self.folder / "link"
        link.symlink_to(self.shot)
        inside = self.shot / "truth"
        for out in (self.shot, link, inside, inside / "new", self.shot / "frames"):
            for write in ("exr", "none"):
                self.kept(
                    2, "folder of its own", "run", self.shot, "-m", "fxaa311", "-o", out, "--write", write, "-q",
                    unchanged=[self.shot],
                )  # fmt: skip
        vary = ("--vary", "subpix=0,1")
        self.kept(
            2, "folder of its own", "sweep", self.shot, "-m", "fxaa311", *vary, "-o", link, "-q",
            unchanged=[self.shot],
        )  # fmt: skip
        # A shot whose frames lie where the run keeps its truth.
        shot = json.loads((self.shot / "shot.json").read_text())
        above = self.folder / "above"
        (above / "truth/s").mkdir(parents=True)
        shutil.copytree(self.shot, above / "truth/s", dirs_exist_ok=True)
        self.kept(
            2, "would write over", "run", above / "truth/s", "-m", "fxaa311", "-o", above, "-q",
            unchanged=[above],
        )  # fmt: skip
        self.assertTrue(shot["frames"])
        # Beside its frames a run may lie.
        self.aaresolve("run", self.shot, "-m", "fxaa311", "-o", self.shot / "results", "-q")

    def test_synth_into_what_others_made(self) -> None:
        synth = ("synth", "circles", "--size", "64x36", "--frames", "2", "-q", "-o")
        self.kept(2, "results of a run", *synth, self.out, unchanged=[self.out])
        manifest = self.shot / "shot.json"
        text = manifest.read_text()
        for other in (text.replace("aaresolve synth", "blender add-on"), "{"):
            manifest.write_text(other)
            self.kept(2, "did not make", *synth, self.shot, unchanged=[self.shot])
        manifest.write_text(text)
        self.aaresolve(*synth, self.shot)

    def test_outputs_that_are_inputs(self) -> None:
        results, picture = self.out / "results.json", self.out / "noaa/000002.png"
        other = self.out / "fxaa311/000002.png"
        both = [self.out, self.shot]
        says = "this command reads it"
        self.kept(2, says, "report", self.out, "-o", results, unchanged=both)
        self.kept(2, says, "sheet", self.out, "-o", picture, unchanged=both)
        self.kept(2, says, "compare", picture, other, "--map", other, unchanged=both)
        self.kept(
            2,
            says,
            "compare",
            self.out / "noaa",
            self.out / "fxaa311",
            "--map",
            self.out / "fxaa311",
            unchanged=both,
        )
        self.kept(2, says, "gate", self.out, self.out, "--junit", results, unchanged=both)
        self.kept(2, says, "filter", "fxaa311", picture, picture, unchanged=both)
        new = self.folder / "new"
        trace = ("--trace", self.shot / "shot.json")
        self.kept(
            2, says, "run", self.shot, "-m", "noaa", "-o", new, *trace, "-q", unchanged=[self.shot]
        )
        self.assertFalse(new.exists(), "refused before the run")

    def test_a_run_goes_on_with_its_own_results(self) -> None:
        self.aaresolve(
            "run", self.shot, "-m", "smaa1x", "-o", self.out, "--write", "exr,png", "--add", "-q"
        )
        methods = json.loads((self.out / "results.json").read_text())["methods"]
        self.assertEqual([m["id"] for m in methods], ["noaa", "fxaa311", "smaa1x"])

    def test_missing_pictures_are_made_again(self) -> None:
        before = digests(self.out, "*.exr")
        for picture in (self.out / "noaa").glob("*.exr"):
            picture.unlink()
        run = (
            "run",
            self.shot,
            "-m",
            "noaa,fxaa311",
            "-o",
            self.out,
            "--write",
            "exr,png",
            "--resume",
            "-q",
        )
        self.aaresolve(*run)
        self.assertEqual(digests(self.out, "*.exr"), before)

    def test_answers_of_viewers(self) -> None:
        survey = self.folder / "survey"
        make = (
            "survey",
            "make",
            self.out,
            "-o",
            survey,
            "--seed",
            "7",
            "--question",
            "pair noaa fxaa311",
        )
        self.aaresolve(*make)
        key = survey / "survey.key.json"
        answers = self.folder / "answers.json"
        questions = json.loads(key.read_text())
        answers.write_text("{}")
        for out in (key, answers):
            done = self.aaresolve(
                "survey", "score", answers, "--survey", survey / "survey.html", "-o", out, expect=3
            )
            self.assertIn("answers.json", done.stderr)
        self.assertEqual(json.loads(key.read_text()), questions)

    def test_devices_and_links(self) -> None:
        self.aaresolve(
            "compare",
            self.out / "noaa/000002.png",
            self.out / "fxaa311/000002.png",
            "--map",
            "/dev/null",
        )
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))
        pipe, report = self.folder / "pipe", self.folder / "report.html"
        os.mkfifo(pipe)
        read = self.folder / "read"
        with open(read, "wb") as file:
            reader = subprocess.Popen(["cat", str(pipe)], stdout=file)
        self.aaresolve("report", self.out, "-o", pipe)
        self.assertEqual(reader.wait(timeout=60), 0)
        text = read.read_bytes()
        self.aaresolve("report", self.out, "-o", report)
        self.assertEqual(text, report.read_bytes())
        self.assertTrue(stat.S_ISFIFO(os.stat(pipe).st_mode))
        link = self.folder / "link.html"
        link.symlink_to(report)
        report.write_text("old")
        self.aaresolve("report", self.out, "-o", link)
        self.assertTrue(link.is_symlink())
        self.assertEqual(report.read_bytes(), text)


class Numbers(ProgramTest):
    def test_what_is_no_number(self) -> None:
        shot = self.folder / "shot"
        synth = ("synth", "half_plane", "-o", shot, "--size", "64x36", "--frames", "2", "-q")
        for option in ("--angle", "--offset"):
            for value in ("nan", "inf", "1e308"):
                self.aaresolve(*synth, option, value, expect=2)
        self.assertFalse(shot.exists())
        self.aaresolve(*synth)
        run = ("run", shot, "-m", "fxaa311", "-o", self.folder / "out", "-q")
        for option in ("--exposure", "--flip-ppd", "--metric-fps"):
            for value in ("nan", "-nan", "inf"):
                done = self.aaresolve(*run, option, value, expect=2)
                self.assertIn(option, done.stderr)
        self.assertFalse((self.folder / "out").exists())
        # Below the smallest normal number: a number.
        self.aaresolve("run", shot, "-m", "fxaa311:subpix=1e-320", "-o", self.folder / "out", "-q")

    def test_one_word_after_a_list(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.aaresolve(
            "synth", "--for", "noaa", "moving", "-o", shot, "--size", "64x36", "--frames", "2", "-q"
        )
        self.aaresolve("run", "--metrics", "mae,flip", shot, "-m", "noaa,fxaa311", "-o", out, "-q")
        figures = json.loads((out / "results.json").read_text())["methods"][0]["frames"][0][
            "metrics"
        ]
        self.assertTrue({"mae", "flip"} <= set(figures), figures)
        self.aaresolve("run", "--maps=error", shot, "-m", "noaa", "-o", out, "-q")
        self.aaresolve("sheet", "--columns", "frame,error", out)

    def test_long_names(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.aaresolve("synth", "moving", "-o", shot, "--size", "64x36", "--frames", "2", "-q")
        kmin = "kmin=0.88000008800000007,kmax=0.97000009700000001,neighbourhood=rounded,unjitterColor=on"
        text = (
            f"inside:{kmin},unjitterNeighbourhood=off,ycocg=off,luminance=bt709,clipTarget=aabbCentre,"
            "dilation=closest3x3,history=bilinear,outside=reject,motionBlur=0,warmup=none,historyBits="
        )
        for _ in range(2):  # into a folder that holds them
            self.aaresolve(
                "run",
                shot,
                "-m",
                text + "32f",
                "-m",
                text + "16f",
                "-o",
                out,
                "--maps",
                "error",
                "-q",
            )
        methods = json.loads((out / "results.json").read_text())["methods"]
        folders = [m["folder"] for m in methods]
        self.assertEqual(len(set(folders)), 3)
        self.assertLessEqual(max(map(len, folders)), 200)
        self.assertTrue(all((out / f / "000002.exr").exists() for f in folders))
        name = self.folder / ("n" * 240 + ".html")
        self.aaresolve("report", out, "-o", name)
        self.assertTrue(name.exists())

    def test_damaged_parts_of_errors(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.aaresolve("synth", "moving", "-o", shot, "--size", "192x108", "--frames", "2", "-q")
        self.aaresolve("run", shot, "-m", "noaa,fxaa311", "-o", out, "-q")
        whole = (out / "results.json").read_text()
        first = json.loads(whole)["methods"][1]["errorParts"][0]
        for member, value in {
            "values": [],
            "halves": [],
            "squares": [1.0],
            "columns": 0,
            "rows": -1,
        }.items():
            content = json.loads(whole)
            self.assertEqual(content["methods"][1]["errorParts"][0], first)
            content["methods"][1]["errorParts"][0][member] = value
            (out / "results.json").write_text(json.dumps(content))
            for command in (
                ("run", shot, "-m", "smaa1x", "-o", out, "--add", "-q"),
                ("report", out),
            ):
                done = self.aaresolve(*command, expect=3)
                self.assertIn("results.json: damaged", done.stderr)
        self.assertFalse(math.isnan(first["measured"]))

    def test_no_name(self) -> None:
        for words in (
            ("gate", "", ""),
            ("report", ""),
            ("sheet", ""),
            ("survey", "make", "", "-o", self.folder),
            ("list", "--shot", ""),
            ("check", ""),
            ("run", "", "-m", "noaa", "-o", self.folder / "out"),
            ("run", self.folder, "-m", "noaa", "-o", ""),
            ("compare", "", ""),
            ("filter", "noaa", "", "a.png"),
            ("filter", "noaa", "a.png", ""),
            ("import", "", "-o", self.folder / "shot"),
            ("synth", "moving", "-o", ""),
        ):
            done = subprocess.run(
                [PROGRAM, *words], capture_output=True, text=True, cwd=self.folder
            )
            self.assertEqual(done.returncode, 2, (words, done.stderr))
            self.assertIn("empty name", done.stderr)

    def test_no_threads(self) -> None:
        if os.geteuid() == 0 and not shutil.which("setpriv"):
            self.skipTest("no setpriv")
        as_nobody = ["setpriv", "--reuid=65534", "--clear-groups"] if os.geteuid() == 0 else []
        shot = self.folder / "shot"
        self.aaresolve("synth", "moving", "-o", shot, "--size", "64x36", "--frames", "2", "-q")
        os.chmod(self.folder, 0o755)
        words = [
            *as_nobody,
            "sh",
            "-c",
            'ulimit -u 1; exec "$@"',
            "sh",
            str(PROGRAM),
            "check",
            str(shot),
            "-j",
            "2",
        ]
        done = subprocess.run(words, capture_output=True, text=True, timeout=120)
        if done.returncode == 0:
            self.skipTest("threads can be started in spite of the limit")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertNotIn("terminate", done.stderr)


main()
