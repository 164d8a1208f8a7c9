# SPDX-License-Identifier: GPL-3.0-or-later
"""A window of its own for a picture, which is fitted into it."""

from __future__ import annotations

import bpy

_FIT_SECONDS = 0.1  # a new window has no size before it was drawn
_TRIES = 20


def show(path: str) -> None:
    """Loads a picture and shows it, in the window that shows it already or in a new one.

    Without a window (``blender -b``) it is loaded only."""
    image = bpy.data.images.load(path, check_existing=True)
    image.reload()
    if bpy.app.background:
        return
    area = _area_with(image) or _new_area()
    area.spaces.active.image = image
    tries = iter(range(_TRIES))

    def fit() -> float | None:
        if next(tries, None) is None or _fitted(image):
            return None
        return _FIT_SECONDS

    bpy.app.timers.register(fit, first_interval=_FIT_SECONDS)


def _windows() -> list[bpy.types.Window]:
    return list(bpy.context.window_manager.windows)


def _area_with(image: bpy.types.Image) -> bpy.types.Area | None:
    for window in _windows():
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR" and area.spaces.active.image == image:
                return area
    return None


def _new_area() -> bpy.types.Area:
    """An image editor alone in a new window."""
    before = set(_windows())
    with bpy.context.temp_override(window=next(iter(_windows()))):
        bpy.ops.wm.window_new()
    window = next(item for item in _windows() if item not in before)
    area = max(window.screen.areas, key=lambda item: item.width * item.height)
    area.type = "IMAGE_EDITOR"
    return area


def _fitted(image: bpy.types.Image) -> bool:
    """Fits the picture where it is shown; False while the place for it has no size yet."""
    for window in _windows():
        for area in window.screen.areas:
            if area.type != "IMAGE_EDITOR" or area.spaces.active.image != image:
                continue
            region = next((item for item in area.regions if item.type == "WINDOW"), None)
            if region is None or region.width < 2 or not image.has_data and not image.size[0]:
                return False
            with bpy.context.temp_override(window=window, area=area, region=region):
                bpy.ops.image.view_all(fit_view=True)
            area.tag_redraw()
            return True
    return True
