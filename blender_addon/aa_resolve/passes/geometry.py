# SPDX-License-Identifier: GPL-3.0-or-later
"""What the samples of a frame hit: passes ``depth``, ``normal`` and ``object``, by-products of the main render."""

from __future__ import annotations

import bpy
import numpy as np

from .base import Pass
from .exposure import Exposure


class Depth(Pass):
    """Planar view-space depth, scene units; background 1e10."""

    name = "depth"
    cycles = frozenset({"Depth"})

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        return dict(zip(self.facts.channels, (exposure.depth,)))


class Normal(Pass):
    """World-space unit normal, towards the camera; 0 on the background."""

    name = "normal"
    cycles = frozenset({"Normal"})

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        return dict(zip(self.facts.channels, np.moveaxis(exposure.main.get("Normal"), -1, 0)))


class ObjectId(Pass):
    """Id of the object or instance (scene/instances.py); 0 on the background."""

    name = "object"
    cycles = frozenset({"IndexOB"})

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        return dict(zip(self.facts.channels, (ids_of(exposure),)))


def ids_of(exposure: Exposure) -> np.ndarray:
    """Ids (H x W uint32) of a frame's own samples, found when a pass first asks."""
    if exposure.ids is None:
        with exposure.watch.of(ObjectId.name):
            exposure.plan.ids.look(bpy.context.evaluated_depsgraph_get())
            exposure.ids = exposure.plan.ids.resolve(exposure.main)
    return exposure.ids


def shown_by(exposure: Exposure) -> set[int]:
    """Ids that at least one sample of the frame shows."""
    return set(np.unique(ids_of(exposure)).tolist())
