# SPDX-License-Identifier: GPL-3.0-or-later
"""What an export renders: the decisions that are made before its first picture."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from . import registry
from .scene.camera import Frame
from .scene.cuts import CameraCuts
from .scene.instances import ObjectIds
from .scene.lighting import LightPlan
from .scene.textures import TextureReading
from .settings import Settings


@dataclass
class Plan:
    """The decisions; ``passes_of`` holds the shot's passes of jittered frames and of those at the pixel centres."""

    scene: bpy.types.Scene
    settings: Settings
    view_layer: bpy.types.ViewLayer
    frame: Frame
    cuts: CameraCuts
    passes_of: dict[str, set[str]]
    static: bool
    own_geometry: str | None  # material whose nodes decide what depth, normals or ids are
    positions: list[tuple[float, float]]  # of the sub-samples, pixels from centre + jitter, y down
    light: LightPlan
    ids: ObjectIds
    textures: TextureReading
    folder: str  # of intermediate renders

    @property
    def passes(self) -> set[str]:
        """Passes of either kind of frame."""
        return self.passes_of["frames"] | self.passes_of["centre"]

    @property
    def has_subsamples(self) -> bool:
        """True when the shot holds sub-samples."""
        return registry.reads_subsamples(self.passes)
