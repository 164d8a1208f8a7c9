"""The program for 64-bit Arm, built here and run by qemu: unit and property tests of all methods, and the bits of x86.

    python3 tests/arm/run.py [-j N] [--only bits,kernels,property,unit] [--sysroot FOLDER]

The cross compiler is Debian's g++-aarch64-linux-gnu; the libraries are this Debian's arm64 packages, unpacked into a
folder (tests/bundle/systems.py). What the program must write is in tests/e2e/same_bits.json, against which the x86
program is held too. Exit code 77: it cannot be built here, and a line on stderr says why.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import resource
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "tests/bundle"))

import systems  # noqa: E402
from systems import CannotBeHad  # noqa: E402

BUILD = ROOT / "build-arm"
CANNOT_BE_HAD = 77
PARTS = ("bits", "kernels", "property", "unit")  # the quickest first
TARGETS = ("aaresolve", "aaresolve_formats", "unit_tests", "property_tests")
# Shards, so that the processors are busy to the end though tests differ in length by a hundred times.
SHARDS_PER_JOB = 6
# An emulated processor takes ten times as long and more. Left out is what runs whole studies, whose arithmetic the other
# tests hold, asks for a graphics device, or draws: patterns of gtest.
LEFT_OUT = {
    "unit": (
        "CheckTest.*",
        "ErrorBarCoverage.*",
        "Gate.*",
        "Gpu*",
        "JitterCheck.*",
        "Resume.*",
        "Sheet.DrawsEverySize",
        "Stability.*",
    ),
    "property": (),
}


def say(text: str) -> None:
    print(f"arm: {text}", flush=True)


def processor_seconds() -> float:
    """Of everything that was started here and has ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def check_tools() -> None:
    """Raises CannotBeHad."""
    for tool, package in (
        ("aarch64-linux-gnu-g++", "g++-aarch64-linux-gnu"),
        ("qemu-aarch64-static", "qemu-user-static"),
        ("cmake", "cmake"),
        ("ninja", "ninja-build"),
    ):
        if not shutil.which(tool):
            raise CannotBeHad(f"{tool} is missing: apt-get install {package}")


def sysroot() -> Path:
    """This Debian's arm64 packages, unpacked; raises CannotBeHad."""
    try:
        release = platform.freedesktop_os_release()
    except OSError:
        release = {}
    suite = f"arm64-{release.get('VERSION_CODENAME')}"
    if release.get("ID") != "debian" or suite not in systems.ARM:
        raise CannotBeHad(
            "the cross compiler's libraries are known for Debian 12, 13 and sid alone"
        )
    return systems.root_of(suite)


def build(root: Path, jobs: int) -> bool:
    """Configures and builds into build-arm/; ends the run when it cannot."""
    packages = ROOT / "build/resolver/report/web/node_modules"  # the report's charts, fetched once
    options = [
        f"--toolchain={HERE / 'toolchain.cmake'}",
        f"-DAA_ARM_SYSROOT={root}",
        "-DCMAKE_BUILD_TYPE=Release",
        "-DAA_GPU=OFF",  # no device answers under qemu
        f"-DAA_WEB_PACKAGES={packages if packages.is_dir() else ''}",
    ]
    if shutil.which("ccache"):
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    for command in (
        ["cmake", "-S", str(ROOT), "-B", str(BUILD), "-G", "Ninja", *options],
        ["cmake", "--build", str(BUILD), "-j", str(jobs), "--target", *TARGETS],
    ):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            raise SystemExit(f"arm: {' '.join(command)}\n{done.stdout[-6000:]}")
    return True


def emulated(root: Path) -> list[str]:
    """The words before a program of build-arm/."""
    return ["qemu-aarch64-static", "-L", str(root)]


def googletest(root: Path, part: str, jobs: int) -> bool:
    """All of a part's tests but those left out, in shards."""
    program = str(BUILD / f"tests/{part}_tests")
    left_out = f"--gtest_filter=*{'-' if LEFT_OUT[part] else ''}{':'.join(LEFT_OUT[part])}"
    shards = jobs * SHARDS_PER_JOB

    def run(shard: int) -> tuple[int, str]:
        variables = {
            **os.environ,
            "GTEST_TOTAL_SHARDS": str(shards),
            "GTEST_SHARD_INDEX": str(shard),
            "AARESOLVE_FORMATS": str(BUILD / "aaresolve_formats.so"),
        }
        done = subprocess.run(
            [*emulated(root), program, "--gtest_brief=1", left_out],
            env=variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
        if done.returncode:
            print(done.stdout[-4000:], f"exit code {done.returncode}", sep="\n")
        say(f"{part}: shard {shard + 1} of {shards} ended")
        return done.returncode, done.stdout

    def counted(pattern: str) -> int:
        return sum(int(n) for _, told in results for n in re.findall(pattern, told, re.MULTILINE))

    with ThreadPoolExecutor(jobs) as pool:
        results = list(pool.map(run, range(shards)))
    passed = counted(r"^\[  PASSED  \] (\d+) test")
    skipped = counted(r"^\[  SKIPPED \] (\d+) test")
    failed = counted(r"^\[  FAILED  \] (\d+) test")
    say(f"{part}: {passed} tests passed, {skipped} do not concern their method, {failed} FAILED")
    return passed > 0 and not any(code for code, _ in results)


def bits(root: Path) -> bool:
    """Every method's pixels on synthetic shots are those of x86."""
    program = BUILD / "aaresolve-emulated"
    command = " ".join([*emulated(root), str(BUILD / "aaresolve")])
    program.write_text(f'#!/bin/sh\nexec {command} "$@"\n')
    program.chmod(0o755)
    told = subprocess.run(
        [str(program), "bench", "-m", "noaa", "--size", "64x64", "--frames", "1", "--repeats", "1"],
        capture_output=True,
        text=True,
    ).stdout
    if not re.search("^noaa +neon ", told, re.MULTILINE):
        say(f"bits: FAILED: `bench` does not say that it runs on neon:\n{told[:600]}")
        return False
    test = [sys.executable, str(ROOT / "tests/e2e/same_bits_test.py"), str(program), str(ROOT)]
    if subprocess.run(test, env={**os.environ, "AARESOLVE_TEST_LIMIT_S": "7200"}).returncode:
        return False
    wanted = json.loads((ROOT / "tests/e2e/same_bits.json").read_text())
    named = [name for shot in wanted.values() for name in shot if not name.startswith("input ")]
    methods = {name for name in named if ":" not in name}
    say(
        f"bits: {len(named)} results of {len(methods)} methods on {len(wanted)} shots are those of x86-64"
    )
    return True


def kernels() -> bool:
    """What ctest knows of the kernels' objects."""
    return (
        subprocess.run(
            ["ctest", "--test-dir", str(BUILD), "-R", "^kernels", "--no-tests=error"]
        ).returncode
        == 0
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-j", type=int, default=os.cpu_count() or 2)
    parser.add_argument("--only", default=",".join(PARTS))
    parser.add_argument("--sysroot", type=Path)
    asked = parser.parse_args()
    try:
        check_tools()
        root = asked.sysroot or sysroot()
    except CannotBeHad as reason:
        print(f"arm: SKIPPED: {reason}", file=sys.stderr)
        return CANNOT_BE_HAD
    checks = {
        "built": lambda: build(root, asked.j),
        "bits": lambda: bits(root),
        "kernels": kernels,
        "property": lambda: googletest(root, "property", asked.j),
        "unit": lambda: googletest(root, "unit", asked.j),
    }
    failed = []
    for part in ["built", *asked.only.split(",")]:
        started, used = time.monotonic(), processor_seconds()
        if not checks[part]():
            failed.append(part)
        wall, used = time.monotonic() - started, processor_seconds() - used
        say(f"{part}: {used:.0f} s of processor time in {wall:.0f} s")
    say(f"FAILED: {', '.join(failed)}" if failed else "passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
