# SPDX-License-Identifier: GPL-3.0-or-later
"""How long an export would take and how large it would be: one or two pictures of each sort of work, rendered into a
temporary folder. Of truth a few samples are enough."""

from __future__ import annotations

import os
import tempfile
import time
from dataclasses import dataclass

from .adding import Missing, Work, counted, duration
from .export import Exporter
from .store import Store

_MORE = 4  # times the samples of truth, until they and not the picture itself take the time


@dataclass(frozen=True)
class Cost:
    """One picture."""

    seconds: float
    bytes: int


@dataclass(frozen=True)
class Estimate:
    """What all missing work would take."""

    groups: list[tuple[Work, int, Cost]]  # an example, how many there are, what each takes

    @property
    def seconds(self) -> float:
        """Of all."""
        return sum(count * cost.seconds for _, count, cost in self.groups)

    @property
    def bytes(self) -> int:
        """Of all."""
        return sum(count * cost.bytes for _, count, cost in self.groups)

    def amount(self) -> str:
        """Time and size in words."""
        return f"{duration(self.seconds)} and {self.bytes / 1e6:.0f} MB"

    def sentence(self) -> str:
        """For people."""
        parts = ", ".join(
            f"{counted(item, count)} of {cost.seconds:.2g} s" for item, count, cost in self.groups
        )
        return f"about {self.amount()}: {parts}" if parts else "nothing to render"

    def values(self) -> dict:
        """For machines; a frame counts with its centre picture."""
        frame = sum(c.seconds for item, _, c in self.groups if item.kind != "truth")
        truth = sum(c.seconds for item, _, c in self.groups if item.kind == "truth")
        return {
            "seconds": round(self.seconds, 3),
            "frame_seconds": round(frame, 3),
            "truth_seconds": round(truth, 3),
            "bytes": self.bytes,
        }


def estimate(exporter: Exporter, store: Store, missing: Missing) -> Estimate:
    """Measures every sort of missing work; nothing is written to the store's folder."""
    found = []
    with tempfile.TemporaryDirectory(prefix="aa_resolve_probe_") as folder:
        path = os.path.join(folder, "probe.exr")
        for item, count in missing.groups():
            if item.kind == "truth":
                cost = _of_truth(exporter, store, item, path)
            else:
                alike = [other for other in missing.work if other.sort == item.sort]
                # The first one also pays for what the following ones find ready.
                cost = [_measured(exporter, store, other, path) for other in alike[:2]][-1]
            found.append((item, count, cost))
    return Estimate(found)


def _measured(
    exporter: Exporter, store: Store, item: Work, path: str, samples: int | None = None
) -> Cost:
    started = time.perf_counter()
    made = exporter.make(item, path, store, samples)
    return Cost(time.perf_counter() - started, sum(made.bytes.values()))


def _of_truth(exporter: Exporter, store: Store, item: Work, path: str) -> Cost:
    """By its time with one sample, and with as many as take longer than all the rest does: less would be noise."""
    wanted = exporter.settings.truth_samples
    # The first one also pays for what the following ones find ready.
    one = min(
        (_measured(exporter, store, item, path, 1) for _ in range(2)), key=lambda c: c.seconds
    )
    samples = 1
    while samples < wanted:
        samples = min(_MORE * samples, wanted)
        more = _measured(exporter, store, item, path, samples)
        if more.seconds >= 2.0 * one.seconds:
            each = (more.seconds - one.seconds) / (samples - 1)
            return Cost(one.seconds + each * (wanted - 1), more.bytes)
    return one if wanted == 1 else more
