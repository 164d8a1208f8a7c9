"""How time and memory grow: with the picture from 480 x 270 to 8K, with the frames from 16 to 10,000, and from one thread to two.

usage: growth.py PROGRAM OUT DOCS [--pieces N] | growth.py --page-only DOCS

Writes growth.json, growth.md and two curves to DOCS. Sizes and threads are timed by `aaresolve bench` on frames in memory,
frames by whole calls of `aaresolve run` on a shot of 16 files that repeats, each call with the peak of its memory. Each
piece takes a minute at most, but the 10,000 frames, and is kept in OUT until the program changes; --pieces makes so many now, so that the
machine need not be quiet for long.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scenes/reproduce"))

import measured  # noqa: E402
from chart import write_svg  # noqa: E402
from page import Page, code  # noqa: E402

METHODS = ("noaa", "smaa1x:preset=HIGH", "karis", "master", "fsr2n")
SIZES = ("480x270", "960x540", "1920x1080", "3840x2160", "7680x4320")
FRAMES = (16, 100, 1000, 10000)
SMALL = "480x270"
THREADS = (1, 2)
RUN = (
    "-m",
    "noaa,smaa1x:preset=HIGH,karis",
    "--write",
    "none",
    "--metrics",
    "flip,ssimRgb",
    "-q",
    "-j",
    "1",
)


def called(words: list[object]) -> tuple[str, dict]:
    """What a program prints; its processor seconds and the peak of its memory, as far as one looks often enough. (The
    system's own maximum of a child counts what it was before it became the program, and so does a look that is too early.)
    """
    peak = 0
    program = Path(words[0]).resolve()
    with tempfile.TemporaryFile("w+") as said:
        process = subprocess.Popen([str(w) for w in words], stdout=said)
        status = Path(f"/proc/{process.pid}/status")
        while not os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT):
            with contextlib.suppress(FileNotFoundError):  # it may end meanwhile
                found = re.search(r"VmHWM:\s*(\d+) kB", status.read_text())
                if found and os.readlink(f"/proc/{process.pid}/exe") == str(program):
                    peak = max(peak, int(found[1]) * 1024)
            time.sleep(0.02)
        _, result, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(result)
        if process.returncode:
            raise SystemExit(f"{' '.join(map(str, words))}: exit {process.returncode}")
        said.seek(0)
        return said.read(), {"seconds": used.ru_utime + used.ru_stime, "peakBytes": peak}


def bench_of(program: Path, size: str, threads: int) -> dict:
    words = ["bench", "-m", ",".join(METHODS), "--size", size, "--scene", "moving", "-j", threads]
    words += ["--frames", 2, "--repeats", 2 if size == SIZES[-1] else 6, "--no-error", "--json"]
    said, used = called([program, *words])
    return {**json.loads(said), **used}


def repeating_shot(program: Path, out: Path, frames: int) -> Path:
    """A moving shot of so many frames on the files of sixteen, over and over; a cut where they begin again."""
    folder = out / "shot"
    if not (folder / "shot.json").exists():
        words = ["synth", "moving", "-o", folder, "--size", SMALL, "--frames", 16, "-q"]
        called([program, *words, "--for", RUN[1]])
        (folder / "shot.json").rename(folder / "sixteen.json")
        (folder / "shot.json").write_text((folder / "sixteen.json").read_text())
    shot = json.loads((folder / "sixteen.json").read_text())
    shot["frames"] = [{**shot["frames"][i % 16], "frame": i + 1} for i in range(frames)]
    (folder / "shot.json").write_text(json.dumps(shot))
    return folder


def run_of(program: Path, frames: int, out: Path) -> dict:
    shot = repeating_shot(program, out, frames)
    shutil.rmtree(out / "run", ignore_errors=True)  # results that are there are read first
    _, used = called([program, "run", shot, "-o", out / "run", *RUN])
    return {"frames": frames, "run": " ".join(RUN), **used}


def pieces(program: Path, out: Path) -> dict[str, object]:
    """What is measured by name, as calls."""
    found: dict[str, object] = {}
    for size in SIZES:
        found[f"size {size}"] = lambda size=size: bench_of(program, size, 1)
    for threads in THREADS:
        found[f"threads {threads}"] = lambda threads=threads: bench_of(
            program, "1920x1080", threads
        )
    for frames in FRAMES:
        found[f"frames {frames}"] = lambda frames=frames: run_of(program, frames, out)
    return found


def measure(program: Path, out: Path, docs: Path, most: int | None) -> bool:
    """At most so many pieces; writes growth.json and returns True when none is missing."""
    out.mkdir(parents=True, exist_ok=True)
    identity = hashlib.sha256(program.read_bytes() + Path(__file__).read_bytes()).hexdigest()[:16]
    file = out / f"{identity}.json"
    kept = json.loads(file.read_text()) if file.exists() else {}
    every = pieces(program, out)
    for name in [n for n in every if n not in kept][:most]:
        kept[name] = every[name]()
        file.write_text(json.dumps(kept))
        print(name, flush=True)
    if len(kept) < len(every):
        return False
    measured.write_document(docs, "growth", {"pieces": {n: kept[n] for n in every}})
    return True


def by_method(piece: dict, figure: str) -> dict[str, float]:
    return {r["method"]: r[figure] for r in piece["methods"]}


def write_page(document: dict, docs: Path) -> None:
    found = document["pieces"]
    page = Page("How time and memory grow")
    first = found[f"size {SIZES[0]}"]
    benches = [p for n, p in found.items() if not n.startswith("frames")]
    load = max(p.get("load", {}).get("others", 0.0) for p in benches)
    page.say(
        "Made by `tests/bench/growth.py` (`make growth`) from [growth.json](growth.json); do not edit.",
        f"{first['machine']['processor']}, {first['methods'][0]['instructionSet']}, {first['machine']['system']}; synthetic frames that move.",
        f"Other programs kept at most {load:.2f} processors busy meanwhile; a processor's time is spared that, the clock's is not.",
    )
    page.heading("With the picture")
    page.say(
        "Processor time in ns per pixel on one thread, median; below it state in bytes per pixel. Flat is linear growth. Once a "
        "plane fits no cache, a copy (`noaa`) is bound by memory."
    )
    page.picture("growth-size.svg", "Time per pixel over the size of the picture")
    times = {s: by_method(found[f"size {s}"], "nsPerPixel") for s in SIZES}
    state = {s: by_method(found[f"size {s}"], "stateBytes") for s in SIZES}
    area = {s: found[f"size {s}"]["methods"][0]["resolution"] for s in SIZES}
    rows = []
    for m in METHODS:
        rows.append([code(m), *(f"{times[s][m]:.1f}" for s in SIZES)])
        if any(state[s][m] for s in SIZES):
            rows.append(
                [
                    "state, bytes/px",
                    *(f"{state[s][m] / (area[s][0] * area[s][1]):.1f}" for s in SIZES),
                ]
            )
    page.table(["method", *SIZES], rows)
    write_svg(
        docs / "growth-size.svg", {m: [times[s][m] for s in SIZES] for m in METHODS},
        "Processor time per pixel, one thread", "ns", labels=list(SIZES), along="picture", low=0,
    )  # fmt: skip
    page.heading("With the frames")
    runs = [found[f"frames {n}"] for n in FRAMES]
    base = runs[0]
    page.say(
        "All figures of all frames are kept until the end, and the shot's list of frames is read as a whole: that is what memory "
        "grows by. Results are written anew every five seconds as they grow.",
        f"Whole runs (`aaresolve run {base['run']}`) at {SMALL}, reading and metrics with them, on one thread. A frame: what each costs above "
        f"the run of {FRAMES[0]}, whose start is most of it.",
    )
    page.picture("growth-frames.svg", "Peak memory over the number of frames")
    extra = lambda r: (r["seconds"] - base["seconds"]) / max(
        1, r["frames"] - base["frames"]
    )  # noqa: E731
    page.table(
        ["frames", "processor seconds", "ms per frame above", "peak memory, MB", f"of that of {FRAMES[0]}"],
        [[f"{r['frames']}", f"{r['seconds']:.2f}", f"{1e3 * extra(r):.2f}" if r is not base else "–", f"{r['peakBytes'] / 1e6:.0f}",
          f"{r['peakBytes'] / base['peakBytes']:.3f}"] for r in runs],
    )  # fmt: skip
    write_svg(
        docs / "growth-frames.svg", {"peak": [r["peakBytes"] / 1e6 for r in runs]},
        f"Peak memory of a run at {SMALL}", "MB", labels=[str(n) for n in FRAMES], along="frames", low=0,
    )  # fmt: skip
    page.heading("With the threads")
    one, two = (found[f"threads {n}"] for n in THREADS)
    wall = [by_method(p, "wallNsPerPixel") for p in (one, two)]
    spent = [by_method(p, "nsPerPixel") for p in (one, two)]
    others = max(p.get("load", {}).get("others", 0.0) for p in (one, two))
    disturbed = others > 0.1 * one["machine"]["cores"]
    page.say(
        "1920 x 1080. Work: processor time of two threads by that of one; 1 is no loss.",
        f"By the clock nothing is shown: other programs kept {others:.2f} of {one['machine']['cores']} processors busy; `make growth` on a quiet machine."
        if disturbed
        else "By the clock, ns per pixel.",
    )
    head = (
        ["method", "work"] if disturbed else ["method", "work", "one thread", "two", "times faster"]
    )
    rows = []
    for m in METHODS:
        row = [code(m), f"{spent[1][m] / spent[0][m]:.2f}"]
        row += [f"{wall[0][m]:.1f}", f"{wall[1][m]:.1f}", f"{wall[0][m] / wall[1][m]:.2f}"]
        rows.append(row[: len(head)])
    page.table(head, rows)
    page.write(docs / "growth.md")


if __name__ == "__main__":
    sys.exit(measured.main(sys.argv[1:], __doc__, "growth", measure, write_page))
