# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of an export: a jittered frame, the same instant at the pixel centres, or ground truth."""

from __future__ import annotations

import contextlib
from collections.abc import Collection
from dataclasses import dataclass

from . import exr, jitter
from .passes.exposure import Exposure, Stopwatch
from .passes.table import PARTS, parts_of, passes_named
from .plan import Plan
from .registry import reads_subsamples
from .scene import lighting, rendering
from .scene.cuts import cut_between
from .scene.light_sources import lights_of
from .scene.stage import Stage


_NOTHING: dict = {"entry": {}, "objects": {}, "passes": [], "pattern": None}


@dataclass(frozen=True)
class Kept:
    """A finished picture to which passes are added: its file and its record."""

    path: str
    record: dict


@dataclass(frozen=True)
class Made:
    """A picture that was written: its record, and what it took now, by pass."""

    record: dict
    seconds: dict[str, float]
    bytes: dict[str, int]


class Pictures:
    """Renders the pictures of one plan and writes them; what they cost goes to their records.

    The seconds of ``color`` are those of its render, from which depth, normal, object, motion and albedo come as well;
    theirs are of the work after it. In passes that are added without colour the first one carries the render.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        resting = plan.settings.first_frame if plan.static else None
        details = any(item.from_frame_before for item in passes_named(plan.passes))
        self.stage = Stage(plan.scene, plan.frame, plan.cuts, resting, details)

    def frame(
        self,
        kind: str,
        number: int,
        path: str,
        passes: Collection[str] | None = None,
        kept: Kept | None = None,
    ) -> Made:
        """Writes a jittered frame ("frames"), or the same instant at the pixel centres ("centre").

        ``passes`` are those to make, by default all of the shot. With ``kept`` they are added to what that holds, or
        take its place there."""
        plan = self.plan
        offset = self._jitter_of(number) if kind == "frames" else (0.0, 0.0)
        names = plan.passes_of[kind] if passes is None else passes
        wanted = passes_named(names, with_color=kept is None)
        exposure = Exposure(plan, self.stage, number, offset, wanted)
        parts = parts_of(exposure)
        with exposure.watch.of("write"):
            if kept is None:
                sizes = exr.write_parts(path, parts)
            else:
                sizes = exr.add_parts(kept.path, path, parts, PARTS)
        before = kept.record if kept else _NOTHING
        made = {item.name for item in wanted}
        knows_cut = kept is None or any(item.from_frame_before for item in wanted)
        took = _rounded(exposure.watch.seconds)
        seconds = _sums(before.get("render_seconds", {}), took)
        shown = plan.ids.names(exposure.ids) if exposure.ids is not None else {}
        wrong = exposure.nonfinite_pixels
        entry = {
            **before["entry"],
            "frame": number,
            "file": f"{kind}/{number:06d}.exr",
            **({"nonfinite_pixels": wrong} if wrong else {}),
            **exposure.notes,
            "jitter": [float(offset[0]), float(offset[1])],
            "camera": exposure.now.camera.as_manifest(),
            "render_seconds": seconds,
            "bytes": sizes,
        }
        pattern = plan.settings.pattern if reads_subsamples(made) else before["pattern"]
        record = {
            "entry": entry,
            "objects": {**before["objects"], **shown},
            "passes": sorted(made.union(before["passes"])),
            "pattern": pattern,  # of its sub-samples
            "cut": self._is_cut(exposure) if knows_cut else before["cut"],
            "render_seconds": seconds,
            "bytes": sizes,
        }
        new = {part.name for part in parts}
        return Made(record, took, {name: size for name, size in sizes.items() if name in new})

    def _jitter_of(self, number: int) -> tuple[float, float]:
        settings = self.plan.settings
        index = number - settings.first_frame
        return jitter.jitter_at(settings.jitter, index, settings.period, settings.jitter_centred)

    def _is_cut(self, exposure: Exposure) -> bool:
        """True where the camera jumps, so that the frame before is no history of this one."""
        now, before = exposure.now, exposure.before
        if before is None:
            return False
        if now.camera_name != before.camera_name:
            return True
        return cut_between(
            now.camera,
            before.camera,
            self.plan.frame,
            exposure.offset,
            exposure.depth,
            exposure.vectors,
        )

    def truth(self, number: int, path: str, samples: int | None = None) -> Made:
        """Writes both halves of a frame's ground truth, of ``samples`` instead of the shot's if given."""
        plan = self.plan
        samples = samples or plan.settings.truth_samples
        self.stage.go_to(number)
        self.stage.aim(number)
        plan.textures.rest()
        parts = []
        watch = Stopwatch()
        with watch.of("truth"), self._lights_in_order():
            for half, seed in (("a", 1), ("b", 2)):
                rendering.sample_pixel_area(plan.scene, samples, seed)
                rendering.request_passes(plan.view_layer, plan.light.passes)
                layers = rendering.render(plan.scene, plan.view_layer, plan.folder)
                color = lighting.compose(plan.light, [layers])[:, :, :3]
                kinds, packing = ("float",) * 3, plan.settings.compression
                parts.append(exr.Part(half, ("R", "G", "B"), kinds, color, packing))
        sizes = exr.write_parts(path, parts)
        seconds, size = _rounded(watch.seconds), {"truth": sum(sizes.values())}
        return Made({"samples": samples, "render_seconds": seconds, "bytes": size}, seconds, size)

    @contextlib.contextmanager
    def _lights_in_order(self):
        """Within this context Cycles takes the scene in anew for each render.

        A light that was hidden comes back behind the others in what it keeps between renders, and the light that a
        sample picks at random depends on their order: truth would depend on what was rendered before it.
        """
        render = self.plan.scene.render
        render.use_persistent_data = len(lights_of(self.plan.scene)) < 2
        try:
            yield
        finally:
            render.use_persistent_data = True


def _rounded(seconds: dict[str, float]) -> dict[str, float]:
    return {name: round(value, 4) for name, value in seconds.items()}


def _sums(one: dict[str, float], other: dict[str, float]) -> dict[str, float]:
    """Seconds by pass: those of a part made anew in the place of the old ones, those of writing added up."""
    written = {"write": one.get("write", 0.0) + other["write"]}
    return _rounded({**one, **other, **written})
