# SPDX-License-Identifier: GPL-3.0-or-later
"""The export itself: prepare, render what is neither finished nor claimed by another process, write the shot.

Works on the open scene in memory and never saves it; whoever calls it owns a Blender process for that purpose.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, field
from statistics import median

import bpy

from .adding import Missing, Work, lacking, lacks, lacks_truth
from .manifest import head_of
from .picture import Kept, Made, Pictures
from .plan import Plan
from .prepare import make_plan
from .progress import Progress
from .scene.linked import identity_of_linked
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

    def add(self, made: Made) -> None:
        """Counts a picture and its passes."""
        self.rendered += 1
        for name, seconds in made.seconds.items():
            self.costs.setdefault(name, Cost()).seconds += seconds
        for name, size in made.bytes.items():
            self.costs.setdefault(name, Cost()).bytes += size


class Exporter:
    """One scene, one shot."""

    plan: Plan
    pictures: Pictures

    def __init__(
        self, scene: bpy.types.Scene, settings: Settings, progress: Progress, version: str
    ) -> None:
        self.scene, self.settings, self.progress = scene, settings, progress
        self.version = version
        self._seconds: dict[tuple, list[float]] = {}  # by sort of work

    def prepare(self) -> None:
        """Checks the scene, brings it to the light model and decides what each frame needs."""
        self._linked = identity_of_linked()
        self.plan = make_plan(self.scene, self.settings, self.progress)
        self.pictures = Pictures(self.plan)

    @property
    def static(self) -> bool:
        """True when every frame shows the same."""
        return self.plan.static

    def content(self) -> dict:
        """What decides the content of every picture: the settings' part, and what the scene and the programs add."""
        return {
            **self.settings.fingerprint(),
            "static": self.static,
            "linked": self._linked,
            "version": self.version,
            "blender": bpy.app.version_string,
        }

    def missing(self, store: Store) -> Missing:
        """What the shot lacks. Raises UsageError when it was made with settings that make other pictures."""
        stored = None
        if not self.settings.overwrite:
            store.refuse_other(self.content())
            stored = store.stored()
        return lacking(self.settings, self.plan.passes_of, self.static, stored)

    def open(self, store: Store) -> None:
        """Begins the shot in the store's folder, or joins it."""
        settings = self.settings
        pattern = settings.pattern if self.plan.has_subsamples else None
        store.open(self.content(), settings.methods, settings.name, pattern, settings.overwrite)

    def run(self, store: Store) -> Summary:
        """Renders everything that is not finished and not claimed by another process."""
        head = head_of(self.plan, self.version)
        stored = store.stored()
        every = lacking(self.settings, self.plan.passes_of, self.static, None).work
        work = lacking(self.settings, self.plan.passes_of, self.static, stored).work
        summary = Summary(skipped=len(every) - len(work))
        progressed = True
        # What another process had at first may be free later, or lack a pass that only this one wants.
        while work and progressed:
            rendered, left = summary.rendered, []
            for position, item in enumerate(work):
                if self._waits(item, store) or not self._claim(item, store):
                    if self._lacks(item, store.record(item.kind, item.number)):
                        left.append(item)
                    else:
                        summary.skipped += 1
                    continue
                started = time.perf_counter()
                made, size = self._make(item, store, head)
                seconds = time.perf_counter() - started
                self._seconds.setdefault(item.sort, []).append(seconds)
                summary.add(made)
                self._report(item, made, seconds, size, left + work[position + 1 :])
            work, progressed = left, summary.rendered > rendered
        summary.elsewhere = len(work)
        with store.locked():
            store.write_manifest(head)
        return summary

    def _lacks(self, item: Work, record: dict | None) -> bool:
        if item.kind == "truth":
            return lacks_truth(self.settings, record)
        return bool(lacks(self.plan.passes_of[item.kind], record, self.settings.pattern))

    def _claim(self, item: Work, store: Store) -> bool:
        return store.claim(item.kind, item.number, lambda record: self._lacks(item, record))

    def _waits(self, item: Work, store: Store) -> bool:
        """True for what is to be made last while others still lack it."""
        if not item.last or (self.static and item.kind == "centre"):
            return False
        others = store.stored().records["frames"].keys() - {item.number}
        return any(self._lacks(item, store.record(item.kind, number)) for number in others)

    def _make(self, item: Work, store: Store, head: dict) -> tuple[Made, int]:
        """Makes a claimed picture; also the bytes of its file."""
        try:
            made = self.make(item, store.unfinished(item.kind, item.number), store)
            return made, store.finish(item.kind, item.number, made.record, head)
        except BaseException:
            store.release(item.kind, item.number)
            raise

    def make(self, item: Work, path: str, store: Store, truth_samples: int | None = None) -> Made:
        """Writes the picture of a piece of work to ``path``, with all that the store has of it."""
        if item.kind == "truth":
            return self.pictures.truth(item.number, path, truth_samples)
        record = None if self.settings.overwrite else store.record(item.kind, item.number)
        names = lacks(self.plan.passes_of[item.kind], record, self.settings.pattern)
        file = os.path.join(store.folder, store.picture(item.kind, item.number))
        kept = Kept(file, record) if record is not None else None
        return self.pictures.frame(item.kind, item.number, path, names, kept)

    def _report(self, item: Work, made: Made, seconds: float, size: int, rest: list[Work]) -> None:
        typical = {sort: median(values) for sort, values in self._seconds.items()}
        left = sum(typical.get(other.sort, seconds) for other in rest)
        label = {"frames": "frame"}.get(item.kind, item.kind)
        parts = ", ".join(f"{name} {value:.2f} s" for name, value in made.seconds.items())
        what = f"{label} {item.number}"
        if item.adds and item.passes:
            what += f", {', '.join(sorted(item.passes))} added"
        self.progress.say(
            label,
            f"{what}: {seconds:.2f} s ({parts}), {size / 1e6:.2f} MB, {left:.0f} s left",
            frame=item.number,
            adds=item.adds,
            seconds=round(seconds, 3),
            bytes=size,
            left_seconds=round(left, 1),
            remaining=len(rest),
            passes={"seconds": made.seconds, "bytes": made.bytes},
        )
