# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/scenes.md from the add-on's table of what a scene may contain. Needs no Blender."""

from __future__ import annotations

import importlib
import os
import sys
import types

HERE = os.path.dirname(os.path.abspath(__file__))

if __name__ == "__main__":
    scene = types.ModuleType("scene")  # the add-on's own package would want Blender
    scene.__path__ = [os.path.join(HERE, "aa_resolve", "scene")]
    sys.modules["scene"] = scene
    page = importlib.import_module("scene.features").page()
    with open(os.path.join(HERE, "..", "docs", "scenes.md"), "w", encoding="utf-8") as file:
        file.write(page)
