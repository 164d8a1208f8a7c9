# SPDX-License-Identifier: GPL-3.0-or-later
"""What a shot has, and what is to be rendered so that it has all that is wanted: a shot is added to, never made anew.

A shot is rectangular: all its frames have the same passes. What is wanted is therefore put together with what is there:
a pass that is added is added to every frame, a frame that is added gets every pass. Each pass stands in a part of its
frame's file, the truth in files of its own, so that nothing else needs to be rendered again. Sub-samples of another
pattern take the place of the old ones, truth of more samples that of the truth with fewer.

Nothing here renders or looks at the scene: ``missing`` may be asked at any time.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from statistics import median

from . import registry
from .errors import UsageError
from .passes.color import Color
from .passes.table import passes_named
from .settings import Settings
from .store import Store, Stored


@dataclass(frozen=True)
class Work:
    """One picture to make: a new one, or passes to add to one that is there."""

    kind: str  # of store.KINDS
    number: int
    passes: frozenset[str] = frozenset()  # none for a truth
    adds: bool = False  # to a finished picture
    last: bool = False  # the resolver takes the passes of the first frame for those of all: it gets new ones last

    @property
    def sort(self) -> tuple[str, frozenset[str], bool]:
        """What is alike in works that take alike time."""
        return self.kind, self.passes, self.adds


@dataclass
class Missing:
    """Result of ``missing``: what is there, what is to be rendered, and why it cannot be added, if it cannot."""

    work: list[Work]
    kept: dict  # frames, passes, centre, centre_passes, truth (numbers of pictures and names of passes)
    seconds: float | None  # that the work will take, from what the shot's pictures took; None where none was alike
    changed: str | None = (
        None  # what differs from the settings with which the shot was made, in words
    )
    if_at_rest: bool = (
        False  # said of a shot at rest, and of frames of which nobody has looked whether they rest
    )

    def groups(self) -> list[tuple[Work, int]]:
        """An example of each sort of work, and how often it comes."""
        found: dict[tuple, list[Work]] = {}
        for item in self.work:
            found.setdefault(item.sort, []).append(item)
        return [(items[0], len(items)) for items in found.values()]

    def sentence(self) -> str:
        """For people."""
        kept = _kept_in_words(self.kept)
        if not self.work:
            return f"{kept}; nothing to render" if kept else "nothing to render"
        wanted = "; ".join(in_words(item, count) for item, count in self.groups())
        time = f", about {duration(self.seconds)}" if self.seconds is not None else ""
        condition = (
            "; if something moves in the new frames, also motion and truth of all" * self.if_at_rest
        )
        return (f"{kept}; " if kept else "") + f"to render: {wanted}{time}{condition}"

    def values(self) -> dict:
        """For machines."""
        return {
            "kept": self.kept,
            "render": [
                {
                    "kind": item.kind,
                    "pictures": count,
                    "passes": _in_order(item.passes),
                    "adds": item.adds,
                }
                for item, count in self.groups()
            ],
            "seconds": None if self.seconds is None else round(self.seconds, 1),
        }


def duration(seconds: float) -> str:
    """A time in words."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def in_words(item: Work, count: int) -> str:
    """``item`` and others like it."""
    names = ", ".join(_in_order(item.passes))
    things = counted(item, count)
    if item.kind == "truth":
        return f"{things} again with more samples" if item.adds else things
    return f"{names} for {things}" if item.adds else f"{things} ({names})"


def counted(item: Work, count: int) -> str:
    """``count`` pictures of the item's kind."""
    one = {"frames": "frame", "centre": "centre picture", "truth": "truth"}[item.kind]
    return f"{count} {one}{'s' if count != 1 else ''}"


def _kept_in_words(kept: dict) -> str:
    said = []
    for kind in ("frames", "centre", "truth"):
        if kept[kind]:
            names = ", ".join(kept.get(f"{kind}_passes", ()))
            said.append(counted(Work(kind, 0), kept[kind]) + (f" ({names})" if names else ""))
    return f"kept: {', '.join(said)}" if said else ""


def _in_order(names: Collection[str]) -> list[str]:
    return [item.name for item in passes_named(names, with_color=False)]


def settled(settings: Settings, stored: Stored | None) -> Settings:
    """The settings put together with what the shot has: all its frames and passes are wanted.

    Raises UsageError for frames before the one with which the shot's jitter begins."""
    if stored is None:
        return settings
    first = stored.first_frame
    if settings.frames[0] < first:
        raise UsageError(
            f"--frames: the shot in '{settings.out}' begins with frame {first}, and so does its jitter: frame "
            f"{settings.frames[0]} cannot be put before it; choose a new folder, or replace the shot with --overwrite"
        )
    rests = stored.content["static"]
    return dataclasses.replace(
        settings,
        origin=first,
        moves=not rests,
        rested=sorted(stored.records["frames"]) if rests else [],
        rested_with_truth=rests and bool(stored.records["truth"]),
        frames=sorted({*settings.frames, *stored.records["frames"]}),
        passes=sorted({*settings.passes, *stored.passes_of("frames"), *_left_out_at_rest(stored)}),
        centre_passes=sorted({*settings.centre_passes, *stored.passes_of("centre")}),
    )


def _left_out_at_rest(stored: Stored) -> set[str]:
    """Passes of which the shot has none because it rests, and which its methods read once it moves."""
    if not stored.content["static"]:
        return set()
    known = registry.load_methods()
    choices = [registry.MethodChoice(name) for name in stored.methods if name in known]
    wanted = passes_named(registry.required_passes(choices, "jittered"))
    return {item.name for item in wanted if item.from_frame_before}


def missing(settings: Settings, store: Store) -> Missing:
    """What the shot of ``store`` lacks of what the settings (of ``settings_from``) want. Reads small files only.

    Whether nothing moves is known once a shot has been begun; before that, a new shot's motion and truth of every
    frame count as missing although a static one does without."""
    stored = None if settings.overwrite else store.stored()
    static = bool(stored and stored.content["static"])
    found = lacking(settings, wanted_passes(settings, static), static, stored)
    if stored is not None:
        found.changed = store.changed({**stored.content, **settings.fingerprint()})
        found.if_at_rest = static and len(settings.frames) > len(stored.records["frames"])
    return found


def wanted_passes(settings: Settings, static: bool) -> dict[str, set[str]]:
    """Passes of either kind of frame; those that compare two frames say nothing of a shot at rest."""
    wanted = {"frames": set(settings.passes), "centre": set(settings.centre_passes)}
    if static:
        for names in wanted.values():
            names -= {item.name for item in passes_named(names) if item.from_frame_before}
    return wanted


def lacking(
    settings: Settings,
    passes_of: Mapping[str, Collection[str]],
    static: bool,
    stored: Stored | None,
) -> Missing:
    """What ``stored`` lacks of the passes and truths of all frames, in the order in which it is to be made."""
    records = stored.records if stored else {"frames": {}, "centre": {}, "truth": {}}
    first = settings.first_frame
    leading = {kind: min(found, default=None) for kind, found in records.items()}
    truths = set(settings.truth_frames)
    if static:
        truths = {first} if truths else truths
    elif truths and settings.rested_with_truth:
        truths.update(settings.rested)  # what they shared is the first one's alone
    work = []
    for number in sorted({first, *settings.frames} if static else settings.frames):
        for kind in ("frames", "centre"):
            if kind == "centre" and not (passes_of[kind] and (number == first or not static)):
                continue
            record = records[kind].get(number)
            names = lacks(passes_of[kind], record, settings.pattern)
            if names:
                last = number == leading["frames"] and not _is_stale(record, settings.pattern)
                work.append(Work(kind, number, frozenset(names), record is not None, last))
        if number in truths and lacks_truth(settings, records["truth"].get(number)):
            work.append(Work("truth", number, adds=number in records["truth"]))
    work.sort(key=lambda item: item.last)
    kept = {kind: len(found) for kind, found in records.items()}
    for kind in ("frames", "centre"):
        kept[f"{kind}_passes"] = _in_order(stored.passes_of(kind)) if stored else []
    return Missing(work, kept, _known_seconds(settings, work, records))


def lacks(wanted: Collection[str], record: dict | None, pattern: str) -> set[str]:
    """Passes to make so that a picture has the wanted ones; those that share a part are made together."""
    wanted = {Color.name, *wanted}
    if record is None:
        return wanted
    there = set(record["passes"])
    parts = {_part(name) for name in wanted - there}
    if _is_stale(record, pattern):
        parts |= {_part(name) for name in there if registry.reads_subsamples([name])}
    return {name for name in wanted | there if _part(name) in parts}


def lacks_truth(settings: Settings, record: dict | None) -> bool:
    """True where there is no truth yet, or one of fewer samples than are wanted now."""
    return record is None or record["samples"] < settings.truth_samples


def _is_stale(record: dict | None, pattern: str) -> bool:
    """True when a picture holds sub-samples of another pattern."""
    return record is not None and record["pattern"] not in (None, pattern)


def _part(name: str) -> str:
    return registry.load_passes()[name].part


def _known_seconds(
    settings: Settings, work: list[Work], records: Mapping[str, Mapping[int, dict]]
) -> float | None:
    """What the work will take, from what like pictures of the shot took."""
    total = 0.0
    typical: dict[tuple, float | None] = {}
    for item in work:
        if item.sort not in typical:
            took = [
                seconds
                for record in records[item.kind].values()
                if (seconds := _seconds_of(item, record, settings)) is not None
            ]
            typical[item.sort] = median(took) if took else None
        if typical[item.sort] is None:
            return None
        total += typical[item.sort]
    return total


def _seconds_of(item: Work, record: dict, settings: Settings) -> float | None:
    """What a piece of work would take if it went like a finished picture of its kind; None if that has other passes."""
    took = record["render_seconds"]
    if item.kind == "truth":
        return took["truth"] * settings.truth_samples / record["samples"]
    if not item.passes <= set(record["passes"]):
        return None
    # Colour's seconds are those of the render that all passes come from.
    parts = {Color.name, "write", *map(_part, item.passes)}
    return sum(seconds for name, seconds in took.items() if name in parts)
