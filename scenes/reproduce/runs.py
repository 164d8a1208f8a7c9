# SPDX-License-Identifier: MIT
"""Calls of the program on a shot; each is repeated only when the shot, the program or what is asked has changed."""

from __future__ import annotations

import hashlib
import json
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
    """Methods on a shot, in a protocol of `flags`."""
    out = folder.parent / f"{folder.name}.{what}"
    texts = [m for m in texts if shop.serves(m)]
    wish = f"{_content(folder / 'shot.json', shop.program)} {texts} {flags} {write}"
    if not _cached(out, wish, out / "results.json"):
        command: list[object] = [
            shop.program,
            "run",
            folder,
            "-o",
            out,
            "--write",
            write,
            "-q",
            "--no-noaa",  # the tables hold what their sources do
            *flags,
        ]
        for m in texts:
            command += ["-m", m]
        shop.run(f"{what}.{folder.name}", command)
        (out / "made_of").write_text(wish)
    return Run(out)


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
    return {row["method"]: row for row in json.loads((out / "bench.json").read_text())}


def compared(
    picture: Path, reference: Path, what: str, shop: Workshop, spectrum: Path | None = None
) -> dict[str, float]:
    """Figures of one picture against another, both as 8-bit codes for the display; `spectrum`: where the picture of
    their difference in the Fourier domain is written."""
    command: list[object] = [shop.program, "compare", picture, reference, "--json", "--q8"]
    if spectrum:
        command += ["--map", spectrum, "--map-of", "fourier"]
    said = shop.run(f"compare.{what}", [*command, "--metrics", "fmagMse,mse,psnr,ssimLuma"])
    return {k: number(v) for k, v in json.loads(said)["pooled"].items()}
