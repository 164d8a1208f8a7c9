"""Lets clang read every source of the program, as CMake would compile it: a second compiler's errors and warnings.

python3 .ci/clang.py build/apart [-j N]      after `cmake --preset release -B build/apart -DAA_TOGETHER=OFF`; nothing
                                             is compiled

Kernels are read for the widest instruction set, the texts of the others being the same. Tests are not read.
"""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

# By how they begin: GCC's own, of its precompiled headers, and what is kept apart here.
DROPPED = ("-Winvalid-pch", "-fpch-preprocess", "-mmove-max=", "-mstore-max=", "-MD", "-Werror")
CLANG = ["clang++", "-Wno-unknown-warning-option", "-fsyntax-only", "-Werror"]
# Padded lanes are wider than what x86-64 passes in registers: every helper is inlined.
CLANG += ["-Wno-psabi", "-Wno-unused-function"]


def command_of(entry: dict) -> tuple[list[str], str]:
    """clang's arguments without the source, and the precompiled header's text that the source takes in (or "")."""
    words = shlex.split(entry["command"])
    while not words[0].endswith(("c++", "g++", "clang++")):
        words.pop(0)  # a compiler cache
    kept, header, i = [], "", 1
    while i < len(words):
        if words[i] in ("-o", "-c", "-MF", "-MT", "--param"):
            i += 2
        elif words[i] == "-include" and words[i + 1].endswith("cmake_pch.hxx"):
            header = words[i + 1]
            i += 2
        else:
            if not words[i].startswith(DROPPED):
                kept.append(words[i])
            i += 1
    return kept, header


def main(build: str, jobs: int) -> int:
    entries = json.loads((Path(build) / "compile_commands.json").read_text(encoding="utf-8"))
    sets = [a for a in ("v4", "v3", "v2") if any(f"AA_ARCH={a}" in e["command"] for e in entries)]
    chosen, headers = [], {}
    for e in entries:
        name = e["file"]
        if Path(name).resolve().is_relative_to(Path(build).resolve()):
            continue  # generated when the program is built
        if "_test.cpp" in name or "/tests/" in name or name.endswith((".cxx", "cmake_pch.hxx.cxx")):
            continue
        if "AA_ARCH=" in e["command"] and f"AA_ARCH={sets[0]}" not in e["command"]:
            continue
        arguments, header = command_of(e)
        chosen.append((e, arguments, header))
        if header:
            headers.setdefault(header, (arguments, e["directory"]))

    def precompile(header: str) -> str:
        arguments, folder = headers[header]
        out = header + ".clang.pch"
        command = [CLANG[0], *arguments, "-x", "c++-header", header, "-o", out]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        return out

    def read(job: tuple[dict, list[str], str]) -> str:
        e, arguments, header = job
        taken = ["-include-pch", header + ".clang.pch"] if header else []
        done = subprocess.run(
            [*CLANG, *arguments, *taken, e["file"]],
            cwd=e["directory"],
            capture_output=True,
            text=True,
            check=False,
        )
        return done.stderr if done.returncode else ""

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(precompile, headers))
        complaints = [c for c in pool.map(read, chosen) if c]
    for header in headers:
        Path(header + ".clang.pch").unlink(missing_ok=True)
    for c in complaints:
        print(c, file=sys.stderr)
    print(f"clang: {len(chosen)} sources read, {len(complaints)} refused")
    return 1 if complaints else 0


if __name__ == "__main__":
    arguments = sys.argv[1:]
    number = int(arguments[arguments.index("-j") + 1]) if "-j" in arguments else 2
    sys.exit(main(arguments[0], number))
