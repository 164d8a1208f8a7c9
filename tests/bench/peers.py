#!/usr/bin/env python3
"""Our SMAA, FLIP and SSIM beside those of others, one thread, processor time, medians of interleaved rounds.

    peers.py --program build/aaresolve --benchmarks build/tests/benchmarks
        --smaa FOLDER    sources of smaa-cpp (github.com/iRi-E/smaa-cpp)
        --flip FOLDER    sources of NVIDIA's FLIP (github.com/NVlabs/flip)
        [--rounds 5] [--size 1920x1080] [--isa v3] [--out peers.md]

Of scikit-image (Debian: python3-skimage) this Python's is taken. What is missing is named and left out; nothing is
installed. The pictures are noaa and the truth of `synth moving`, as 8-bit sRGB codes; our FLIP and SSIM, whose time
does not depend on what they see, are those of the benchmarks. FLIP of others gets linear light; ours decodes codes too.
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
from pathlib import Path
from typing import Callable

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"

import numpy as np
import OpenImageIO as oiio

HERE = Path(__file__).parent / "peers"
FLAGS = ["-std=c++20", "-O3", "-march=x86-64-v3", "-w"]


def told(*command: str | Path) -> str:
    return subprocess.run(
        [str(c) for c in command], check=True, capture_output=True, text=True
    ).stdout


def pictures(program: Path, size: str, work: Path) -> list[np.ndarray]:
    """Codes of noaa and of the truth, in [0, 1]."""
    told(program, "synth", "moving", "-o", work / "shot", "--size", size, "--frames", "1", "-q")
    told(program, "run", work / "shot", "-m", "noaa", "-o", work / "run", "--write", "png", "-q")
    run = json.loads((work / "run/results.json").read_text())
    frame = run["methods"][0]["frames"][0]
    truth = run["truthImages"][str(frame["frame"])] if "truthImages" in run else frame["truthImage"]
    return [
        oiio.ImageBuf(str(work / "run" / name)).get_pixels(oiio.FLOAT)[..., :3]
        for name in (frame["image"], truth)
    ]


def linear(codes: np.ndarray) -> np.ndarray:
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def version(folder: Path) -> str:
    try:
        return told("git", "-C", folder, "describe", "--always", "--tags").strip()
    except subprocess.CalledProcessError:
        return "unknown"


def smaa_cpp(folder: Path, work: Path) -> Path:
    told(
        "cmake",
        "-S",
        folder,
        "-B",
        work / "smaa",
        "-DWITH_TESTS=OFF",
        "-DWITH_EXAMPLE=OFF",
        "-DCMAKE_BUILD_TYPE=None",
        "-DCMAKE_CXX_FLAGS=-O3 -march=x86-64-v3 -w",
    )
    told("cmake", "--build", work / "smaa")
    library = next(iter((work / "smaa").rglob("lib*.a")))
    told("g++", *FLAGS, f"-I{folder}/include", HERE / "smaa.cpp", library, "-o", work / "smaa_peer")
    return work / "smaa_peer"


def seconds_of_bench(benchmarks: Path, name: str, isa: str) -> float:
    os.environ["AARESOLVE_BENCH_ISA"] = isa
    out = told(
        benchmarks,
        f"--benchmark_filter=^measure/{name}$",
        "--benchmark_format=json",
        "--benchmark_min_time=0.2",
    )
    return json.loads(out)["benchmarks"][0]["cpu_time"] * 1e-9


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
    width, height = (int(v) for v in o.size.split("x"))
    pixels = width * height

    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        test, truth = pictures(o.program, o.size, work)
        pairs: list[tuple[str, str, Callable[[], float], Callable[[], float], float]] = []

        if o.smaa:
            peer = smaa_cpp(o.smaa, work)
            np.concatenate([test, np.ones_like(test[..., :1])], -1).astype(np.float32).tofile(
                work / "test.rgba"
            )
            raw = str(work / "test.rgba")

            def ours() -> float:
                out = told(
                    o.program,
                    "bench",
                    "-m",
                    "smaa1x:preset=HIGH",
                    "--shot",
                    work / "shot",
                    "--frames",
                    "1",
                    "--repeats",
                    "9",
                    "--isa",
                    o.isa,
                    "--json",
                )
                return (
                    next(r for r in json.loads(out) if r["method"].startswith("smaa1x"))[
                        "nsPerPixel"
                    ]
                    * 1e-9
                    * pixels
                )

            pairs.append(
                (
                    "SMAA HIGH",
                    f"smaa-cpp {version(o.smaa)}",
                    ours,
                    lambda: float(told(peer, raw, str(width), str(height))),
                    0.10,
                )
            )
        else:
            print("peers: no --smaa: smaa-cpp is left out", file=sys.stderr)

        if o.flip:
            told("g++", *FLAGS, f"-I{o.flip}/src/cpp", HERE / "flip.cpp", "-o", work / "flip_peer")
            for name, image in (("test", test), ("truth", truth)):
                linear(image).astype(np.float32).tofile(work / f"{name}.rgb")

            def nvidia() -> float:
                out = told(
                    work / "flip_peer",
                    work / "test.rgb",
                    work / "truth.rgb",
                    str(width),
                    str(height),
                )
                return float(out.split()[0])

            pairs.append(
                (
                    "LDR-FLIP",
                    f"NVIDIA's FLIP {version(o.flip)}",
                    lambda: seconds_of_bench(o.benchmarks, "flip", o.isa),
                    nvidia,
                    0.05,
                )
            )
        else:
            print("peers: no --flip: NVIDIA's FLIP is left out", file=sys.stderr)

        try:
            import skimage
            from skimage.metrics import structural_similarity

            def scikit() -> float:
                start = time.process_time()
                structural_similarity(
                    test,
                    truth,
                    data_range=1,
                    channel_axis=-1,
                    gaussian_weights=True,
                    sigma=1.5,
                    use_sample_covariance=False,
                )
                return time.process_time() - start

            pairs.append(
                (
                    "SSIM RGB",
                    f"scikit-image {skimage.__version__}",
                    lambda: seconds_of_bench(o.benchmarks, "ssimRgb", o.isa),
                    scikit,
                    0.01,
                )
            )
        except ImportError:
            print("peers: no scikit-image: apt-get install python3-skimage", file=sys.stderr)

        load = os.getloadavg()[0]
        times: list[tuple[list[float], list[float]]] = [([], []) for _ in pairs]
        for _ in range(o.rounds):
            for (_, _, ours, theirs, _), (mine, other) in zip(pairs, times):
                mine.append(ours() / pixels * 1e9)
                other.append(theirs() / pixels * 1e9)

    cpu = next(
        (
            line.split(":")[1].strip()
            for line in open("/proc/cpuinfo")
            if line.startswith("model name")
        ),
        "?",
    )
    lines = [
        f"{cpu}, {os.cpu_count()} processors, load {load:.1f} before; {o.size}, one thread, processor time, ns per pixel:",
        f"medians of {o.rounds} rounds, in which each ran in turn, with the least and the largest; ours: x86-64-{o.isa}, theirs: -O3 -march=x86-64-v3.",
        "",
        "| what | ours | theirs | of | share | goal |",
        "| --- | ---: | ---: | --- | ---: | ---: |",
    ]
    for (what, peer, _, _, goal), (mine, other) in zip(pairs, times):

        def spread(v: list[float]) -> str:
            return f"{statistics.median(v):.1f} ({min(v):.1f}–{max(v):.1f})"

        share = statistics.median(a / b for a, b in zip(mine, other))
        lines.append(
            f"| {what} | {spread(mine)} | {spread(other)} | {peer} | {share:.3f} | {goal} |"
        )
    text = "\n".join(lines) + "\n"
    print(text, end="")
    if o.out:
        o.out.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
