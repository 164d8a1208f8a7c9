# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in layouts, which know labels of one line only."""

from __future__ import annotations

import textwrap

import bpy

_LETTER_PIXELS = 6.2  # mean width at a scale of 1


def letters(context, margin: int) -> int:
    """How many letters of mean width fit into a line of the region beside ``margin`` (pixels at a scale of 1)."""
    scale = context.preferences.system.ui_scale
    return int((context.region.width - margin * scale) / (_LETTER_PIXELS * scale))


def draw_text(layout: bpy.types.UILayout, context, text: str, icon: str = "NONE") -> None:
    """A sentence in as many lines as the width of the region asks for: a label would cut it off."""
    if not text:
        return
    column = layout.column(align=True)
    column.scale_y = 0.8
    wide = max(20, letters(context, 50 if icon == "NONE" else 70))
    for line in textwrap.wrap(text, wide):
        column.label(text=line, icon=icon)
        icon = icon if icon == "NONE" else "BLANK1"
