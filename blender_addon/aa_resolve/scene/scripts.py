# SPDX-License-Identifier: GPL-3.0-or-later
"""Python inside the .blend: drivers and texts that Blender does not run, and handlers that run at every frame."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import bpy

from . import ownership

_BLENDERS_OWN = ("cycles", "bl_", "rigify", __package__.partition(".")[0])


def notes_on_blocked() -> list[str]:
    """Sentences about drivers and texts that this Blender was not allowed to run: what they move rests."""
    if not bpy.app.autoexec_fail:
        return []
    blocked = sorted({f"{block.name}.{driver.data_path}" for block, driver in python_drivers()})
    texts = sorted(text.name for text in bpy.data.texts if text.use_module)
    told = []
    if blocked:
        told.append(
            f"Blender was not allowed to run the Python of {len(blocked)} driver{'s' if len(blocked) > 1 else ''} "
            f"({_some(blocked)}): what they drive stands still; start Blender with "
            "--enable-autoexec, or allow Auto Run Python Scripts in its preferences"
        )
    if texts:
        told.append(
            f"the file's scripts ({_some(texts)}) were not allowed to run; --enable-autoexec allows them"
        )
    return told


def python_drivers() -> Iterator[tuple[bpy.types.ID, bpy.types.FCurve]]:
    """Drivers whose expression needs Python, with the block that they are on."""
    for block, curve in drivers():
        if curve.driver.type == "SCRIPTED" and not curve.driver.is_simple_expression:
            yield block, curve


def drivers() -> Iterator[tuple[bpy.types.ID, bpy.types.FCurve]]:
    """All drivers of the file, with the block that they are on."""
    for name in dir(bpy.data):
        blocks = getattr(bpy.data, name)
        if not isinstance(blocks, bpy.types.bpy_prop_collection):
            continue
        for block in blocks:
            for owner in (block, getattr(block, "node_tree", None)):
                animation = getattr(owner, "animation_data", None)
                for curve in animation.drivers if animation else ():
                    yield block, curve


def foreign_handlers() -> list[Callable]:
    """Functions of the file or of add-ons that run when the frame changes."""
    handlers = bpy.app.handlers
    return [
        function
        for function in (
            *handlers.frame_change_pre,
            *handlers.frame_change_post,
            *handlers.render_init,
            *handlers.render_pre,
        )  # fmt: skip
        if not (function.__module__ or "").startswith(_BLENDERS_OWN)
    ]


def hold_against_handlers() -> list[str]:
    """Where foreign functions run at changes of the frame, sets after them again what the exporter owns."""
    found = foreign_handlers()
    if not found:
        return []
    ownership.hold_against_handlers()
    names = sorted({function.__name__ for function in found})
    return [
        f"scripts run when the frame changes ({_some(names)}): what they set of the render is set back by the export"
    ]


def _some(names: list[str]) -> str:
    return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
