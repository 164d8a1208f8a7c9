# SPDX-License-Identifier: GPL-3.0-or-later
"""A window of its own for a picture, which is fitted into it."""

from __future__ import annotations

import bpy

# A new window gets its final size, and what is drawn in it the right place, only after it was drawn a first time.
_FIT_SECONDS = (0.1, 0.4, 0.5, 1.0)


def show(path: str) -> None:
    """Loads a picture and shows it, in the window that shows it already or in a new one.

    Without a window (``blender -b``) it is loaded only."""
    image = bpy.data.images.load(path, check_existing=True)
    image.reload()
    if bpy.app.background:
        return
    area = _area_with(image) or _new_area()
    area.spaces.active.image = image
    pauses = iter(_FIT_SECONDS[1:])
    sizes: set[tuple[int, int]] = set()

    def fit() -> float | None:
        _fit(image, sizes)
        return next(pauses, None)

    bpy.app.timers.register(fit, first_interval=_FIT_SECONDS[0])


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


def _fit(image: bpy.types.Image, sizes: set[tuple[int, int]]) -> None:
    """Fits the picture where it is shown, again when that place has got another size (``sizes``: those it had)."""
    for window in _windows():
        for area in window.screen.areas:
            if area.type != "IMAGE_EDITOR" or area.spaces.active.image != image:
                continue
            region = next(item for item in area.regions if item.type == "WINDOW")
            size = region.width, region.height
            if size not in sizes and min(size) > 1:
                sizes.add(size)
                with bpy.context.temp_override(window=window, area=area, region=region):
                    bpy.ops.image.view_all(fit_view=True)
            area.tag_redraw()
