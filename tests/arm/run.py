"""The program for 64-bit Arm, built here and run by qemu: unit and property tests of all methods, and the bits of x86.

    python3 tests/arm/run.py [-j N] [--only unit,property,bits,kernels] [--sysroot FOLDER]

The cross compiler is Debian's g++-aarch64-linux-gnu; the libraries are this Debian's arm64 packages, unpacked into a
folder (tests/bundle/systems.py). What the program must write is in tests/e2e/same_bits.json, against which the x86
program is held too. Exit code 77: it cannot be built here, and a line on stderr says why.
"""

from __future__ import annotations

import argparse
import os
import platform
import re
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
PARTS = ("unit", "property", "bits", "kernels")
TARGETS = ("aaresolve", "aaresolve_formats", "unit_tests", "property_tests")
# Shards, so that the processors are busy to the end though tests differ in length by a hundred times.
SHARDS_PER_JOB = 6
# An emulated processor takes ten times as long and more. Left out is what runs whole studies or thousands of frames, asks
# for a graphics device, or tries a size for its own sake: {part: patterns of gtest}.
LEFT_OUT = {
    "unit": (
        "*TenThousandFrames*",
        "*HundredThousandFrames*",
        "CheckTest.*",
        "ErrorBarCoverage.*",
        "Gate.*",
        "Gpu*",
        "ImageFiles.PngOfEveryDepthAndType",
        "ImageFiles.WrittenExrIsWhatOthersExpect",
        "JitterCheck.*",
        "Resume.*",
        "Rsaa.GeometryFindsTheMasks*",
        "RsaaLearn.*",
        "Sheet.DrawsEverySize",
        "Sraa.GainOnHalfPlanesIsThatOfCoverage",
        "Stability.*",
    ),
    "property": ("*Torture.LongestSides*",),
}


def say(text: str) -> None:
    print(f"arm: {text}", flush=True)


def sysroot() -> Path:
    """This Debian's arm64 packages, unpacked; raises CannotBeHad."""
    for tool, package in (
        ("aarch64-linux-gnu-g++", "g++-aarch64-linux-gnu"),
        ("qemu-aarch64-static", "qemu-user-static"),
    ):
        if not shutil.which(tool):
            raise CannotBeHad(f"{tool} is missing: apt-get install {package}")
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


def build(root: Path, jobs: int) -> None:
    """Configures and builds into build-arm/."""
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
        return done.returncode, done.stdout

    with ThreadPoolExecutor(jobs) as pool:
        results = list(pool.map(run, range(shards)))
    for code, told in results:
        if code:
            print(told[-4000:], f"exit code {code}", sep="\n")
    ran = sum(int(n) for _, told in results for n in re.findall(r"(\d+) tests? from .* ran", told))
    passed = ran > 0 and not any(code for code, _ in results)
    say(f"{part}: {ran} tests ran" if passed else f"{part}: FAILED")
    return passed


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
    if ", neon," not in told:
        say(f"bits: FAILED: `bench` does not say that it runs on neon: {told[:200]}")
        return False
    test = [sys.executable, str(ROOT / "tests/e2e/same_bits_test.py"), str(program), str(ROOT)]
    return subprocess.run(test).returncode == 0


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
        root = asked.sysroot or sysroot()
    except CannotBeHad as reason:
        print(f"arm: SKIPPED: {reason}", file=sys.stderr)
        return CANNOT_BE_HAD
    started = time.monotonic()
    build(root, asked.j)
    say(f"built in {time.monotonic() - started:.0f} s")
    checks = {
        "unit": lambda: googletest(root, "unit", asked.j),
        "property": lambda: googletest(root, "property", asked.j),
        "bits": lambda: bits(root),
        "kernels": kernels,
    }
    failed = []
    for part in asked.only.split(","):
        started = time.monotonic()
        if not checks[part]():
            failed.append(part)
        say(f"{part}: {time.monotonic() - started:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
