"""Bad input: each case ends with one clear line and the right exit code, and damages nothing."""

from __future__ import annotations

import json
import os
import resource
import shutil
import signal
import subprocess
from pathlib import Path

import pictures
from program import PROGRAM, ProgramTest, digests, main


class BadInput(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.shot = self.folder / "shot"
        self.synth("moving", self.shot, (48, 32), 3, "--for", "noaa,uncharted")

    def run_refused(self, code: int, *says: str, method: str = "noaa", **options) -> str:
        return self.refused(
            code,
            "run",
            self.shot,
            "-m",
            method,
            "-o",
            self.folder / "out",
            "-q",
            says=says,
            **options,
        )

    def frame(self, number: int) -> Path:
        return self.shot / "frames" / f"{number:06d}.exr"

    def edit_manifest(self, change) -> None:
        path = self.shot / "shot.json"
        manifest = json.loads(path.read_text())
        change(manifest)
        path.write_text(json.dumps(manifest))

    def test_missing_shot(self) -> None:
        shutil.rmtree(self.shot)
        self.run_refused(3, str(self.shot))

    def test_missing_frame(self) -> None:
        self.frame(2).unlink()
        self.run_refused(3, "000002.exr")

    def test_truncated_exr(self) -> None:
        path = self.frame(2)
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
        self.run_refused(3, "000002.exr", method="uncharted")

    def test_not_an_exr(self) -> None:
        self.frame(2).write_text("this is no picture")
        self.run_refused(3, "000002.exr")

    def test_wrong_resolution(self) -> None:
        self.edit_manifest(lambda m: m.update(resolution=[64, 32]))
        self.run_refused(3, "64", "48")

    def test_missing_pass_names_pass_and_method(self) -> None:
        shot = self.folder / "colour_only"
        self.synth("moving", shot, (48, 32), 2, "--for", "noaa")
        self.refused(
            3,
            "run",
            shot,
            "-m",
            "uncharted",
            "-o",
            self.folder / "o",
            "-q",
            says=("uncharted", "depth"),
        )

    def test_manifest_with_wrong_type(self) -> None:
        self.edit_manifest(lambda m: m["frames"][1].update(jitter="none"))
        self.run_refused(3, "shot.json", "frames[1].jitter")

    def test_manifest_is_not_json(self) -> None:
        (self.shot / "shot.json").write_text("{")
        self.run_refused(3, "shot.json")

    def test_unknown_method_is_suggested(self) -> None:
        self.run_refused(2, "unchartedd", "did you mean 'uncharted'", method="unchartedd")

    def test_parameter_out_of_range(self) -> None:
        self.run_refused(2, "kmin", "0 to 1", method="uncharted:kmin=2")

    def test_unknown_parameter_is_suggested(self) -> None:
        self.run_refused(2, "did you mean 'kmin'", method="uncharted:kmni=0.5")

    def test_nan_is_counted_or_refused(self) -> None:
        shot = self.folder / "nan"
        self.synth("moving", shot, (48, 32), 2, "--for", "noaa", "--inject-nan", "10", "7")
        done = self.aaresolve("run", shot, "-m", "noaa", "-o", self.folder / "o", "-q")
        self.assertIn("colourNan", done.stdout)
        self.refused(
            3,
            "run",
            shot,
            "-m",
            "noaa",
            "-o",
            self.folder / "o",
            "-q",
            "--non-finite",
            "strict",
            says=("color", "10", "7"),
        )

    def test_output_folder_not_writable(self) -> None:
        if os.geteuid() == 0:  # root may write anywhere: a file in the way is the same refusal
            (self.folder / "out").write_text("in the way")
        else:
            (self.folder / "out").mkdir(mode=0o500)
        self.run_refused(1, str(self.folder / "out"))

    def test_disk_full_keeps_finished_frames(self) -> None:
        """A limit on the size of files stands in for a full disk: the large image fails, earlier files stay whole."""
        out = self.folder / "out"
        self.aaresolve("run", self.shot, "-m", "noaa", "-o", out, "-q", "--write-frames", "all")
        before = digests(out)
        self.assertGreater(len(before), 3)

        def small_files() -> None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1500, 1500))

        self.run_refused(1, "cannot be written", preexec_fn=small_files)
        self.assertEqual(before, digests(out))
        self.assertEqual([], [p for p in out.rglob(".*")], "a partial file was left behind")

    def test_other_formats_need_their_module_and_nothing_else_does(self) -> None:
        tiff, png = self.folder / "in.tif", self.folder / "out.png"
        tiff.write_bytes(pictures.tiff(24, 20, bytes(i % 251 for i in range(24 * 20))))
        self.aaresolve("filter", "noaa", tiff, png)
        expected = png.read_bytes()
        loaded = subprocess.run(
            [PROGRAM], env={"LD_TRACE_LOADED_OBJECTS": "1"}, capture_output=True, text=True
        )
        self.assertIn("OpenEXR", loaded.stdout)
        self.assertNotIn("OpenImageIO", loaded.stdout)
        alone = self.folder / "alone" / "bin" / PROGRAM.name
        alone.parent.mkdir(parents=True)
        shutil.copy(PROGRAM, alone)
        command = [alone, "filter", "noaa", tiff, png]
        refused = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(refused.returncode, 3)
        for words in (
            "in.tif",
            "TIFF file",
            "aaresolve_formats.so",
            "OpenImageIO",
            "AARESOLVE_FORMATS",
        ):
            self.assertIn(words, refused.stderr)
        self.assertEqual(refused.stderr.count("\n"), 1)
        module = PROGRAM.parent / "aaresolve_formats.so"
        subprocess.run(
            command,
            check=True,
            env={**os.environ, "AARESOLVE_FORMATS": str(module)},
            capture_output=True,
        )
        self.assertEqual(png.read_bytes(), expected)
        installed = self.folder / "alone" / "lib" / "aaresolve" / module.name
        installed.parent.mkdir(parents=True)
        installed.write_text("no library")
        refused = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(refused.returncode, 3)
        self.assertIn(str(installed), refused.stderr)
        shutil.copy(module, installed)
        subprocess.run(command, check=True, capture_output=True)
        tiff.write_bytes(tiff.read_bytes()[:200])
        self.refused(3, "filter", "noaa", tiff, png, says=("in.tif",))

    def test_words_that_are_nearly_right(self) -> None:
        run = ("run", self.shot, "-o", self.folder / "o", "-q", "-m")
        for kinds in ("pngexrjunk", "none,exr", "exr,", "jpg"):
            self.refused(2, *run, "noaa", "--write", kinds, says=(f"--write: expected exr, png, exr,png or none, found '{kinds}'",))  # fmt: skip
        self.refused(2, *run, "fxaa311:subpix=0,subpix=1", says=("parameter 'subpix' is given twice",))  # fmt: skip
        self.refused(2, *run, "noaa", "--external", f"results.json={self.shot / 'truth'}", says=("'results.json' is a file's name",))  # fmt: skip
        self.assertFalse((self.folder / "o").exists(), "told before anything is computed")
        self.refused(2, "synth", "moving", "-o", self.folder / "s", "--start", -2, says=("--start", "-2"))  # fmt: skip
        layout = self.folder / "layout.json"
        layout.write_text("{}")
        self.refused(2, "import", self.shot, "-o", self.folder / "i", "--layout", layout, "--fps", 30, says=("--fps", "--layout"))  # fmt: skip

    def test_usage(self) -> None:
        self.refused(2, "run", self.shot, says=("--out",))
        self.refused(2, "nonsense", says=("nonsense",))
        # More bytes than an integer holds would be none on x86-64, hence no limit, and some number on Arm.
        self.refused(
            2, "report", self.shot, "--embed-limit", "1e20", says=("--embed-limit", "not in range")
        )
        self.refused(
            2, "filter", "uncharted", "a.png", "b.png", says=("needs more than one image",)
        )
        self.refused(
            3,
            "filter",
            "noaa",
            self.folder / "none.png",
            self.folder / "b.png",
            says=("none.png", "no such file"),
        )
        self.refused(
            3,
            "run",
            self.shot,
            "-m",
            "noaa",
            "-o",
            self.folder / "o",
            "--frames",
            "99",
            says=("99",),
        )


main()
