#!/usr/bin/env python3
"""Our SMAA, FLIP and SSIM beside those of others: one thread, processor time, medians of rounds in which each runs in turn.

    peers.py --program build/aaresolve --benchmarks build/tests/benchmarks [--rounds 5] [--size 1920x1080] [--isa v3]
        --smaa FOLDER    sources of smaa-cpp (github.com/iRi-E/smaa-cpp)
        --flip FOLDER    sources of NVIDIA's FLIP (github.com/NVlabs/flip)

Of scikit-image this Python's is taken (Debian: python3-skimage). What is missing is named and left out; nothing is
installed. All see noaa and the truth of `synth moving` as 8-bit sRGB codes, but for our FLIP and SSIM, whose time depends
on no value and which are those of the benchmarks. NVIDIA's FLIP is given linear light, so that ours decodes on top.
--out FILE writes the page (`make peers`).
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"

import numpy as np
import OpenImageIO as oiio

from whole_run import processor_name

HERE = Path(__file__).parent / "peers"
FLAGS = ["-O3", "-march=x86-64-v3", "-w"]


@dataclass
class Pair:
    """Two programs for one thing; each call gives seconds of processor time."""

    what: str
    peer: str
    ours: Callable[[], float]
    theirs: Callable[[], float]
    goal: float
    ours_s: list[float] = field(default_factory=list)
    theirs_s: list[float] = field(default_factory=list)


@dataclass
class Bench:
    options: argparse.Namespace
    work: Path
    test: np.ndarray
    truth: np.ndarray

    @property
    def size(self) -> list[str]:
        return self.options.size.split("x")

    @property
    def pixels(self) -> int:
        return int(self.size[0]) * int(self.size[1])

    def smaa(self) -> Pair:
        folder, program = self.options.smaa, self.work / "smaa_peer"
        build = self.work / "smaa"
        told(
            *("cmake", "-S", folder, "-B", build, "-DWITH_TESTS=OFF", "-DWITH_EXAMPLE=OFF"),
            *("-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={' '.join(FLAGS)}"),
        )
        told("cmake", "--build", build)
        headers = (f"-I{folder}/include", f"-I{build}/include")
        library = build / "lib/libsmaa-cpp.a"
        told("g++", *FLAGS, *headers, HERE / "smaa.cpp", library, "-o", program)
        raw = self.work / "test.rgba"
        np.concatenate([self.test, np.ones_like(self.test[..., :1])], -1).astype("f4").tofile(raw)
        return Pair(
            "SMAA HIGH",
            f"smaa-cpp {version(folder)}",
            self.our_smaa,
            lambda: float(told(program, raw, *self.size)),
            0.10,
        )

    def our_smaa(self) -> float:
        o = self.options
        method = "smaa1x:preset=HIGH"
        out = told(
            *(o.program, "bench", "-m", method, "--shot", self.work / "shot", "--frames", "1"),
            *("--repeats", "9", "--isa", o.isa, "--no-error", "--json"),
        )
        methods = json.loads(out)["methods"]
        return next(m for m in methods if m["method"] == method)["nsPerPixel"] * 1e-9 * self.pixels

    def flip(self) -> Pair:
        folder, program = self.options.flip, self.work / "flip_peer"
        told("g++", "-std=c++20", *FLAGS, f"-I{folder}/src/cpp", HERE / "flip.cpp", "-o", program)
        raw = []
        for name, codes in (("test", self.test), ("truth", self.truth)):
            raw.append(self.work / f"{name}.rgb")
            linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
            linear.astype("f4").tofile(raw[-1])
        return Pair(
            "LDR-FLIP",
            f"NVIDIA's FLIP {version(folder)}",
            lambda: self.benchmark("flip"),
            lambda: float(told(program, *raw, *self.size)),
            0.05,
        )

    def ssim(self) -> Pair:
        import skimage
        from skimage.metrics import structural_similarity

        wang = dict(gaussian_weights=True, sigma=1.5, use_sample_covariance=False)

        def theirs() -> float:
            start = time.process_time()
            structural_similarity(self.test, self.truth, data_range=1, channel_axis=-1, **wang)
            return time.process_time() - start

        peer = f"scikit-image {skimage.__version__}"
        return Pair("SSIM RGB", peer, lambda: self.benchmark("ssimRgb"), theirs, 0.01)

    def benchmark(self, name: str) -> float:
        """Of 1920 x 1080, whatever the size of the others."""
        os.environ["AARESOLVE_BENCH_ISA"] = self.options.isa
        out = told(
            self.options.benchmarks,
            f"--benchmark_filter=^measure/{name}$",
            "--benchmark_format=json",
            "--benchmark_min_time=0.2",
        )
        measured = json.loads(out)["benchmarks"][0]
        assert measured["time_unit"] == "ns"
        return measured["cpu_time"] * 1e-9 * self.pixels / (1920 * 1080)


def told(*command: str | Path) -> str:
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"peers: {' '.join(map(str, command))}:\n{done.stderr}")
    return done.stdout


def version(folder: Path) -> str:
    done = subprocess.run(
        ["git", "-C", folder, "describe", "--always", "--tags"], capture_output=True, text=True
    )
    return done.stdout.strip() or "of no commit"


def picture(file: Path) -> np.ndarray:
    return oiio.ImageBuf(str(file)).get_pixels(oiio.FLOAT)[..., :3]


def prepared(o: argparse.Namespace, work: Path) -> Bench:
    told(o.program, "synth", "moving", "-o", work / "shot", "--size", o.size, "--frames", "1", "-q")
    told(o.program, "run", work / "shot", "-m", "noaa", "-o", work / "run", "--write", "png", "-q")
    return Bench(
        o, work, picture(work / "run/noaa/000001.png"), picture(work / "run/truth/000001.png")
    )


def pairs_of(bench: Bench) -> list[Pair]:
    pairs = []
    if bench.options.smaa:
        pairs.append(bench.smaa())
    else:
        print("peers: no --smaa: smaa-cpp is left out", file=sys.stderr)
    if bench.options.flip:
        pairs.append(bench.flip())
    else:
        print("peers: no --flip: NVIDIA's FLIP is left out", file=sys.stderr)
    try:
        pairs.append(bench.ssim())
    except ImportError:
        print("peers: no scikit-image: apt-get install python3-skimage", file=sys.stderr)
    return pairs


def table(bench: Bench, pairs: list[Pair], load: float) -> str:
    o = bench.options

    def spread(seconds: list[float]) -> str:
        ns = [s / bench.pixels * 1e9 for s in seconds]
        return f"{statistics.median(ns):.1f} ({min(ns):.1f} to {max(ns):.1f})"

    lines = [
        "# Beside others' programs",
        "",
        "Made by `make peers`; `tests/bench/peers.py` says what is held against what. "
        f"{processor_name()}, load {load:.1f} before; {o.size}, one thread, ns of processor time per pixel, median of "
        f"{o.rounds} rounds (least to largest); ours x86-64-{o.isa}, theirs `{' '.join(FLAGS[:2])}`. Share: of their time; "
        "goal: what we want it to be at most.",
        "",
        "| | ours | theirs | whose | share | goal |",
        "|---|---|---|---|---|---|",
    ]
    for p in pairs:
        share = statistics.median(a / b for a, b in zip(p.ours_s, p.theirs_s))
        lines.append(
            f"| {p.what} | {spread(p.ours_s)} | {spread(p.theirs_s)} | {p.peer} | {share:.3f} | {p.goal} |"
        )
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--benchmarks", type=Path, required=True)
    parser.add_argument("--smaa", type=Path)
    parser.add_argument("--flip", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--isa", default="v3")
    parser.add_argument("--out", type=Path)
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = prepared(o, Path(folder))
        pairs = pairs_of(bench)
        load = os.getloadavg()[0]
        for _ in range(o.rounds):
            for p in pairs:
                p.ours_s.append(p.ours())
                p.theirs_s.append(p.theirs())
        page = table(bench, pairs, load)
    print(page, end="")
    if o.out:
        o.out.write_text(page, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
