# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour without light (pass ``albedo``), from Cycles' colour passes; before 4.0 from its denoising albedo."""

from __future__ import annotations

import numpy as np

from .. import compat
from ..scene.camera import BACKGROUND_DEPTH
from ..scene.rendering import Layers
from .base import Pass
from .color import color_planes
from .exposure import Exposure


class Albedo(Pass):
    """Unlit colour, linear."""

    name = "albedo"
    cycles = frozenset({"Emit", "DiffCol", "GlossCol", "TransCol", "Env", "Depth"}) | (
        frozenset() if compat.colors_are_albedos() else frozenset({"Denoising Albedo"})
    )
    in_color_type = True

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        with exposure.watch.of(self.name):
            pixels = unlit_albedo(exposure.main)
            return color_planes(self, exposure, self.facts.channels, pixels)


def unlit_albedo(layers: Layers) -> np.ndarray:
    """Colour without light (H x W x 3).

    Since 4.0 the sum of the colour passes: what the surface reflects of uniform light, seen from the camera. That is the
    base colour of matt surfaces; of rough metal somewhat less, because the shader loses light between its facets.

    Before, that sum is no albedo (a Principled shader's glossy colour is white), and the denoising albedo less the
    emission that it contains serves; the sum only where that is empty although a surface was hit (mirrors, clear
    glass). In either case what only emits keeps its emission as its colour."""
    colours = layers.get("DiffCol") + layers.get("TransCol") + layers.get("GlossCol")
    nothing = np.zeros_like(colours)  # passes that are known to be 0 are not rendered
    emission = layers.get("Emit") if layers.has("Emit") else nothing
    sky = layers.get("Env") if layers.has("Env") else nothing
    background = layers.get("Depth")[:, :, :1] >= BACKGROUND_DEPTH
    if compat.colors_are_albedos():
        base = colours
    else:
        base = np.maximum(layers.get("Denoising Albedo") - emission, 0.0)
    reflects = base.max(axis=-1, keepdims=True) > 1.0e-5
    colour = np.where(reflects, base, emission)
    empty = ~background & (colour.max(axis=-1, keepdims=True) <= 0.0)
    colour = np.where(empty, np.minimum(colours, 1.0), colour)
    return np.where(background, sky, colour).astype(np.float32)
