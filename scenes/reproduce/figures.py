# SPDX-License-Identifier: MIT
"""Figures of finished runs (results.json) and their differences, each with its 95 % interval."""

from __future__ import annotations

import json
import math
import random
from dataclasses import dataclass
from pathlib import Path


def number(value) -> float:
    """JSON has no infinity: it is written as text."""
    if isinstance(value, str):
        return {"Inf": math.inf, "-Inf": -math.inf}.get(value, math.nan)
    return math.nan if value is None else float(value)


def signed(value: float, digits: int = 2) -> str:
    """+1.23 with a true minus sign; a rounded zero has no sign."""
    if 0 < abs(value) < 0.01:
        digits = max(digits, 3)
    text = f"{value:+.{digits}f}"
    return text.lstrip("+-") if float(text) == 0 else text.replace("-", "−")


@dataclass(frozen=True)
class Difference:
    """Decibels by which a first method is better than a second one; `resolved`: more than chance and truth's noise."""

    db: float
    low: float
    high: float
    resolved: bool

    def __str__(self) -> str:
        return f"{signed(self.db)} dB ({self.interval})" + (
            "" if self.resolved else f", {self.doubt}"
        )

    @property
    def interval(self) -> str:
        """Its 95 % interval in dB; half of one, or none, where errors sit in too few places of the picture."""
        if math.isinf(self.low) and math.isinf(self.high):
            return "no interval"
        if math.isinf(self.high):
            return f"{signed(self.low)} and more"
        if math.isinf(self.low):
            return f"{signed(self.high)} and less"
        return f"{signed(self.low)} to {signed(self.high)}"

    @property
    def doubt(self) -> str:
        """Of one that is not resolved: chance, as its interval shows, or the truth's noise, which the interval lacks."""
        within_noise = self.low * self.high > 0
        return "not resolved" + (" beside the truth's noise" if within_noise else "")

    def __neg__(self) -> "Difference":
        return Difference(-self.db, -self.high, -self.low, self.resolved)


class Run:
    """One results.json."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.data = json.loads((folder / "results.json").read_text())
        self.methods = {m["text"]: m for m in self.data["methods"]}
        self._pairs = {(p["first"], p["second"]): p for p in self.data["pairs"]}

    def with_methods_alone(self, texts: list[str], folder: Path) -> "Run":
        """The same with some of its methods, as a folder of its own whose pictures are this one's."""
        folder.mkdir(parents=True, exist_ok=True)
        kept = [self.methods[t] for t in texts]
        for name in {
            "truth",
            *(Path(f["image"]).parts[0] for m in kept for f in m["frames"] if f.get("image")),
        }:
            link = folder / name
            if link.is_symlink():
                link.unlink()
            link.symlink_to(self.folder / name)
        number = {t: i for i, t in enumerate(texts)}
        pairs = [
            {**p, "indices": [number[p["first"]], number[p["second"]]]}
            for p in self.data["pairs"]
            if p["first"] in number and p["second"] in number
        ]
        (folder / "results.json").write_text(
            json.dumps({**self.data, "methods": kept, "pairs": pairs})
        )
        return Run(folder)

    def __contains__(self, text: str) -> bool:
        return text in self.methods

    @property
    def noise(self) -> float:
        return number(self.data["truth"]["noiseMse"])

    def mse(self, text: str) -> float:
        return number(self.methods[text]["pooled"]["mse"])

    def psnr(self, text: str) -> float:
        return number(self.methods[text]["pooled"]["psnr"])

    def best_first(self) -> list[str]:
        return sorted(self.methods, key=self.mse)

    def temporal(self, text: str, key: str):
        """A figure over time, or None."""
        value = self.methods[text].get("temporal", {}).get(key)
        return value if isinstance(value, list) or value is None else number(value)

    def _pair(self, a: str, b: str) -> tuple[dict, int]:
        return (self._pairs[a, b], 1) if (a, b) in self._pairs else (self._pairs[b, a], -1)

    def gain(self, a: str, b: str = "noaa") -> Difference:
        """PSNR of a over b. Interval: bootstrap over tiles of 32 x 32 px, and the truth's noise."""
        if a == b:
            return Difference(0.0, 0.0, 0.0, False)
        pair, sign = self._pair(a, b)
        d = Difference(
            *(number(pair[k]) for k in ("gainDb", "gainLow95", "gainHigh95")), pair["resolved"]
        )
        return d if sign > 0 else -d

    def over_time(self, a: str, b: str, key: str) -> Difference | None:
        """How much less a has than b of `ghost`, `flicker` or (error where history was) `rejected`."""
        pair, sign = self._pair(a, b)
        if key not in pair:
            return None
        c = pair[key]
        d = Difference(number(c["gainDb"]), number(c["low95"]), number(c["high95"]), c["resolved"])
        return d if sign > 0 else -d


def setup(run: Run, smallest: float | None, of: str) -> str:
    """Size, frames and how good the truth is beside the smallest error that is ranked, `of` something; None: none is."""
    shot, truth = run.data["shot"], run.data["truth"]
    width, height = shot["resolution"]
    frames = len(run.data["methods"][0]["frames"])
    text = f"{width} × {height}, {frames} frame{'s' if frames > 1 else ''}, {'static' if shot['static'] else 'moving'}"
    if not run.noise > 0:
        return text + (", analytic, with exact truth." if run.noise == 0 else ".")
    if not smallest:
        return text + "."
    share = 100 * run.noise / smallest
    text += f"; truth of two halves of {truth['samplesPerHalf']} samples, its own error {share:.2g} % of the smallest one {of}"
    return text + (" (**more than the 1 % that a ranking asks for**)." if share > 1 else ".")


def across(run_a: Run, a: str, run_b: Run, b: str) -> Difference:
    """PSNR of a over b in two shots of one scene and truth: the same bootstrap, by the runs' tiles."""
    of_a, of_b = (r.methods[m]["tileSquares"] for r, m in ((run_a, a), (run_b, b)))
    assert len(of_a) == len(of_b), "two shots of one scene have the same tiles"
    in_db = lambda picked: 10 * math.log10(
        sum(of_b[i] for i in picked) / sum(of_a[i] for i in picked)
    )  # noqa: E731
    tiles = range(len(of_a))
    generator = random.Random(1)  # the same figures at every run
    resampled = sorted(in_db(generator.choices(tiles, k=len(tiles))) for _ in range(1000))
    low, high = resampled[25], resampled[974]
    apart = abs(run_a.mse(a) - run_b.mse(b)) > run_a.noise
    return Difference(in_db(tiles), low, high, apart and low * high > 0)


def kendall_tau(first: list[float], second: list[float]) -> float:
    """Agreement of two orders: pairs in the same order less pairs in the other, over all pairs; 1 = the same order."""
    sign = lambda v: (v > 0) - (v < 0)  # noqa: E731
    pairs = [(i, j) for i in range(len(first)) for j in range(i)]
    return sum(sign(first[i] - first[j]) * sign(second[i] - second[j]) for i, j in pairs) / len(
        pairs
    )


def verdict(difference: Difference | None, better: str = "better", worse: str = "worse") -> str:
    """The figures' answer to: is the first one better than the second? All figures count along the word beside them."""
    if difference is None:
        return "**Cannot be said**: no such figure in this shot."
    along, word = (difference, better) if difference.db >= 0 else (-difference, worse)
    size = f"{signed(along.db).lstrip('+')} dB {word} (95 %: {along.interval})"
    if not difference.resolved:
        return f"**{difference.doubt.capitalize()}**: {size}."
    return f"**{'Yes' if difference.db > 0 else 'No'}**, {size}."
