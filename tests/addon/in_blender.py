"""Runs the add-on's tests in the Blender that BLENDER names (else `blender`): one passes its words on, several make a row.

    python3 tests/addon/in_blender.py [light motion ...] [-j 2] [--logs FOLDER]
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

HERE = Path(__file__).resolve().parent
NAMES = sorted(script.stem.removeprefix("test_") for script in HERE.glob("test_*.py"))
LIMIT_S = 900 + 60 * int(os.environ.get("AA_FAULTS", "0"))  # so many kills
CANNOT_BE_HAD = 77  # exit code of what this machine does not have; it is named, and is no failure
PASSED = re.compile(r"^(\d+) of (\d+) passed$", re.MULTILINE)
# What says why a test failed, among a line per rendered tile and the complaints of Blender's own add-ons.
TELLING = re.compile(
    r"^(FAIL |SKIPPED|error: |aaresolve: |WRONG |\w*Error\b|\w+\.\w*Error\b|Segmentation|Fatal)",
    re.MULTILINE,
)
# What Blender 5.2 of Debian says against itself, of missing recommended packages and scenes without a world.
OF_BLENDER = re.compile(r"cattrs|EXTENSIONS_OT|'NoneType' object has no attribute 'update_tag'")


@dataclass
class Outcome:
    """What one script did in one Blender."""

    name: str
    passed: int
    of: int  # 0: it did not come to its end
    seconds: float
    code: int
    telling: list[str]

    @property
    def skipped(self) -> bool:
        return self.code == CANNOT_BE_HAD

    @property
    def good(self) -> bool:
        return self.skipped or self.code == 0 and self.of > 0 and self.passed == self.of

    def __str__(self) -> str:
        if self.skipped:
            return "skipped"
        counted = f"{self.passed}/{self.of}"
        if self.of == 0 or (self.code and self.passed == self.of):
            counted = f"ended with {self.code}"
        return f"{counted}, {self.seconds:.0f} s"


def blender() -> str:
    return os.environ.get("BLENDER") or "blender"


def environment() -> dict[str, str]:
    """Blender finds its modules by the python3 of PATH: another one of the same version would mislead it."""
    places = [
        place
        for place in os.environ["PATH"].split(os.pathsep)
        if not os.path.exists(os.path.join(place, "python3")) or place == "/usr/bin"
    ]
    # tests/blenders/wrapper.sh makes this clone visible to a Blender of another Debian.
    return {**os.environ, "PATH": os.pathsep.join(places), "AA_SHARE": str(HERE.parents[1])}


def command(name: str, path: str | None = None) -> list[str]:
    """Of the add-on's test `name`, in the Blender at `path`."""
    script = HERE / f"test_{name}.py"
    return [
        path or blender(),
        "-b",
        "--factory-startup",
        "--python-exit-code",
        "9",
        "-P",
        str(script),
    ]


def version() -> str:
    """Of the Blender; ends the program where there is none."""
    try:
        told = subprocess.run([blender(), "--version"], capture_output=True, text=True).stdout
    except OSError as error:
        sys.exit(f"{blender()} cannot be run ({error.strerror}): set BLENDER to a Blender")
    found = re.search(r"^Blender (\d\S*)", told, re.MULTILINE)
    if not found:
        sys.exit(f"{blender()} --version names no version: set BLENDER to a Blender")
    return found[1]


def run_logged(
    name: str,
    commands: list[list[str]],
    log: Path,
    count: Callable[[str], tuple[int, int]],
    **options,
) -> Outcome:
    """Runs commands until one fails and keeps what they say in `log`; `count(text)` gives how many passed of how many."""
    log.parent.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    code = 0
    with log.open("w", errors="replace") as said:
        for words in commands:
            try:
                done = subprocess.run(
                    [str(word) for word in words],
                    stdin=subprocess.DEVNULL,
                    stdout=said,
                    stderr=said,
                    timeout=LIMIT_S,
                    **options,
                )
                code = done.returncode
            except subprocess.TimeoutExpired:
                said.write(f"FAIL not done after {LIMIT_S} s\n")
                code = 124
            if code:
                break
    seconds = time.monotonic() - started
    text = log.read_text(errors="replace")
    passed, of = count(text)
    telling = [
        line for line in text.splitlines() if TELLING.match(line) and not OF_BLENDER.search(line)
    ]
    return Outcome(name, passed, of, seconds, code, telling)


def counted_by_support(text: str) -> tuple[int, int]:
    """From the last line of support.main()."""
    found = PASSED.findall(text)
    return (int(found[-1][0]), int(found[-1][1])) if found else (0, 0)


def run_script(name: str, logs: Path) -> Outcome:
    log = logs / f"{name}.log"
    return run_logged(name, [command(name)], log, counted_by_support, env=environment())


def show(outcome: Outcome, where: str, log: Path) -> None:
    """One line, and why where it failed."""
    print(f"{where} {outcome.name:24} {outcome}", flush=True)
    if outcome.skipped or not outcome.good:
        for line in outcome.telling[-12:]:
            print(f"    {line[:200]}")
        print(f"    {log}", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(NAMES)}; all")
    parser.add_argument("-j", "--jobs", type=int, default=1, help="scripts at a time")
    parser.add_argument("--logs", type=Path, help="folder for what each says")
    a = parser.parse_args()
    names = [name for word in a.names for name in word.split(",") if name]
    for name in names:
        if name not in NAMES:
            parser.error(f"no script test_{name}.py; there are {', '.join(NAMES)}")
    if len(names) == 1:
        version()
        return subprocess.run(command(names[0]), env=environment()).returncode

    of_blender = version()
    logs = a.logs or Path(tempfile.mkdtemp(prefix="aa_addon_logs_"))
    with ThreadPoolExecutor(a.jobs) as pool:
        outcomes = []
        for outcome in pool.map(lambda name: run_script(name, logs), names or NAMES):
            outcomes.append(outcome)
            show(outcome, of_blender, logs / f"{outcome.name}.log")
    print(f"\n| Blender | {' | '.join(o.name for o in outcomes)} |")
    print(f"|---|{'---|' * len(outcomes)}")
    print(f"| {of_blender} | {' | '.join(map(str, outcomes))} |")
    return 0 if all(o.good for o in outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
