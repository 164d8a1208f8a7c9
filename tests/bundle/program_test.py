"""The add-on's search for the program: which one it takes, and what it says of one that cannot serve. Without Blender."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "blender_addon"))

from aa_resolve import ADDON_VERSION, program  # noqa: E402


class Search(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="aa_program_test_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.on_path = self.folder / "on_path"
        self.on_path.mkdir()
        for patch in (
            mock.patch.dict(os.environ, PATH=f"{self.on_path}:/usr/bin:/bin"),
            mock.patch.object(program, "BUNDLED", str(self.folder / "bundle/bin/aaresolve")),
        ):
            patch.start()
            self.addCleanup(patch.stop)
        program.look_again()

    def script(self, path: Path | str, text: str, mode: int = 0o755) -> str:
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/bin/sh\n" + text + "\n")
        path.chmod(mode)
        return str(path)

    def stand_in(self, path: Path | str, version: str = ADDON_VERSION, mode: int = 0o755) -> str:
        return self.script(path, f"echo {version}", mode)

    def refused(self, preferred: str, *expected: str) -> None:
        self.assertIsNone(program.find(preferred))
        said = program.problem(preferred)
        for part in expected:
            self.assertIn(part, said)
        self.assertNotIn("\n", said)

    def test_the_order(self) -> None:
        self.refused("", "was not found", "preferences", "PATH")
        last = self.stand_in(self.on_path / "aaresolve")
        self.assertEqual(program.find(""), program.Program(last, ADDON_VERSION, program.PATH))
        second = self.stand_in(program.BUNDLED)
        self.assertEqual(program.find(""), program.Program(second, ADDON_VERSION, program.BUNDLE))
        first = self.stand_in(self.folder / "mine")
        found = program.find(first)
        self.assertEqual(found, program.Program(first, ADDON_VERSION, program.PREFERENCE))
        self.assertEqual(program.problem(first), "")

    def test_a_wrong_preference_is_said_and_not_replaced(self) -> None:
        self.stand_in(self.on_path / "aaresolve")
        gone = str(self.folder / "gone")
        self.refused(gone, gone, "no such file", "leave the field empty")
        self.refused(str(self.folder), "is a folder")
        self.refused(self.stand_in(self.folder / "plain", mode=0o644), "not an executable file")
        silent = self.script(self.folder / "silent", "exit 0")
        self.refused(silent, "is not aaresolve", "nothing, and ended with code 0")
        self.refused("/bin/ls", "is not aaresolve", "ls (GNU coreutils)")
        self.refused(
            self.script(
                self.folder / "no_library",
                "echo 'libx.so.1: cannot open shared object' >&2; exit 127",
            ),
            "cannot run here",
            "libx.so.1: cannot open shared object",
        )
        foreign = self.folder / "foreign"
        foreign.write_bytes(b"\x7fELF of another machine")
        foreign.chmod(0o755)
        self.refused(str(foreign), "cannot be started")

    def test_what_the_zip_brought_becomes_executable(self) -> None:
        called = self.script(program.BUNDLED, 'exec "${0%/bin/*}/libexec/aaresolve" "$@"', 0o644)
        started = self.stand_in(self.folder / "bundle/libexec/aaresolve", mode=0o644)
        self.assertEqual(program.find(""), program.Program(called, ADDON_VERSION, program.BUNDLE))
        for path in (called, started):
            self.assertTrue(os.access(path, os.X_OK), path)

    def test_another_version_is_found_and_a_problem(self) -> None:
        old = self.stand_in(self.folder / "old", "0.9.0")
        self.assertEqual(program.find(old).version, "0.9.0")
        self.assertIn("0.9.0", program.problem(old))
        self.assertIn(ADDON_VERSION, program.problem(old))

    def test_a_program_is_asked_once_until_it_changes(self) -> None:
        path = self.stand_in(self.folder / "mine", "1.2.3")
        with mock.patch.object(subprocess, "run", wraps=subprocess.run) as run:
            for _ in range(3):
                self.assertEqual(program.find(path).version, "1.2.3")
            self.assertEqual(run.call_count, 1)
            self.stand_in(path, "1.2.30")
            self.assertEqual(program.find(path).version, "1.2.30")
            program.look_again()
            program.find(path)
            self.assertEqual(run.call_count, 3)

    def test_a_blender_without_numpy_is_told_what_to_do(self) -> None:
        import aa_resolve

        with mock.patch.dict(sys.modules, numpy=None):
            with self.assertRaisesRegex(RuntimeError, "apt-get install python3-numpy"):
                aa_resolve.register()


if __name__ == "__main__":
    unittest.main()
