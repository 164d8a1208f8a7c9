"""The shaders against the kernels on whole shots, as a user compares them; validation is on."""

from __future__ import annotations

import json
import re
import subprocess

from gpu import PROGRAM, ROOT, GpuTest, main, need_device

TEMPORAL = 3e-5  # largest difference, over all frames of a history
SEARCHED = 1e-4  # share of pixels that a search may decide otherwise at a tie


def study_presets() -> list[str]:
    """Methods with options or stages as the study runs them."""
    source = "".join(
        (ROOT / "scenes/reproduce" / name).read_text(encoding="utf-8")
        for name in ("catalogue.py", "shots.py", "studies.py")
    )
    written = r"\b[A-Za-z0-9]+(?::[A-Za-z0-9]+=[A-Za-z0-9.,=]+)?(?:\+[a-z]+=[A-Za-z0-9:.=]+)?"
    return sorted({w.rstrip(".,") for w in re.findall(written, source) if ":" in w or "+" in w})


class Verify(GpuTest):
    def test_files_of_every_method(self) -> None:
        """The table of shaders/README.md."""
        timed = subprocess.run(
            [PROGRAM, "bench", "-m", "all", "--device", "vulkan", "--size", "32x24", "--frames", "2", "--runs", "4", "--json"],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        files: dict[tuple[str, ...], list[str]] = {}
        for row in json.loads(timed.stdout)["rows"]:
            passes = tuple(dict.fromkeys(f"{p['shader']}.comp" for p in row["passes"]))
            files.setdefault(passes, []).append(row["method"])
        listed = lambda words: ", ".join(f"`{w}`" for w in words)  # noqa: E731
        page = (ROOT / "shaders/README.md").read_text(encoding="utf-8")
        rows = re.findall(r"^\| `.*`.*\.comp` \|$", page, re.MULTILINE)
        self.assertEqual(rows, [f"| {listed(m)} | {listed(f)} |" for f, m in files.items()])

    def test_shots(self) -> None:
        for scene, frames in (("half_planes", 4), ("thin_lines", 4), ("moving", 8)):
            shot = self.folder / scene
            self.synth(scene, shot, (96, 64), frames, "--subsamples", "d3d8", "--subsample-color")
            presets = [m for m in study_presets() if self.serves(shot, m)]
            self.assertGreater(len(presets), 3, presets)
            found = {**self.verify(shot, []), **self.verify(shot, presets)}
            self.assertGreater(len(found), 38)
            for name, m in found.items():
                with self.subTest(f"{scene} {name}"):
                    self.assertEqual(m["notFinite"], 0)
                    if m["family"] == "spatial":
                        self.assertLessEqual(m["shareAboveCode"], SEARCHED)
                    else:
                        self.assertLessEqual(m["max"], TEMPORAL)

    def serves(self, shot: object, method: str) -> bool:
        command = [str(PROGRAM), "run", str(shot), "-m", method, "--frames", "1", "--write", "none"]
        done = subprocess.run(
            [*command, "-o", str(self.folder / "probe"), "-q"], capture_output=True, check=False
        )
        return done.returncode == 0

    def test_fast_is_near(self) -> None:
        shot = self.folder / "shot"
        self.synth("moving", shot, (96, 64), 4)
        for name, m in self.verify(shot, ["karis", "uncharted"], "--gpu-precision", "fast").items():
            with self.subTest(name):
                self.assertLess(m["rms"], 2e-3)
                self.assertGreater(m["max"], 1e-6)  # it is not the exact one

    def test_one_image(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("half_planes", shot, (96, 64), 1)
        self.aaresolve("run", shot, "-m", "noaa", "-o", out, "-q")
        picture = next((out / "noaa").glob("*.exr"))
        cpu, gpu = self.folder / "cpu.exr", self.folder / "gpu.exr"
        self.aaresolve("filter", "smaa1x", picture, cpu)
        said = self.aaresolve("filter", "smaa1x", picture, gpu, "--device", "vulkan")
        self.assertIn(" ms on ", said.stdout)
        figures = ("--json", "--metrics", "mse,ssimRgb,flip")
        compared = [
            json.loads(self.aaresolve("compare", picture, cpu, *figures, *device).stdout)["pooled"]
            for device in ((), ("--device", "vulkan"))
        ]
        for name in ("mse", "ssimRgb", "flip"):
            self.assertAlmostEqual(compared[0][name], compared[1][name], delta=1e-6)
        equal = self.aaresolve("compare", cpu, gpu, "--json")
        self.assertLess(json.loads(equal.stdout)["pooled"]["mse"], 1e-10)


if __name__ == "__main__":
    need_device()
    main()
