# SPDX-License-Identifier: GPL-3.0-or-later
"""Base colour without light (pass ``albedo``), from Cycles' denoising albedo and its colour passes."""

from __future__ import annotations

import numpy as np

from ..scene.camera import BACKGROUND_DEPTH
from ..scene.rendering import Layers
from .base import Pass
from .color import color_planes
from .exposure import Exposure


class Albedo(Pass):
    """Unlit colour, linear."""

    name = "albedo"
    cycles = frozenset(
        {"Denoising Albedo", "Emit", "DiffCol", "GlossCol", "TransCol", "Env", "Depth"}
    )
    in_color_type = True

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        with exposure.watch.of(self.name):
            pixels = unlit_albedo(exposure.main)
            return color_planes(self, exposure, self.facts.channels, pixels)


def unlit_albedo(layers: Layers) -> np.ndarray:
    """Base colour without light (H x W x 3): the denoising albedo less the emission that it contains.

    The sum of the colour passes is no albedo (a Principled shader's glossy colour is white); it only serves where
    the denoising albedo is empty although a surface was hit (mirrors and clear glass). What only emits keeps its
    emission as its colour."""
    albedo = layers.get("Denoising Albedo")
    nothing = np.zeros_like(albedo)  # passes that are known to be 0 are not rendered
    emission = layers.get("Emit") if layers.has("Emit") else nothing
    sky = layers.get("Env") if layers.has("Env") else nothing
    background = layers.get("Depth")[:, :, :1] >= BACKGROUND_DEPTH
    base = np.maximum(albedo - emission, 0.0)
    reflects = base.max(axis=-1, keepdims=True) > 1.0e-5
    colour = np.where(reflects, base, emission)
    colours = layers.get("DiffCol") + layers.get("TransCol") + layers.get("GlossCol")
    empty = ~background & (colour.max(axis=-1, keepdims=True) <= 0.0)
    colour = np.where(empty, np.minimum(colours, 1.0), colour)
    return np.where(background, sky, colour).astype(np.float32)
