# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender that shows one picture and nothing else.

    blender --factory-startup -P picture_window.py -- PICTURE

Whoever starts it holds its standard input: each byte there says that the file has changed, its end that all is over.
"""

from __future__ import annotations

import os
import sys
import threading

import bpy

_LOOK_SECONDS = 0.2


def main(path: str) -> None:
    """Fills the window with the picture."""
    view = bpy.context.preferences.view
    view.show_splash, view.use_save_prompt = False, False
    changed = threading.Event()
    threading.Thread(target=_listen, args=(changed,), daemon=True).start()
    image = bpy.data.images.load(path)
    sizes: set[tuple[int, int]] = set()

    def begin() -> None:
        _fill(image)
        bpy.app.timers.register(go_on)

    def go_on() -> float:
        if changed.is_set():
            changed.clear()
            image.reload()
            sizes.clear()
        _fit(image, sizes)
        return _LOOK_SECONDS

    bpy.app.timers.register(begin)  # while the script runs there is no window yet


def _listen(changed: threading.Event) -> None:
    while os.read(0, 1):
        changed.set()
    os._exit(0)


def _fill(image: bpy.types.Image) -> None:
    window = next(iter(bpy.context.window_manager.windows))
    area = max(window.screen.areas, key=lambda item: item.width * item.height)
    area.type = "IMAGE_EDITOR"
    area.spaces.active.image = image
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.screen.screen_full_area(use_hide_panels=True)


def _fit(image: bpy.types.Image, sizes: set[tuple[int, int]]) -> None:
    """Fits the picture into the window when that has a size that is not in ``sizes``, and notes it there."""
    for window in bpy.context.window_manager.windows:
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


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1])
