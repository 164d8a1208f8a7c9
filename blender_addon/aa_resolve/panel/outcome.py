# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run found, for the panel: the three methods nearest to the truth, from the resolver's results.json."""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass

_BASE = "noaa"
_BEST = 3
_RESULTS = "results.json"
_FILES = ("sheet.png", "report.html")


@dataclass(frozen=True)
class Rank:
    """One method of the ranking. Decibels of PSNR, pooled over the frames with truth."""

    text: str  # id and parameters
    title: str
    psnr: float
    gain: tuple[
        float, float, float
    ] | None  # over no anti-aliasing: value, low and high end of its 95 % interval
    told_apart: bool  # from the one above it


@dataclass(frozen=True)
class Outcome:
    """The results of one folder."""

    folder: str
    best: tuple[Rank, ...]
    methods: int
    trouble: str = ""  # why there is no ranking
    older_than_shot: bool = False
    files: tuple[str, ...] = ()  # beside the results


def stamp_of(folder: str, shot: str) -> tuple[int, ...]:
    """Changes when the results or the shot change."""
    paths = [os.path.join(folder, name) for name in (_RESULTS, *_FILES)]
    return tuple(map(_time, (*paths, os.path.join(shot, "shot.json"))))


def _time(path: str) -> int:
    try:
        return os.stat(path).st_mtime_ns
    except OSError:
        return 0


def read(folder: str, shot: str) -> Outcome | None:
    """The outcome of a folder of results; None where there is none."""
    path = os.path.join(folder, _RESULTS)
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
        unfinished = _unfinished(content)
        best = () if unfinished else tuple(_ranking(content))
        count = len(content["methods"])
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
        return Outcome(
            folder, (), 0, f"{path} cannot be read ({error}); press Export and Compare again"
        )
    trouble = unfinished
    if not best and not unfinished:
        trouble = "no method could be measured: the shot has no truth"
    older = _time(os.path.join(shot, "shot.json")) > _time(path)
    files = tuple(name for name in _FILES if _time(os.path.join(folder, name)))
    return Outcome(folder, best, count, trouble, older, files)


def _unfinished(content: dict) -> str:
    """Says that a run was interrupted, or still goes on: its figures are not those of the whole shot."""
    run = content.get("run", {})
    if run.get("complete", True):
        return ""
    done = len(content["methods"][0]["frames"]) if content["methods"] else 0
    return f"not finished: {done} of {run.get('framesAsked', '?')} frames; press Export and Compare again"


def _ranking(content: dict) -> list[Rank]:
    """The methods nearest to the truth. References (those that need what no renderer has in time) compete only where
    there is nothing else."""
    judged = [method for method in content["methods"] if method.get("pooled")]
    methods = [method for method in judged if method["family"] != "reference"] or judged
    methods.sort(key=lambda method: _number(method["pooled"]["psnr"]), reverse=True)
    ranks: list[Rank] = []
    for place, method in enumerate(methods[:_BEST]):
        above = methods[place - 1] if place else None
        pair = _pair(content, method["text"], above["text"]) if above else None
        ranks.append(
            Rank(
                method["text"],
                method["title"],
                _number(method["pooled"]["psnr"]),
                _gain(content, method["text"]),
                pair is None or bool(pair[0]["resolved"]),
            )
        )
    return ranks


def _pair(content: dict, first: str, second: str) -> tuple[dict, bool] | None:
    """The comparison of two methods, and whether it was made the other way round."""
    for pair in content.get("pairs", []):
        if (pair["first"], pair["second"]) == (first, second):
            return pair, False
        if (pair["first"], pair["second"]) == (second, first):
            return pair, True
    return None


def _gain(content: dict, text: str) -> tuple[float, float, float] | None:
    """Gain of a method over no anti-aliasing, with its interval."""
    found = _pair(content, text, _BASE)
    if found is None:
        return None
    pair, reversed_ = found
    value, low, high = (_number(pair[name]) for name in ("gainDb", "gainLow95", "gainHigh95"))
    return (-value, -high, -low) if reversed_ else (value, low, high)


def _number(value) -> float:
    """A number of results.json, where infinity is a text."""
    return float(value) if not isinstance(value, bool) else 0.0


def _decibels(value: float) -> str:
    """With its sign, and none before zero."""
    text = f"{value:+.1f}"
    return "0.0" if text in ("+0.0", "-0.0") else text


def _interval(low: float, high: float) -> str:
    """In words, as the report has it: an end without bound is not known."""
    if math.isinf(low) and math.isinf(high):
        return "no interval"
    known = (
        f"above {_decibels(low)}"
        if math.isinf(high)
        else f"below {_decibels(high)}"
        if math.isinf(low)
        else ""
    )
    return f"95\u00a0%: {known or f'{_decibels(low)} to {_decibels(high)}'}"


def lines_of(place: int, rank: Rank) -> list[str]:
    """One place of the ranking in words."""
    _, _, changed = rank.text.partition(":")
    lines = [f"{place}. {rank.title}{f' ({changed})' if changed else ''}: {rank.psnr:.1f} dB"]
    if rank.gain is not None:
        lines.append(
            f"{_decibels(rank.gain[0])} dB over no anti-aliasing ({_interval(*rank.gain[1:])})"
        )
    if not rank.told_apart:
        lines.append("not told apart from the one above")
    return lines
