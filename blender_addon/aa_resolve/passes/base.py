# SPDX-License-Identifier: GPL-3.0-or-later
"""What every pass of a shot is to the exporter. Its name, part, channels and types stand in ``methods.json``."""

from __future__ import annotations

import numpy as np

from .. import registry
from .exposure import Exposure


class Pass:
    """One pass. To add one: a row in the resolver's table of passes, a class like this, its line in ``table.py``."""

    name: str  # in methods.json
    cycles: frozenset[
        str
    ] = frozenset()  # passes of Cycles (compat.PASS_NAMES) that it is made from
    shaded = False  # made of lit colour, in as many renders as the light model has
    in_color_type = False  # its channels have the type of --color-type instead of the table's
    from_frame_before = False  # compares two frames: nothing to say of a shot at rest
    from_meshes = False  # made from evaluated meshes, beside the picture that Cycles renders
    from_jitter = False  # measured from the jitter: needs samples that keep it exactly

    @property
    def facts(self) -> registry.PassFacts:
        """The pass as the resolver knows it."""
        return registry.load_passes()[self.name]

    def reads(self, _exposure: Exposure) -> frozenset[str]:
        """Passes of Cycles that the main render must hold for it."""
        return self.cycles

    def planes(self, exposure: Exposure) -> dict[str, np.ndarray]:
        """Its channels by their names in the file, each H x W."""
        raise NotImplementedError

    def kind_of(self, channel: str, color_type: str) -> str:
        """Type of a channel in the file: half, float or uint."""
        return color_type if self.in_color_type else self.facts.kind_of(channel)
