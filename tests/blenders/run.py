"""Runs all that depends on Blender in the Blenders of other Debians, and ends with a table of scripts and Blenders.

    python3 tests/blenders/run.py PROGRAM [-j 2] [--suites trixie sid host] [--only light scenes e2e.import]

In each suite (`host`: the Blender of BLENDER or PATH): the add-on's tests; the scenes of `make demo` and one of many
shards in small, exported and checked; the whole-program tests that start a Blender; one scene compared with what the
host's Blender exports of it; and the panel in a window of a display in memory, with pictures of it in
build/blenders/SUITE/screenshots. Where there is no such display, that is said and skipped.
Blender runs in the other Debian with what it starts itself, the rest on this machine. A suite that cannot be had is
named, with the reason, and skipped.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import debian

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/addon"))

import in_blender  # noqa: E402

SCENES = {  # and frames of each: the last just after its balls have burst
    "hard_edges": "1-3",
    "moving_sphere": "1-3",
    "collision": "41-43",
}
WHOLE_PROGRAM = ("blender", "import", "masks")
WINDOWS = ("window", "screenshots")
SCRIPTS = (
    *in_blender.NAMES,
    *(f"scenes.{name}" for name in SCENES),
    *(f"e2e.{name}" for name in WHOLE_PROGRAM),
    "agree",
    *WINDOWS,
)
PASSES = "albedo,depth,normal,object,motion,subsamples,edges,segments"
STREET_PASSES = "depth,normal,object,albedo,motion,edges"
HEADLESS = ROOT / "blender_addon/aa_resolve/headless.py"
FAIL = ("--python-exit-code", "9")  # before -P, or it has no effect
RAN = re.compile(r"^Ran (\d+) tests? in", re.MULTILINE)
AGREES = re.compile(r"^(ok|WRONG) ", re.MULTILINE)
NOT_PASSED = re.compile(r"(?:failures|errors|skipped)=(\d+)")


def counted_by_unittest(text: str) -> tuple[int, int]:
    """A skipped test has not passed; of one test several parts may fail."""
    ran = RAN.findall(text)
    if not ran:
        return 0, 0
    bad = sum(map(int, NOT_PASSED.findall(text[text.rindex("\nRan ") :])))
    return max(int(ran[-1]) - bad, 0), int(ran[-1])


def whole(_text: str) -> tuple[int, int]:
    """Commands of which each must succeed: the exit code says it."""
    return 1, 1


def counted_by_agree(text: str) -> tuple[int, int]:
    words = AGREES.findall(text)
    return words.count("ok"), len(words)


class Blender:
    """One Blender and where its scripts' words go."""

    def __init__(self, name: str, path: str, program: Path, logs: Path) -> None:
        self.name, self.path, self.program, self.logs = name, path, program, logs / name
        self.environment = {**in_blender.environment(), "BLENDER": path}
        bundles = sorted(program.parent.glob("bundle/aaresolve-*/bin/aaresolve"))
        if name != "host" and bundles:
            self.environment["AA_PROGRAM_IN_BLENDER"] = str(bundles[-1])
        told = subprocess.run([path, "--version"], capture_output=True, text=True).stdout
        found = re.search(r"^Blender (\S+)", told, re.MULTILINE)
        if not found:
            sys.exit(f"blenders: {path} --version names no version")
        self.version = found[1]

    def run(self, script: str) -> in_blender.Outcome:
        kind, _, name = script.rpartition(".")
        folder = Path(tempfile.mkdtemp(prefix="aa_blenders_"))
        try:
            if kind == "scenes":
                commands, count = self.scene(name, folder), whole
            elif kind == "e2e":
                test = ROOT / f"tests/e2e/{name}_test.py"
                commands, count = [[sys.executable, test, self.program, ROOT]], counted_by_unittest
            elif script in WINDOWS:
                commands, count = [self.window(script, folder)], whole
            elif script == "agree":
                commands, count = self.agree(folder), counted_by_agree
            else:
                commands = [in_blender.command(name, self.path)]
                count = in_blender.counted_by_support
            return in_blender.run_logged(
                script, commands, self.log(script), count, env=self.environment
            )
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def agree(self, folder: Path) -> list[list[object]]:
        """The street by the host's Blender and by this one."""
        # Python with the modules of the host's Blender.
        python = shutil.which("python3", path=self.environment["PATH"])
        agree = ROOT / "tests/blenders/agree.py"
        shots = [folder / "host", folder / "here"]
        return [
            *self.street(in_blender.blender(), shots[0]),
            *self.street(self.path, shots[1]),
            [python, agree, *shots],
        ]

    def street(self, blender: str, shot: Path) -> list[list[object]]:
        blend = shot.with_suffix(".blend")
        street = ROOT / "tests/blenders/street.py"
        options = ["--for", "taaSimplest,rsaa", "--passes", STREET_PASSES, "--frames", "1-4"]
        options += ["--color-type", "float", "--truth-frames", "none"]
        return [
            [blender, "-b", "--factory-startup", *FAIL, "-P", street, "--", blend],
            [blender, "-b", blend, *FAIL, "-P", HEADLESS, "--", "--out", shot, *options],
        ]

    def window(self, script: str, folder: Path) -> list[object]:
        """Pictures are kept, to be looked at."""
        command = [sys.executable, ROOT / f"tests/blenders/{script}.py"]
        if script == "window":
            return [*command, folder]
        program = self.environment.get("AA_PROGRAM_IN_BLENDER", self.program)
        return [*command, self.logs.resolve() / script, program]

    def scene(self, name: str, folder: Path) -> list[list[object]]:
        """Build, export with every pass, check."""
        blend, shot = folder / "scene.blend", folder / "shot"
        options = ["--for", "uncharted", "--passes", PASSES, "--resolution", "160x90"]
        frames = ["--frames", SCENES[name], "--truth-samples", "16"]
        build = [*FAIL, "-P", ROOT / f"scenes/{name}.py", "--", "--out", blend]
        return [
            [self.path, "-b", "--factory-startup", *build],
            [self.path, "-b", blend, *FAIL, "-P", HEADLESS, "--", "--out", shot, *options, *frames],
            [self.program, "check", shot],
        ]

    def log(self, script: str) -> Path:
        return self.logs / f"{script}.log"


def chosen(only: list[str]) -> list[str]:
    """`e2e` means all of e2e."""
    known = {*SCRIPTS, "scenes", "e2e"}
    for name in only:
        if name not in known:
            sys.exit(f"blenders: no script '{name}'; there are {', '.join(SCRIPTS)}")
    wanted = [s for s in SCRIPTS if s in only or s.partition(".")[0] in only]
    return wanted if only else list(SCRIPTS)


def found_blenders(suites: list[str], program: Path, logs: Path) -> tuple[list[Blender], list[str]]:
    """And one line per suite that cannot be had."""
    blenders, skipped = [], []
    for suite in suites:
        try:
            path = in_blender.blender() if suite == "host" else str(debian.get(suite))
            blenders.append(Blender(suite, path, program, logs))
        except debian.CannotBeHad as reason:
            skipped.append(f"SKIPPED {suite}: {reason}")
            debian.say(skipped[-1])
    return blenders, skipped


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count(), help="scripts at a time")
    parser.add_argument("--suites", nargs="*", default=[], help=f"{' '.join(debian.SUITES)}; host")
    parser.add_argument("--only", nargs="*", default=[], metavar="SCRIPT")
    parser.add_argument("--logs", type=Path, default=ROOT / "build/blenders")
    a = parser.parse_args()
    split = lambda words: [w for word in words for w in re.split(r"[ ,]+", word) if w]  # noqa: E731
    scripts = chosen(split(a.only))
    suites = split(a.suites) or list(debian.SUITES)
    blenders, skipped = found_blenders(suites, a.program.resolve(), a.logs)

    started = time.monotonic()
    table: dict[str, list[in_blender.Outcome]] = {script: [] for script in scripts}
    jobs = [(blender, script) for blender in blenders for script in scripts]
    with ThreadPoolExecutor(max(a.jobs, 1)) as pool:
        for (blender, script), outcome in zip(jobs, pool.map(lambda job: job[0].run(job[1]), jobs)):
            in_blender.show(outcome, blender.version, blender.log(script))
            if outcome.skipped:
                skipped.append(f"{' '.join(outcome.telling[-1:])} ({script}, {blender.name})")
            table[script].append(outcome)

    outcomes = [outcome for row in table.values() for outcome in row]
    if outcomes:
        heads = [f"{blender.version} ({blender.name})" for blender in blenders]
        print(f"\n| script | {' | '.join(heads)} |\n|---|{'---|' * len(heads)}")
        for script, row in table.items():
            cells = (str(o) if o.good else f"**{o}**" for o in row)
            print(f"| {script} | {' | '.join(cells)} |")
        failed = sum(not outcome.good for outcome in outcomes)
        print(
            f"\n{len(outcomes) - failed} of {len(outcomes)} in {time.monotonic() - started:.0f} s"
        )
    for line in skipped:
        print(f"blenders: {line}")
    return 0 if all(outcome.good for outcome in outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
