"""Shaders from Python: compiling them, changing them, comparing them with the kernels."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "e2e"))
from program import PROGRAM, ROOT, ProgramTest, main  # noqa: E402,F401

SHADERS = ROOT / "shaders"
SPIRV = Path(os.environ.get("AA_SPIRV", ROOT / "build/resolver/gpu/spirv"))
SKIPPED = 77


def compile_shader(source: Path, to: Path) -> None:
    to.parent.mkdir(parents=True, exist_ok=True)
    command = ["glslangValidator", "--quiet", "-V", "--target-env", "vulkan1.1"]
    done = subprocess.run(
        [*command, "-o", str(to), str(source)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise AssertionError(f"{source}: {done.stdout}{done.stderr}")


def need_device() -> None:
    """Ends the test as skipped where Vulkan offers no device."""
    done = subprocess.run([str(PROGRAM), "devices", "--json"], capture_output=True, text=True)
    if done.returncode or not json.loads(done.stdout):
        print(f"SKIPPED: no Vulkan device here: {done.stderr.strip()}")
        sys.exit(SKIPPED)


class GpuTest(ProgramTest):
    """A test case that compares shaders and kernels; validation is on in every comparison."""

    def verify(self, shot: Path, methods: list[str], *options: object) -> dict[str, dict]:
        """What `verify` found, by method."""
        chosen = [word for m in methods for word in ("-m", m)]
        done = self.aaresolve("verify", shot, *chosen, "--gpu-validate", "--json", "-q", *options)
        return {m["method"]: m for m in json.loads(done.stdout)["methods"]}

    def changed(self, shader: str, file: str, old: str, new: str) -> Path:
        """A folder of SPIR-V with `shader` as it is when `old` in shaders/`file` reads `new`."""
        copy = self.folder / "shaders"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(SHADERS, copy)
        text = (copy / file).read_text(encoding="utf-8")
        self.assertEqual(text.count(old), 1, f"{file}: {old!r} is not there once; mend this test")
        (copy / file).write_text(text.replace(old, new), encoding="utf-8")
        binaries = self.folder / "spirv"
        compile_shader(copy / f"{shader}.comp", binaries / f"{shader}.spv")
        return binaries
