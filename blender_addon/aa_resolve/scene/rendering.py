# SPDX-License-Identifier: GPL-3.0-or-later
"""One Cycles render into a temporary multilayer EXR, read back as arrays.

This is the robust way in background mode: neither the Render Result nor a Viewer node holds pixels there, and a
File Output node drops the fourth component of the motion vectors.
"""

from __future__ import annotations

import os
from collections.abc import Collection
from dataclasses import dataclass

import bpy
import numpy as np

from .. import compat, exr
from ..errors import Cancelled, SceneError
from .ownership import own, own_if_present


@dataclass
class Layers:
    """Passes of one render: ``get("Depth")`` is H x W x 1, ``get("Combined", "k03")`` that of a view."""

    planes: dict[
        tuple[str, str], list[np.ndarray]
    ]  # by pass and view, components in order; views of the file

    def __post_init__(self) -> None:
        self._stacked: dict[tuple[str, str], np.ndarray] = {}

    def has(self, name: str) -> bool:
        """True when the pass was rendered (without views)."""
        return any((candidate, "") in self.planes for candidate in compat.PASS_NAMES[name])

    def get(self, name: str, view: str = "") -> np.ndarray:
        """The pass as H x W x C float32 under this package's own name."""
        for candidate in compat.PASS_NAMES.get(name, (name,)):
            key = candidate, view
            if key in self.planes:
                if key not in self._stacked:
                    self._stacked[key] = _stacked(self.planes[key])
                return self._stacked[key]
        found = ", ".join(sorted({key[0] for key in self.planes}))
        raise SceneError(
            f"Cycles delivered no pass '{name}' (found: {found}); is this Blender version supported?"
        )


def _stacked(planes: list[np.ndarray]) -> np.ndarray:
    """H x W planes as H x W x C float32; a view where they lie at equal distances, as in a file without compression:
    copies of a render's many passes would cost as much as reading them."""
    first = planes[0]
    starts = [plane.__array_interface__["data"][0] for plane in planes]
    distances = {after - before for before, after in zip(starts, starts[1:])} or {0}
    if len(distances) == 1 and all(
        plane.dtype == np.float32 and plane.strides == first.strides and plane.base is first.base
        for plane in planes
    ):
        return np.lib.stride_tricks.as_strided(
            first, (*first.shape, len(planes)), (*first.strides, distances.pop())
        )
    return np.stack(planes, axis=-1).astype(np.float32, copy=False)


_ORDER = {"R": 0, "G": 1, "B": 2, "A": 3, "X": 0, "Y": 1, "Z": 2, "W": 3, "V": 0}


def _group(
    channels: dict[str, np.ndarray], layer: str, views: tuple[str, ...]
) -> dict[tuple[str, str], list[np.ndarray]]:
    """Gathers ``Layer.Pass[.view].C`` channels to passes."""
    groups: dict[tuple[str, str], dict[str, np.ndarray]] = {}
    for name, pixels in channels.items():
        if not name.startswith(layer + "."):
            continue
        stem, _, component = name[len(layer) + 1 :].rpartition(".")
        view = ""
        head, _, tail = stem.rpartition(".")
        if tail in views:
            stem, view = head, tail
        groups.setdefault((stem, view), {})[component] = pixels
    result = {}
    for key, components in groups.items():
        ordered = sorted(components, key=lambda component: _ORDER.get(component.upper(), 9))
        if key[0] == "Depth":
            ordered = ordered[:1]
        result[key] = [components[component] for component in ordered]
    return result


def render(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    folder: str,
    views: tuple[str, ...] = (),
) -> Layers:
    """Renders the scene's current frame with its current settings."""
    path = os.path.join(folder, "native.exr")
    scene.render.filepath = path
    cancelled: list[bool] = []

    def note_cancel(*_scene) -> None:
        cancelled.append(True)

    bpy.app.handlers.render_cancel.append(note_cancel)
    try:
        bpy.ops.render.render(write_still=True, scene=scene.name)
    except RuntimeError as error:
        raise SceneError(
            f"Cycles could not render frame {scene.frame_current}: {str(error).strip()}"
        ) from error
    finally:
        bpy.app.handlers.render_cancel.remove(note_cancel)
    if cancelled:  # the operator itself calls it finished
        raise Cancelled()
    if not os.path.exists(path):
        raise SceneError(
            f"Cycles wrote no picture for frame {scene.frame_current}; is the temporary folder full?"
        )
    channels = exr.read_channels(path)
    os.unlink(path)
    return Layers(_group(channels, view_layer.name, views))


def prepare(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> None:
    """Settings that every render of an export shares; nothing that changes the look of the scene."""
    render = scene.render
    own(render, engine="CYCLES")
    compat.set_multilayer_exr(render.image_settings)
    # Read back at once: packing would only cost time.
    own(render.image_settings, color_depth="32", exr_codec="NONE")
    own(
        render,
        use_file_extension=False,
        use_overwrite=True,
        use_placeholder=False,
        use_motion_blur=False,
        use_freestyle=False,
        use_stamp=False,
        use_multiview=False,
        use_persistent_data=True,
        use_crop_to_border=True,
        film_transparent=render.film_transparent,  # what the light model subtracts depends on it
    )
    compat.set_compositing(scene, False)
    for layer in scene.view_layers:
        own(layer, use=layer == view_layer)
    own(
        scene.cycles,
        use_adaptive_sampling=False,
        use_denoising=False,
        light_sampling_threshold=0.0,
        sample_clamp_direct=0.0,
        sample_clamp_indirect=0.0,
        use_animated_seed=False,
        time_limit=0.0,
        scrambling_distance=1.0,
        auto_scrambling_distance=False,
        sampling_pattern=compat.sampling_pattern(scene.cycles),
        use_guiding=False,  # it learns from what threads find first: no two renders would be equal
        direct_light_sampling_type="MULTIPLE_IMPORTANCE_SAMPLING",  # others miss lights without size
    )
    own_if_present(scene.cycles, use_pixel_jitter=False)
    own_if_present(render, use_texture_cache=False)  # since 5.2; it reads textures of less detail
    own(view_layer, samples=0, pass_alpha_threshold=0.5)


def request_passes(view_layer: bpy.types.ViewLayer, names: Collection[str]) -> None:
    """Switches on exactly these passes of Cycles (names of compat.PASS_NAMES)."""
    switches = {
        "Depth": "use_pass_z",
        "Normal": "use_pass_normal",
        "Vector": "use_pass_vector",
        "Position": "use_pass_position",
        "IndexOB": "use_pass_object_index",
        "DiffCol": "use_pass_diffuse_color",
        "GlossCol": "use_pass_glossy_color",
        "TransCol": "use_pass_transmission_color",
        "Emit": "use_pass_emit",
        "Env": "use_pass_environment",
    }
    wanted = {switches[name] for name in switches if name in names} | {"use_pass_combined"}
    own(view_layer, **{name: name in wanted for name in compat.pass_switches(view_layer)})
    own(view_layer, **{f"cycles.{name}": False for name in compat.pass_switches(view_layer.cycles)})
    own(view_layer, **{"cycles.denoising_store_passes": "Denoising Albedo" in names})


def sample_points(scene: bpy.types.Scene, samples: int) -> None:
    """All samples of a pixel at one point: the geometry stays aliased, shading noise is averaged.

    BOX would ignore the width; sample 0 lies at the exact centre with any filter."""
    own(
        scene.cycles,
        pixel_filter_type="BLACKMAN_HARRIS",
        filter_width=0.01,
        seed=0,
        **compat.samples_from(scene.cycles, 0, samples),
    )


def sample_pixel_area(scene: bpy.types.Scene, samples: int, seed: int) -> None:
    """Ground truth: samples spread evenly over the pixel's square."""
    # Cycles puts sample 0 of every pixel at the exact centre, in both halves alike; beginning later leaves it out.
    own(
        scene.cycles,
        pixel_filter_type="BOX",
        seed=seed,
        **compat.samples_from(scene.cycles, samples, samples),
    )


def own_samples(scene: bpy.types.Scene) -> None:
    """Sets once what is set anew for every picture, so that its animation is gone and told before the first."""
    sample_pixel_area(scene, 1, 0)
    sample_points(scene, 1)


def temporary_folder() -> str:
    """Folder for Cycles' intermediate pictures; it goes when Blender ends."""
    folder = os.path.join(bpy.app.tempdir, "aa_resolve")
    os.makedirs(folder, exist_ok=True)
    return folder
