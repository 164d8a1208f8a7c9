"""What a whole run costs: processor time, wall time and peak memory of `aaresolve run`, of one program or of two.

    python3 tests/bench/whole_run.py PROGRAM [OLDER_PROGRAM] [--size 1920x1080] [--frames 16] [--rounds 1] [--threads 1,2]
        [--methods a,b,c] [--cache FOLDER] [--stages]

Both programs run the same methods on the same shot (`synth moving`, made once and kept in the cache), without pictures,
without them and with FLIP and SSIM of RGB, which long runs leave out by themselves, and with EXR pictures of every frame,
in turn, so that a busy machine slows both alike. Processor time and peak memory are what the system says of the process;
of several rounds the least is shown.

A run cannot take less than decoding its frames or its methods' kernels on all cores, whichever is more: ratios are to
that. Kernels are the sum of the methods' times in results.json; decoding is its share of a run on one thread (`--trace`)
times that run's processor time. --stages prints the shares of all stages of that run.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

# What is written of each frame, and what is asked of the program besides.
RUNS = (("none", ()), ("none", ("--metrics", "flip,ssimRgb")), ("exr", ()))
METHODS = (
    "noaa,fxaa1,fxaa311,mlaa,smaa1x,cmaa2,dlaa,nfaa,ssssaa,dmsaa,"
    "smaaT2x,taaSimplest,uncharted,master,accumReject,raptor,karis,salvi,inside,fsr2n"
)


@dataclass
class Cost:
    processor: float
    wall: float
    peak_mb: float
    kernels: float = 0.0
    figures: str = ""  # of each frame: the least that a run has, or FLIP and SSIM of RGB besides


def measured(command: list[str]) -> Cost:
    """Of one process, its threads included."""
    start = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    assert child.stderr
    said = child.stderr.read().decode()
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"whole_run: {' '.join(command)}: {said.strip()}")
    wall = time.perf_counter() - start
    return Cost(
        used.ru_utime + used.ru_stime, wall, used.ru_maxrss * 1024 / 1e6
    )  # the system counts in KiB


def least(costs: list[Cost]) -> Cost:
    return Cost(
        min(c.processor for c in costs),
        min(c.wall for c in costs),
        min(c.peak_mb for c in costs),
        min(c.kernels for c in costs),
        costs[0].figures,
    )


class Bench:
    def __init__(self, arguments: argparse.Namespace, shot: Path, work: Path) -> None:
        self.methods = [word for m in arguments.methods.split(",") for word in ("-m", m)]
        self.shot, self.out, self.trace = shot, work / "out", work / "trace.json"

    def run(self, program: str, write: str, threads: int, *options: str) -> Cost:
        shutil.rmtree(self.out, ignore_errors=True)
        cost = measured(
            [program, "run", str(self.shot), *self.methods, "-o", str(self.out), "-q", "-j", str(threads)]
            + ["--write", write, "--write-frames", "all", *options]
        )  # fmt: skip
        results = json.loads((self.out / "results.json").read_text())
        cost.kernels = sum(f["seconds"] for m in results["methods"] for f in m["frames"])
        cost.figures = (
            "more" if "flip" in results["methods"][0]["frames"][-1]["metrics"] else "least"
        )
        return cost

    def stages(self, program: str) -> dict[str, float]:
        """Processor seconds of each stage of a run with pictures on one thread."""
        cost = self.run(program, "exr", 1, "--trace", str(self.trace))
        lengths: Counter[str] = Counter()
        for event in json.loads(self.trace.read_text())["traceEvents"]:
            if event["ph"] == "X":
                lengths[event["cat"]] += event["dur"] / 1e6
        lengths["other"] = max(0.0, cost.wall - sum(lengths.values()))
        return {stage: cost.processor * s / cost.wall for stage, s in lengths.items()}


def shot_in(cache: Path, program: str, size: str, frames: int) -> Path:
    folder = cache / f"moving-{size}-{frames}"
    if not (folder / "shot.json").exists():
        shutil.rmtree(folder, ignore_errors=True)
        options = ("--size", size, "--frames", str(frames), "--subsamples", "d3d4", "-q")
        subprocess.run([program, "synth", "moving", "-o", folder, *options], check=True)
    return folder


def processor_name() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", nargs="+", metavar="PROGRAM", help="the newest first")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--frames", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--threads", default=f"1,{os.cpu_count()}", help="numbers of threads")
    parser.add_argument("--methods", default=METHODS)
    parser.add_argument("--cache", type=Path, default=Path.home() / ".cache/aa-resolve/bench")
    parser.add_argument("--stages", action="store_true")
    arguments = parser.parse_args()
    newest = arguments.programs[0]
    shot = shot_in(arguments.cache, newest, arguments.size, arguments.frames)
    load = os.getloadavg()[0]
    print(f"{processor_name()}, {os.cpu_count()} processors, load {load:.1f} before")
    print(
        f"{len(arguments.methods.split(','))} methods x {arguments.frames} frames of {arguments.size}"
    )
    with tempfile.TemporaryDirectory(prefix="aa_whole_run_") as work:
        bench = Bench(arguments, shot, Path(work))
        stages = bench.stages(newest)
        if arguments.stages:
            print("of a run with pictures on one thread, CPU s: " + ", ".join(f"{k} {v:.2f}" for k, v in stages.items()))  # fmt: skip
        print(f"{'program':<10} {'write':<5} {'figures':<7} {'-j':>2} {'CPU s':>8} {'wall s':>8} {'peak MB':>8} {'CPU/limit':>10} {'wall/limit':>10}")  # fmt: skip
        for threads in map(int, arguments.threads.split(",")):
            for write, options in RUNS:
                costs: dict[str, list[Cost]] = {program: [] for program in arguments.programs}
                for _ in range(arguments.rounds):
                    for program in arguments.programs:
                        costs[program].append(bench.run(program, write, threads, *options))
                limit = max(stages["decode"], least(costs[newest]).kernels)
                for number, program in enumerate(arguments.programs):
                    c = least(costs[program])
                    name = "new" if number == 0 else "old" if number == 1 else f"older {number}"
                    print(f"{name:<10} {write:<5} {c.figures:<7} {threads:>2} {c.processor:>8.1f} {c.wall:>8.1f} {c.peak_mb:>8.0f} {c.processor / limit:>10.2f} {c.wall * threads / limit:>10.2f}")  # fmt: skip


if __name__ == "__main__":
    main()
