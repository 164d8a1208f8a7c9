# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in layouts, which know labels of one line only."""

from __future__ import annotations

import functools

import blf
import bpy

_FONT = 0  # Blender's own, in which it draws its labels
_BORDER_PIXELS = 44  # of region, panel and box to both sides, at a scale of 1
_ICON_PIXELS = 22


def _points(context) -> float:
    """Size of the letters of labels, pixels."""
    return context.preferences.ui_styles[0].widget.points * context.preferences.system.ui_scale


def room(context, margin: int = _BORDER_PIXELS) -> float:
    """Pixels that a line of the region has beside ``margin`` (at a scale of 1)."""
    return context.region.width - margin * context.preferences.system.ui_scale


@functools.lru_cache(maxsize=4096)
def _width(text: str, points: float) -> float:
    blf.size(_FONT, points)
    return blf.dimensions(_FONT, text)[0]


def fits(context, text: str, margin: int) -> bool:
    """True when a label is not cut off."""
    return _width(text, _points(context)) <= room(context, margin)


def lines_of(text: str, width: float, points: float) -> list[str]:
    """The text in lines of at most ``width`` pixels; a single word may be longer."""
    lines = [""]
    for word in text.split(" "):
        longer = f"{lines[-1]} {word}" if lines[-1] else word
        if lines[-1] and _width(longer, points) > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def draw_text(layout: bpy.types.UILayout, context, text: str, icon: str = "NONE") -> None:
    """A sentence in as many lines as the width of the region asks for: a label would cut it off."""
    if not text:
        return
    column = layout.column(align=True)
    column.scale_y = 0.8
    margin = _BORDER_PIXELS + (_ICON_PIXELS if icon != "NONE" else 0)
    for line in lines_of(text, room(context, margin), _points(context)):
        column.label(text=line, icon=icon)
        icon = icon if icon == "NONE" else "BLANK1"
