# SPDX-License-Identifier: GPL-3.0-or-later
"""The exporter's command line: flags from the table of options, checked against each other and the scene."""

from __future__ import annotations

import argparse
import re

import bpy

from . import jitter, registry
from .adding import settled
from .errors import UsageError
from .identity import scene_identity
from .options import FlagParser, add_flags, check_spans, options_of
from .passes.table import passes_named
from .settings import Invocation, Settings
from .store import Store, Stored

_DESCRIPTION = """\
Exports an animation as a shot for aaresolve. The .blend file is never changed.

A shot that is there is added to: only the frames, passes and truths that it lacks are rendered."""
_LAST_FRAME = 1048574  # of Blender, on either side of 0; it takes every one beyond for this one
_EXAMPLES = """\
examples:
  blender -b FILE.blend --python-exit-code 9 -P headless.py -- --out SHOT --frames 1-16 --for noaa,taaSimplest
      exports 16 frames with the passes that the two methods read, and their truth
  blender -b FILE.blend --python-exit-code 9 -P headless.py -- --out SHOT --frames 1-16 --passes object --plan
      says what it would take to add the pass `object` to them

exit codes: 0 done, 1 stopped by the user, 2 wrong usage, 3 the scene or a file cannot serve, 9 a fault of the exporter"""


def build_parser() -> argparse.ArgumentParser:
    """All options; the panel uses the same ones."""
    parser = FlagParser(
        prog="blender -b FILE.blend --python-exit-code 9 -P headless.py --",
        usage="%(prog)s --out SHOT [options]",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    add_flags(parser, Settings, Invocation)
    return parser


def parse_frames(text: str, option: str) -> list[int]:
    """Reads ``1-16``, ``5``, ``1,4,8-10`` or ``-3-2`` to an ascending list without repeats."""
    numbers: set[int] = set()
    for part in text.split(","):
        part = part.strip()
        found = re.fullmatch(r"(-?[0-9]+)(?:\s*-\s*(-?[0-9]+))?", part)
        if not found:
            raise UsageError(f"{option}: expected frames such as 1-16 or 1,4,8, found '{text}'")
        first, last = int(found[1]), int(found[2] or found[1])
        if max(abs(first), abs(last)) >= _LAST_FRAME:  # the one beside it is read, too
            raise UsageError(f"{option}: Blender has no frame beyond {_LAST_FRAME}, found '{part}'")
        if last < first:
            raise UsageError(f"{option}: the range '{part}' ends before it begins")
        numbers.update(range(first, last + 1))
    return sorted(numbers)


def settings_from(arguments: argparse.Namespace, scene: bpy.types.Scene) -> Settings:
    """Settings of parsed arguments, put together with what the shot has (adding.py). Raises UsageError for what
    contradicts itself, the scene or the shot."""
    stored = None if arguments.overwrite else Store(arguments.out, 0.0).stored()
    # Of a shot that is there nothing is wanted but what is said.
    choices = registry.parse_choices(arguments.methods or ([] if stored else ["noaa"]))
    passes, centre_passes, sequence = _passes_and_jitter(choices, arguments, stored)
    if sequence not in jitter.SEQUENCES:
        raise UsageError(
            f"--jitter: unknown sequence '{sequence}'; known: {', '.join(jitter.SEQUENCES)}"
        )
    if arguments.jitter_projection == "pre":
        _check_projection(sequence, passes)
    _check_textures(arguments, sequence)
    check_spans(vars(arguments), Settings)
    if arguments.ambient and arguments.lighting == "as-is":
        raise UsageError("--ambient: has no effect with --lighting as-is; leave one of them out")
    frames = (
        parse_frames(arguments.frames, "--frames") if arguments.frames else frames_of_scene(scene)
    )
    said = {item.name: getattr(arguments, item.name) for item, _ in options_of(Settings)}
    made = {
        "methods": [choice.id for choice in choices],
        "passes": sorted(passes),
        "centre_passes": sorted(centre_passes),
        "frames": frames,
        "truth_frames": _truth_frames(arguments.truth_frames, frames),
        "jitter": sequence,
        "pattern": _pattern(choices, arguments.pattern, passes | centre_passes, stored),
        "ambient": tuple(arguments.ambient) if arguments.ambient else None,
        "source": _source(arguments, stored),
        "scene": _name_of(scene, arguments, stored),
    }
    return settled(Settings(**{**said, **made}), stored)


def _source(arguments: argparse.Namespace, stored: Stored | None) -> str:
    """The scene's identity; that of the shot where the user vouches for it."""
    if arguments.same_scene and stored:
        return stored.content["source"]
    return arguments.source or scene_identity()


def _name_of(scene: bpy.types.Scene, arguments: argparse.Namespace, stored: Stored | None) -> str:
    """The scene's name. A shot that names none, of an earlier version, is of the only scene of its file that has a
    camera, or of the one for which the user vouches."""
    if stored and "scene" not in stored.content:
        alone = not any(other.camera for other in bpy.data.scenes if other != scene)
        if alone or arguments.same_scene:
            return ""
    return scene.name


def frames_of_scene(scene: bpy.types.Scene) -> list[int]:
    """The scene's frame range, in its steps."""
    return list(range(scene.frame_start, scene.frame_end + 1, scene.frame_step))


def _passes_and_jitter(
    choices: list[registry.MethodChoice], arguments: argparse.Namespace, stored: Stored | None
) -> tuple[set[str], set[str], str]:
    """Passes of the frames and of those at the pixel centres, and the jitter sequence.

    Methods that accumulate read jittered frames, all others the pixel centres: with both kinds chosen the shot holds
    both, with one kind only the frames themselves are of that kind; where a jitter is asked for nevertheless, those at
    the centres lie beside them, as their truth does. A shot's methods count as chosen, and its jitter is the default of
    what is added to it."""
    passes = registry.required_passes(choices, "jittered")
    centre_passes = registry.required_passes(choices, "centre")
    before = stored.methods if stored else []
    known_before = [
        registry.MethodChoice(name) for name in before if name in registry.load_methods()
    ]
    jittered = bool(passes or registry.required_passes(known_before, "jittered"))
    sequence = arguments.jitter
    if sequence is None and stored:
        sequence = stored.content["jitter"]
    if sequence is None:
        sequence = Settings.jitter if passes or not arguments.methods else "none"
    if sequence == "none" or not jittered and arguments.jitter is None:
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


def _check_textures(arguments, sequence: str) -> None:
    """What would change nothing, or nothing that is known."""
    if arguments.mip_bias and arguments.texture_filter != "mip":
        raise UsageError("--mip-bias: has no effect without --texture-filter mip")
    if arguments.unjitter_textures and sequence == "none":
        raise UsageError("--unjitter-textures: has no effect without a jitter")
    if arguments.unjitter_textures and arguments.jitter_projection == "pre":
        raise UsageError(
            "--unjitter-textures: with --jitter-projection pre the samples do not keep the jitter"
        )


def _pattern(
    choices: list[registry.MethodChoice],
    asked: str | None,
    passes: set[str],
    stored: Stored | None,
) -> str:
    """The sub-sample pattern that serves the methods; that of the shot, if it has sub-samples, unless another one is
    asked for by name."""
    held = stored.pattern if stored and _has_subsamples(stored) else None
    if held and not asked:
        _check_held_pattern(choices, held)
        return held
    pattern = registry.pattern_from(choices, asked) or Settings.pattern
    try:
        jitter.pattern_positions(pattern)
    except ValueError:
        known = ", ".join(jitter.D3D_PATTERNS)
        raise UsageError(
            f"--subsamples: expected {known} or grid1 to grid8, found '{pattern}'"
        ) from None
    if asked and not held and not registry.reads_subsamples(passes):
        raise UsageError("--subsamples: has no effect, none of the methods reads sub-samples")
    return pattern


def _has_subsamples(stored: Stored) -> bool:
    return registry.reads_subsamples(stored.passes_of("frames") | stored.passes_of("centre"))


def _check_held_pattern(choices: list[registry.MethodChoice], held: str) -> None:
    """Raises UsageError for methods that the sub-samples of the shot cannot serve."""
    for choice in choices:
        known = registry.patterns_of(choice)
        if known and held not in known:
            raise UsageError(
                f"--for: {choice.id} wants sub-samples of pattern {' or '.join(known)}, the shot has {held}; choose a "
                f"new folder, or have the shot's sub-samples rendered anew with --subsamples {known[0]}"
            )


def _truth_frames(text: str, frames: list[int]) -> list[int]:
    if text in ("all", "none"):
        return frames if text == "all" else []
    truth = parse_frames(text, "--truth-frames")
    outside = sorted(set(truth) - set(frames))
    if outside:
        raise UsageError(f"--truth-frames: frame {outside[0]} is not among --frames")
    return truth
