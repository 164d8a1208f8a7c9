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

_UINT_MAX = 4294967295.0


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
        spec = oiio.ImageSpec(width, height, count, _oiio_type(oiio, part.types[0]))
        pixels = np.ascontiguousarray(part.pixels)
        if len(set(part.types)) > 1:
            spec.channelformats = tuple(
                oiio.TypeDesc(_oiio_type(oiio, kind)) for kind in part.types
            )
            # One array feeds channels of several types: OIIO maps 0..1 to the range of an integer channel, and
            # double holds every 32-bit integer and every float exactly on that way.
            pixels = pixels.astype(np.float64)
            for index, kind in enumerate(part.types):
                if kind == "uint":
                    pixels[:, :, index] /= _UINT_MAX
        spec.channelnames = part.channels
        spec.attribute("oiio:subimagename", part.name)
        spec.attribute("compression", part.compression)
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
        os.replace(temporary, path)
    except BaseException:
        if os.path.exists(temporary):
            os.unlink(temporary)
        raise


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
    version = struct.unpack_from("<I", content, 4)[0]
    multipart = bool(version & 0x1000)
    position = 8
    names: list[str] = []
    chunk_counts: list[int] = []
    while True:
        attributes, position = _read_header(content, position)
        if not attributes:
            break
        names.append(attributes.get("name", b"\0")[:].rstrip(b"\0").decode())
        chunk_counts.append(
            struct.unpack("<i", attributes["chunkCount"])[0] if "chunkCount" in attributes else 0
        )
        if not multipart:
            break
    if not multipart:
        return {names[0]: len(content)}
    position += 8 * sum(chunk_counts)  # offset tables
    sizes = dict.fromkeys(names, 0)
    for _ in range(sum(chunk_counts)):
        part, _row, size = struct.unpack_from("<iii", content, position)
        sizes[names[part]] += size + 12
        position += size + 12
    return sizes


def _read_header(content: bytes, position: int) -> tuple[dict[str, bytes], int]:
    """One part's attributes (raw values) and the position behind them; empty at the end of the list of headers."""
    attributes: dict[str, bytes] = {}
    while content[position] != 0:
        end = content.index(b"\0", position)
        name = content[position:end].decode()
        position = content.index(b"\0", end + 1) + 1
        size = struct.unpack_from("<i", content, position)[0]
        attributes[name] = content[position + 4 : position + 4 + size]
        position += 4 + size
    return attributes, position + 1
