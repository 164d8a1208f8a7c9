# SPDX-License-Identifier: MIT
"""What a method costs above no anti-aliasing: milliseconds of one thread, and memory."""

from __future__ import annotations


def figures(row: dict, base: dict, pixels: int) -> dict[str, float]:
    """Of one row of `bench --json` and that of noaa: `ms` and `ms above`, and `MB` of everything that it needs beyond
    the colour: input passes, targets and state."""
    milliseconds = lambda r: r["nsPerPixel"] * pixels * 1e-6  # noqa: E731
    held = ("inputBytes", "targetBytes", "stateBytes")
    return {
        "ms": milliseconds(row),
        "ms above": milliseconds(row) - milliseconds(base),
        "MB": sum(row.get(k, 0) - base.get(k, 0) for k in held) / 1e6,
    }
