# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the add-on's panel as a user sees it, without a screen.

    BLENDER=/path/to/blender python3 tests/blenders/screenshots.py FOLDER [PROGRAM]

Starts Xvfb (a display in memory) and in it the Blender that BLENDER names (else `blender`), drawing in software, which
runs this file again. FOLDER gets one PNG per step: the panel as it opens, with parameters of a method unfolded, while a
job runs, and, where PROGRAM (aaresolve) is given, the window of the sheet and the results; the preview of the light, a
scene of EEVEE, and the preferences. Ends with 1 where a step fails.

The pictures come from the display's own memory: Blender's operator for screenshots gives black ones without a graphics
card since 4.0.
"""

from __future__ import annotations

import os
import sys
import time
import traceback

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import display  # noqa: E402

try:
    import bpy
except ImportError:  # not in Blender yet
    if not 2 <= len(sys.argv) <= 3:
        raise SystemExit(__doc__) from None
    raise SystemExit(display.run(__file__, *[*sys.argv[1:], ""][:2])) from None

from aa_resolve import panel  # noqa: E402
from aa_resolve.panel import running, windows  # noqa: E402
from pixels import screen, write_png  # noqa: E402

FOLDER, PROGRAM = sys.argv[sys.argv.index("--") + 1 :]


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def narrow_area() -> bpy.types.Area:
    """Where the properties editor goes: as wide as people have it, and higher than it is by default."""
    largest = max(window().screen.areas, key=lambda item: item.width * item.height)
    before = set(window().screen.areas)
    with bpy.context.temp_override(window=window(), area=largest):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.4)
    parts = {largest, *(set(window().screen.areas) - before)}
    return min(parts, key=lambda item: item.width)


def only_our_panels() -> None:
    """Blender's own panels of the Render tab would fill the picture."""
    for name in dir(bpy.types):
        kind = getattr(bpy.types, name)
        if getattr(kind, "bl_context", "") == "render" and "AA_RESOLVE" not in name:
            if getattr(kind, "bl_space_type", "") == "PROPERTIES":
                bpy.utils.unregister_class(kind)
    for kind in panel._CLASSES:
        if getattr(kind, "bl_options", None) == {"DEFAULT_CLOSED"}:
            closed = getattr(kind, "family", "temporal") != "temporal"
            kind.bl_options = {"DEFAULT_CLOSED"} if closed else set()


def picture(name: str, area: bpy.types.Area | None = None) -> None:
    """One PNG: of an area of the first window, or of all there is."""
    pixels = screen(FOLDER)
    if area is not None:
        top = display.HEIGHT - window().y - area.y - area.height
        left = window().x + area.x
        pixels = pixels[top : top + area.height, left : left + area.width]
    if pixels.max() == 0:
        raise RuntimeError(f"{name}: nothing was drawn")
    write_png(os.path.join(FOLDER, f"{name}.png"), pixels)


def settled():
    """A pause for the timers and for a redraw."""
    end = time.monotonic() + 2.5
    while time.monotonic() < end:
        running.redraw()
        yield


def shown():
    """Until the window of a picture, which is another process's, is drawn."""
    before = screen(FOLDER)
    end = time.monotonic() + 60.0
    while (screen(FOLDER) != before).mean() < 0.2 and time.monotonic() < end:
        yield
    yield from settled()


def finished():
    """Until the running job is over."""
    while running.State.running is not None:
        yield
    assert not running.State.failed, running.State.result
    yield from settled()


def steps():
    """The pictures, one after the other; each ``yield`` lets Blender draw."""
    scene = bpy.context.scene
    settings = scene.aa_resolve
    settings.out = "//shot"
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.render.resolution_x, scene.render.resolution_y = 320, 180
    cube = bpy.data.objects["Cube"]
    cube.rotation_euler = (0.3, 0.2, 0.1)
    for frame, place in ((1, -1.0), (8, 1.0)):
        cube.location.x = place
        cube.keyframe_insert("location", frame=frame)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(FOLDER, "scene.blend"))
    area = narrow_area()
    area.type = "PROPERTIES"
    yield from settled()
    area.spaces.active.context = "RENDER"
    yield from settled()
    picture("1_panel", area)
    with bpy.context.temp_override(window=window()):
        bpy.ops.aa_resolve.use_preset(kind="QUICK")
    settings.unfold_karis = settings.unfold_smaa1x = True
    settings.widgets_karis.set_alpha = 0.1
    settings.widgets_karis.set_box = "variance"
    settings.first, settings.last = 1, 4
    settings.truth_samples = 8
    bpy.context.window_manager.aa_resolve_search = "karis"
    yield from settled()
    picture("2_parameters", area)
    bpy.context.window_manager.aa_resolve_search = ""
    settings.unfold_karis = settings.unfold_smaa1x = False
    if PROGRAM:
        bpy.context.preferences.addons["aa_resolve"].preferences.resolver = PROGRAM
    with bpy.context.temp_override(window=window(), area=area):
        bpy.ops.aa_resolve.estimate("INVOKE_DEFAULT")
    yield from settled()
    picture("3_running", area)
    yield from finished()
    if PROGRAM:
        with bpy.context.temp_override(window=window(), area=area):
            bpy.ops.aa_resolve.compare("INVOKE_DEFAULT")
        yield from finished()
        yield from shown()
        picture("4_sheet")
        windows.stop()
        yield from settled()
        picture("5_results", area)
    with bpy.context.temp_override(window=window(), area=area):
        bpy.ops.aa_resolve.preview_light("INVOKE_DEFAULT")
    yield from finished()
    yield from shown()
    picture("6_light")
    windows.stop()
    try:
        scene.render.engine = "BLENDER_EEVEE"
    except TypeError:  # its name in 4.2 to 4.5
        scene.render.engine = "BLENDER_EEVEE_NEXT"
    settings.out = "//another"
    yield from settled()
    picture("7_eevee", area)
    with bpy.context.temp_override(window=window()):
        bpy.ops.aa_resolve.preferences()
    yield from settled()
    picture("8_preferences")


def main() -> None:
    os.makedirs(FOLDER, exist_ok=True)
    display.begun(FOLDER)
    bpy.context.preferences.view.show_splash = False
    only_our_panels()
    bpy.ops.preferences.addon_enable(module="aa_resolve")
    todo = steps()

    def go_on() -> float | None:
        try:
            next(todo)
            return 0.1
        except StopIteration:
            sys.stdout.flush()
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(1)

    bpy.app.timers.register(go_on, first_interval=1.0, persistent=True)


main()
