# SPDX-License-Identifier: MIT
"""Calls of the program on a shot; each is repeated only when the shot, the program or what is asked has changed."""

from __future__ import annotations

import hashlib
import json
from concurrent.futures import Future
from functools import lru_cache
from pathlib import Path

from figures import Run, number
from shots import Workshop


@lru_cache(maxsize=None)
def _digest(path: Path, _changed: int) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _content(*files: Path) -> str:
    return " ".join(_digest(f, f.stat().st_mtime_ns) for f in files)


def _cached(out: Path, wish: str, made: Path) -> bool:
    stamp = out / "made_of"
    return made.exists() and stamp.exists() and stamp.read_text() == wish


def run_methods(
    folder: Path, what: str, texts: list[str], shop: Workshop, flags: tuple[str, ...] = (), write: str = "none"
) -> Run:  # fmt: skip
    """Methods on a shot, in a protocol of `flags`; asked for once more under another name, it is the same run."""
    out = folder.parent / f"{folder.name}.{what}"
    texts = [m for m in texts if shop.serves(m)]
    if "--frames" not in flags:
        flags = (*flags, *_judged_alone(folder, texts, shop))
    wish = f"{_content(folder / 'shot.json', shop.program)} {texts} {flags} {write}"
    with shop.lock:
        first = shop.runs.setdefault(wish, Future())
        mine = not first.running() and not first.done() and first.set_running_or_notify_cancel()
    if not mine:
        return first.result()
    try:
        if not _cached(out, wish, out / "results.json"):
            command: list[object] = [shop.program, "run", folder, "-o", out, "--write", write, "-q"]
            command += [
                "--no-noaa",
                "-j",
                shop.threads,
                *flags,
            ]  # tables hold what their sources do
            for m in texts:
                command += ["-m", m]
            shop.run(f"{what}.{folder.name}", command)
            (out / "made_of").write_text(wish)
        first.set_result(Run(out))
    except BaseException as error:
        first.set_exception(error)
    return first.result()


def _judged_alone(folder: Path, texts: list[str], shop: Workshop) -> tuple[str, ...]:
    """Without a history the frames before a judged one are of no use to a method."""
    shot = json.loads((folder / "shot.json").read_text())
    numbers = [f["frame"] for f in shot["frames"] if "truth" in f]
    if shot["static"] or len(numbers) in (0, len(shot["frames"])):
        return ()
    return () if any(map(shop.accumulates, texts)) else ("--frames", ",".join(map(str, numbers)))


def bench(folder: Path, texts: list[str], shop: Workshop) -> dict[str, dict]:
    """Times on one thread and memory, by method; noaa first. Kept until something changes: times are of a quiet hour."""
    out = folder.parent / f"{folder.name}.bench"
    texts = [m for m in texts if shop.serves(m)]
    wish = f"{_content(folder / 'shot.json', shop.program)} {texts}"
    if not _cached(out, wish, out / "bench.json"):
        command: list[object] = [
            shop.program,
            "bench",
            "-j",
            1,
            "--json",
            "--repeats",
            3,
            "--frames",
            3,
        ]
        command += ["--shot", folder]
        for m in texts:
            command += ["-m", m]
        out.mkdir(parents=True, exist_ok=True)
        (out / "bench.json").write_text(shop.run(f"bench.{folder.name}", command))
        (out / "made_of").write_text(wish)
    rows = json.loads((out / "bench.json").read_text())["methods"]
    return {row["method"]: row for row in rows}


def compared(
    picture: Path, reference: Path, what: str, shop: Workshop, spectrum: Path | None = None,
    flags: tuple[str, ...] = ("--q8",), figures: str = "fmagMse,mse,psnr,ssimLuma",
) -> dict[str, float]:  # fmt: skip
    """Figures of one picture against another, both as 8-bit codes for the display unless `flags` say otherwise;
    `spectrum`: where the picture of their difference in the Fourier domain is written."""
    command: list[object] = [shop.program, "compare", picture, reference, "--json", *flags]
    if spectrum:
        command += ["--map", spectrum, "--map-of", "fourier"]
    said = shop.run(f"compare.{what}", [*command, "--metrics", figures])
    return {k: number(v) for k, v in json.loads(said)["pooled"].items()}


# For Blender's Python, which has both modules.
_PLACES = """
import json, sys
import numpy as np
import OpenImageIO as oiio
def shown(path):
    light = np.clip(oiio.ImageBuf(path).get_pixels(oiio.FLOAT)[:, :, :3], 0, 1).astype(np.float64)
    code = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.floor(255 * code + 0.5) / 255
reference, plain = shown(sys.argv[1]), shown(sys.argv[2])
edge = np.abs(plain - reference).max(-1) > 1.5 / 255
found = {}
for name, path in zip(sys.argv[3::2], sys.argv[4::2]):
    squares = ((shown(path) - reference) ** 2).mean(-1)
    found[name] = (float((squares * edge).mean()), float((squares * ~edge).mean()))
print(json.dumps([float(edge.mean()), found]))
"""


def at_edges_and_elsewhere(
    reference: Path, plain: Path, pictures: dict[str, Path], what: str, shop: Workshop
) -> tuple[float, dict[str, tuple[float, float]]]:
    """Where linear pictures differ from a reference, as 8-bit codes for the display: share of the pixels in which that
    differs from the picture without anti-aliasing, and by name the squared error there and elsewhere over all pixels.
    """
    words = [w for name, path in pictures.items() for w in (name, path)]
    said = shop.run(f"places.{what}", ["/usr/bin/python3", "-c", _PLACES, reference, plain, *words])
    share, found = json.loads(said)
    return share, {name: tuple(both) for name, both in found.items()}
