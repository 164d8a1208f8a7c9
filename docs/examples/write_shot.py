#!/usr/bin/env python3
"""The least exporter: writes a shot of a disc that moves over a striped wall, with everything that methods read.

    python3 write_shot.py SHOT
    aaresolve check SHOT
    aaresolve run SHOT -m noaa -m salvi -m fxaa311 -o OUT

What your renderer would do stands in `sample`: colour, depth and so on at any place of the picture. All else is the
format, which docs/format.md describes. Needs numpy and OpenImageIO.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT, FRAMES, PERIOD = 96, 64, 8, 8
SPEED = np.array([0.6, 0.25])  # of the disc, px per frame: x right, y down
TRUTH_SIDE = 8  # samples per half: 8 x 8 at places of their own in each pixel


def halton(index: int, base: int) -> float:
    value, digit = 0.0, 1.0 / base
    while index:
        index, remainder = divmod(index, base)
        value += remainder * digit
        digit /= base
    return value


def sample(frame: int, x: np.ndarray, y: np.ndarray) -> dict[str, np.ndarray]:
    """What lies at the places (x, y) of the picture in this frame."""
    centre = np.array([24.0, 26.0]) + SPEED * frame
    disc = (x - centre[0]) ** 2 + (y - centre[1]) ** 2 < 14**2
    stripes = np.where(np.floor((x + 0.4 * y) / 7) % 2 == 0, 0.75, 0.1)
    return {
        "color": np.stack(
            [np.where(disc, c, stripes * s) for c, s in ((1.4, 1), (0.3, 0.9), (0.1, 0.7))]
        ),
        "depth": np.where(disc, 5.0, 9.0)[None],
        "normal": np.stack([0 * x, 0 * x, 0 * x + 1]),
        "object": np.where(disc, 2, 1)[None],
        # Now less before, in px, without jitter.
        "motion": np.stack([np.where(disc, SPEED[0], 0.0), np.where(disc, SPEED[1], 0.0)]),
    }


CHANNELS = {
    "color": ("R", "G", "B"),
    "depth": ("Z",),
    "normal": ("N.X", "N.Y", "N.Z"),
    "object": ("id",),
    "motion": ("motion.X", "motion.Y"),
}


def write(file: Path, parts: dict[str, tuple[tuple[str, ...], np.ndarray]]) -> None:
    """An EXR of named parts, each with its channels: float, and unsigned integer for ids."""
    specs = []
    for name, (channels, planes) in parts.items():
        spec = oiio.ImageSpec(
            WIDTH, HEIGHT, len(channels), "uint" if channels == ("id",) else "float"
        )
        spec.channelnames = channels
        spec.attribute("name", name)
        spec.attribute("compression", "zip")
        specs.append(spec)
    file.parent.mkdir(parents=True, exist_ok=True)
    out = oiio.ImageOutput.create(str(file))
    if not out or not out.open(str(file), tuple(specs)):
        raise SystemExit(f"{file}: {oiio.geterror()}")
    for i, (channels, planes) in enumerate(parts.values()):
        if i and not out.open(str(file), specs[i], "AppendSubimage"):
            raise SystemExit(f"{file}: {out.geterror()}")
        pixels = np.ascontiguousarray(np.moveaxis(planes, 0, -1))
        out.write_image(pixels.astype(np.uint32 if channels == ("id",) else np.float32))
    out.close()


def frame_at(frame: int, jitter: tuple[float, float], passes: tuple[str, ...]) -> dict:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    values = sample(frame, x + jitter[0], y + jitter[1])
    return {name: (CHANNELS[name], values[name]) for name in passes}


def truth_of(frame: int, half: int) -> np.ndarray:
    """The mean over the pixel's square; each half samples it at places of its own."""
    total = np.zeros((3, HEIGHT, WIDTH))
    random = np.random.default_rng([frame, half])
    for k in range(TRUTH_SIDE**2):
        inside = np.array(divmod(k, TRUTH_SIDE)) + random.random((HEIGHT, WIDTH, 2))
        y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + np.moveaxis(inside, -1, 0) / TRUTH_SIDE
        total += sample(frame, x, y)["color"]
    return total / TRUTH_SIDE**2


def main(shot: Path) -> None:
    frames = []
    for frame in range(1, FRAMES + 1):
        index = (frame - 1) % PERIOD + 1
        jitter = (halton(index, 2) - 0.5, halton(index, 3) - 0.5)
        entry = {
            "frame": frame,
            "file": f"frames/{frame:06}.exr",
            "centre": f"centre/{frame:06}.exr",
            "truth": f"truth/{frame:06}.exr",
            "reset": frame == 1,
            "jitter": jitter,
        }
        write(shot / entry["file"], frame_at(frame, jitter, tuple(CHANNELS)))
        # Methods without a history judge the picture as it is sampled at the pixel centres.
        write(
            shot / entry["centre"], frame_at(frame, (0, 0), ("color", "depth", "normal", "object"))
        )
        halves = {name: (("R", "G", "B"), truth_of(frame, half)) for half, name in enumerate("ab")}
        write(shot / entry["truth"], halves)
        frames.append(entry)
    document = {
        "format": "aaresolve-shot",
        "version": 1,
        "name": "disc",
        "resolution": [WIDTH, HEIGHT],
        "fps": 24,
        "static": False,
        "jitter": {"sequence": "halton23", "start": 1, "period": PERIOD},
        "objects": {"1": "wall", "2": "disc"},
        "truth": {"samples_per_half": TRUTH_SIDE**2, "filter": "box", "filter_width": 1},
        "frames": frames,
    }
    (shot / "shot.json").write_text(json.dumps(document, indent=1))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit("usage: write_shot.py SHOT")
    main(Path(sys.argv[1]))
