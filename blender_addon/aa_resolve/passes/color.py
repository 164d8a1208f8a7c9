# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene-referred colour (pass ``color``): the light model's sum, with the alpha that Cycles gives it."""

from __future__ import annotations

import numpy as np

from ..errors import SceneError
from .base import Pass
from .exposure import Exposure

_LARGEST_HALF = 65504.0


class Color(Pass):
    """Every frame has it: its render is the one that the other passes come from."""

    name = "color"
    shaded = True
    in_color_type = True

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        """A stands beside the table's channels; no method reads it."""
        return color_planes(self, exposure, "RGBA", exposure.color)


def color_planes(
    item: Pass, exposure: Exposure, channels: str | tuple[str, ...], pixels: np.ndarray
) -> dict[str, np.ndarray]:
    """H x W x C pixels by channel. Raises SceneError where they do not fit into halves that were asked for."""
    finite = pixels[np.isfinite(pixels)]
    half = exposure.plan.settings.color_type == "half"
    if half and np.abs(finite).max(initial=0.0) > _LARGEST_HALF:
        raise SceneError(
            f"part '{item.facts.part}' holds values above 65504, too large for half: use --color-type float"
        )
    return dict(zip(channels, np.moveaxis(pixels, -1, 0)))
