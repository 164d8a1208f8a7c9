"""RSAA's masks: what the program computes from a Blender shot's geometry is what the exporter wrote as its mask pass."""

from __future__ import annotations

import re

from program import ROOT, ProgramTest, main, run_blender


class Masks(ProgramTest):
    def blender(self, *arguments: object) -> None:
        done = run_blender(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr[-2000:])

    def pictures(self, shot, method: str) -> list[bytes]:
        out = self.folder / re.sub(r"\W", "_", f"{shot.name}_{method}")
        self.aaresolve(
            "run", shot, "-m", method, "-o", out, "-q", "--write", "exr", "--write-frames", "all"
        )
        return [p.read_bytes() for p in sorted(out.rglob("*.exr")) if p.parent != out]

    def test_computed_masks_equal_the_pass(self) -> None:
        """Wires, railings and a skeleton at 64 x 36: most edge pixels hold several surfaces."""
        blend = self.folder / "scene.blend"
        self.blender(
            "--factory-startup",
            "--python-exit-code",
            9,
            "-P",
            ROOT / "scenes/wires.py",
            "--",
            "--out",
            blend,
        )
        for pattern in ("d3d4", "d3d8"):
            shot = self.folder / pattern
            self.blender(
                blend, "--python-exit-code", 9, "-P", ROOT / "blender_addon/aa_resolve/headless.py", "--", "--out", shot,
                "--for", f"rsaa:S={pattern[3:]}", "--resolution", "64x36", "--frames", "3", "--truth-frames", "none",
            )  # fmt: skip
            plain = self.pictures(shot, "noaa")
            self.assertEqual(len(plain), 1)
            for tuning in ("off", "on"):
                computed = self.pictures(shot, f"rsaa:mask=geometry,tuning={tuning}")
                self.assertNotEqual(computed, plain)
                self.assertEqual(
                    computed,
                    self.pictures(shot, f"rsaa:mask=pass,tuning={tuning}"),
                    f"{pattern} {tuning}",
                )


main()
