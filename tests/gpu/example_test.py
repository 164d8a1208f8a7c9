"""shaders/example/ depends on nothing of the program and gives the picture that the program gives."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess

from gpu import SHADERS, SPIRV, GpuTest, main, need_device


class Example(GpuTest):
    def test_same_picture(self) -> None:
        source = SHADERS / "example/host.cpp"
        includes = re.findall(r'#include "([^"]+)"', source.read_text(encoding="utf-8"))
        self.assertEqual(includes, [], "the example takes nothing from the project")
        # Where Debian has OpenEXR; elsewhere pkg-config knows.
        flags = ["-I/usr/include/OpenEXR", "-I/usr/include/Imath", "-lOpenEXR", "-lIex", "-lImath"]
        if shutil.which("pkg-config"):
            flags = subprocess.run(
                ["pkg-config", "--cflags", "--libs", "OpenEXR"],
                capture_output=True,
                text=True,
                check=True,
            ).stdout.split()
        host = self.folder / "host"
        compiler = os.environ.get("CXX", "c++")
        subprocess.run(
            [compiler, "-std=c++20", "-O0", str(source), "-o", str(host), *flags, "-lvulkan"],
            check=True,
        )
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (96, 64), 8)
        self.aaresolve("run", shot, "-m", "karis", "-o", out, "-q")
        picture = self.folder / "host.exr"
        subprocess.run(
            [str(host), str(SPIRV / "temporal/karis.spv"), str(shot), str(picture)], check=True
        )
        found = self.aaresolve(
            "compare", picture, out / "karis/000008.exr", "--json", "--metrics", "mse"
        )
        figures = json.loads(found.stdout)
        self.assertLess(figures["pooled"]["mse"], 1e-10, figures)


if __name__ == "__main__":
    need_device()
    main()
