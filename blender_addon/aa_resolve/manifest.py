# SPDX-License-Identifier: GPL-3.0-or-later
"""shot.json: what all frames share, from the plan, and an entry per frame, from the records of finished work."""

from __future__ import annotations

import bpy

from . import jitter
from .plan import Plan

FORMAT, FORMAT_VERSION = "aaresolve-shot", 1


def head_of(plan: Plan, version: str) -> dict:
    """Members of shot.json that all frames share; ``version`` is the add-on's."""
    settings, frame = plan.settings, plan.frame
    head = {
        "format": FORMAT,
        "version": FORMAT_VERSION,
        "name": settings.name,
        "resolution": [frame.width, frame.height],
        "fps": plan.scene.render.fps / plan.scene.render.fps_base,
        "jitter": {
            "sequence": settings.jitter,
            "start": jitter.start_of(settings.jitter),
            "period": settings.period,
            "centred": settings.jitter_centred,
            **({"projection": "premultiplied"} if settings.jitter_projection == "pre" else {}),
        },
        "static": plan.static,
    }
    if plan.has_subsamples:
        head["subsamples"] = {
            "pattern": settings.pattern,
            "positions": [list(p) for p in plan.positions],
        }
    if settings.truth_frames != "none":
        head["truth"] = {
            "samples_per_half": settings.truth_samples,
            "filter": "box",
            "filter_width": 1.0,
        }
    head["color"] = {
        "samples": settings.samples,
        "lighting": settings.lighting,
        "ambient": list(plan.light.ambient),
    }
    if frame.is_cropped:
        head["window"] = {
            "full_resolution": [frame.full_width, frame.full_height],
            "offset": [frame.left, frame.top],
        }
    head["methods"] = settings.methods
    head["producer"] = {
        "name": "aa_resolve",
        "version": version,
        "blender": bpy.app.version_string,
    }
    return head


def content_of(store, head: dict, frames: list[int]) -> dict:
    """The whole of shot.json: the head, and an entry per finished frame from the records of Store ``store``."""
    entries = []
    objects: dict[str, str] = {}
    for number in frames:
        record = store.record("frames", number)
        if record is None:
            continue
        entry = dict(record["entry"])
        objects.update(record["objects"])
        truth_frame = frames[0] if head["static"] else number
        centre = store.record("centre", truth_frame)
        if centre is not None:
            entry["centre"] = store.picture("centre", truth_frame)
            objects.update(centre["objects"])
            if truth_frame == number:
                spent = {f"centre.{k}": v for k, v in centre["render_seconds"].items()}
                entry["render_seconds"] = {**entry["render_seconds"], **spent}
                size = sum(centre["bytes"].values())
                entry["bytes"] = {**entry["bytes"], "centre": size}
        truth = store.record("truth", truth_frame)
        if truth is not None:
            entry["truth"] = store.picture("truth", truth_frame)
            if truth_frame == number:
                entry["render_seconds"] = {**entry["render_seconds"], **truth["render_seconds"]}
                entry["bytes"] = {**entry["bytes"], **truth["bytes"]}
        entries.append(entry)
    content = {key: value for key, value in head.items() if key != "producer"}
    content["objects"] = dict(sorted(objects.items(), key=lambda pair: int(pair[0])))
    content["frames"] = entries
    content["producer"] = head["producer"]
    return content
