# SPDX-License-Identifier: GPL-3.0-or-later
"""Command line of the exporter.

    blender -b FILE.blend --python-exit-code 9 -P headless.py -- --out SHOT --frames 1-16 --for noaa,taaSimplest

Exit codes: 0 done, 1 stopped by the user, 2 wrong usage, 3 the scene or a file cannot serve, 9 a fault of this
program. Errors are one line on standard error. The .blend file is only read.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
import os
import sys
import tempfile
import time

import bpy

if __package__ in (None, ""):
    sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    import aa_resolve  # noqa: F401  (makes the relative imports below work when Blender runs this file)

    __package__ = "aa_resolve"

from . import ADDON_VERSION, exr, jitter, registry  # noqa: E402
from .scene import lighting  # noqa: E402
from .errors import Cancelled, SceneError, UsageError  # noqa: E402
from .export import Exporter  # noqa: E402
from .progress import Progress  # noqa: E402
from .settings import Settings, parse_frames  # noqa: E402
from .store import Store  # noqa: E402


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message: str):
        raise UsageError(f"{message} (--help lists every option)")


def build_parser() -> argparse.ArgumentParser:
    """All options; the panel uses the same ones."""
    sequences = "; ".join(f"{name}: {text}" for name, text in jitter.SEQUENCES.items())
    parser = _Parser(
        prog="blender -b FILE.blend --python-exit-code 9 -P headless.py --",
        description="Exports an animation as a shot for aaresolve. The .blend file is never changed.",
    )
    add = parser.add_argument
    add(
        "--out",
        required=True,
        metavar="SHOT",
        help="folder of the shot; an interrupted export resumes there",
    )
    add("--frames", metavar="LIST", help="frames, e.g. 1-16 or 1,4,8 (default: the scene's range)")
    add(
        "--for",
        dest="methods",
        action="append",
        default=[],
        metavar="METHODS",
        help="methods the shot must serve, e.g. noaa,taaSimplest,rsaa:S=8; decides the passes (default: noaa)",
    )
    add(
        "--passes",
        default="",
        metavar="LIST",
        help=f"passes to write in addition to those of --for, of {', '.join(registry.load_passes())}",
    )
    add("--resolution", nargs=2, type=int, metavar=("W", "H"), help="pixels (default: the scene's)")
    add(
        "--samples",
        type=int,
        default=1,
        metavar="N",
        help="shading samples per pixel, all at one point: geometry stays aliased (default 1)",
    )
    add(
        "--truth-samples",
        type=int,
        default=256,
        metavar="N",
        help="samples per pixel and half of the truth (256)",
    )
    add(
        "--truth-frames",
        default="all",
        metavar="LIST",
        help="frames with ground truth: all, none or e.g. 1,8,16 (all); a static shot has one for all frames",
    )
    add(
        "--jitter",
        metavar="SEQUENCE",
        help=f"default halton23, or none where no method of --for accumulates frames. {sequences}",
    )
    add(
        "--period",
        type=int,
        default=16,
        metavar="N",
        help="frames after which the jitter repeats (16)",
    )
    add(
        "--jitter-centred",
        action="store_true",
        help="subtract the mean of one period of the jitter",
    )
    add(
        "--jitter-projection",
        choices=("post", "pre"),
        default="post",
        help="post: samples move by the jitter; pre: labelled variant, the error of the T2MSAA/ASAA thesis: the camera moves by (2 jx / W, -2 jy / H) scene units and the picture by jitter x focal length / depth (post)",
    )
    add(
        "--subsamples",
        default=None,
        metavar="PATTERN",
        help=f"sub-sample pattern: {', '.join(jitter.D3D_PATTERNS)} or gridN, around pixel centre + jitter (default: what serves the methods, else d3d8)",
    )
    add(
        "--lighting",
        choices=lighting.MODELS,
        default="noise-free",
        help="noise-free: delta lights, ambient in place of the world's light, no bounces; as-is: the scene's own light",
    )
    add(
        "--ambient",
        nargs=3,
        type=float,
        metavar=("R", "G", "B"),
        help="ambient radiance of noise-free light, linear (default: the mean of the world, where it lights surfaces)",
    )
    add(
        "--color-type",
        choices=("float", "half"),
        default="float",
        help="type of colour and albedo (float)",
    )
    add(
        "--compression",
        choices=tuple(exr.COMPRESSIONS),
        default="zip",
        help="of every part (zip)",
    )
    add("--view-layer", metavar="NAME", help="view layer to render (default: the only one in use)")
    add("--no-instance-ids", action="store_true", help="instances share the id of their source")
    add("--name", help="name of the shot (default: that of the folder)")
    add(
        "--source",
        metavar="HASH",
        help="identity of the scene, to notice changes (default: SHA-256 of the .blend)",
    )
    add("--overwrite", action="store_true", help="replace an export with other settings")
    add(
        "--claim-timeout",
        type=float,
        default=3600.0,
        metavar="SECONDS",
        help="after this time work claimed by a process on another machine is taken over (3600)",
    )
    add(
        "--estimate",
        action="store_true",
        help="render one frame and a little of its truth elsewhere, say how long the export would take, write nothing",
    )
    add("--json", action="store_true", help="progress as one JSON object per line")
    return parser


def _check_range(option: str, value: int, low: int, high: int) -> None:
    if not low <= value <= high:
        raise UsageError(f"{option}: expected {low} to {high}, found {value}")


def settings_from(arguments: argparse.Namespace, scene: bpy.types.Scene) -> Settings:
    """Checks the options against each other and the scene."""
    choices = registry.parse_choices(arguments.methods or ["noaa"])
    # Methods that accumulate read jittered frames, all others the pixel centres: with both kinds chosen the shot holds
    # both, with one kind only the frames themselves are of that kind.
    passes = registry.required_passes(choices, "jittered")
    centre_passes = registry.required_passes(choices, "centre")
    if arguments.jitter is None:
        arguments.jitter = "halton23" if passes or not arguments.methods else "none"
    if not passes or arguments.jitter == "none":
        passes |= centre_passes
        centre_passes = set()
    for name in filter(None, (part.strip() for part in arguments.passes.split(","))):
        if name not in registry.load_passes():
            raise UsageError(
                f"--passes: unknown pass '{name}'; known: {', '.join(registry.load_passes())}"
            )
        passes.add(name)
    if arguments.jitter not in jitter.SEQUENCES:
        raise UsageError(
            f"--jitter: unknown sequence '{arguments.jitter}'; known: {', '.join(jitter.SEQUENCES)}"
        )
    if arguments.jitter_projection == "pre" and arguments.jitter == "none":
        raise UsageError("--jitter-projection pre: has no effect without a jitter")
    if arguments.jitter_projection == "pre" and "edges" in passes:
        raise UsageError(
            "--jitter-projection pre: distances to edges are measured from the jitter, which the samples do not keep; leave out the pass 'edges'"
        )
    _check_range("--period", arguments.period, 1, 1 << 20)
    _check_range("--samples", arguments.samples, 1, 1 << 16)
    _check_range("--truth-samples", arguments.truth_samples, 1, 1 << 20)
    if arguments.resolution:
        for value in arguments.resolution:
            _check_range("--resolution", value, 4, 65536)  # Blender's own lower limit
    if arguments.ambient and min(arguments.ambient) < 0.0:
        raise UsageError(f"--ambient: expected three numbers >= 0, found {arguments.ambient}")
    if arguments.ambient and arguments.lighting == "as-is":
        raise UsageError("--ambient: has no effect with --lighting as-is; leave one of them out")
    both = passes | centre_passes
    pattern = registry.pattern_from(choices, arguments.subsamples) or "d3d8"
    try:
        jitter.pattern_positions(pattern)
    except ValueError:
        known = ", ".join(jitter.D3D_PATTERNS)
        raise UsageError(
            f"--subsamples: expected {known} or grid1 to grid8, found '{pattern}'"
        ) from None
    if arguments.subsamples and not registry.reads_subsamples(both):
        raise UsageError("--subsamples: has no effect, none of the methods reads sub-samples")
    frames = (
        parse_frames(arguments.frames, "--frames")
        if arguments.frames
        else list(range(scene.frame_start, scene.frame_end + 1))
    )
    truth: list[int] | str = arguments.truth_frames
    if truth not in ("all", "none"):
        truth = parse_frames(arguments.truth_frames, "--truth-frames")
        outside = sorted(set(truth) - set(frames))
        if outside:
            raise UsageError(f"--truth-frames: frame {outside[0]} is not among --frames")
    return Settings(
        out=arguments.out,
        methods=[choice.id for choice in choices],
        passes=sorted(passes),
        centre_passes=sorted(centre_passes),
        frames=frames,
        name=arguments.name or os.path.basename(os.path.abspath(arguments.out)),
        resolution=tuple(arguments.resolution) if arguments.resolution else None,
        samples=arguments.samples,
        truth_samples=arguments.truth_samples,
        truth_frames=truth,
        jitter=arguments.jitter,
        period=arguments.period,
        jitter_centred=arguments.jitter_centred,
        jitter_projection=arguments.jitter_projection,
        pattern=pattern,
        lighting=arguments.lighting,
        ambient=tuple(arguments.ambient) if arguments.ambient else None,
        color_type=arguments.color_type,
        compression=arguments.compression,
        view_layer=arguments.view_layer,
        instance_ids=not arguments.no_instance_ids,
        source=arguments.source or file_identity(bpy.data.filepath),
        overwrite=arguments.overwrite,
    )


def file_identity(path: str) -> str:
    """SHA-256 of the .blend, or ``unsaved`` for a scene without a file."""
    if not path:
        return "unsaved"
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()


_PROBE_SAMPLES = 8


def _estimate(scene: bpy.types.Scene, settings: Settings, progress: Progress) -> int:
    """Measures one frame and ``_PROBE_SAMPLES`` samples of truth, and scales them up."""
    frames = settings.frames
    truth = frames if settings.truth_frames == "all" else settings.truth_frames
    with tempfile.TemporaryDirectory(prefix="aa_resolve_probe_") as folder:
        probe = dataclasses.replace(
            settings,
            out=os.path.join(folder, "shot"),
            frames=frames[:2],
            truth_frames=[frames[0]],
            truth_samples=min(settings.truth_samples, _PROBE_SAMPLES),
        )
        exporter = Exporter(scene, probe, progress, ADDON_VERSION)
        exporter.prepare()
        store = Store(probe.out, 1.0)
        store.open(probe.fingerprint(), False)
        exporter.run(store)
        frame_seconds, truth_seconds = exporter.seconds_of("frames"), exporter.seconds_of("truth")
        centre_seconds = exporter.seconds_of("centre")
        size = os.path.getsize(os.path.join(probe.out, store.picture("frames", frames[0])))
    truths = 0 if truth == "none" else 1 if exporter.static else len(truth)
    centres = 1 if exporter.static else len(frames)
    per_truth = truth_seconds * settings.truth_samples / probe.truth_samples
    total = frame_seconds * len(frames) + centre_seconds * centres + per_truth * truths
    progress.say(
        "estimate",
        f"about {_duration(total)}: {len(frames)} frames of {frame_seconds + centre_seconds:.2g} s, "
        f"{truths} truths of {per_truth:.2g} s, {size * len(frames) / 1e6:.0f} MB",
        seconds=round(total, 1),
        frame_seconds=round(frame_seconds, 3),
        truth_seconds=round(per_truth, 3),
        bytes=size * len(frames),
    )
    return 0


def _duration(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def run(argv: list[str]) -> int:
    """Exports the open file; returns the exit code."""
    try:
        arguments = build_parser().parse_args(argv)
        progress = Progress(arguments.json)
        scene = bpy.context.scene
        settings = settings_from(arguments, scene)
        if arguments.estimate:
            return _estimate(scene, settings, progress)
        started = time.perf_counter()
        exporter = Exporter(scene, settings, progress, ADDON_VERSION)
        exporter.prepare()
        store = Store(settings.out, arguments.claim_timeout)
        store.open(
            {
                **settings.fingerprint(),
                "static": exporter.static,
                "version": ADDON_VERSION,
                "blender": bpy.app.version_string,
            },
            settings.overwrite,
        )
        summary = exporter.run(store)
        seconds = time.perf_counter() - started
        finished = f", {summary.skipped} were finished before" if summary.skipped else ""
        elsewhere = (
            f", {summary.elsewhere} are being made by other processes" if summary.elsewhere else ""
        )
        for name, cost in summary.costs.items():
            size = f", {cost.bytes / 1e6:.2f} MB" if cost.bytes else ""
            progress.say(
                "cost",
                f"{name}: {cost.seconds:.2f} s{size}",
                **{"pass": name, "seconds": round(cost.seconds, 3), "bytes": cost.bytes},
            )
        progress.say(
            "done",
            f"{os.path.join(settings.out, 'shot.json')}: {summary.rendered} pictures in {seconds:.1f} s"
            f"{finished}{elsewhere}",
            shot=os.path.join(store.folder, "shot.json"),
            rendered=summary.rendered,
            skipped=summary.skipped,
            elsewhere=summary.elsewhere,
            seconds=round(seconds, 3),
        )
        return 0
    except (UsageError, SceneError, Cancelled) as error:
        print(f"error: {error}", file=sys.stderr, flush=True)
        return error.exit_code


if __name__ == "__main__":
    sys.exit(run(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []))
