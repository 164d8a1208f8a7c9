# SPDX-License-Identifier: GPL-3.0-or-later
"""Scanline OpenEXR in numpy: Blender's own multilayer files in, the shot's multi-part files out.

Blender's Python brings no EXR module in every version (OpenImageIO is missing before 4.x), and OpenImageIO's Python
interface rounds integers beside floats and writes the time of day. The format itself is small: headers, a table of
offsets, blocks of lines. Specification: openexr.com, "OpenEXR File Layout".

Arrays are H x W x C, row 0 at the top. A file is written under a temporary name and renamed when it is complete, so
that a reader never meets half a frame; the same pixels give the same bytes.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from .errors import SceneError

_MAGIC = 20000630
_VERSION = 2
_LONG_NAMES, _MULTIPART = 0x400, 0x1000
_TYPES = {"uint": (0, np.dtype("<u4")), "half": (1, np.dtype("<f2")), "float": (2, np.dtype("<f4"))}
_DTYPES = {number: dtype for number, dtype in _TYPES.values()}
# Name: (number in the file, lines per block).
COMPRESSIONS = {"none": (0, 1), "zips": (2, 1), "zip": (3, 16)}
_LINES = {number: lines for number, lines in COMPRESSIONS.values()}
_ZLIB_LEVEL = 4  # what OpenEXR and OpenImageIO use: level 9 takes four times as long for 3 %


@dataclass
class Part:
    """One part of a file: its name, channel names, one type per channel (half|float|uint) and the pixels.

    ``pixels`` is one H x W x C array, or a list of H x W planes where the types differ. Their size is the part's data
    window; the display window of every part is the size of the file's first one."""

    name: str
    channels: tuple[str, ...]
    types: tuple[str, ...]
    pixels: np.ndarray | list[np.ndarray]
    compression: str = "zip"

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width of the data window."""
        first = self.pixels[0] if isinstance(self.pixels, list) else self.pixels
        return first.shape[0], first.shape[1]

    def planes(self) -> list[np.ndarray]:
        """One H x W plane per channel, in the channel's type; the part's own pixels where that is theirs."""
        planes = (
            self.pixels if isinstance(self.pixels, list) else list(np.moveaxis(self.pixels, -1, 0))
        )
        return [
            plane.astype(_TYPES[kind][1], copy=False) for plane, kind in zip(planes, self.types)
        ]


def _attribute(name: str, kind: str, value: bytes) -> bytes:
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def _window(shape: tuple[int, int]) -> bytes:
    """A box2i from the origin, of H x W pixels; the format counts its last pixel in."""
    return struct.pack("<iiii", 0, 0, shape[1] - 1, shape[0] - 1)


def _header(part: Part, display: tuple[int, int], order: list[int], blocks: int) -> bytes:
    """Header of one part; ``order`` lists its channels by name, as the format demands."""
    channels = b"".join(
        part.channels[index].encode()
        + b"\0"
        + struct.pack("<iBxxxii", _TYPES[part.types[index]][0], 0, 1, 1)
        for index in order
    )
    return (
        _attribute("channels", "chlist", channels + b"\0")
        + _attribute("chunkCount", "int", struct.pack("<i", blocks))
        + _attribute("compression", "compression", bytes([COMPRESSIONS[part.compression][0]]))
        + _attribute("dataWindow", "box2i", _window(part.shape))
        + _attribute("displayWindow", "box2i", _window(display))
        + _attribute("lineOrder", "lineOrder", b"\0")
        + _attribute("name", "string", part.name.encode())
        + _attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0))
        + _attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0.0, 0.0))
        + _attribute("screenWindowWidth", "float", struct.pack("<f", 1.0))
        + _attribute("type", "string", b"scanlineimage")
        + b"\0"
    )


def _pack(data: np.ndarray, compression: str) -> bytes:
    """One block as it is stored: bytes halved into even and odd ones, differences, deflate; raw if that is no gain."""
    if compression == "none":
        return data.tobytes()
    sorted_bytes = np.concatenate((data[0::2], data[1::2]))
    differences = np.empty_like(sorted_bytes)
    differences[:1] = sorted_bytes[:1]
    np.subtract(sorted_bytes[1:], sorted_bytes[:-1], out=differences[1:])
    differences[1:] += np.uint8(128)
    packed = zlib.compress(differences, _ZLIB_LEVEL)
    return packed if len(packed) < len(data) else data.tobytes()


def _unpack(stored: bytes, size: int) -> bytes:
    """Inverse of ``_pack`` for a block of ``size`` bytes."""
    if len(stored) == size:
        return stored
    differences = np.frombuffer(zlib.decompress(stored), np.uint8).copy()
    differences[1:] -= np.uint8(128)
    sorted_bytes = np.cumsum(differences, dtype=np.uint8)
    data = np.empty(size, np.uint8)
    half = (size + 1) // 2
    data[0::2], data[1::2] = sorted_bytes[:half], sorted_bytes[half:]
    return data.tobytes()


def _block(planes: list[np.ndarray], row: int, lines: int) -> np.ndarray:
    """Bytes of some lines, not compressed: line by line, in each line channel by channel."""
    rows = [np.ascontiguousarray(plane[row : row + lines]).view(np.uint8) for plane in planes]
    return np.concatenate(rows, axis=1).reshape(-1)


@dataclass
class _Stored:
    """One part as it lies in a file."""

    name: str
    header: bytes
    blocks: list[tuple[int, bytes]]  # first line and bytes, packed


def _stored(part: Part, display: tuple[int, int], pool: ThreadPoolExecutor) -> _Stored:
    order = sorted(range(len(part.channels)), key=lambda index: part.channels[index].encode())
    planes = part.planes()
    ordered = [planes[index] for index in order]
    lines = COMPRESSIONS[part.compression][1]
    rows = range(0, part.shape[0], lines)

    def packed(row: int) -> bytes:
        return _pack(_block(ordered, row, lines), part.compression)

    header = _header(part, display, order, len(rows))
    return _Stored(part.name, header, list(zip(rows, pool.map(packed, rows))))


def _all_stored(parts: list[Part], display: tuple[int, int]) -> list[_Stored]:
    # deflate runs outside Python's lock
    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        return [_stored(part, display, pool) for part in parts]


def write_parts(path: str, parts: list[Part]) -> dict[str, int]:
    """Writes all parts to ``path`` and returns the bytes that the blocks of each take.

    On failure nothing is left under that name. Raises SceneError with what the system says."""
    return _write(path, _all_stored(parts, parts[0].shape))


def add_parts(source: str, path: str, parts: list[Part], order: list[str]) -> dict[str, int]:
    """Writes the parts of the file ``source`` and ``parts`` to ``path``, sorted by ``order``; returns bytes by part.

    A part of ``source`` is copied as it lies there, to the bit, or replaced by the one of its name in ``parts``. The
    result is the file that ``write_parts`` would have made of all of them at once. Raises SceneError.
    """
    kept, display = _parts_as_stored(source)
    merged = {part.name: part for part in [*kept, *_all_stored(parts, display)]}
    return _write(path, sorted(merged.values(), key=lambda part: order.index(part.name)))


def _write(path: str, parts: list[_Stored]) -> dict[str, int]:
    many = len(parts) > 1
    flags = _VERSION | (_MULTIPART if many else 0)
    headers = b"".join(part.header for part in parts)
    start = struct.pack("<ii", _MAGIC, flags) + headers + (b"\0" if many else b"")
    position = len(start) + 8 * sum(len(part.blocks) for part in parts)
    offsets, body, sizes = [], [], {}
    for number, part in enumerate(parts):
        sizes[part.name] = 0
        for row, block in part.blocks:
            label = struct.pack("<ii", row, len(block))
            label = struct.pack("<i", number) + label if many else label
            offsets.append(position)
            body += [label, block]
            position += len(label) + len(block)
            sizes[part.name] += len(label) + len(block)
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "wb") as file:
            file.write(start)
            file.write(struct.pack(f"<{len(offsets)}Q", *offsets))
            file.writelines(body)
        os.replace(temporary, path)
    except OSError as error:
        if os.path.exists(temporary):
            os.unlink(temporary)
        raise SceneError(f"{path}: cannot be written: {error.strerror}") from error
    return sizes


@dataclass
class _Header:
    """What is needed of one part's header to find its pixels."""

    name: str = ""
    channels: list[tuple[str, np.dtype]] = field(default_factory=list)
    compression: int = 0
    width: int = 0
    height: int = 0
    top: int = 0
    blocks: int = 0
    text: bytes = b""  # as it lies in the file


def _read_header(content: memoryview, position: int) -> tuple[_Header | None, int]:
    """One part's header and the position behind it; None at the end of the list of headers."""
    header = _Header()
    if content[position] == 0:
        return None, position + 1
    while content[position] != 0:
        name, position = _text(content, position)
        _kind, position = _text(content, position)
        size = struct.unpack_from("<i", content, position)[0]
        value = bytes(content[position + 4 : position + 4 + size])
        position += 4 + size
        if name == "name":
            header.name = value.decode()
        elif name == "compression":
            header.compression = value[0]
        elif name == "dataWindow":
            left, header.top, right, bottom = struct.unpack("<iiii", value)
            header.width, header.height = right - left + 1, bottom - header.top + 1
        elif name == "channels":
            cursor = 0
            while value[cursor] != 0:
                channel, cursor = _text(memoryview(value), cursor)
                header.channels.append(
                    (channel, _DTYPES[struct.unpack_from("<i", value, cursor)[0]])
                )
                cursor += 16
    lines = _LINES.get(header.compression)
    if lines is None:
        raise SceneError(
            f"Blender wrote an EXR with compression {header.compression}, which cannot be read here"
        )
    header.blocks = (header.height + lines - 1) // lines
    return header, position + 1


def _text(content: memoryview, position: int) -> tuple[str, int]:
    end = position
    while content[end] != 0:
        end += 1
    return bytes(content[position:end]).decode(), end + 1


def read_channels(path: str) -> dict[str, np.ndarray]:
    """Every channel of a file as H x W in its stored type; those of further parts carry ``part/`` before their names.

    Reads scanline files without compression, ZIPS or ZIP. Without compression the arrays are views of the file's
    bytes: a channel that nobody looks at costs nothing."""
    return _opened(path, _read)


def _opened(path: str, read: Callable):
    """What ``read`` makes of a file's bytes. Raises SceneError where they are none of an EXR."""
    try:
        # Into an array of numpy's, whose large ones lie in huge pages: the page faults of a bytes object cost more
        # than the reading.
        return read(memoryview(np.fromfile(path, np.uint8)))
    except (OSError, IndexError, ValueError, KeyError, struct.error, zlib.error) as error:
        raise SceneError(f"{path}: cannot be read as EXR ({error})") from error


def _parts_as_stored(path: str) -> tuple[list[_Stored], tuple[int, int]]:
    """Every part of a file, nothing unpacked, and the size (H, W) of the first one."""
    return _opened(path, _stored_in)


def _stored_in(content: memoryview) -> tuple[list[_Stored], tuple[int, int]]:
    headers, position, many = _headers(content)
    parts = []
    for header in headers:
        blocks = []
        for offset in struct.unpack_from(f"<{header.blocks}Q", content, position):
            label = offset + (4 if many else 0)  # behind the number of the part
            row, size = struct.unpack_from("<ii", content, label)
            if label + 8 + size > len(content):
                raise ValueError("it ends too early")
            blocks.append((row, bytes(content[label + 8 : label + 8 + size])))
        position += 8 * header.blocks
        parts.append(_Stored(header.name, header.text, blocks))
    return parts, (headers[0].height, headers[0].width)


def _headers(content: memoryview) -> tuple[list[_Header], int, bool]:
    """The header of every part, the position behind them, and whether the file can hold several parts."""
    magic, flags = struct.unpack_from("<ii", content, 0)
    if magic != _MAGIC:
        raise ValueError("wrong magic number")
    many = bool(flags & _MULTIPART)
    headers: list[_Header] = []
    position = 8
    while True:
        header, behind = _read_header(content, position)
        if header is not None:
            header.text = bytes(content[position:behind])
            headers.append(header)
        position = behind
        if header is None or not many:
            return headers, position, many


def _read(content: memoryview) -> dict[str, np.ndarray]:
    headers, position, many = _headers(content)
    channels: dict[str, np.ndarray] = {}
    for number, header in enumerate(headers):
        offsets = struct.unpack_from(f"<{header.blocks}Q", content, position)
        position += 8 * header.blocks
        row_bytes = sum(dtype.itemsize for _, dtype in header.channels) * header.width
        label = 12 if many else 8  # bytes before each block: part, row and size
        pixels, start, step = content, offsets[0] + label, row_bytes + label
        if header.compression or np.any(np.diff(np.array(offsets, np.int64)) != step):
            pixels, start, step = (
                _unpacked(content, header, offsets, row_bytes, label),
                0,
                row_bytes,
            )
        for name, dtype in header.channels:
            channels[f"{header.name}/{name}" if number else name] = np.ndarray(
                (header.height, header.width), dtype, pixels, start, (step, dtype.itemsize)
            )
            start += dtype.itemsize * header.width
    return channels


def _unpacked(
    content: memoryview, header: _Header, offsets: tuple[int, ...], row_bytes: int, label: int
) -> np.ndarray:
    """All rows of one part, one after the other."""
    rows = np.empty((header.height, row_bytes), np.uint8)
    for offset in offsets:
        first, size = struct.unpack_from("<ii", content, offset + label - 8)
        first -= header.top
        count = min(_LINES[header.compression], header.height - first)
        block = bytes(content[offset + label : offset + label + size])
        if header.compression:
            block = _unpack(block, count * row_bytes)
        rows[first : first + count] = np.frombuffer(block, np.uint8).reshape(count, row_bytes)
    return rows
