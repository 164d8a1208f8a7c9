# SPDX-License-Identifier: MIT
"""docs/results/speed.md from docs/results/speed.json, and that file from the program.

usage: speed.py PROGRAM OUT DOCS [--pieces N] | speed.py --page-only DOCS

Some methods at a time, in every instruction set that the processor has, noaa among them each time: a ratio is of one
call of `aaresolve bench`, and one call takes less than a minute. What is measured is kept in OUT until the program
changes, so that the work can be done in pieces (--pieces: so many calls now) while the machine is quiet; what other
programs disturbed is measured again, and the quieter call kept. The file is written when nothing is missing.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from pathlib import Path

import measured
from catalogue import EDGES, SPATIAL, SUBSAMPLES, TEMPORAL
from page import Page, code

SIZES = {
    "1920x1080": ("--frames", "3", "--repeats", "3", "--no-error"),
    "480x270": ("--frames", "4", "--repeats", "3"),
}
AT_ONCE = 8  # methods of a call
DISTURBED = 0.2  # processors that other programs kept busy: a tenth of two
OTHERS = "rsaa accum:samples=16 asaa t2msaa smaaT2x smaaS2x smaa4x ssaa resolve"


def timed() -> list[str]:
    """All methods that the study runs, but the options of `master` and `raptor`, which cost what these do."""
    named = f"{SPATIAL} {EDGES} {SUBSAMPLES} {OTHERS} {TEMPORAL}".split()
    alike = ("master:", "raptor:", "accumReject:")
    return [m for m in dict.fromkeys(named) if m != "noaa" and not m.startswith(alike)]


def pieces() -> list[list[str]]:
    """Words of each call."""
    methods = timed()
    return [
        ["--size", size, *words, "-m", ",".join(["noaa", *methods[i : i + AT_ONCE]])]
        for size, words in SIZES.items()
        for i in range(0, len(methods), AT_ONCE)
    ]


def file_of(program: Path, words: list[str], out: Path) -> Path:
    identity = hashlib.sha256(program.read_bytes() + " ".join(words).encode()).hexdigest()[:16]
    return out / f"{identity}.json"


def load_of(kept: Path) -> float:
    """Processors that other programs kept busy in a call; infinite for one that is missing."""
    if not kept.exists():
        return float("inf")
    return json.loads(kept.read_text()).get("load", {}).get("others", 0.0)


def measure(program: Path, out: Path, docs: Path, most: int) -> bool:
    """Makes what is missing, then once more what other programs disturbed, at most so many calls; writes the file and
    returns True when none is missing."""
    out.mkdir(parents=True, exist_ok=True)
    files = {file_of(program, words, out): words for words in pieces()}
    left = {f: load_of(f) for f in files if load_of(f) > DISTURBED}
    for kept in sorted(left, key=left.__getitem__, reverse=True)[:most]:
        command = [program, "bench", "-j", "1", "--every-isa", "--json", *files[kept]]
        said = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
        if json.loads(said).get("load", {}).get("others", 0.0) < left[kept]:
            kept.write_text(said)
    if not all(f.exists() for f in files):
        return False
    measured.write_document(docs, "speed", {"calls": [json.loads(f.read_text()) for f in files]})
    return True


def short(instruction_set: str) -> str:
    return instruction_set.removeprefix("x86-64-")


def page_of(document: dict) -> Page:
    calls = document["calls"]
    machine, sets = calls[0]["machine"], calls[0]["machine"]["instructionSets"]
    loads = [c["load"]["others"] for c in calls if "load" in c]
    page = Page("Speed, memory, and the error of the fast form")
    page.say(
        "Made by `make speed` from [speed.json](speed.json), whose form is that of `aaresolve bench --json`; do not edit.",
        f"{machine['processor']}, {machine['cores']} cores, {', '.join(sets)}; {machine['system']}. One thread, processor time, synthetic",
        "frames that move (with edges at every angle for methods that read edges), medians over the frames.",
    )
    page.say(
        f"Other programs kept at most {max(loads):.2f} of {calls[0]['load']['processors']} processors busy meanwhile."
        if loads
        else "What other programs did meanwhile is not known.",
        "A line of the table is of one call, in which `noaa`, a plain copy, was timed too: `x` is in multiples of it. Quartiles: their",
        f"distance as a share of the median, in {short(sets[-1])}. Every instruction set gives the same bits.",
        "Where a system that has long run has no pages of 2 MB left to give, some methods take up to half as long again; freeing",
        "them first (`compact_memory` of Linux) makes calls comparable.",
    )
    for size in SIZES:
        resolution = [int(n) for n in size.split("x")]
        rows = []
        for call in calls:
            found = [r for r in call["methods"] if r["resolution"] == resolution]
            by_method: dict[str, dict[str, dict]] = {}
            for r in found:
                by_method.setdefault(r["method"], {})[r["instructionSet"]] = r
            base = by_method.pop("noaa", None)
            if base and not rows:
                rows.append(_row("noaa", base, base, sets))
            rows += [_row(m, of, base, sets) for m, of in by_method.items()]
        page.heading(size.replace("x", " x "))
        with_error = any(row[-1] for row in rows)
        rows.sort(key=lambda row: float(row[len(sets)]))
        page.table(
            ["method", *(f"ns/px {short(s)}" for s in sets), *(f"x {short(s)}" for s in sets), "quartiles", "state, MB"]
            + (["max error"] if with_error else []),
            rows if with_error else [row[:-1] for row in rows],
        )  # fmt: skip
    page.say(
        "State: history and working memory. Error: the fast form (float lanes) against the same method in double, over all pixels and frames.",
    )
    return page


def _row(method: str, of: dict[str, dict], base: dict[str, dict], sets: list[str]) -> list[str]:
    last = of[sets[-1]]
    spread = (last["nsPerPixelHigh"] - last["nsPerPixelLow"]) / last["nsPerPixel"]
    error = last.get("maxError")
    return [
        code(method),
        *(f"{of[s]['nsPerPixel']:.1f}" for s in sets),
        *(f"{of[s]['nsPerPixel'] / base[s]['nsPerPixel']:.1f}" for s in sets),
        f"{100 * spread:.0f} %",
        f"{last['stateBytes'] / 1e6:.1f}",
        "" if error is None else error if isinstance(error, str) else f"{error:.2g}",
    ]


if __name__ == "__main__":
    sys.exit(
        measured.main(
            sys.argv[1:],
            __doc__,
            "speed",
            measure,
            lambda document, docs: page_of(document).write(docs / "speed.md"),
        )
    )
