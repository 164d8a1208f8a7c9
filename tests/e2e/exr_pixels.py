"""The smallest reader of scanline OpenEXR files (no, ZIPS or ZIP compression; several parts): the pixels' bytes."""

from __future__ import annotations

import struct
import zlib
from itertools import accumulate
from pathlib import Path

LINES = {0: 1, 2: 1, 3: 16}  # compression: lines per chunk
MULTI_PART = 0x1000
_HALF_TURN = bytes(b ^ 128 for b in range(256))


def _decoded(chunk: bytes, size: int) -> bytes:
    """Undoes deflate, the differences between neighbours, and the parting of even from odd bytes."""
    if len(chunk) == size:  # stored as it is: deflate did not pay
        return chunk
    deltas = zlib.decompress(chunk)
    parted = bytearray(map((255).__and__, accumulate(deltas)))
    parted[1::2] = parted[1::2].translate(_HALF_TURN)  # each difference is stored 128 too large
    pixels = bytearray(size)
    half = (size + 1) // 2
    pixels[0::2], pixels[1::2] = parted[:half], parted[half:]
    return bytes(pixels)


def parts_of(path: Path) -> dict[str, bytes]:
    """Name of each part ("" if it has none) and its pixels: line by line, the channels of a line by name."""
    data = path.read_bytes()
    at = 8
    magic, version = struct.unpack_from("<II", data)
    if magic != 20000630:
        raise ValueError(f"{path}: not an OpenEXR file")

    def text() -> str:
        nonlocal at
        end = data.index(b"\0", at)
        word, at = data[at:end].decode(), end + 1
        return word

    headers = []
    while data[at] and (not headers or version & MULTI_PART):
        header = {}
        while name := text():
            text()  # the attribute's type
            (size,) = struct.unpack_from("<i", data, at)
            header[name] = data[at + 4 : at + 4 + size]
            at += 4 + size
        headers.append(header)
    at += bool(version & MULTI_PART)

    parts = {}
    for header in headers:
        left, top, right, bottom = struct.unpack("<iiii", header["dataWindow"])
        step = LINES[header["compression"][0]]
        channels, pixel_bytes = header["channels"], 0
        while channels[0]:
            end = channels.index(b"\0")
            pixel_bytes += (4, 2, 4)[struct.unpack_from("<i", channels, end + 1)[0]]
            channels = channels[end + 17 :]
        rows = {}
        for chunk in range((bottom - top) // step + 1):
            (offset,) = struct.unpack_from("<Q", data, at + 8 * chunk)
            offset += 4 if version & MULTI_PART else 0
            y, size = struct.unpack_from("<ii", data, offset)
            lines = min(step, bottom + 1 - y)
            rows[y] = _decoded(
                data[offset + 8 : offset + 8 + size], lines * (right + 1 - left) * pixel_bytes
            )
        at += 8 * ((bottom - top) // step + 1)
        name = header["name"].decode() if "name" in header else ""
        parts[name] = b"".join(rows[y] for y in sorted(rows))
    return parts
