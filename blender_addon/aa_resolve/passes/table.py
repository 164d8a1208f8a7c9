# SPDX-License-Identifier: GPL-3.0-or-later
"""Every pass that the exporter makes, and the walk over them that makes the parts of a frame's file."""

from __future__ import annotations

from typing import Iterable

from .. import exr
from .albedo import Albedo
from .base import Pass
from .color import Color
from .edges import Edges
from .exposure import Exposure
from .geometry import Depth, Normal, ObjectId
from .motion import Motion
from .segments import Segments
from .subsamples import SubsampleColor, Subsamples

# In the order in which they are made and stand in the file: the sub-samples, which render the scene anew, come last.
TABLE: tuple[Pass, ...] = (
    Color(),
    Albedo(),
    Depth(),
    Normal(),
    ObjectId(),
    Motion(),
    Edges(),
    Segments(),
    Subsamples(),
    SubsampleColor(),
)


# The parts of a file in their order.
PARTS: tuple[str, ...] = tuple(dict.fromkeys(item.facts.part for item in TABLE))


def passes_named(names: Iterable[str], with_color: bool = True) -> list[Pass]:
    """The passes of these names, in the order of the table, and colour, which every picture has."""
    wanted = {*names, *([Color.name] if with_color else [])}
    return [item for item in TABLE if item.name in wanted]


def parts_of(exposure: Exposure) -> list[exr.Part]:
    """Makes the wanted passes one after the other; those that share a part are put together there."""
    settings = exposure.plan.settings
    parts: dict[str, dict[str, tuple]] = {}
    for item in exposure.wanted:
        channels = parts.setdefault(item.facts.part, {})
        for channel, plane in item.planes(exposure).items():
            channels[channel] = item.kind_of(channel, settings.color_type), plane
    made = []
    for name, channels in parts.items():
        kinds, planes = zip(*channels.values())
        made.append(exr.Part(name, tuple(channels), kinds, list(planes), settings.compression))
    return made
