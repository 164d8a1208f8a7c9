#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Do shots of one scene, made by different Blenders, say the same?

    for each Blender:
        BLENDER -b --factory-startup --python-exit-code 9 -P tests/blenders/street.py -- street.blend
        BLENDER -b street.blend -P blender_addon/aa_resolve/headless.py -- --out SHOT --frames 1-4 \\
            --for taaSimplest,rsaa --passes depth,normal,object,albedo,motion,edges --color-type float \\
            --truth-frames none --overwrite
    agree.py SHOT SHOT [SHOT...]

Compares every further shot with the first, prints the largest difference of each pass, and ends with 1 where one is
larger than its limit, with 2 for wrong usage. Objects are compared by their names, everything else only where both
shots show the same object. Needs numpy and OpenImageIO.
"""

from __future__ import annotations

import json
import os
import re
import sys
from dataclasses import dataclass

import numpy as np
import OpenImageIO as oiio

# Largest difference by part. Depth: relative. Color: of diffuse surfaces in noise-free light; linear, 1 is white.
LIMITS = {
    "object": 0.0,  # share of pixels
    "depth": 1.0e-4,
    "normal": 1.0e-4,
    "motion": 1.0e-3,  # pixels
    "edges": 1.0e-3,  # pixels
    "albedo": 1.0e-3,
    "color": 1.0e-3,
    "subsamples.id": 0.0,
    "subsamples.Z": 1.0e-4,
    "subsamples.N": 1.0e-4,
    "subsamples.mask": 1.0e-3,  # share of pixels
    "jitter": 0.0,
    "camera": 1.0e-6,
}
BACKGROUND_DEPTH = 1.0e9


@dataclass
class Largest:
    """Largest difference of one thing, and where."""

    value: float = 0.0
    place: str = ""

    def note(self, values: np.ndarray | float, place: str) -> None:
        values = np.atleast_1d(np.asarray(values, np.float64))
        if values.size and not values.max() <= self.value:  # NaN counts as larger
            self.value, self.place = float(values.max()), place


def parts_of(path: str) -> dict[str, dict[str, np.ndarray]]:
    """Part -> channel -> H x W, in their stored types."""
    source = oiio.ImageInput.open(path)
    if source is None:
        raise SystemExit(f"error: {path}: cannot be read: {oiio.geterror()}")
    found: dict[str, dict[str, np.ndarray]] = {}
    while source.seek_subimage(len(found), 0):
        spec = source.spec()
        kinds = spec.channelformats or (spec.format,) * spec.nchannels
        channels = {}
        for index, name in enumerate(spec.channelnames):
            kind = "uint" if str(kinds[index]) == "uint" else "float"
            pixels = source.read_image(len(found), 0, index, index + 1, kind)
            channels[name] = pixels.reshape(spec.height, spec.width)
        found[spec.getattribute("oiio:subimagename")] = channels
    return found


def manifest_of(folder: str) -> dict:
    try:
        with open(os.path.join(folder, "shot.json"), encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        raise SystemExit(f"error: {folder}: is no shot: {error.strerror}") from error


def numbers(ids: np.ndarray, names: dict[str, str], known: dict[str, int]) -> np.ndarray:
    """The same number for the same name in every shot."""
    values, inverse = np.unique(ids, return_inverse=True)
    own = [known.setdefault(names.get(str(value), ""), len(known)) for value in values]
    return np.array(own)[inverse.reshape(ids.shape)]


def relative(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    both = (a >= BACKGROUND_DEPTH) & (b >= BACKGROUND_DEPTH)
    return np.where(both, 0.0, np.abs(a.astype(np.float64) / b - 1.0))


def compare(first: str, other: str) -> dict[str, Largest]:
    """Largest differences of two shots of the same frames and passes."""
    one, two = manifest_of(first), manifest_of(other)
    frames = [entry["frame"] for entry in one["frames"]]
    if frames != [entry["frame"] for entry in two["frames"]]:
        raise SystemExit(f"error: {other}: its frames are not those of {first}")
    found: dict[str, Largest] = {}
    known: dict[str, int] = {"": 0}
    for a, b in zip(one["frames"], two["frames"]):
        place = f"frame {a['frame']}"
        difference = np.abs(np.subtract(a["jitter"], b["jitter"]))
        found.setdefault("jitter", Largest()).note(difference, place)
        for matrix in ("view", "projection"):
            difference = np.abs(np.subtract(a["camera"][matrix], b["camera"][matrix]))
            found.setdefault("camera", Largest()).note(difference, f"{place}, {matrix}")
        for kind in ("file", "centre"):
            if kind in a:
                left = parts_of(os.path.join(first, a[kind]))
                right = parts_of(os.path.join(other, b[kind]))
                compare_pictures(left, right, one, two, known, f"{place} ({a[kind]})", found)
    return found


def compare_pictures(
    left: dict, right: dict, one: dict, two: dict, known: dict, place: str, found: dict
) -> None:
    if set(left) != set(right):
        raise SystemExit(f"error: {place}: parts {sorted(left)} here, {sorted(right)} there")
    same: np.ndarray | None = None
    if "object" in left:
        ids = [
            numbers(parts["object"]["id"], shot["objects"], known)
            for parts, shot in ((left, one), (right, two))
        ]
        same = ids[0] == ids[1]
        found.setdefault("object", Largest()).note((~same).mean(), place)
    for part in left:
        if part == "object":
            continue
        for channel, a in left[part].items():
            b = right[part][channel]
            if a.shape != b.shape:
                raise SystemExit(f"error: {place}, {part}.{channel}: {a.shape} and {b.shape}")
            if a.dtype == np.uint32 and channel.endswith(".id"):
                a, b = numbers(a, one["objects"], known), numbers(b, two["objects"], known)
                found.setdefault(f"{part}.id", Largest()).note((a != b).mean(), place)
                continue
            if a.dtype == np.uint32:
                found.setdefault(f"{part}.{channel}", Largest()).note((a != b).mean(), place)
                continue
            is_depth = part in ("depth", "subsamples") and re.fullmatch(r"(s\d+\.)?Z", channel)
            difference = relative(a, b) if is_depth else np.abs(a.astype(np.float64) - b)
            if same is not None and same.shape == difference.shape and part != "subsamples":
                difference = difference[same]
            name = part
            if part == "subsamples":
                name = f"{part}.{'Z' if is_depth else 'N' if '.N.' in channel else channel[-1]}"
            found.setdefault(name, Largest()).note(difference, f"{place}, {channel}")


def main(folders: list[str]) -> int:
    if len(folders) < 2 or any(folder.startswith("-") for folder in folders):
        print(__doc__, file=sys.stderr)
        return 2
    failed = False
    for other in folders[1:]:
        print(f"{other} against {folders[0]}")
        for name, largest in compare(folders[0], other).items():
            limit = LIMITS.get(name)
            wrong = limit is not None and not largest.value <= limit
            failed |= wrong
            said = "no limit" if limit is None else f"limit {limit:.3g}"
            where = f"  {largest.place}" if largest.value else ""
            print(
                f"{'WRONG' if wrong else 'ok   '} {name:<16} {largest.value:<10.4g} {said}{where}"
            )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
