# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel does in a window: Esc, another file while it works, drawing without reading, the window of a picture.

    BLENDER=/path/to/blender python3 tests/blenders/window.py FOLDER

Starts Xvfb and a Blender in it, which runs this file again with simulated keys; ends with 1 where a check fails.
"""

from __future__ import annotations

import builtins
import os
import sys
import time
import traceback

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import display  # noqa: E402

try:
    import bpy
except ImportError:  # not in Blender yet
    if len(sys.argv) != 2:
        raise SystemExit(__doc__) from None
    raise SystemExit(
        display.run(__file__, sys.argv[1], flags=("--enable-event-simulate",))
    ) from None

import numpy as np  # noqa: E402
import pixels  # noqa: E402

FOLDER = sys.argv[sys.argv.index("--") + 1]
PICTURE = os.path.join(FOLDER, "picture.png")
_PATIENCE_SECONDS = 60


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def area_of(kind: str) -> bpy.types.Area:
    return max(
        (area for area in window().screen.areas if area.type == kind),
        key=lambda area: area.width * area.height,
    )


def press(key: str, area: bpy.types.Area) -> None:
    """A key with the pointer in the middle of an area."""
    place = area.x + area.width // 2, area.y + area.height // 2
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=place[0], y=place[1])
        window().event_simulate(type=key, value=value, x=place[0], y=place[1])


def pause(seconds: float = 1.5):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        yield


def begin_export() -> None:
    with bpy.context.temp_override(window=window(), area=area_of("PROPERTIES")):
        bpy.ops.aa_resolve.export("INVOKE_DEFAULT")


def steps():
    """The checks; each ``yield`` gives Blender time."""
    from aa_resolve.panel import running, watch
    from aa_resolve.panel.running import State

    settings = bpy.context.scene.aa_resolve
    bpy.context.scene.cycles.device = "CPU"
    settings.out = os.path.join(FOLDER, "shot")
    settings.use_resolution, settings.resolution = True, (64, 36)
    settings.first, settings.last, settings.truth = 1, 5000, "NONE"
    settings.overwrite = True  # of another run of this script
    area = area_of("PROPERTIES")
    area.spaces.active.context = "RENDER"
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(FOLDER, "scene.blend"))
    assert not bpy.data.is_dirty
    yield from pause()

    begin_export()
    yield from pause(1.0)
    press("ESC", area_of("VIEW_3D"))
    yield from pause()
    assert State.running is not None, f"Esc over the 3D view is not ours: {State.result}"
    with bpy.context.temp_override(window=window()):
        bpy.ops.screen.animation_play()
    assert window().screen.is_animation_playing
    yield from pause(1.0)
    press("ESC", area_of("PROPERTIES"))
    yield from pause()
    assert State.running is not None, f"Esc during playback stops that only: {State.result}"
    assert not window().screen.is_animation_playing
    yield from pause()
    press("ESC", area_of("PROPERTIES"))
    end = time.monotonic() + _PATIENCE_SECONDS
    while State.running is not None and time.monotonic() < end:
        yield
    assert State.running is None and "Stopped" in State.result, State.result

    begin_export()
    yield from pause(1.0)
    job = State.running
    bpy.ops.wm.read_homefile(app_template="")
    yield from pause()
    assert State.running is job and job.poll(), "the work goes on with another file open"
    running.cancel()
    assert State.running is None

    bpy.ops.wm.open_mainfile(filepath=os.path.join(FOLDER, "scene.blend"))
    yield from pause()
    area = area_of("PROPERTIES")
    area.spaces.active.context = "RENDER"
    yield from pause(3.0)
    facts = watch.of(bpy.context.scene)
    assert facts.changes, "the panel was drawn and the scene looked at"
    read: list[str] = []
    kept = builtins.open, os.stat, os.path.exists

    def noting(function):
        def noted(path, *more, **named):
            read.append(str(path))
            return function(path, *more, **named)

        return noted

    watch._looked = 0.0  # nobody looks: the timer rests, the drawing alone is heard
    yield from pause(1.0)
    builtins.open, os.stat, os.path.exists = (noting(function) for function in kept)
    with bpy.context.temp_override(window=window()):
        area.tag_redraw()
        bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=3)
    builtins.open, os.stat, os.path.exists = kept
    assert not read, read

    yield from shows_pictures()


def shows_pictures():
    """In windows of which nothing is in the file."""
    from aa_resolve.panel import windows

    yield from shows((255, 0, 0))
    first = windows._shown[PICTURE]
    yield from shows((0, 255, 0))
    assert windows._shown[PICTURE] is first and first.poll() is None, "the same window again"
    assert len(bpy.context.window_manager.windows) == 1 and not bpy.data.is_dirty
    assert not any(image.filepath == PICTURE for image in bpy.data.images)
    windows.stop()
    assert first.poll() is not None
    yield from pause(0.5)
    assert share_of((0, 255, 0)) < 0.01, "the window is closed"


def shows(color: tuple[int, int, int]):
    """A picture of one colour is written, shown and waited for."""
    from aa_resolve.panel import windows

    pixels.write_png(PICTURE, np.full((90, 160, 3), color, np.uint8))
    windows.show(PICTURE)
    end = time.monotonic() + _PATIENCE_SECONDS
    while share_of(color) < 0.2 and time.monotonic() < end:
        yield
    assert share_of(color) > 0.2, color


def share_of(color: tuple[int, int, int]) -> float:
    """Of the display's pixels."""
    return float((pixels.screen(FOLDER) == color).all(-1).mean())


def main() -> None:
    display.begun(FOLDER)
    bpy.context.preferences.view.show_splash = False
    from aa_resolve.panel import panels

    panels.AA_RESOLVE_PT_main.bl_options = set()
    bpy.ops.preferences.addon_enable(module="aa_resolve")
    todo = steps()

    def go_on() -> float | None:
        try:
            next(todo)
            return 0.1
        except StopIteration:
            print("WINDOW OK", flush=True)
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(1)

    bpy.app.timers.register(go_on, first_interval=1.0, persistent=True)


main()
