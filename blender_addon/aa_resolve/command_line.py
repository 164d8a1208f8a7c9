# SPDX-License-Identifier: GPL-3.0-or-later
"""The exporter's command line: flags from the table of options, checked against each other and the scene."""

from __future__ import annotations

import argparse
import hashlib
import os
from typing import NoReturn

import bpy

from . import jitter, registry
from .errors import UsageError
from .options import add_flags, check_spans, options_of
from .passes.table import passes_named
from .settings import Invocation, Settings


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} (--help lists every option)")


def build_parser() -> argparse.ArgumentParser:
    """All options; the panel uses the same ones."""
    parser = _Parser(
        prog="blender -b FILE.blend --python-exit-code 9 -P headless.py --",
        description="Exports an animation as a shot for aaresolve. The .blend file is never changed.",
    )
    add_flags(parser, Settings)
    add_flags(parser, Invocation)
    return parser


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


def settings_from(arguments: argparse.Namespace, scene: bpy.types.Scene) -> Settings:
    """Settings of parsed arguments. Raises UsageError for what contradicts itself or the scene."""
    choices = registry.parse_choices(arguments.methods or ["noaa"])
    passes, centre_passes, sequence = _passes_and_jitter(choices, arguments)
    if sequence not in jitter.SEQUENCES:
        raise UsageError(
            f"--jitter: unknown sequence '{sequence}'; known: {', '.join(jitter.SEQUENCES)}"
        )
    if arguments.jitter_projection == "pre":
        _check_projection(sequence, passes)
    check_spans(vars(arguments), Settings)
    if arguments.ambient and min(arguments.ambient) < 0.0:
        raise UsageError(f"--ambient: expected three numbers >= 0, found {arguments.ambient}")
    if arguments.ambient and arguments.lighting == "as-is":
        raise UsageError("--ambient: has no effect with --lighting as-is; leave one of them out")
    pattern = _pattern(choices, arguments.pattern, passes | centre_passes)
    frames = (
        parse_frames(arguments.frames, "--frames")
        if arguments.frames
        else list(range(scene.frame_start, scene.frame_end + 1))
    )
    said = {item.name: getattr(arguments, item.name) for item, _ in options_of(Settings)}
    made = {
        "methods": [choice.id for choice in choices],
        "passes": sorted(passes),
        "centre_passes": sorted(centre_passes),
        "frames": frames,
        "name": arguments.name or os.path.basename(os.path.abspath(arguments.out)),
        "resolution": tuple(arguments.resolution) if arguments.resolution else None,
        "truth_frames": _truth_frames(arguments.truth_frames, frames),
        "jitter": sequence,
        "pattern": pattern,
        "ambient": tuple(arguments.ambient) if arguments.ambient else None,
        "source": arguments.source or file_identity(bpy.data.filepath),
    }
    return Settings(**{**said, **made})


def _passes_and_jitter(
    choices: list[registry.MethodChoice], arguments: argparse.Namespace
) -> tuple[set[str], set[str], str]:
    """Passes of the frames and of those at the pixel centres, and the jitter sequence.

    Methods that accumulate read jittered frames, all others the pixel centres: with both kinds chosen the shot holds
    both, with one kind only the frames themselves are of that kind."""
    passes = registry.required_passes(choices, "jittered")
    centre_passes = registry.required_passes(choices, "centre")
    sequence = arguments.jitter
    if sequence is None:
        sequence = Settings.jitter if passes or not arguments.methods else "none"
    if not passes or sequence == "none":
        passes |= centre_passes
        centre_passes = set()
    known = registry.load_passes()
    for name in filter(None, (part.strip() for part in arguments.passes.split(","))):
        if name not in known:
            raise UsageError(f"--passes: unknown pass '{name}'; known: {', '.join(known)}")
        passes.add(name)
    return passes, centre_passes, sequence


def _check_projection(sequence: str, passes: set[str]) -> None:
    """What cannot be had with --jitter-projection pre."""
    if sequence == "none":
        raise UsageError("--jitter-projection pre: has no effect without a jitter")
    for item in passes_named(passes):
        if item.from_jitter:
            raise UsageError(
                "--jitter-projection pre: distances to edges are measured from the jitter, which the samples do not "
                f"keep; leave out the pass '{item.name}'"
            )


def _pattern(choices: list[registry.MethodChoice], asked: str | None, passes: set[str]) -> str:
    """The sub-sample pattern that serves the methods."""
    pattern = registry.pattern_from(choices, asked) or Settings.pattern
    try:
        jitter.pattern_positions(pattern)
    except ValueError:
        known = ", ".join(jitter.D3D_PATTERNS)
        raise UsageError(
            f"--subsamples: expected {known} or grid1 to grid8, found '{pattern}'"
        ) from None
    if asked and not registry.reads_subsamples(passes):
        raise UsageError("--subsamples: has no effect, none of the methods reads sub-samples")
    return pattern


def _truth_frames(text: str, frames: list[int]) -> list[int] | str:
    if text in ("all", "none"):
        return text
    truth = parse_frames(text, "--truth-frames")
    outside = sorted(set(truth) - set(frames))
    if outside:
        raise UsageError(f"--truth-frames: frame {outside[0]} is not among --frames")
    return truth


def file_identity(path: str) -> str:
    """SHA-256 of the .blend, or ``unsaved`` for a scene without a file."""
    if not path:
        return "unsaved"
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()
