# SPDX-License-Identifier: MIT
"""Line charts as SVG: every line is named where it ends."""

from __future__ import annotations

import math
from pathlib import Path
from xml.sax.saxutils import escape

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 860, 300, 56, 150, 28, 34
NAME_HEIGHT = 15
COLOURS = (
    "#1f6fb2",
    "#d1651a",
    "#2e8b57",
    "#9b4fb0",
    "#7a7a7a",
    "#b8860b",
    "#c23b4a",
    "#3aa6a6",
)


def ticks(low: float, high: float) -> list[float]:
    """Three to seven round values (1, 2 or 5 times a power of ten apart) within [low, high], low < high."""
    decade = 10 ** math.floor(math.log10((high - low) / 3))
    step = max(s * decade for s in (1, 2, 5, 10) if s * decade <= (high - low) / 3 * (1 + 1e-9))
    return [
        k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)
    ]


def apart(wanted: list[float], least: float, low: float, high: float) -> list[float]:
    """Heights in the order of `wanted`, as near to it as `least` from one to the next allows, within [low, high]."""
    order = sorted(range(len(wanted)), key=lambda i: wanted[i])
    groups: list[
        tuple[float, list[int]]
    ] = []  # the middle of each, and what stands in it side by side
    for i in order:
        middle, group = wanted[i], [i]
        while True:
            half = least * (len(group) - 1) / 2
            middle = min(max(middle, low + half), max(low + half, high - half))
            if (
                not groups
                or middle - half - least >= groups[-1][0] + least * (len(groups[-1][1]) - 1) / 2
            ):
                break
            before = groups.pop()[1]
            group = before + group
            middle = sum(wanted[k] for k in group) / len(group)
        groups.append((middle, group))
    heights = [0.0] * len(wanted)
    for middle, group in groups:
        for n, i in enumerate(group):
            heights[i] = middle + least * (n - (len(group) - 1) / 2)
    return heights


def _text(x: float, y: float, words: str, more: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{escape(words)}</text>'


def write_svg(
    path: Path, series: dict[str, list[float]], title: str, unit: str, first: int = 0,
    labels: list[str] | None = None, along: str = "frame", low: float | None = None,
) -> None:  # fmt: skip
    """Curves over the frames, or over what has `labels`; infinite values leave a gap. `low`: where the axis begins."""
    finite = [v for values in series.values() for v in values if math.isfinite(v)]
    low, high = min(finite) if low is None else low, max(finite)
    low, high = (low - 0.5, high + 0.5) if high - low < 1e-9 else (low, high)
    count, end = max(len(v) for v in series.values()), WIDTH - RIGHT
    x = lambda i: LEFT + (end - LEFT) * i / max(1, count - 1)  # noqa: E731
    y = lambda v: HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (v - low) / (high - low)  # noqa: E731
    grey = 'fill="#555"'
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>'
        + _text(LEFT, 18, title, 'font-size="13"'),
    ]
    for value in ticks(low, high):
        out.append(f'<path d="M{LEFT} {y(value):.1f}H{end}" stroke="#ddd"/>')
        out.append(_text(LEFT - 6, y(value) + 4, f"{value:.6g}", f'text-anchor="end" {grey}'))
    for k in range(0, count, max(1, count // 10)):
        words = labels[k] if labels else str(k + first)
        out.append(_text(x(k), HEIGHT - 16, words, f'text-anchor="middle" {grey}'))
    out.append(_text(end, HEIGHT - 3, f"{along}; {unit}", f'text-anchor="end" {grey}'))
    ends = [
        next((y(v) for v in reversed(line) if math.isfinite(v)), y(low)) for line in series.values()
    ]
    names = apart(ends, NAME_HEIGHT, TOP, HEIGHT - BOTTOM)
    for n, (name, values) in enumerate(series.items()):
        colour, pen, line = COLOURS[n % len(COLOURS)], "M", []
        for i, value in enumerate(values):
            finite_here = math.isfinite(value)
            line += [f"{pen}{x(i):.1f} {y(value):.1f}"] if finite_here else []
            pen = "L" if finite_here else "M"
        out.append(f'<path d="{"".join(line)}" fill="none" stroke="{colour}" stroke-width="1.8"/>')
        out.append(_text(end + 8, names[n] + 4, name, f'fill="{colour}"'))
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".tmp")
    temporary.write_text("\n".join([*out, "</svg>", ""]), encoding="utf-8")
    temporary.replace(path)
