# SPDX-License-Identifier: GPL-3.0-or-later
"""The export itself: analyse the scene, render what the plan asks for, write the shot.

Works on the open scene in memory and never saves it; whoever calls it owns a Blender process for that purpose.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass

import bpy
import numpy as np

from . import analysis
from . import camera as cam
from . import edges, exr, instances, jitter, lighting, rendering, subsamples
from .errors import SceneError
from .report import Reporter
from .settings import Settings
from .store import Store

FORMAT, FORMAT_VERSION = "aaresolve-shot", 1


@dataclass
class Summary:
    """What an export did."""

    rendered: int = 0
    skipped: int = 0
    elsewhere: int = 0


class Exporter:
    """One scene, one shot."""

    def __init__(
        self, scene: bpy.types.Scene, settings: Settings, reporter: Reporter, version: str
    ) -> None:
        self.scene, self.settings, self.reporter = scene, settings, reporter
        self.version = version
        self.folder = lighting.temporary_folder()
        self._cameras: dict[str, cam.JitterCamera] = {}
        self._view_sets: dict[str, subsamples.ViewSet] = {}
        self._states: dict[int, analysis.FrameState] = {}
        self._static_samples: dict[tuple[bool, bool], list[rendering.Layers]] = {}
        self._seconds: dict[str, list[float]] = {"frames": [], "centre": [], "truth": []}

    # --- before the first render ---------------------------------------------------------------------------------

    def prepare(self) -> None:
        """Checks the scene, brings it to the light model and decides what each frame needs."""
        scene, settings = self.scene, self.settings
        self.view_layer, notes = analysis.refuse_unsuitable(scene, settings.view_layer)
        if settings.resolution:
            scene.render.resolution_x, scene.render.resolution_y = settings.resolution
            scene.render.resolution_percentage = 100
        self.frame = cam.frame_of(scene)
        self.cuts = cam.CameraCuts(scene)
        self.cuts.at(settings.frames[0])
        analysis.show_what_renders(scene)
        # What each kind of picture holds: jittered frames, and the same instants at the pixel centres.
        self.passes_of = {"frames": set(settings.passes), "centre": set(settings.centre_passes)}
        self.passes = set(settings.passes) | set(settings.centre_passes)
        motion = analysis.find_motion(scene, settings.frames, self.frame, self.cuts)
        self.static = motion.static
        left_out = []
        if self.static:
            self.passes.discard("motion")
            self.passes_of["frames"].discard("motion")
            left_out.append(
                f"motion ({motion.reason}: the shot is static, one truth serves all frames)"
            )
        self.cutout = analysis.has_cutouts()
        self.wants_samples = bool(self.passes & {"subsamples", "subsampleColor"})
        if self.wants_samples:
            self.positions = jitter.pattern_positions(settings.pattern)
            if subsamples.uses_override("subsampleColor" in self.passes, self.cutout):
                left_out.append(
                    "shading of sub-samples (override material: no cut-outs, no displacement)"
                )
            elif "subsampleColor" not in self.passes:
                notes.append(
                    f"sub-samples use the real materials: '{self.cutout}' has cut-outs or displacement"
                )
        if left_out:
            notes.append("left out: " + "; ".join(left_out))
        notes += analysis.semi_transparent_note()
        scene.frame_set(settings.frames[0])
        rendering.prepare(scene, self.view_layer)
        self.light = lighting.set_up(scene, settings.lighting, settings.ambient, self.folder)
        lighting.check_visibility_animation(self.light)
        notes += self.light.notes
        self.ids = instances.ObjectIds(scene, self.view_layer, settings.instance_ids)
        notes += self.ids.notes
        for note in notes:
            self.reporter.say("note", f"note: {note}", note=note)
        known = sorted(self.passes)
        self.reporter.say("plan", f"passes: {', '.join(known)}", passes=known, static=self.static)

    def _passes_of_main(self) -> set[str]:
        needed = set(self.light.passes)
        if self.passes & {"depth", "motion", "albedo", "subsamples", "edges"}:
            needed.add("Depth")
        if self.passes & {"normal", "subsamples"}:
            needed.add("Normal")
        if self.passes & {"object", "subsamples", "edges"}:
            needed.add("IndexOB")
        if "motion" in self.passes:
            needed |= {"Vector", "IndexOB"}
        if "albedo" in self.passes:
            needed |= rendering.ALBEDO_PASSES
        return needed

    def _head(self) -> dict:
        """Members of shot.json that all frames share."""
        settings = self.settings
        head = {
            "format": FORMAT,
            "version": FORMAT_VERSION,
            "name": settings.name,
            "resolution": [self.frame.width, self.frame.height],
            "fps": self.scene.render.fps / self.scene.render.fps_base,
            "jitter": {
                "sequence": settings.jitter,
                "start": 0 if settings.jitter in ("none", "halton23zero", "thesis") else 1,
                "period": settings.period,
                "centred": settings.jitter_centred,
            },
            "static": self.static,
        }
        if self.wants_samples:
            head["subsamples"] = {
                "pattern": settings.pattern,
                "positions": [list(p) for p in self.positions],
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
            "ambient": list(self.light.ambient),
        }
        if self.frame.is_cropped:
            head["window"] = {
                "full_resolution": [self.frame.full_width, self.frame.full_height],
                "offset": [self.frame.left, self.frame.top],
            }
        head["methods"] = settings.methods
        head["producer"] = {
            "name": "aa_resolve",
            "version": self.version,
            "blender": bpy.app.version_string,
        }
        return head

    # --- the loop ------------------------------------------------------------------------------------------------

    def run(self, store: Store) -> Summary:
        """Renders everything that is not finished and not claimed by another process."""
        settings = self.settings
        head = self._head()
        truth_frames = self._truth_frames()
        work = []
        for number in settings.frames:
            work.append(("frames", number))
            if self.passes_of["centre"] and (not self.static or number == settings.frames[0]):
                work.append(("centre", number))
            if number in truth_frames:
                work.append(("truth", number))
        summary = Summary()
        for position, (kind, number) in enumerate(work):
            if not store.claim(kind, number):
                if store.record(kind, number) is None:
                    summary.elsewhere += 1
                else:
                    summary.skipped += 1
                continue
            started = time.perf_counter()
            try:
                path = os.path.join(store.folder, store.picture(kind, number))
                record = (
                    self._export_truth(number, path)
                    if kind == "truth"
                    else self._export_frame(kind, number, path)
                )
            except BaseException:
                store.release(kind, number)
                raise
            store.finish(kind, number, record, head, settings.frames)
            self._seconds[kind].append(time.perf_counter() - started)
            summary.rendered += 1
            self._report(kind, number, record, os.path.getsize(path), work[position + 1 :])
        with store.locked():
            store.write_manifest(head, settings.frames)
        return summary

    def seconds_of(self, kind: str) -> float:
        """Seconds of the last picture of a kind (``frames``, ``centre``, ``truth``); 0 where there was none."""
        return self._seconds[kind][-1] if self._seconds[kind] else 0.0

    def _truth_frames(self) -> set[int]:
        settings = self.settings
        if settings.truth_frames == "none":
            return set()
        if self.static:
            return {settings.frames[0]}
        return (
            set(settings.frames) if settings.truth_frames == "all" else set(settings.truth_frames)
        )

    def _report(
        self, kind: str, number: int, record: dict, size: int, rest: list[tuple[str, int]]
    ) -> None:
        seconds = self._seconds[kind][-1]
        typical = {
            name: sorted(values)[len(values) // 2] if values else seconds
            for name, values in self._seconds.items()
        }
        left = sum(typical[name] for name, _ in rest)
        label = {"frames": "frame"}.get(kind, kind)
        parts = ", ".join(
            f"{name} {value:.2f} s" for name, value in record["render_seconds"].items()
        )
        self.reporter.say(
            label,
            f"{label} {number}: {seconds:.2f} s ({parts}), {size / 1e6:.2f} MB, {left:.0f} s left",
            frame=number,
            seconds=round(seconds, 3),
            bytes=size,
            left_seconds=round(left, 1),
            remaining=len(rest),
        )

    # --- one frame -----------------------------------------------------------------------------------------------

    def _state(self, number: int) -> analysis.FrameState:
        """State of a frame; evaluates it unless it is known."""
        if number not in self._states:
            state = analysis.frame_state(
                self.scene, number, self.frame, self.cuts, "motion" in self.passes_of["frames"]
            )
            self._states = {key: value for key, value in self._states.items() if key == number - 1}
            self._states[number] = state
        return self._states[number]

    def _go_to(self, number: int) -> None:
        shown = self.settings.frames[0] if self.static else number
        if self.scene.frame_current != shown or self.scene.frame_subframe != 0.0:
            self.scene.frame_set(shown)

    def _camera(self, number: int) -> cam.JitterCamera:
        source = self.cuts.at(number)
        if source.name_full not in self._cameras:
            self._cameras[source.name_full] = cam.JitterCamera(
                self.scene, source, "AA Resolve Camera"
            )
        return self._cameras[source.name_full]

    def _aim(self, number: int, offset: tuple[float, float]) -> None:
        camera = self._camera(number)
        self.scene.camera = camera.object
        bpy.context.view_layer.update()
        camera.aim(self.frame, bpy.context.evaluated_depsgraph_get(), *offset)

    def _render_lights(self, first_passes: set[str]) -> list[rendering.Layers]:
        """The frame as the light model wants it: one render, or one per light."""
        rendering.request_passes(self.view_layer, first_passes)
        if len(self.light.lights) < 2:
            return [rendering.render(self.scene, self.view_layer, self.folder)]
        renders = []
        for index, light in enumerate(self.light.lights):
            if index == 1:
                rendering.request_passes(self.view_layer, {"Combined", "Emit", "Env"})
            with lighting.only_light(self.light, light):
                renders.append(rendering.render(self.scene, self.view_layer, self.folder))
        return renders

    def _export_frame(self, kind_of_frame: str, number: int, path: str) -> dict:
        """A jittered frame ("frames"), or the same instant at the pixel centres ("centre")."""
        settings = self.settings
        self.passes = self.passes_of[kind_of_frame]
        self.wants_samples = bool(self.passes & {"subsamples", "subsampleColor"})
        position = settings.frames.index(number)
        offset = (0.0, 0.0)
        if kind_of_frame == "frames":
            offset = jitter.jitter_at(
                settings.jitter,
                number - settings.frames[0],
                settings.period,
                settings.jitter_centred,
            )
        before = None
        if not self.static:
            before = self._state(number - 1)
        now = self._state(settings.frames[0] if self.static else number)
        self._go_to(number)
        self._aim(number, offset)
        rendering.sample_points(self.scene, settings.samples)
        renders = self._render_lights(self._passes_of_main())
        seconds = {"color": sum(layers.seconds for layers in renders)}
        main = renders[0]
        color = lighting.compose(self.light, renders)
        kind = settings.color_type
        parts = [self._part("color", "RGBA", kind, color)]
        entry = {
            "frame": number,
            "file": f"{kind_of_frame}/{number:06d}.exr",
            "reset": self._is_reset(position, now, before),
            "jitter": [float(offset[0]), float(offset[1])],
            "camera": now.camera.as_manifest(),
        }
        wrong = int((~np.isfinite(color)).any(axis=-1).sum())
        if wrong:
            entry["nonfinite_pixels"] = wrong
        if "albedo" in self.passes:
            parts.append(
                self._part(
                    "albedo",
                    ("albedo.R", "albedo.G", "albedo.B"),
                    kind,
                    rendering.unlit_albedo(main),
                )
            )
        depth = main.get("Depth")[:, :, 0] if ("Depth", "") in main.passes else None
        if "depth" in self.passes:
            parts.append(self._part("depth", ("Z",), "float", depth[:, :, None]))
        if "normal" in self.passes:
            parts.append(self._part("normal", ("N.X", "N.Y", "N.Z"), "float", main.get("Normal")))
        ids = None
        if self.passes & {"object", "motion", "subsamples", "edges"}:
            self.ids.look(bpy.context.evaluated_depsgraph_get())
            ids = self.ids.resolve(main)
        if "object" in self.passes:
            parts.append(self._part("object", ("id",), "uint", ids[:, :, None]))
        if "motion" in self.passes:
            motion = cam.motion_from_vector(
                main.get("Vector"), depth, self.frame, offset, now.camera, before.camera
            )
            invalid = self._mark_invalid_motion(motion, main, now, before)
            if invalid:
                entry["motion_invalid"] = invalid
            parts.append(self._part("motion", ("motion.X", "motion.Y"), "float", motion))
        if "edges" in self.passes:
            started = time.perf_counter()
            finder = edges.EdgeFinder(self.frame, now.camera)
            depsgraph = bpy.context.evaluated_depsgraph_get()
            edges.collect(finder, depsgraph, self.ids.identify, set(np.unique(ids).tolist()))
            distances, missing = finder.measure(ids, depth, offset)
            if missing:
                entry["pixels_without_edges"] = missing
            parts.append(self._part("edges", ("edge.X", "edge.Y"), "float", distances))
            seconds["edges"] = time.perf_counter() - started
        if self.wants_samples:
            part, spent = self._subsample_part(number, offset, now.camera, main, ids, depth)
            parts.append(part)
            seconds["subsamples"] = spent
        started = time.perf_counter()
        sizes = exr.write_parts(path, parts)
        seconds["write"] = time.perf_counter() - started
        entry["render_seconds"] = {name: round(value, 4) for name, value in seconds.items()}
        entry["bytes"] = sizes
        return {
            "entry": entry,
            "objects": self.ids.names(ids) if ids is not None else {},
            "render_seconds": entry["render_seconds"],
        }

    def _part(self, name: str, channels, kind: str, pixels: np.ndarray) -> exr.Part:
        if kind == "half" and np.abs(pixels[np.isfinite(pixels)]).max(initial=0.0) > 65504.0:
            raise SceneError(
                f"part '{name}' holds values above 65504, too large for half: use --color-type float"
            )
        kinds = (kind,) * len(tuple(channels))
        pixels = pixels.astype(np.uint32) if kind == "uint" else pixels.astype(np.float32)
        return exr.Part(name, tuple(channels), kinds, pixels, self.settings.compression)

    def _is_reset(
        self, position: int, now: analysis.FrameState, before: analysis.FrameState | None
    ) -> bool:
        """True where no history belongs to the frame: at the start, after a gap and after a cut."""
        frames = self.settings.frames
        if position == 0 or frames[position] != frames[position - 1] + 1:
            return True
        if before is None:
            return False
        return now.camera_name != before.camera_name or cam.cut_between(now.camera, before.camera)

    def _mark_invalid_motion(
        self,
        motion: np.ndarray,
        main: rendering.Layers,
        now: analysis.FrameState,
        before: analysis.FrameState,
    ) -> dict | None:
        """Where Cycles' vector is known to be wrong the motion points far out of the picture instead.

        Objects that were hidden in the previous frame, and meshes whose number of vertices changed.
        """
        names = {name for name in before.hidden if name not in now.hidden}
        names |= {
            name
            for name, count in now.vertices.items()
            if before.vertices.get(name, count) != count
        }
        if not names:
            return None
        indices = [index for index, name in self.ids.table.items() if name in names]
        pixels = np.isin(np.rint(main.get("IndexOB")[:, :, 0]).astype(np.int64), indices)
        if not pixels.any():
            return None
        motion[pixels] = cam.NO_PREVIOUS_POSITION_PX
        return {
            "objects": sorted(names),
            "pixels": int(pixels.sum()),
            "value": cam.NO_PREVIOUS_POSITION_PX,
        }

    def _views(self, number: int) -> subsamples.ViewSet:
        source = self.cuts.at(number)
        if source.name_full not in self._view_sets:
            self._view_sets[source.name_full] = subsamples.ViewSet(
                self.scene, source, self.positions
            )
        return self._view_sets[source.name_full]

    def _render_samples(
        self, views: subsamples.ViewSet, wants_color: bool, wants_geometry: bool
    ) -> list[rendering.Layers]:
        """All sub-samples of the current frame: one render, or one per light where they are shaded."""
        bpy.context.view_layer.update()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        geometry = {"Depth", "Normal", "IndexOB"} if wants_geometry else set()
        if not wants_color:
            rendering.request_passes(self.view_layer, geometry)
            own_override = self.view_layer.material_override
            with subsamples.no_lights(self.light, self.scene):
                if subsamples.uses_override(wants_color, self.cutout):
                    self.view_layer.material_override = self.ids.override()
                try:
                    return [views.render(self.view_layer, self.frame, depsgraph, self.folder)]
                finally:
                    self.view_layer.material_override = own_override
        renders = []
        for index, light in enumerate(self.light.lights if len(self.light.lights) > 1 else [None]):
            rendering.request_passes(
                self.view_layer, self.light.passes | (geometry if index == 0 else set())
            )
            if light is None:
                renders.append(views.render(self.view_layer, self.frame, depsgraph, self.folder))
            else:
                with lighting.only_light(self.light, light):
                    renders.append(
                        views.render(self.view_layer, self.frame, depsgraph, self.folder)
                    )
        return renders

    def _subsample_part(
        self,
        number: int,
        offset: tuple[float, float],
        camera: cam.CameraState,
        main: rendering.Layers,
        ids: np.ndarray,
        depth: np.ndarray,
    ) -> tuple[exr.Part, float]:
        """Part ``subsamples``: geometry, mask and colour as the plan asks for, and the seconds it took."""
        wants_color = "subsampleColor" in self.passes
        wants_geometry = "subsamples" in self.passes
        views = self._views(number)
        renders = self._static_samples.get((wants_color, wants_geometry))
        seconds = 0.0
        if renders is None:
            renders = self._render_samples(views, wants_color, wants_geometry)
            seconds = sum(layers.seconds for layers in renders)
            if self.static:
                # Sub-samples are not jittered: they serve all frames.
                self._static_samples[wants_color, wants_geometry] = renders
        names: list[str] = []
        kinds: list[str] = []
        planes: list[np.ndarray] = []
        if wants_geometry:
            samples = [
                {
                    "depth": renders[0].get("Depth", view)[:, :, 0],
                    "normal": renders[0].get("Normal", view),
                    "id": self.ids.resolve(renders[0], view),
                }
                for view in views.names
            ]
            centre = {"depth": depth, "normal": main.get("Normal"), "id": ids}
            mask = subsamples.surface_mask(
                centre, samples, self.frame, camera, offset, self.positions
            )
            names.append("mask")
            kinds.append("uint")
            planes.append(mask)
        for index, view in enumerate(views.names):
            if wants_geometry:
                sample = samples[index]
                names += [f"{view}.Z", f"{view}.N.X", f"{view}.N.Y", f"{view}.N.Z", f"{view}.id"]
                kinds += ["float", "float", "float", "float", "uint"]
                planes += [sample["depth"], *np.moveaxis(sample["normal"], -1, 0), sample["id"]]
            if wants_color:
                color = lighting.compose(self.light, renders, view)
                names += [f"{view}.R", f"{view}.G", f"{view}.B"]
                kinds += [self.settings.color_type] * 3
                planes += list(np.moveaxis(color[:, :, :3], -1, 0))
        part = exr.Part("subsamples", tuple(names), tuple(kinds), planes, self.settings.compression)
        return part, seconds

    def _export_truth(self, number: int, path: str) -> dict:
        self._go_to(number)
        self._aim(number, (0.0, 0.0))
        parts = []
        seconds = 0.0
        for half, seed in (("a", 1), ("b", 2)):
            rendering.sample_pixel_area(self.scene, self.settings.truth_samples, seed)
            rendering.request_passes(self.view_layer, self.light.passes)
            layers = rendering.render(self.scene, self.view_layer, self.folder)
            seconds += layers.seconds
            color = lighting.compose(self.light, [layers])[:, :, :3]
            parts.append(
                exr.Part(half, ("R", "G", "B"), ("float",) * 3, color, self.settings.compression)
            )
        sizes = exr.write_parts(path, parts)
        return {
            "render_seconds": {"truth": round(seconds, 4)},
            "bytes": {"truth": sum(sizes.values())},
        }
