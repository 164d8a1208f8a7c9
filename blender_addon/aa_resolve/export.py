# SPDX-License-Identifier: GPL-3.0-or-later
"""The export itself: prepare, render what is neither finished nor claimed by another process, write the shot.

Works on the open scene in memory and never saves it; whoever calls it owns a Blender process for that purpose.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field

import bpy

from .manifest import head_of
from .picture import Pictures
from .plan import Plan
from .prepare import make_plan
from .progress import Progress
from .settings import Settings
from .store import Store


@dataclass
class Cost:
    """What one pass took, summed over pictures."""

    seconds: float = 0.0
    bytes: int = 0


@dataclass
class Summary:
    """What an export did."""

    rendered: int = 0
    skipped: int = 0
    elsewhere: int = 0
    costs: dict[str, Cost] = field(default_factory=dict)

    def add(self, record: dict) -> None:
        """Counts a picture and its passes."""
        self.rendered += 1
        for name, seconds in record["render_seconds"].items():
            self.costs.setdefault(name, Cost()).seconds += seconds
        for name, size in record["bytes"].items():
            self.costs.setdefault(name, Cost()).bytes += size


class Exporter:
    """One scene, one shot."""

    plan: Plan

    def __init__(
        self, scene: bpy.types.Scene, settings: Settings, progress: Progress, version: str
    ) -> None:
        self.scene, self.settings, self.progress = scene, settings, progress
        self.version = version
        self._seconds: dict[str, list[float]] = {"frames": [], "centre": [], "truth": []}

    def prepare(self) -> None:
        """Checks the scene, brings it to the light model and decides what each frame needs."""
        self.plan = make_plan(self.scene, self.settings, self.progress)

    @property
    def static(self) -> bool:
        """True when every frame shows the same."""
        return self.plan.static

    def _work(self) -> list[tuple[str, int]]:
        """Every picture of the shot, in the order in which they are made."""
        settings, truth_frames = self.settings, self._truth_frames()
        work = []
        for number in settings.frames:
            work.append(("frames", number))
            if self.plan.passes_of["centre"] and (not self.static or number == settings.frames[0]):
                work.append(("centre", number))
            if number in truth_frames:
                work.append(("truth", number))
        return work

    def _truth_frames(self) -> set[int]:
        settings = self.settings
        if settings.truth_frames == "none":
            return set()
        if self.static:
            return {settings.frames[0]}
        return set(settings.frames if settings.truth_frames == "all" else settings.truth_frames)

    def run(self, store: Store) -> Summary:
        """Renders everything that is not finished and not claimed by another process."""
        settings = self.settings
        head, work = head_of(self.plan, self.version), self._work()
        pictures = Pictures(self.plan)
        summary = Summary()
        for position, (kind, number) in enumerate(work):
            if not store.claim(kind, number):
                if store.record(kind, number) is None:
                    summary.elsewhere += 1
                else:
                    summary.skipped += 1
                continue
            started = time.perf_counter()
            try:
                path = os.path.join(store.folder, store.picture(kind, number))
                record = (
                    pictures.truth(number, path)
                    if kind == "truth"
                    else pictures.frame(kind, number, path)
                )
            except BaseException:
                store.release(kind, number)
                raise
            store.finish(kind, number, record, head, settings.frames)
            self._seconds[kind].append(time.perf_counter() - started)
            summary.add(record)
            self._report(kind, number, record, os.path.getsize(path), work[position + 1 :])
        with store.locked():
            store.write_manifest(head, settings.frames)
        return summary

    def seconds_of(self, kind: str) -> float:
        """Seconds of the last picture of a kind (``frames``, ``centre``, ``truth``); 0 where there was none."""
        return self._seconds[kind][-1] if self._seconds[kind] else 0.0

    def _report(
        self, kind: str, number: int, record: dict, size: int, rest: list[tuple[str, int]]
    ) -> None:
        seconds = self._seconds[kind][-1]
        typical = {
            name: sorted(values)[len(values) // 2] if values else seconds
            for name, values in self._seconds.items()
        }
        left = sum(typical[name] for name, _ in rest)
        label = {"frames": "frame"}.get(kind, kind)
        parts = ", ".join(
            f"{name} {value:.2f} s" for name, value in record["render_seconds"].items()
        )
        self.progress.say(
            label,
            f"{label} {number}: {seconds:.2f} s ({parts}), {size / 1e6:.2f} MB, {left:.0f} s left",
            frame=number,
            seconds=round(seconds, 3),
            bytes=size,
            left_seconds=round(left, 1),
            remaining=len(rest),
            passes={
                "seconds": record["render_seconds"],
                "bytes": record["bytes"],
            },
        )
