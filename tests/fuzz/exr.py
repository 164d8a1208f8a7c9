"""The smallest writer of an uncompressed scanline OpenEXR file, so that the fuzzer can damage a Blender-like file."""

from __future__ import annotations

import struct


def attribute(name: str, kind: str, value: bytes) -> bytes:
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def write(
    path,
    width: int,
    height: int,
    channels: dict[str, list[float]],
    texts: dict[str, str],
    more: bytes = b"",
) -> None:
    """Float channels of width * height values each; `more`: further attributes."""
    names = sorted(channels)
    listed = b"".join(n.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for n in names) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2)
    header += attribute("channels", "chlist", listed) + attribute(
        "compression", "compression", b"\0"
    )
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute(
        "pixelAspectRatio", "float", struct.pack("<f", 1)
    )
    header += attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)) + attribute(
        "screenWindowWidth", "float", struct.pack("<f", 1)
    )
    for key, value in texts.items():
        header += attribute(key, "string", value.encode())
    header += more + b"\0"
    row_bytes = 4 * width * len(names)
    first = len(header) + 8 * height
    offsets = b"".join(struct.pack("<Q", first + y * (8 + row_bytes)) for y in range(height))
    with open(path, "wb") as file:
        file.write(header + offsets)
        for y in range(height):
            row = b"".join(
                struct.pack(f"<{width}f", *channels[n][y * width : (y + 1) * width]) for n in names
            )
            file.write(struct.pack("<ii", y, row_bytes) + row)
