# SPDX-License-Identifier: GPL-3.0-or-later
"""shot.json: what all frames share, from the plan, and an entry per frame, from the records of finished work.

It is true at any moment of an export, also while passes are added: it states what every frame that it lists has."""

from __future__ import annotations

import bpy

from . import jitter
from .plan import Plan

FORMAT, FORMAT_VERSION = "aaresolve-shot", 1


def head_of(plan: Plan, version: str) -> dict:
    """Members of shot.json that all frames share; ``version`` is the add-on's."""
    settings, frame = plan.settings, plan.frame
    head = {
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
        "color": {
            "samples": settings.samples,
            "lighting": settings.lighting,
            "ambient": list(plan.light.ambient),
        },
    }
    if frame.is_cropped:
        head["window"] = {
            "full_resolution": [frame.full_width, frame.full_height],
            "offset": [frame.left, frame.top],
        }
    head["producer"] = {
        "name": "aa_resolve",
        "version": version,
        "blender": bpy.app.version_string,
    }
    return head


def content_of(stored, head: dict) -> dict | None:
    """The whole of shot.json for what the folder holds (a store.Stored): the head, and an entry per finished frame.

    None where no frame can be listed yet."""
    entries, objects = _entries(stored, head["static"])
    if not entries:
        return None
    return {
        "format": FORMAT,
        "version": FORMAT_VERSION,
        "name": stored.name,
        **head,
        **_subsamples(stored),
        **_truth(stored),
        "methods": stored.methods,
        "objects": objects,
        "frames": entries,
    }


def _entries(stored, static: bool) -> tuple[list[dict], dict[str, str]]:
    """An entry per listed frame, and the objects that they show by id."""
    entries: list[dict] = []
    objects: dict[str, str] = {}
    frames = {n: r for n, r in stored.records["frames"].items() if _is_current(stored, r)}
    for number, record in sorted(frames.items()):
        entry = dict(record["entry"])
        entry["reset"] = not entries or number - 1 not in frames or record["cut"]
        objects.update(record["objects"])
        resting = stored.first_frame if static else number
        for kind in ("centre", "truth"):
            further = stored.records[kind].get(resting)
            if further is None or not _is_current(stored, further):
                continue
            entry[kind] = f"{kind}/{resting:06d}.exr"
            objects.update(further.get("objects", {}))
            if resting == number:
                spent = _named(kind, further["render_seconds"])
                entry["render_seconds"] = {**entry["render_seconds"], **spent}
                entry["bytes"] = {**entry["bytes"], kind: sum(further["bytes"].values())}
        entries.append(entry)
    return entries, dict(sorted(objects.items(), key=lambda pair: int(pair[0])))


def _named(kind: str, seconds: dict[str, float]) -> dict[str, float]:
    """Seconds by pass as a frame's entry names them."""
    return {f"centre.{k}": v for k, v in seconds.items()} if kind == "centre" else seconds


def _is_current(stored, record: dict) -> bool:
    """False while a picture still has sub-samples of a pattern that is being replaced."""
    return record.get("pattern") in (None, stored.pattern)


def _subsamples(stored) -> dict:
    """Member ``subsamples``, where a listed picture has them."""
    pictures = [r for kind in ("frames", "centre") for r in stored.records[kind].values()]
    if not any(record["pattern"] == stored.pattern for record in pictures):
        return {}
    positions = [list(place) for place in jitter.pattern_positions(stored.pattern)]
    return {"subsamples": {"pattern": stored.pattern, "positions": positions}}


def _truth(stored) -> dict:
    """Member ``truth``; its samples are what every truth has, while some are being raised the least of them."""
    truths = stored.records["truth"].values()
    if not truths:
        return {}
    samples = min(record["samples"] for record in truths)
    return {"truth": {"samples_per_half": samples, "filter": "box", "filter_width": 1.0}}
