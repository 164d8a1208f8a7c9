"""Runs CTest and passes on what it prints and its exit code; the ten slowest tests stand before its summary.

python3 tests/run_tests.py --preset release -j 2
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

DONE = re.compile(r"^ *\d+/\d+ Test +#\d+: (\S+) .*?([\d.]+) sec *$")
SUMMARY = re.compile(r"^\d+% tests passed")


def main(arguments: list[str]) -> int:
    slowest: list[tuple[float, str]] = []
    summary: list[str] = []
    # A launcher of several Pythons puts the one that runs this first in PATH; Blender, which finds its modules by the
    # python3 of PATH, would take it for its own.
    here = str(Path(sys.executable).parent)
    places = [p for p in os.environ["PATH"].split(os.pathsep) if p != here or here == "/usr/bin"]
    environment = {**os.environ, "PATH": os.pathsep.join(places)}
    with subprocess.Popen(
        ["ctest", *arguments],
        stdout=subprocess.PIPE,
        text=True,
        errors="replace",
        env=environment,
    ) as ctest:
        assert ctest.stdout
        for line in ctest.stdout:
            if done := DONE.match(line):
                slowest.append((float(done[2]), done[1]))
            if summary or SUMMARY.match(line):
                summary.append(line)
            else:
                print(line, end="", flush=True)
    if summary and slowest:
        print("Slowest tests:")
        for seconds, name in sorted(slowest, reverse=True)[:10]:
            print(f"{seconds:10.2f} s  {name}")
        print()
    print("".join(summary), end="", flush=True)
    return ctest.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
