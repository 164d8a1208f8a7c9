# SPDX-License-Identifier: GPL-3.0-or-later
"""Two pictures of truth beside each other with a label above each, as the open scene's view transform shows them.

    blender -b FILE.blend -P side_by_side.py -- LEFT.exr LABEL RIGHT.exr LABEL OUT.png

The labels are text objects that Cycles renders: the one way to write into a picture that every Blender has without a
window."""

from __future__ import annotations

import os
import sys

import bpy
import numpy as np

if __package__ in (None, ""):
    _ADDON = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    sys.path.insert(0, os.path.dirname(_ADDON))
    import aa_resolve  # noqa: F401  (makes the relative imports below work when Blender runs this file)

    __package__ = "aa_resolve.panel"

from .. import compat, exr  # noqa: E402
from ..scene import rendering  # noqa: E402

_LABEL_PIXELS = 26
_GAP_PIXELS = 6
_GROUND = 0.02  # of labels and gap, linear
_LETTER = 0.8  # of the label's height


def truth_of(path: str) -> np.ndarray:
    """H x W x 3: mean of both halves of a truth, linear."""
    channels = exr.read_channels(path)
    halves = [np.stack([channels[f"{part}{name}"] for name in "RGB"], -1) for part in ("", "b/")]
    return (halves[0] + halves[1]) / 2.0


def label(text: str, width: int) -> np.ndarray:
    """A strip of ``width`` x _LABEL_PIXELS with a text in it, linear."""
    scene = bpy.data.scenes.new("AA Resolve Label")
    data = bpy.data.curves.new("AA Resolve Label", "FONT")
    data.body, data.size = text, _LETTER
    data.align_y = "CENTER"
    material = bpy.data.materials.new("AA Resolve Label")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shine = tree.nodes.new("ShaderNodeEmission")
    shine.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shine.outputs[0], output.inputs["Surface"])
    data.materials.append(material)
    item = bpy.data.objects.new("AA Resolve Label", data)
    scene.collection.objects.link(item)
    lens = bpy.data.cameras.new("AA Resolve Label")
    lens.type, lens.sensor_fit = "ORTHO", "VERTICAL"
    lens.ortho_scale = 1.0  # the label's height
    camera = bpy.data.objects.new("AA Resolve Label", lens)
    camera.location = (width / _LABEL_PIXELS / 2.0 - 0.3, 0.0, 1.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = width, _LABEL_PIXELS
    scene.render.resolution_percentage = 100
    layer = scene.view_layers[0]
    rendering.prepare(scene, layer)
    rendering.request_passes(layer, set())
    rendering.sample_pixel_area(scene, 16, 0)
    return rendering.render(scene, layer, rendering.temporary_folder()).get("Combined")[:, :, :3]


def join(left: np.ndarray, left_text: str, right: np.ndarray, right_text: str) -> np.ndarray:
    """Both pictures with their labels, linear."""
    height, width = left.shape[:2]
    whole = np.full((height + _LABEL_PIXELS, 2 * width + _GAP_PIXELS, 3), _GROUND, np.float32)
    for start, picture, text in (
        (0, left, left_text),
        (width + _GAP_PIXELS, right, right_text),
    ):
        whole[:_LABEL_PIXELS, start : start + width] += label(text, width)
        whole[_LABEL_PIXELS:, start : start + width] = picture
    return whole


def save(pixels: np.ndarray, path: str, scene: bpy.types.Scene) -> None:
    """Writes a PNG through the scene's view transform."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new("AA Resolve", width, height, alpha=False, float_buffer=True)
    upright = np.concatenate([pixels, np.ones((height, width, 1), np.float32)], -1)[::-1]
    image.pixels.foreach_set(np.ascontiguousarray(upright, np.float32).ravel())
    compat.set_png(scene.render.image_settings)
    image.save_render(path, scene=scene)


def main(words: list[str]) -> None:
    """Makes the picture."""
    left, left_text, right, right_text, out = words
    scene = bpy.context.scene
    compat.render_in_rec709()  # as the shots were: what is linear here is read as the file's own space
    pixels = join(truth_of(left), left_text, truth_of(right), right_text)
    save(pixels, out, scene)


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :])
