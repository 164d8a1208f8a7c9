# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of an export: a jittered frame, the same instant at the pixel centres, or ground truth."""

from __future__ import annotations

from . import exr, jitter
from .passes.exposure import Exposure, Stopwatch
from .passes.table import parts_of, passes_named
from .plan import Plan
from .scene import lighting, rendering
from .scene.cuts import cut_between
from .scene.stage import Stage


class Pictures:
    """Renders the pictures of one plan and writes them; what they cost goes to their records.

    The seconds of ``color`` are those of its render, from which depth, normal, object, motion and albedo come as well;
    theirs are of the work after it."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        resting = plan.settings.frames[0] if plan.static else None
        details = any(item.from_frame_before for item in passes_named(plan.passes))
        self.stage = Stage(plan.scene, plan.frame, plan.cuts, resting, details)

    def frame(self, kind: str, number: int, path: str) -> dict:
        """Writes a jittered frame ("frames"), or the same instant at the pixel centres ("centre"); its record."""
        plan = self.plan
        offset = self._jitter_of(number) if kind == "frames" else (0.0, 0.0)
        wanted = passes_named(plan.passes_of[kind])
        exposure = Exposure(plan, self.stage, number, offset, wanted)
        parts = parts_of(exposure)
        with exposure.watch.of("write"):
            sizes = exr.write_parts(path, parts)
        wrong = exposure.nonfinite_pixels
        seconds = {name: round(value, 4) for name, value in exposure.watch.seconds.items()}
        entry = {
            "frame": number,
            "file": f"{kind}/{number:06d}.exr",
            **({"nonfinite_pixels": wrong} if wrong else {}),
            "reset": self._is_reset(exposure),
            **exposure.notes,
            "jitter": [float(offset[0]), float(offset[1])],
            "camera": exposure.now.camera.as_manifest(),
            "render_seconds": seconds,
            "bytes": sizes,
        }
        return {
            "entry": entry,
            "objects": plan.ids.names(exposure.ids) if exposure.ids is not None else {},
            "render_seconds": seconds,
            "bytes": sizes,
        }

    def _jitter_of(self, number: int) -> tuple[float, float]:
        settings = self.plan.settings
        index = number - settings.frames[0]
        return jitter.jitter_at(settings.jitter, index, settings.period, settings.jitter_centred)

    def _is_reset(self, exposure: Exposure) -> bool:
        """True where no history belongs to the frame: at the start, after a gap and after a cut."""
        frames, number = self.plan.settings.frames, exposure.number
        now, before = exposure.now, exposure.before
        if number == frames[0] or number - 1 not in frames:
            return True
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

    def truth(self, number: int, path: str) -> dict:
        """Writes both halves of a frame's ground truth; its record."""
        plan = self.plan
        self.stage.go_to(number)
        self.stage.aim(number)
        parts = []
        watch = Stopwatch()
        with watch.of("truth"):
            for half, seed in (("a", 1), ("b", 2)):
                rendering.sample_pixel_area(plan.scene, plan.settings.truth_samples, seed)
                rendering.request_passes(plan.view_layer, plan.light.passes)
                layers = rendering.render(plan.scene, plan.view_layer, plan.folder)
                color = lighting.compose(plan.light, [layers])[:, :, :3]
                parts.append(
                    exr.Part(
                        half, ("R", "G", "B"), ("float",) * 3, color, plan.settings.compression
                    )
                )
        sizes = exr.write_parts(path, parts)
        return {
            "render_seconds": {"truth": round(watch.seconds["truth"], 4)},
            "bytes": {"truth": sum(sizes.values())},
        }
