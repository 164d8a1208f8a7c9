# SPDX-License-Identifier: GPL-3.0-or-later
"""What an export is asked to do, and the fingerprint by which a changed wish is noticed on resume."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field

from .errors import UsageError


def parse_frames(text: str, option: str) -> list[int]:
    """Reads ``1-16``, ``5``, ``1,4,8-10`` or ``-3-2`` to an ascending list without repeats."""
    numbers: set[int] = set()
    for part in text.split(","):
        part = part.strip()
        try:
            position = part.find("-", 1)
            if position < 0:
                numbers.add(int(part))
                continue
            first, last = int(part[:position]), int(part[position + 1 :])
        except ValueError:
            raise UsageError(
                f"{option}: expected frames such as 1-16 or 1,4,8, found '{text}'"
            ) from None
        if last < first:
            raise UsageError(f"{option}: the range '{part}' ends before it begins")
        numbers.update(range(first, last + 1))
    return sorted(numbers)


@dataclass
class Settings:
    """One export. Sizes in pixels, jitter in pixels with y down, colours linear BT.709."""

    out: str
    methods: list[str]
    passes: list[str]  # of the jittered frames
    frames: list[int]
    centre_passes: list[str] = field(
        default_factory=list
    )  # of the same instants at the pixel centres
    name: str = ""
    resolution: tuple[int, int] | None = None
    samples: int = 1
    truth_samples: int = 256
    truth_frames: list[int] | str = "all"
    jitter: str = "halton23"
    period: int = 16
    jitter_centred: bool = False
    jitter_projection: str = "post"  # pre: camera.premultiplied_movement, a labelled variant
    pattern: str = "d3d8"
    lighting: str = "noise-free"
    ambient: tuple[float, float, float] | None = None
    color_type: str = "float"
    compression: str = "zip"
    view_layer: str | None = None
    instance_ids: bool = True
    source: str = ""
    overwrite: bool = False

    def shift_and_movement(
        self, offset: tuple[float, float]
    ) -> tuple[tuple[float, float], tuple[float, float]]:
        """A frame's jitter as JitterCamera.aim takes it: what shifts the picture and what moves the camera."""
        nothing = (0.0, 0.0)
        return (nothing, offset) if self.jitter_projection == "pre" else (offset, nothing)

    def fingerprint(self) -> dict:
        """What decides the content of every file: equal fingerprints, equal bytes.

        The number of frames may grow between runs, the first one (where the jitter begins) may not.
        """
        wishes = asdict(self)
        for name in ("out", "methods", "truth_frames", "overwrite", "name"):
            wishes.pop(name)
        wishes["first_frame"] = wishes.pop("frames")[0]
        return json.loads(json.dumps(wishes))


_FLAGS = {
    "passes": "--for/--passes",
    "centre_passes": "--for",
    "resolution": "--resolution",
    "samples": "--samples",
    "truth_samples": "--truth-samples",
    "jitter": "--jitter",
    "period": "--period",
    "jitter_centred": "--jitter-centred",
    "jitter_projection": "--jitter-projection",
    "pattern": "--subsamples",
    "lighting": "--lighting",
    "ambient": "--ambient",
    "color_type": "--color-type",
    "compression": "--compression",
    "view_layer": "--view-layer",
    "instance_ids": "--no-instance-ids",
    "first_frame": "the first of --frames",
    "source": "the .blend file",
    "version": "the version of the add-on",
    "blender": "the version of Blender",
}


def difference(old: dict, new: dict) -> str | None:
    """First difference of two fingerprints in words, or None."""
    for key in sorted(set(old) | set(new)):
        if old.get(key) != new.get(key):
            if key == "source":
                return f"{_FLAGS[key]} has changed"
            return f"{_FLAGS.get(key, key)} was {_shown(old.get(key))} and now is {_shown(new.get(key))}"
    return None


def _shown(value) -> str:
    return ",".join(map(str, value)) if isinstance(value, list) else str(value)
