# SPDX-License-Identifier: GPL-3.0-or-later
"""How long an export would take, from one frame and a little of its truth, rendered into a temporary folder."""

from __future__ import annotations

import dataclasses
import os
import tempfile

import bpy

from . import ADDON_VERSION
from .export import Exporter
from .progress import Progress
from .settings import Settings
from .store import Store

_PROBE_SAMPLES = 8


def estimate(scene: bpy.types.Scene, settings: Settings, progress: Progress) -> int:
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
