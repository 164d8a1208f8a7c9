# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of an export: a jittered frame, the same instant at the pixel centres, or ground truth."""

from __future__ import annotations

import contextlib
import time

import bpy
import numpy as np

from . import analysis
from . import camera as cam
from . import edges, exr, jitter, lighting, motion, rendering, sample_part, segments, subsamples
from .errors import SceneError
from .plan import Plan


class _Stopwatch:
    """Seconds by pass."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextlib.contextmanager
    def of(self, name: str):
        """Adds the time of the context to a pass."""
        started = time.perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - started


class Pictures:
    """Renders the pictures of one plan and writes them; what they cost goes to their records.

    The seconds of ``color`` are those of its render, from which depth, normal, object, motion and albedo come as well;
    theirs are of the work after it."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self._cameras: dict[str, cam.JitterCamera] = {}
        self._view_sets: dict[str, subsamples.ViewSet] = {}
        self._states: dict[int, analysis.FrameState] = {}

    # --- where the scene stands ----------------------------------------------------------------------------------

    def _state(self, number: int) -> analysis.FrameState:
        """State of a frame; evaluates it unless it is known."""
        if number not in self._states:
            plan = self.plan
            state = analysis.frame_state(
                plan.scene, number, plan.frame, plan.cuts, "motion" in plan.passes
            )
            self._states = {key: value for key, value in self._states.items() if key > number - 3}
            self._states[number] = state
        return self._states[number]

    def _go_to(self, number: int) -> None:
        scene = self.plan.scene
        shown = self.plan.settings.frames[0] if self.plan.static else number
        if scene.frame_current != shown or scene.frame_subframe != 0.0:
            scene.frame_set(shown)

    def _aim(self, number: int, offset: tuple[float, float]) -> None:
        source = self.plan.cuts.at(number)
        if source.name_full not in self._cameras:
            self._cameras[source.name_full] = cam.JitterCamera(
                self.plan.scene, source, "AA Resolve Camera"
            )
        camera = self._cameras[source.name_full]
        self.plan.scene.camera = camera.object
        bpy.context.view_layer.update()
        shift, movement = self.plan.settings.shift_and_movement(offset)
        camera.aim(
            self.plan.frame, bpy.context.evaluated_depsgraph_get(), *shift, premultiplied=movement
        )

    def _views(self, number: int) -> subsamples.ViewSet:
        source = self.plan.cuts.at(number)
        if source.name_full not in self._view_sets:
            self._view_sets[source.name_full] = subsamples.ViewSet(
                self.plan.scene, source, self.plan.positions
            )
        return self._view_sets[source.name_full]

    # --- a frame -------------------------------------------------------------------------------------------------

    def frame(self, kind_of_frame: str, number: int, path: str) -> dict:
        """Writes a jittered frame ("frames"), or the same instant at the pixel centres ("centre")."""
        plan, settings = self.plan, self.plan.settings
        passes = plan.passes_of[kind_of_frame]
        offset = (0.0, 0.0)
        if kind_of_frame == "frames":
            offset = jitter.jitter_at(
                settings.jitter,
                number - settings.frames[0],
                settings.period,
                settings.jitter_centred,
            )
        before = None if plan.static else self._state(number - 1)
        now = self._state(settings.frames[0] if plan.static else number)
        apart = "motion" in passes and self._instances_change(number)
        self._go_to(number)
        self._aim(number, offset)
        rendering.sample_points(plan.scene, settings.samples)
        watch = _Stopwatch()
        with watch.of("color"):
            cycles_passes = plan.cycles_passes(passes)
            renders = self._render_lights(cycles_passes - {"Vector"} if apart else cycles_passes)
            color = lighting.compose(plan.light, renders)
        main = renders[0]
        parts = [self._part("color", "RGBA", settings.color_type, color)]
        entry = {"frame": number, "file": f"{kind_of_frame}/{number:06d}.exr"}
        wrong = int((~np.isfinite(color)).any(axis=-1).sum())
        if wrong:
            entry["nonfinite_pixels"] = wrong
        if "albedo" in passes:
            with watch.of("albedo"):
                names = ("albedo.R", "albedo.G", "albedo.B")
                albedo = rendering.unlit_albedo(main)
                parts.append(self._part("albedo", names, settings.color_type, albedo))
        depth = main.get("Depth")[:, :, 0] if main.has("Depth") else None
        if "depth" in passes:
            parts.append(self._part("depth", ("Z",), "float", depth[:, :, None]))
        if "normal" in passes:
            parts.append(self._part("normal", ("N.X", "N.Y", "N.Z"), "float", main.get("Normal")))
        ids = None
        if passes & {"object", "motion", "subsamples", "edges", "segments"}:
            with watch.of("object"):
                plan.ids.look(bpy.context.evaluated_depsgraph_get())
                ids = plan.ids.resolve(main)
        if "object" in passes:
            parts.append(self._part("object", ("id",), "uint", ids[:, :, None]))
        vectors = None
        if "motion" in passes:
            with watch.of("motion"):
                vectors = motion.motion_from_vector(
                    self._vectors_apart(main) if apart else main.get("Vector"),
                    depth,
                    plan.frame,
                    offset,
                    now.camera,
                    before.camera,
                )
        entry["reset"] = self._is_reset(number, now, before, depth, vectors, offset)
        if vectors is not None:
            invalid = self._mark_invalid_motion(vectors, main, ids, now, before)
            if invalid:
                entry["motion_invalid"] = invalid
            parts.append(self._part("motion", ("motion.X", "motion.Y"), "float", vectors))
        if "edges" in passes:
            with watch.of("edges"):
                distances, missing = self._edges(now.camera, ids, depth, offset)
            if missing:
                entry["pixels_without_edges"] = missing
            parts.append(self._part("edges", ("edge.X", "edge.Y"), "float", distances))
        if "segments" in passes:
            with watch.of("segments"):
                found = segments.find(
                    plan.frame,
                    now.camera,
                    bpy.context.evaluated_depsgraph_get(),
                    plan.ids,
                    set(np.unique(ids).tolist()),
                )
            parts.append(segments.as_part(found, settings.compression))
        if passes & {"subsamples", "subsampleColor"}:
            with watch.of("subsamples"):
                views = self._views(number)
                samples = sample_part.render(plan, views, passes, offset)
                centre = {"depth": depth, "id": ids}
                if "subsamples" in passes:
                    centre["normal"] = main.get("Normal")
                parts.append(
                    sample_part.make(plan, views, samples, passes, centre, now.camera, offset)
                )
        with watch.of("write"):
            sizes = exr.write_parts(path, parts)
        entry["jitter"] = [float(offset[0]), float(offset[1])]
        entry["camera"] = now.camera.as_manifest()
        entry["render_seconds"] = {name: round(value, 4) for name, value in watch.seconds.items()}
        entry["bytes"] = sizes
        return {
            "entry": entry,
            "objects": plan.ids.names(ids) if ids is not None else {},
            "render_seconds": entry["render_seconds"],
            "bytes": sizes,
        }

    def _render_lights(self, first_passes: set[str]) -> list[rendering.Layers]:
        """The frame as the light model wants it: one render, or one per light."""
        plan = self.plan
        rendering.request_passes(plan.view_layer, first_passes)
        if len(plan.light.lights) < 2:
            return [rendering.render(plan.scene, plan.view_layer, plan.folder)]
        renders = []
        for index, light in enumerate(plan.light.lights):
            if index == 1:
                rendering.request_passes(plan.view_layer, plan.light.further_passes)
            with lighting.only_light(plan.light, light):
                renders.append(rendering.render(plan.scene, plan.view_layer, plan.folder))
        return renders

    def _instances_change(self, number: int) -> bool:
        """True when an instance of the frame is missing in the one before or after: with motion vectors Cycles shows
        only instances that exist in all three."""
        now = self._state(number).instances
        return bool(now) and not (
            now <= self._state(number - 1).instances and now <= self._state(number + 1).instances
        )

    def _vectors_apart(self, main: rendering.Layers) -> np.ndarray:
        """Vector pass of a render of its own; no place in the picture where that shows something else."""
        plan = self.plan
        rendering.request_passes(plan.view_layer, {"Vector", "Depth", "IndexOB"})
        with subsamples.no_lights(plan.light, plan.scene):
            layers = rendering.render(plan.scene, plan.view_layer, plan.folder)
        same = (layers.get("IndexOB") == main.get("IndexOB")) & (
            layers.get("Depth") == main.get("Depth")
        )
        return np.where(same, layers.get("Vector"), motion.NO_PREVIOUS_POSITION_PX)

    def _part(self, name: str, channels, kind: str, pixels: np.ndarray) -> exr.Part:
        if kind == "half" and np.abs(pixels[np.isfinite(pixels)]).max(initial=0.0) > 65504.0:
            raise SceneError(
                f"part '{name}' holds values above 65504, too large for half: use --color-type float"
            )
        kinds = (kind,) * len(tuple(channels))
        pixels = pixels.astype(np.uint32 if kind == "uint" else np.float32, copy=False)
        return exr.Part(name, tuple(channels), kinds, pixels, self.plan.settings.compression)

    def _is_reset(
        self,
        number: int,
        now: analysis.FrameState,
        before: analysis.FrameState | None,
        depth: np.ndarray | None,
        vectors: np.ndarray | None,
        offset: tuple[float, float],
    ) -> bool:
        """True where no history belongs to the frame: at the start, after a gap and after a cut."""
        frames = self.plan.settings.frames
        if number == frames[0] or number - 1 not in frames:
            return True
        if before is None:
            return False
        if now.camera_name != before.camera_name:
            return True
        return motion.cut_between(
            now.camera, before.camera, self.plan.frame, offset, depth, vectors
        )

    def _mark_invalid_motion(
        self,
        vectors: np.ndarray,
        main: rendering.Layers,
        ids: np.ndarray,
        now: analysis.FrameState,
        before: analysis.FrameState,
    ) -> dict | None:
        """Where Cycles' vector is known to be wrong the motion points far out of the picture instead.

        Objects that were hidden in the previous frame, instances that were not there, and meshes whose number of
        vertices changed.
        """
        table = self.plan.ids.table
        names = {name for name in before.hidden if name not in now.hidden}
        names |= {
            name
            for name, count in now.vertices.items()
            if before.vertices.get(name, count) != count
        }
        indices = [index for index, name in table.items() if name in names]
        pixels = np.isin(np.rint(main.get("IndexOB")[:, :, 0]).astype(np.int64), indices)
        new = self.plan.ids.of_instances(now.instances - before.instances)
        pixels |= np.isin(ids, new) | (np.abs(vectors) > motion.NO_PREVIOUS_POSITION_PX / 2.0).any(-1)
        if not pixels.any():
            return None
        vectors[pixels] = motion.NO_PREVIOUS_POSITION_PX
        return {
            "objects": sorted(set(self.plan.ids.names(ids[pixels]).values())),
            "pixels": int(pixels.sum()),
            "value": motion.NO_PREVIOUS_POSITION_PX,
        }

    def _edges(
        self,
        camera: cam.CameraState,
        ids: np.ndarray,
        depth: np.ndarray,
        offset: tuple[float, float],
    ) -> tuple[np.ndarray, int]:
        """Distances to edges and the number of surface pixels without a triangle."""
        finder = edges.EdgeFinder(self.plan.frame, camera)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        edges.collect(finder, depsgraph, self.plan.ids, set(np.unique(ids).tolist()))
        return finder.measure(ids, depth, offset)

    # --- ground truth --------------------------------------------------------------------------------------------

    def truth(self, number: int, path: str) -> dict:
        """Writes both halves of a frame's ground truth."""
        plan = self.plan
        self._go_to(number)
        self._aim(number, (0.0, 0.0))
        parts = []
        watch = _Stopwatch()
        with watch.of("truth"):
            for half, seed in (("a", 1), ("b", 2)):
                rendering.sample_pixel_area(plan.scene, plan.settings.truth_samples, seed)
                rendering.request_passes(plan.view_layer, plan.light.passes)
                layers = rendering.render(plan.scene, plan.view_layer, plan.folder)
                color = lighting.compose(plan.light, [layers])[:, :, :3]
                parts.append(
                    exr.Part(half, ("R", "G", "B"), ("float",) * 3, color, plan.settings.compression)
                )
        sizes = exr.write_parts(path, parts)
        return {
            "render_seconds": {"truth": round(watch.seconds["truth"], 4)},
            "bytes": {"truth": sum(sizes.values())},
        }
