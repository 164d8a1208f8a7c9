# SPDX-License-Identifier: GPL-3.0-or-later
"""Jitter sequences and sub-sample patterns.

Unit and sign, everywhere in this package: pixels of the final image, x to the right, y **down**; a jitter is
the displacement of the sample from the pixel centre, each component in [-0.5, 0.5].
"""

from __future__ import annotations

import math

Offset = tuple[float, float]

# Direct3D 11 standard patterns, in 1/16 pixel, y down, in API order; quincunx: centre and shared corner.
_D3D_SIXTEENTHS: dict[str, tuple[tuple[int, int], ...]] = {
    "d3d1": ((0, 0),),
    "d3d2": ((4, 4), (-4, -4)),
    "d3d4": ((-2, -6), (6, -2), (-6, 2), (2, 6)),
    "d3d8": ((1, -3), (-1, 3), (5, 1), (-3, -5), (-5, 5), (-7, -1), (3, 7), (7, -7)),
    "d3d16": (
        (1, 1), (-1, -3), (-3, 2), (4, -1), (-5, -2), (2, 5), (5, 3), (3, -5),
        (-2, 6), (0, -7), (-4, -6), (-6, 4), (-8, 0), (7, -4), (6, 7), (-7, -8),
    ),
    "quincunx": ((0, 0), (-8, -8)),
}  # fmt: skip

D3D_PATTERNS = tuple(_D3D_SIXTEENTHS)


def pattern_positions(name: str) -> list[Offset]:
    """Sub-sample offsets of ``d3d1|2|4|8|16``, of ``quincunx`` or of a regular ``gridN`` (N x N, row by row), N from 1 to 8.

    Raises ValueError for any other name."""
    if name in _D3D_SIXTEENTHS:
        return [(x / 16.0, y / 16.0) for x, y in _D3D_SIXTEENTHS[name]]
    if name.startswith("grid") and name[4:].isdigit() and 1 <= int(name[4:]) <= 8:
        count = int(name[4:])
        return [
            ((2 * column + 1) / (2 * count) - 0.5, (2 * row + 1) / (2 * count) - 0.5)
            for row in range(count)
            for column in range(count)
        ]
    raise ValueError(name)


def radical_inverse(base: int, index: int, permutation: tuple[int, ...] | None = None) -> float:
    """Digits of ``index`` mirrored at the point, each digit passed through ``permutation``."""
    digits, scale = 0, 1
    while index:
        index, digit = divmod(index, base)
        digits = digits * base + (permutation[digit] if permutation else digit)
        scale *= base
    return digits / scale


def _interleaved_gradient(x: float, y: float, index: int) -> float:
    """Jimenez's gradient noise; fmod of positive values is their fractional part."""
    inner = 0.06711056 * (x + 5.588238 * index) + 0.00583715 * (y + 5.588238 * index)
    return math.fmod(52.9829189 * math.fmod(inner, 1.0), 1.0)


class _Pcg32:
    """O'Neill's PCG32: the same numbers on every machine and Python version."""

    def __init__(self, sequence: int) -> None:
        self.state = 0
        self.increment = (sequence << 1) | 1
        self.next()
        self.state = (self.state + 0x853C49E6748FEA9B) & 0xFFFFFFFFFFFFFFFF
        self.next()

    def next(self) -> int:
        """A uniform 32-bit number."""
        old = self.state
        self.state = (old * 6364136223846793005 + self.increment) & 0xFFFFFFFFFFFFFFFF
        shifted = (((old >> 18) ^ old) >> 27) & 0xFFFFFFFF
        rotation = old >> 59
        return ((shifted >> rotation) | (shifted << (-rotation & 31))) & 0xFFFFFFFF

    def uniform(self) -> float:
        """A number in [0, 1)."""
        return self.next() / 4294967296.0


def _gaussian(index: int, scale: float) -> Offset:
    """Marsaglia's polar method, one generator per frame, clipped to the pixel."""
    generator = _Pcg32(index)
    while True:
        a, b = 2.0 * generator.uniform() - 1.0, 2.0 * generator.uniform() - 1.0
        square = a * a + b * b
        if 0.0 < square < 1.0:
            break
    factor = scale * math.sqrt(-2.0 * math.log(square) / square)
    return max(-0.5, min(0.5, factor * a)), max(-0.5, min(0.5, factor * b))


_QUADRANTS: tuple[Offset, ...] = ((-0.25, -0.25), (-0.25, 0.25), (0.25, -0.25), (0.25, 0.25))
# The INSIDE lists are published with y up.
_UNIFORM4: tuple[Offset, ...] = ((-0.25, 0.25), (0.25, -0.25), (0.25, 0.25), (-0.25, -0.25))
_ROTATED4: tuple[Offset, ...] = ((-0.125, 0.375), (0.375, 0.125), (0.125, -0.375), (-0.375, -0.125))
# [Stejmar n.d., listing 4.2], which multiplies by the square of sigma by mistake.
_GAUSSIAN_SCALE: dict[str, float] = {
    "gaussian": 0.2575,
    "quadrantGaussian": 0.2575,
    "quadrantGaussianVariance": 0.2575 * 0.2575,
}

SEQUENCES: dict[str, str] = {
    "none": "every sample at the pixel centre",
    "halton23": "Halton, bases 2 and 3, from index 1",
    "halton23zero": "Halton, bases 2 and 3, from index 0 (contains the pixel corner)",
    "thesis": "MATLAB haltonset(2) with RR2 scrambling, from index 0",
    "hammersley": "(n / period, radical inverse to base 2)",
    "r2": "Roberts' additive recurrence",
    "ign": "interleaved gradient noise",
    "gaussian": "normal distribution, sigma 0.2575 px, clipped to the pixel",
    "quadrant": "the four quarter points in turn",
    "quadrantGaussian": "quarter points plus the normal distribution (asaa)",
    "quadrantGaussianVariance": "labelled variant: quarter points plus a normal distribution of 0.0663 px, the square of sigma, as [Stejmar n.d.] lists it",
    "insideUniform4": "four quarter points, helix order",
    "insideRotated4": "rotated grid of four",
    "msaa8": "the Direct3D 8x pattern in turn",
    "smaaT2x": "(+.25, +.25) and (-.25, -.25) in turn",
    "smaa4x": "(+.125, -.125) and (-.125, +.125) in turn, for sub-samples d3d2",
    "t2msaa": "(+.25, -.25) and (-.25, +.25) in turn, for sub-samples d3d2",
    "t2msaa1875": "(+.1875, -.1875) and (-.1875, +.1875) in turn, for sub-samples d3d2",
    "t2msaa125": "(+.125, -.125) and (-.125, +.125) in turn, for sub-samples d3d2",
}
# Two places in turn: SMAA's ([Jimenez 2012], published with y up) and those of [Stejmar n.d., 4.4.2], whose tables 5.18
# and 5.19 have the two smaller ones: with these the samples of two frames lie in rows and columns of their own.
_PAIRS: dict[str, tuple[Offset, Offset]] = {
    "smaaT2x": ((0.25, 0.25), (-0.25, -0.25)),
    "smaa4x": ((0.125, -0.125), (-0.125, 0.125)),
    "t2msaa": ((0.25, -0.25), (-0.25, 0.25)),
    "t2msaa1875": ((0.1875, -0.1875), (-0.1875, 0.1875)),
    "t2msaa125": ((0.125, -0.125), (-0.125, 0.125)),
}


def start_of(sequence: str) -> int:
    """Index of a sequence's first point, for shot.json."""
    return 1 if sequence == "halton23" else 0


def _raw(sequence: str, index: int, period: int) -> Offset:
    n = index % period
    if sequence == "none":
        return 0.0, 0.0
    if sequence in ("halton23", "halton23zero"):
        m = n + start_of(sequence)
        return radical_inverse(2, m) - 0.5, radical_inverse(3, m) - 0.5
    if sequence == "thesis":
        return radical_inverse(2, n) - 0.5, radical_inverse(3, n, (0, 2, 1)) - 0.5
    if sequence == "hammersley":
        return n / period - 0.5, radical_inverse(2, n) - 0.5
    if sequence == "r2":
        return (
            math.fmod(0.5 + n * 0.7548776662466927, 1.0) - 0.5,
            math.fmod(0.5 + n * 0.5698402909980532, 1.0) - 0.5,
        )
    if sequence == "ign":
        return _interleaved_gradient(1.0, 1.0, n) - 0.5, _interleaved_gradient(1.0, 2.0, n) - 0.5
    if sequence in _GAUSSIAN_SCALE:
        (dx, dy), (x, y) = _gaussian(n, _GAUSSIAN_SCALE[sequence]), _QUADRANTS[n % 4]
        if sequence == "gaussian":
            return dx, dy
        return max(-0.5, min(0.5, x + dx)), max(-0.5, min(0.5, y + dy))
    tables = {"quadrant": _QUADRANTS, "insideUniform4": _UNIFORM4, "insideRotated4": _ROTATED4}
    if sequence in tables:
        return tables[sequence][n % 4]
    if sequence == "msaa8":
        return pattern_positions("d3d8")[n % 8]
    if sequence in _PAIRS:
        return _PAIRS[sequence][n % 2]
    raise ValueError(sequence)


def jitter_at(sequence: str, index: int, period: int, centre: bool = False) -> Offset:
    """Jitter of the ``index``-th frame (from 0) of a shot; it repeats after ``period`` frames.

    ``centre`` subtracts the mean of one period, which a finite block of most sequences does not have at 0.
    """
    x, y = _raw(sequence, index, period)
    if centre:
        block = [_raw(sequence, n, period) for n in range(period)]
        x -= sum(offset[0] for offset in block) / period
        y -= sum(offset[1] for offset in block) / period
    return x, y
