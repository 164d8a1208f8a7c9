"""Seeded damage to files: bytes, EXR headers, JSON documents, method texts. Everything comes from one `random.Random`."""

from __future__ import annotations

import json
import random
import struct

_INTEGERS = [
    0,
    1,
    2,
    255,
    256,
    0x7FFF,
    0xFFFF,
    0x10000,
    0x7FFFFFFF,
    0x80000000,
    0xFFFFFFFF,
    0x40000000,
]
_VALUES = [
    None, True, False, 0, 1, -1, 16384, 16385, 2**31 - 1, 2**31, -(2**31) - 1, 2**63, 2**64, 1e308, -1e308, 1e-320, 0.5, -0.5, 0.51,
    "", "x", "none", "../../etc/passwd", "/dev/zero", "frames", "a" * 5000, "\x00", "\ud800".encode("utf-8", "surrogatepass").decode("latin-1"),
    [], [[]], {}, [0, 0], [1e9, -1e9], [0] * 16, [1] * 300, {"frame": 1}, {"": {}},
]  # fmt: skip


def mutate_bytes(rng: random.Random, data: bytes, header: int = 0) -> bytes:
    """1 to 6 damages; where the file has a header, most of them there."""
    damaged = bytearray(data)
    for _ in range(rng.choice([1, 1, 1, 2, 3, 6])):
        if not damaged:
            break
        reach = min(len(damaged), header) if header and rng.random() < 0.7 else len(damaged)
        at = rng.randrange(reach)
        kind = rng.randrange(8)
        if kind == 0:
            damaged[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            damaged[at] = rng.choice([0, 1, 0x7F, 0x80, 0xFF, rng.randrange(256)])
        elif kind == 2:
            damaged[at : at + 4] = struct.pack(rng.choice("<>") + "I", rng.choice(_INTEGERS))
        elif kind == 3:
            del damaged[at:]
        elif kind == 4:
            del damaged[at : at + rng.choice([1, 2, 4, 16, 200])]
        elif kind == 5:
            chunk = damaged[at : at + rng.choice([1, 4, 32, 300])]
            damaged[at:at] = chunk * rng.choice([1, 1, 2, 40])
        elif kind == 6:
            other = rng.randrange(len(damaged))
            size = rng.choice([4, 16, 64])
            damaged[at : at + size] = damaged[other : other + size]
        else:
            damaged[at : at + 8] = bytes(rng.randrange(256) for _ in range(8))
    return bytes(damaged)


def _places(node, path=()):
    yield path
    items = (
        node.items()
        if isinstance(node, dict)
        else enumerate(node)
        if isinstance(node, list)
        else ()
    )
    for key, value in items:
        yield from _places(value, (*path, key))


def _nested(depth: int) -> str:
    return "[" * depth + "]" * depth


def mutate_json(rng: random.Random, text: str) -> str:
    """Another document of nearly the same structure, or nearly the same text."""
    if rng.random() < 0.2:
        return mutate_bytes(rng, text.encode()).decode("latin-1")
    document = json.loads(text)
    for _ in range(rng.choice([1, 1, 2, 3])):
        path = rng.choice(list(_places(document)))
        if not path:
            if rng.random() < 0.1:
                document = rng.choice(_VALUES)
                break
            continue
        parent = document
        for key in path[:-1]:
            parent = parent[key]
        key = path[-1]
        kind = rng.randrange(6)
        if kind == 0:
            del parent[key]
        elif kind == 1 and isinstance(parent, list):
            parent.insert(key, parent[key])
        elif kind == 2 and isinstance(parent, dict):
            parent[rng.choice(["", "frame", "jitter", "id", key + "2", "x" * 300])] = parent.pop(
                key
            )
        elif (
            kind == 3
            and isinstance(parent[key], (int, float))
            and not isinstance(parent[key], bool)
        ):
            parent[key] = rng.choice(
                [
                    -parent[key],
                    parent[key] + 1,
                    parent[key] * 1e6,
                    float(parent[key]),
                    parent[key] * 0.5,
                ]
            )
        else:
            parent[key] = rng.choice(_VALUES)
        if not isinstance(document, (dict, list)) or not document:
            break
    result = json.dumps(document)
    if rng.random() < 0.05:
        result = result.replace("[", _nested(rng.choice([70, 100000])) + ",[", 1)
    return result


def mutate_text(rng: random.Random, text: str) -> str:
    """A method as a hasty user would write it."""
    tokens = [
        ":",
        ",",
        "=",
        "+",
        "==",
        "nan",
        "inf",
        "-1",
        "1e999",
        "0x10",
        "",
        " ",
        "\u00e4",
        "taaSimplest",
        "sharpen",
        "fill",
        "9" * 40,
    ]
    for _ in range(rng.choice([1, 1, 2, 4])):
        at = rng.randrange(len(text) + 1)
        if rng.random() < 0.3:
            text = text[:at] + text[at + rng.choice([1, 3]) :]
        else:
            text = text[:at] + rng.choice(tokens) + text[at:]
    return text
