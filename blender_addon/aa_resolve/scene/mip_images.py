# SPDX-License-Identifier: GPL-3.0-or-later
"""The mip pyramid of an image: each level the box mean of the one before, in linear light, weighted by alpha."""

from __future__ import annotations

import bpy
import numpy as np

# Colour spaces whose pixels can be averaged here: as they are, or by the sRGB curve.
_LINEAR = ("Non-Color", "Linear", "Linear Rec.709", "Raw")
_CURVED = ("sRGB",)


def why_no_pyramid(node: bpy.types.Node) -> str | None:
    """Why the image of a node gets no mip maps; None where it does."""
    image = node.image
    if image is None or image.source not in ("FILE", "GENERATED"):
        return "only single pictures get mip maps"
    if node.projection != "FLAT":
        return f"projection {node.projection.lower()}"
    if node.interpolation == "Closest":
        return "interpolation is Closest: every texel is meant to be seen"
    if image.colorspace_settings.name not in _LINEAR + _CURVED:
        return f"colour space {image.colorspace_settings.name}"
    if not image.has_data:
        image.pixels[:1]  # loads the file
    if not image.has_data or min(image.size) < 1:
        return "the picture cannot be read"
    return None


def pyramid(node: bpy.types.Node) -> list[bpy.types.Image]:
    """Images of levels 1 and on, down to one texel; straight alpha, linear values."""
    image = node.image
    width, height = image.size
    flat = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(flat)
    pixels = _rgba(flat.reshape(height, width, image.channels))
    if image.alpha_mode == "NONE":
        pixels[..., 3] = 1.0
    elif image.alpha_mode == "PREMUL" and image.is_float:
        pixels[..., :3] /= np.maximum(pixels[..., 3:], 1.0e-6)
    if image.colorspace_settings.name in _CURVED and not image.is_float:
        pixels[..., :3] = _linear(pixels[..., :3])
    packed = image.alpha_mode == "CHANNEL_PACKED"
    return [
        _as_image(f"{image.name} 1/{2 << index}", level)
        for index, level in enumerate(levels(pixels, packed))
    ]


def levels(pixels: np.ndarray, packed: bool = False) -> list[np.ndarray]:
    """Levels 1 and on of H x W x 4 linear pixels; ``packed``: the fourth channel is no alpha, and weighs nothing."""
    found = []
    weighted = pixels.copy()
    if not packed:
        weighted[..., :3] *= pixels[..., 3:]
    while max(weighted.shape[:2]) > 1:
        for axis in (0, 1):
            weighted = _halved(weighted, axis)
        straight = weighted.copy()
        if not packed:
            straight[..., :3] /= np.maximum(straight[..., 3:], 1.0e-6)
        found.append(straight)
    return found


def _halved(pixels: np.ndarray, axis: int) -> np.ndarray:
    """Box mean along an axis of n texels into n / 2, rounded down; of an odd n texels are shared by their area."""
    count = pixels.shape[axis]
    target = max(count // 2, 1)
    moved = np.moveaxis(pixels, axis, 0)
    if count == 2 * target:
        result = 0.5 * (moved[0::2] + moved[1::2])
    else:
        borders = np.arange(target + 1) * (count / target)
        first, last = borders[:-1, None], borders[1:, None]
        texel = np.arange(count)[None, :]
        shares = np.clip(np.minimum(last, texel + 1) - np.maximum(first, texel), 0.0, None)
        result = np.tensordot((shares * (target / count)).astype(np.float32), moved, axes=1)
    return np.moveaxis(result, 0, axis)


def _rgba(pixels: np.ndarray) -> np.ndarray:
    """Four channels, whatever an image has."""
    channels = pixels.shape[2]
    made = np.ones((*pixels.shape[:2], 4), np.float32)
    made[..., :3] = pixels[..., :3] if channels >= 3 else pixels[..., :1]
    if channels in (2, 4):
        made[..., 3] = pixels[..., -1]
    return made


def _linear(encoded: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1."""
    low = encoded / 12.92
    return np.where(encoded <= 0.04045, low, ((encoded + 0.055) / 1.055) ** 2.4)


def _as_image(name: str, pixels: np.ndarray) -> bpy.types.Image:
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"  # the values are Cycles' own
    image.alpha_mode = "CHANNEL_PACKED"  # straight: nothing is multiplied
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    image.update()
    return image
