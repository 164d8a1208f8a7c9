"""Reads the EXR files that aaresolve writes: one part, scan lines, float channels R G B, ZIP."""

from __future__ import annotations

import struct
import zlib
from array import array
from pathlib import Path


def read(file: Path) -> dict[str, list[float]]:
    """Channel name -> values, row by row from the top."""
    data = Path(file).read_bytes()
    if data[:4] != b"v/1\x01":
        raise ValueError(f"{file}: not an EXR")
    at, header = 8, {}
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    at += 1
    x0, y0, x1, y1 = struct.unpack("<iiii", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    names, listed, n = [], header["channels"], 0
    while listed[n]:
        name, n = _text(listed, n)
        kind = struct.unpack_from("<i", listed, n)[0]
        if kind != 2:
            raise ValueError(f"{file}: channel {name} is not float")
        names.append(name)
        n += 16
    rows_per_block = {0: 1, 2: 1, 3: 16}[header["compression"][0]]
    image: dict[str, list[float]] = {name: [0.0] * (width * height) for name in names}
    blocks = -(-height // rows_per_block)
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(rows_per_block, y1 + 1 - y)
        plain = _unpacked(data[offset + 8 : offset + 8 + size], rows * width * 4 * len(names))
        values = array("f", plain)
        for row in range(rows):
            for k, name in enumerate(names):
                first = (row * len(names) + k) * width
                to = (y - y0 + row) * width
                image[name][to : to + width] = values[first : first + width]
    return image


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _unpacked(block: bytes, size: int) -> bytes:
    """A block that would not shrink is stored as it is."""
    if len(block) == size:
        return block
    d = bytearray(zlib.decompress(block))
    for i in range(1, size):
        d[i] = (d[i - 1] + d[i] - 128) & 255
    half = (size + 1) // 2
    out = bytearray(size)
    out[0::2], out[1::2] = d[:half], d[half:]
    return bytes(out)
