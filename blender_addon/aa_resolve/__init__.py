# SPDX-License-Identifier: GPL-3.0-or-later
"""AA Resolve: records what a real-time renderer would know of a scene, for the anti-aliasing judge ``aaresolve``."""

from __future__ import annotations

bl_info = {
    "name": "AA Resolve",
    "author": "The AA Resolve authors",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > AA Resolve",
    "description": "Exports jittered, aliased frames with geometry, motion and ground truth, and compares methods",
    "category": "Render",
}

ADDON_VERSION = ".".join(str(part) for part in bl_info["version"])


def register() -> None:
    """Called by Blender when the add-on is switched on."""
    try:
        import numpy  # noqa: F401
    except ImportError as missing:
        raise RuntimeError(
            f"AA Resolve needs numpy, and this Blender's Python has none ({missing}): blender.org's Blender brings it,"
            " a distribution's may not; install it (Debian, Ubuntu: apt-get install python3-numpy) and switch the"
            " add-on on again"
        ) from None
    from . import panel

    panel.register()


def unregister() -> None:
    """Called by Blender when the add-on is switched off; leaves nothing behind."""
    from . import panel

    panel.unregister()
