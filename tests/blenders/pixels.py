# SPDX-License-Identifier: GPL-3.0-or-later
"""What a display in memory shows, and pictures of it."""

from __future__ import annotations

import os
import struct
import zlib

import numpy as np


def screen(folder: str) -> np.ndarray:
    """The pixels of the display of that folder (display.py), H x W x 3 bytes, from the file that Xvfb keeps them in (an X
    window dump)."""
    with open(os.path.join(folder, "Xvfb_screen0"), "rb") as file:
        content = file.read()
    header = struct.unpack(">25I", content[:100])
    size, width, height, stride, colors = (header[place] for place in (0, 4, 5, 12, 19))
    pixels = np.frombuffer(content, np.uint8, stride * height, size + 12 * colors)
    return pixels.reshape(height, stride // 4, 4)[:, :width, 2::-1]


def write_png(path: str, pixels: np.ndarray) -> None:
    """8-bit RGB."""
    height, width = pixels.shape[:2]
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], 1)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, body in (
            (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
            (b"IDAT", zlib.compress(rows.tobytes(), 9)),
            (b"IEND", b""),
        ):
            file.write(struct.pack(">I", len(body)) + kind + body)
            file.write(struct.pack(">I", zlib.crc32(kind + body)))
