"""Runs aaresolve as a user would and keeps what it said."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(sys.argv[1]).resolve()
LIMIT_S = float(
    os.environ.get("AARESOLVE_TEST_LIMIT_S", 600)
)  # of one call; an emulated program needs more
ROOT = Path(sys.argv[2]).resolve()
sys.path.insert(0, str(ROOT / "tests/addon"))

import in_blender  # noqa: E402


def run_blender(*arguments: object) -> subprocess.CompletedProcess:
    """The Blender that the variable BLENDER names, else `blender`."""
    return subprocess.run(
        [in_blender.blender(), "-b", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=600,
        env=in_blender.environment(),
    )


def digests(folder: Path, files: str = "*.exr") -> dict[str, str]:
    """Of each such file in the folder and below by its name in there: to compare files, for bytes that differ would be
    printed for minutes."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob(files))
    }


class ProgramTest(unittest.TestCase):
    """A test case with a temporary folder and the program."""

    def setUp(self) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)

    def tearDown(self) -> None:
        self._folder.cleanup()

    def aaresolve(
        self, *arguments: object, expect: int = 0, **options
    ) -> subprocess.CompletedProcess:
        done = subprocess.run(
            [str(PROGRAM), *map(str, arguments)],
            capture_output=True,
            text=True,
            timeout=LIMIT_S,
            **options,
        )
        self.assertEqual(
            done.returncode,
            expect,
            f"aaresolve {' '.join(map(str, arguments))}\n{done.stdout}\n{done.stderr}",
        )
        return done

    def synth(
        self, scene: str, shot: Path, size: tuple[int, int], frames: int, *options: object
    ) -> None:
        """Makes an analytic shot of `size` pixels."""
        self.aaresolve(
            "synth",
            scene,
            "-o",
            shot,
            "--size",
            "{}x{}".format(*size),
            "--frames",
            frames,
            *options,
        )

    def refused(self, code: int, *arguments: object, says: tuple[str, ...], **options) -> str:
        """The call must end with `code` and one line on stderr that holds every word of `says`."""
        done = self.aaresolve(*arguments, expect=code, **options)
        lines = [line for line in done.stderr.splitlines() if line.startswith("aaresolve: ")]
        self.assertEqual(len(lines), 1, done.stderr)
        for words in says:
            self.assertIn(words, lines[0])
        return lines[0]


def main() -> None:
    unittest.main(argv=sys.argv[:1])
