# SPDX-License-Identifier: GPL-3.0-or-later
"""Multi-part EXR through OpenImageIO: Blender's own files in, the shot's files out.

Arrays are H x W x C, row 0 at the top. A file is written under a temporary name and renamed when it is complete,
so that a reader never meets half a frame.
"""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass

import numpy as np

from . import compat
from .errors import SceneError

# OpenImageIO would write the time of day, and the same work would never give the same bytes.
_NO_DATE = "1970:01:01 00:00:00"
_EXR_FLOAT = 2  # pixel type in a channel list; UINT is 0, HALF 1


@dataclass
class Part:
    """One part of a file: its name, channel names, one type per channel (half|float|uint) and the pixels."""

    name: str
    channels: tuple[str, ...]
    types: tuple[str, ...]
    pixels: np.ndarray
    compression: str = "zip"


def _oiio():
    module = compat.oiio_module()
    if module is None:
        raise SceneError(
            "this Blender's Python has no OpenImageIO module: install python3-openimageio, or render Blender's own "
            "multilayer EXRs and turn them into a shot with 'aaresolve import'"
        )
    return module


def write_parts(path: str, parts: list[Part]) -> None:
    """Writes all parts to ``path``; on failure nothing is left under that name."""
    oiio = _oiio()
    specs = []
    arrays = []
    for part in parts:
        height, width, count = part.pixels.shape
        kind = "uint" if len(set(part.types)) > 1 else part.types[0]
        spec = oiio.ImageSpec(width, height, count, _oiio_type(oiio, kind))
        pixels = np.ascontiguousarray(part.pixels)
        if len(set(part.types)) > 1:
            pixels = _bits(part)
        spec.channelnames = part.channels
        spec.attribute("oiio:subimagename", part.name)
        spec.attribute("compression", part.compression)
        spec.attribute("DateTime", _NO_DATE)
        specs.append(spec)
        arrays.append(pixels)
    temporary = f"{path}.{os.getpid()}.tmp.exr"
    output = oiio.ImageOutput.create(temporary)
    try:
        if not output.open(temporary, tuple(specs)):
            raise SceneError(f"{path}: cannot be written: {output.geterror()}")
        for index, (spec, pixels) in enumerate(zip(specs, arrays)):
            if index and not output.open(temporary, spec, "AppendSubimage"):
                raise SceneError(
                    f"{path}: part '{parts[index].name}' cannot be written: {output.geterror()}"
                )
            if not output.write_image(pixels):
                raise SceneError(
                    f"{path}: part '{parts[index].name}' cannot be written: {output.geterror()}"
                )
        if not output.close():
            raise SceneError(f"{path}: cannot be completed: {output.geterror()}; is the disk full?")
        _name_float_channels(temporary, parts)
        os.replace(temporary, path)
    except BaseException:
        if os.path.exists(temporary):
            os.unlink(temporary)
        raise


def _bits(part: Part) -> np.ndarray:
    """Pixels of a part with float and uint channels as 32-bit patterns, H x W x C.

    OpenImageIO takes one array type per write and converts mixed channels through float, which rounds integers above
    2^24. So such a part is written as integers that hold the bits of the floats, and ``_name_float_channels`` then
    corrects the header: every compression on offer treats the two types alike, as four bytes."""
    assert set(part.types) <= {"float", "uint"}, part.types
    bits = np.empty(part.pixels.shape, np.uint32)
    for index, kind in enumerate(part.types):
        plane = part.pixels[:, :, index]
        bits[:, :, index] = plane if kind == "uint" else plane.astype(np.float32).view(np.uint32)
    return bits


def _name_float_channels(path: str, parts: list[Part]) -> None:
    """Gives the float channels of mixed parts their type in the file's header."""
    if all(len(set(part.types)) == 1 for part in parts):
        return
    with open(path, "r+b") as file:
        content = file.read(1 << 22)
        position = 8
        for part in parts:
            attributes, after = _read_header(content, position)
            if len(set(part.types)) > 1:
                types = dict(zip(part.channels, part.types))
                cursor = attributes["channels"].start
                while content[cursor] != 0:
                    end = content.index(b"\0", cursor)
                    if types[content[cursor:end].decode()] == "float":
                        file.seek(end + 1)
                        file.write(struct.pack("<i", _EXR_FLOAT))
                    cursor = end + 1 + 16
            position = after


def _oiio_type(oiio, kind: str):
    return {"half": oiio.HALF, "float": oiio.FLOAT, "uint": oiio.UINT32}[kind]


def read_channels(path: str) -> dict[str, np.ndarray]:
    """Every channel of a file's parts as H x W float32; of several parts, ``part/channel`` are the keys."""
    oiio = _oiio()
    source = oiio.ImageInput.open(path)
    if source is None:
        raise SceneError(f"{path}: cannot be read: {oiio.geterror()}")
    channels: dict[str, np.ndarray] = {}
    index = 0
    while source.seek_subimage(index, 0):
        spec = source.spec()
        name = spec.getattribute("oiio:subimagename")
        pixels = source.read_image(index, 0, 0, spec.nchannels, "float")
        if pixels is None:
            raise SceneError(f"{path}: part {index} cannot be read: {source.geterror()}")
        pixels = pixels.reshape(spec.height, spec.width, spec.nchannels)
        for position, channel in enumerate(spec.channelnames):
            channels[f"{name}/{channel}" if name and index else channel] = pixels[:, :, position]
        index += 1
    source.close()
    return channels


def part_bytes(path: str) -> dict[str, int]:
    """Compressed bytes of each part, from the file's own chunk headers (the EXR 2.0 layout)."""
    with open(path, "rb") as file:
        content = file.read()
    multipart = bool(struct.unpack_from("<I", content, 4)[0] & 0x1000)
    position = 8
    names: list[str] = []
    chunks = 0
    while True:
        attributes, position = _read_header(content, position)
        if not attributes:
            break
        name = attributes.get("name")
        names.append(content[name].rstrip(b"\0").decode() if name else "")
        if not multipart:
            return {names[0]: len(content)}
        chunks += struct.unpack("<i", content[attributes["chunkCount"]])[0]
    position += 8 * chunks  # offset tables
    sizes = dict.fromkeys(names, 0)
    for _ in range(chunks):
        part, _row, size = struct.unpack_from("<iii", content, position)
        sizes[names[part]] += size + 12
        position += size + 12
    return sizes


def _read_header(content: bytes, position: int) -> tuple[dict[str, slice], int]:
    """Where one part's attributes lie, and the position behind them; empty after the last header of several."""
    attributes: dict[str, slice] = {}
    while content[position] != 0:
        end = content.index(b"\0", position)
        name = content[position:end].decode()
        position = content.index(b"\0", end + 1) + 1
        size = struct.unpack_from("<i", content, position)[0]
        attributes[name] = slice(position + 4, position + 4 + size)
        position += 4 + size
    return attributes, position + 1
