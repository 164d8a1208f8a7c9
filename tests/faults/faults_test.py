"""faults_test.py PROGRAM ROOT SHIM: a full disk at each write, kills at random moments, files that are cut or shrink, folders
that are read-only, two writers, a clock that is set back. After each, nothing is taken for good that is not, earlier results
stand, and the same command again gives the same bytes.

AA_FAULTS=N: so many kills, full disks and shrinking files of every command (default 6); AA_FAULTS_ONLY=run,gate: of these
alone; AA_FAULTS_SEED=S."""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path
from typing import Iterator

SHIM = Path(sys.argv[3]).resolve()
sys.path.insert(0, str(Path(sys.argv[2]).resolve() / "tests/e2e"))
del sys.argv[3]  # unittest reads the rest

from program import PROGRAM, ProgramTest, main  # noqa: E402

COUNT = int(os.environ.get("AA_FAULTS", "6"))
SEED = int(os.environ.get("AA_FAULTS_SEED", "1"))
ONLY = os.environ.get("AA_FAULTS_ONLY", "")
LOCK = ".aaresolve.lock"
RESULTS = ("results.json", "results.csv")
# What a second run may tell otherwise.
OF_THE_MOMENT = (
    "seconds",
    "nsPerPixel",
    "time",
    "date",
    "load",
    "machine",
    "timings",
    "command",
    "provenance",
)


def without_the_moment(node: object) -> object:
    """A document without times and whatever else is of one run alone."""
    if isinstance(node, dict):
        return {
            key: without_the_moment(value)
            for key, value in node.items()
            if not any(word.lower() in key.lower() for word in OF_THE_MOMENT)
        }
    return [without_the_moment(item) for item in node] if isinstance(node, list) else node


def content(path: Path) -> object:
    """A file as it is compared: its bytes, of results what is not of the moment."""
    if path.suffix == ".json":
        return without_the_moment(json.loads(path.read_text()))
    if path.name in ("results.csv", "sweep.csv"):
        return path.read_text().splitlines()[0]  # times are in its lines
    if path.name == "sweep.html":
        return re.sub(r'"time":[\d.e+-]+', "", path.read_text())
    return path.read_bytes()


def contents(folder: Path) -> dict[str, object]:
    return {
        str(path.relative_to(folder)): content(path)
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


class FaultsTest(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.shot = self.folder / "shot"
        self.synth("two_planes", self.shot, (48, 32), 3, "-q")
        self.random = random.Random(f"{SEED}/{self.id()}")

    # Each makes everything in `out` and is told its folder alone.
    def commands(self) -> dict[str, list[str]]:
        run, worse = str(self.folder / "run"), str(self.folder / "worse")
        self.aaresolve("run", self.shot, "-m", "noaa", "-m", "taaSimplest", "-o", run, "-q")
        self.aaresolve("run", self.shot, "-m", "noaa", "-m", "taaSimplest", "-o", worse, "-q")
        all_of_them = {
            "synth": ["synth", "two_planes", "--size", "48x32", "--frames", "3", "-q", "-o", "OUT"],
            "run": ["run", str(self.shot), "-m", "noaa", "-m", "fxaa311", "-m", "uncharted", "-q", "-o", "OUT",
                    "--write", "exr,png"],
            "sweep": ["sweep", str(self.shot), "-m", "uncharted", "--vary", "kmin=0.5,0.9", "-q", "-o", "OUT"],
            "report": ["report", run, "-o", "OUT/report.html"],
            "sheet": ["sheet", run, "-o", "OUT/sheet.png"],
            "gate": ["gate", run, worse, "--junit", "OUT/gate.xml"],
        }  # fmt: skip
        return {
            name: words
            for name, words in all_of_them.items()
            if not ONLY or name in ONLY.split(",")
        }

    def start(self, command: list[str], out: Path, **environment: str) -> subprocess.Popen:
        out.mkdir(exist_ok=True)
        return subprocess.Popen(
            [str(PROGRAM), *(part.replace("OUT", str(out)) for part in command)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=os.environ | environment,
        )

    def finished(self, command: list[str], out: Path) -> dict[str, object]:
        process = self.start(command, out)
        said = process.communicate(timeout=300)
        self.assertEqual(process.returncode, 0, said)
        return contents(out)

    def counted(self, command: list[str], out: Path, **environment: str) -> tuple[int, int]:
        """Writes of a command, and how often it touches the file that may shrink."""
        told = self.folder / "counted"
        process = self.start(command, out, LD_PRELOAD=str(SHIM), AA_COUNT=str(told), **environment)
        said = process.communicate(timeout=300)
        self.assertEqual(process.returncode, 0, said)
        writes, touches = told.read_text().split()
        return int(writes), int(touches)

    def moments(self, count: int) -> list[int]:
        """The first two, the last, and others by chance."""
        if count <= COUNT:
            return list(range(1, count + 1))
        return sorted({1, 2, count, *self.random.sample(range(1, count + 1), COUNT - 2)})

    def check_whole(self, out: Path, whole: dict[str, object], what: str) -> None:
        """Every file under its own name is one of the whole result."""
        for path in sorted(out.rglob("*")):
            if path.is_file() and ".partial" not in path.name and path.name != LOCK:
                name = str(path.relative_to(out))
                self.assertIn(name, whole, what)
                if path.name not in RESULTS or self.is_complete(path.parent):
                    self.assertEqual(content(path), whole[name], f"{what}: {name}")

    @staticmethod
    def is_complete(run: Path) -> bool:
        """Results of a run that ended early say so."""
        results = run / "results.json"
        return results.exists() and json.loads(results.read_text())["run"]["complete"]

    def check_repeats(self, command: list[str], out: Path, whole: dict, what: str) -> None:
        again = self.finished(command, out)
        self.assertEqual(sorted(again), sorted(whole), what)
        for name, value in whole.items():
            self.assertEqual(again[name], value, f"{what}, again: {name}")

    def test_a_full_disk_at_each_write(self) -> None:
        for name, command in self.commands().items():
            out = self.folder / f"{name}-whole"
            writes, _ = self.counted(command, out)
            whole = contents(out)
            self.assertGreater(writes, 0, name)
            for at in self.moments(writes):
                with self.subTest(name, write=at):
                    out = self.folder / f"{name}-{at}"
                    process = self.start(command, out, LD_PRELOAD=str(SHIM), AA_FULL_AT=str(at))
                    said = process.communicate(timeout=300)[1]
                    what = f"{name}, full at write {at} of {writes}"
                    self.assertEqual(process.returncode, 1, f"{what}: {said}")
                    lines = [line for line in said.splitlines() if line.startswith("aaresolve: ")]
                    self.assertEqual(len(lines), 1, f"{what}: {said}")
                    self.assertIn("No space left on device", lines[0])
                    self.assertEqual([], [p for p in out.rglob("*.partial*")], what)
                    self.check_whole(out, whole, what)
                    self.check_repeats(command, out, whole, what)
                    shutil.rmtree(out)

    def test_a_kill_at_any_moment(self) -> None:
        for name, command in self.commands().items():
            out = self.folder / f"{name}-whole"
            whole = self.finished(command, out)
            start = time.monotonic()
            self.finished(command, out)
            lasts = time.monotonic() - start
            for number in range(COUNT):
                with self.subTest(name, kill=number):
                    out = self.folder / f"{name}-{number}"
                    after = self.random.uniform(0, lasts)
                    process = self.start(command, out)
                    time.sleep(after)
                    process.send_signal(signal.SIGKILL)
                    process.communicate()
                    what = f"{name}, killed after {after:.3f} of {lasts:.3f} s"
                    self.check_whole(out, whole, what)
                    self.check_repeats(command, out, whole, what)
                    shutil.rmtree(out)

    def test_earlier_results_outlive_a_full_disk(self) -> None:
        out = self.folder / "out"
        first = ["run", str(self.shot), "-m", "noaa", "-m", "fxaa311", "-q", "-o", "OUT"]
        whole = self.finished(first, out)
        process = self.start(first, out, LD_PRELOAD=str(SHIM), AA_FULL_AT="1")
        process.communicate()
        self.assertEqual(process.returncode, 1)
        self.check_whole(out, whole, "a second run on a full disk")
        self.aaresolve("report", out, "-o", self.folder / "report.html")

    def test_a_cut_frame_in_the_middle_is_named(self) -> None:
        frame = self.shot / "frames/000002.exr"
        whole = frame.read_bytes()
        frame.write_bytes(whole[: len(whole) // 3])
        self.refused(
            3, "run", self.shot, "-m", "uncharted", "-o", self.folder / "out", "-q",
            says=("000002.exr", "truncated or damaged"),
        )  # fmt: skip

    def test_two_writers_of_one_folder_give_one_whole_result(self) -> None:
        out = self.folder / "out"
        command = self.commands().get("run") or self.skipTest("not of these commands")
        whole = self.finished(command, out)
        shutil.rmtree(out)
        for _ in range(COUNT):
            both = [self.start(command, out) for _ in range(2)]
            said = [process.communicate(timeout=300)[1] for process in both]
            codes = sorted(process.returncode for process in both)
            self.assertIn(codes, ([0, 0], [0, 3]), said)
            if codes == [0, 3]:
                self.assertTrue(any("another process" in text for text in said), said)
            now = contents(out)
            self.assertEqual(sorted(now), sorted(whole))
            self.check_whole(out, whole, "two writers")

    def test_a_file_that_shrinks_while_it_is_read(self) -> None:
        """It is named, or was read before: never half of it taken for the whole."""
        run = self.folder / "run"
        commands = self.commands()
        picture = self.folder / "picture.png"
        shutil.copy(run / "noaa/000003.exr", self.folder / "picture.exr")
        self.aaresolve("filter", "noaa", self.folder / "picture.exr", picture)
        self.aaresolve("report", run, "-o", self.folder / "report.html")
        run_command = commands.get("run", [])
        cases = [
            (run_command, self.shot / "shot.json"),
            (run_command, self.shot / "frames/000002.exr"),
            (run_command, next((self.shot / "truth").glob("*.exr"))),
            (commands.get("report", []), run / "results.json"),
            (commands.get("report", []), run / "noaa/000003.exr"),
            (["filter", "fxaa311", str(picture), "OUT/filtered.png"], picture),
            (["filter", "fxaa311", str(self.folder / "picture.exr"), "OUT/filtered.exr"], self.folder / "picture.exr"),
        ]  # fmt: skip
        for number, (command, file) in enumerate(cases):
            if not command:
                continue
            whole_file = file.read_bytes()
            out = self.folder / f"shrinks-{number}"
            _, touches = self.counted(command, out, AA_SHRINKS=str(file))
            whole = contents(out)
            self.assertGreater(touches, 0, f"{file} is not read")
            for at in self.moments(touches):
                with self.subTest(command[0], file=file.name, touch=at):
                    shutil.rmtree(out)
                    shrinking = {"AA_SHRINKS": str(file), "AA_SHRINK_AT": str(at)}
                    process = self.start(command, out, LD_PRELOAD=str(SHIM), **shrinking)
                    said = process.communicate(timeout=300)[1]
                    what = f"{command[0]}, {file.name} shrinks at touch {at} of {touches}: {said}"
                    if len(file.read_bytes()) == len(whole_file):
                        # Threads share the reading: this time they touched it less often.
                        self.assertGreater(at, 1, what)
                        self.assertEqual(process.returncode, 0, what)
                        continue
                    self.assertIn(process.returncode, (0, 3), what)
                    if process.returncode == 3:
                        lines = [
                            line for line in said.splitlines() if line.startswith("aaresolve: ")
                        ]
                        self.assertEqual(len(lines), 1, what)
                        self.assertIn(file.name, lines[0])
                    self.check_whole(out, whole, what)
                    file.write_bytes(whole_file)
                    self.check_repeats(command, out, whole, what)

    def test_a_read_only_folder_is_named(self) -> None:
        commands = self.commands()
        place = self.folder / "place"
        place.mkdir()
        with read_only(place) as possible:
            if not possible:
                self.skipTest("nothing is read-only for root without the right to mount")
            for name, command in commands.items():
                with self.subTest(name):
                    process = self.start(command, place)
                    said = process.communicate(timeout=300)[1]
                    lines = [line for line in said.splitlines() if line.startswith("aaresolve: ")]
                    self.assertEqual(process.returncode, 1, said)
                    self.assertEqual(len(lines), 1, said)
                    self.assertIn(str(place), lines[0])
                    self.assertEqual([p for p in place.iterdir()], [])

    def test_a_clock_that_is_set_back(self) -> None:
        """By a year, between a command and the same again, and files are of the future."""
        year = 365 * 24 * 3600
        for name, command in self.commands().items():
            with self.subTest(name):
                out = self.folder / f"{name}-clock"
                whole = self.finished(command, out)
                again = [*command, "--resume"] if name == "run" else command
                process = self.start(again, out, LD_PRELOAD=str(SHIM), AA_CLOCK=str(-year))
                said = process.communicate(timeout=300)
                self.assertEqual(process.returncode, 0, said)
                self.assertEqual(contents(out), whole)
                self.assertEqual([], [p for p in out.rglob("*.partial*")])


@contextlib.contextmanager
def read_only(folder: Path) -> Iterator[bool]:
    """The folder while nobody may write there, root neither; False where that cannot be."""
    if os.geteuid() != 0:
        folder.chmod(0o555)
        yield True
        folder.chmod(0o755)
        return
    library, place, readable = ctypes.CDLL(None), os.fsencode(folder), 1
    if library.mount(b"tmpfs", place, b"tmpfs", readable, b"size=32k"):
        yield False
        return
    try:
        yield True
    finally:
        library.umount2(place, 2)


if __name__ == "__main__":
    main()
