"""Every shader as HLSL and MSL, as an engine on Direct3D or Metal would take it, and back as GLSL.

HLSL and GLSL are compiled again with glslang. Debian has no compiler of MSL, so that text is only made.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from gpu import SHADERS, SKIPPED, SPIRV, GpuTest, main


def run(*command: object) -> str:
    """What went wrong, or nothing."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stdout + done.stderr


class Translate(GpuTest):
    def test_hlsl_msl_glsl(self) -> None:
        names = [
            s.relative_to(SHADERS).with_suffix("")
            for s in sorted(SHADERS.rglob("*.comp"))
            if "example" not in s.parts
        ]
        self.assertGreater(len(names), 0)
        for name in names:
            spirv = SPIRV / name.with_suffix(".spv")
            hlsl, msl, glsl = (self.folder / f"x.{kind}" for kind in ("hlsl", "metal", "comp"))
            back = self.folder / "back.spv"
            with self.subTest(str(name)):
                self.assertTrue(spirv.exists(), spirv)
                self.assertEqual(
                    run("spirv-cross", spirv, "--hlsl", "--shader-model", 60, "--output", hlsl), ""
                )
                self.assertEqual(
                    run(
                        "glslangValidator", "-D", "-V", "-S", "comp", "-e", "main", hlsl, "-o", back
                    ),
                    "",
                )
                self.assertEqual(
                    run("spirv-cross", spirv, "--msl", "--msl-version", 20200, "--output", msl), ""
                )
                self.assertIn("kernel void main0", msl.read_text(encoding="utf-8"))
                self.assertEqual(
                    run("spirv-cross", spirv, "--vulkan-semantics", "--output", glsl), ""
                )
                self.assertEqual(run("glslangValidator", "-V", "-S", "comp", glsl, "-o", back), "")


if __name__ == "__main__":
    if not shutil.which("spirv-cross"):
        print("SKIPPED: spirv-cross is missing (apt-get install spirv-cross)")
        sys.exit(SKIPPED)
    main()
