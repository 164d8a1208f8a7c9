"""Small picture files made byte by byte, whole ones and such as are wrong on purpose."""

from __future__ import annotations

import struct
import zlib
from typing import Callable, Iterable

_COLOUR_TYPES = {1: 0, 4: 6}  # of PNG: grey, RGBA


def png(
    width: int,
    height: int,
    channels: int,
    packed_rows: bytes,
    between: Iterable[tuple[bytes, bytes]] = (),
) -> bytes:
    """8 bits. ``packed_rows``: deflated rows, each after the byte that names its filter; ``between``: chunks (name,
    content) between header and pixels. Nothing is checked."""

    def chunk(name: bytes, content: bytes) -> bytes:
        check = zlib.crc32(name + content)
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", check)

    header = struct.pack(">IIBBBBB", width, height, 8, _COLOUR_TYPES[channels], 0, 0, 0)
    chunks = [(b"IHDR", header), *between, (b"IDAT", packed_rows), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*c) for c in chunks)


def square_png(size: int, channels: int, pixel: Callable[[int, int], Iterable[int]]) -> bytes:
    """``pixel(x, y)`` gives one byte (grey) or four (RGBA)."""
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(size)) for y in range(size))
    return png(size, size, channels, zlib.compress(rows))


def tiff(width: int, height: int, codes: bytes) -> bytes:
    """Grey, 8 bits, not compressed; ``codes`` may be fewer than the size says."""
    entries = {
        256: width,
        257: height,
        258: 8,
        259: 1,
        262: 1,
        273: 8,
        277: 1,
        278: height,
        279: len(codes),
    }
    listed = b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in entries.items())
    start = b"II*\0" + struct.pack("<I", 8 + len(codes))
    return start + codes + struct.pack("<H", len(entries)) + listed + bytes(4)
