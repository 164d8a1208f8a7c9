"""Whether two studies hold the same: every picture to the byte, every figure to the last digit."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

# Times, how busy the machine was, and the command lines with their folders: what two runs of one study may differ in.
_OF_A_RUN = re.compile(
    r"provenance|rerun|load|nsPerPixel|renderSeconds|seconds.*|wallSeconds.*|deviceSeconds.*"
)
_OF_AN_EXPORT = re.compile(r"render_seconds")


def content(out: Path) -> dict[str, str]:
    """Digests by path: of pictures, and of the members of shot.json and results.json that hold no times."""
    found = {}
    for path in sorted(out.rglob("*")):
        name = str(path.relative_to(out))
        if path.suffix == ".exr":
            found[name] = hashlib.sha256(path.read_bytes()).hexdigest()
        elif path.name in ("shot.json", "results.json"):
            without = _OF_AN_EXPORT if path.name == "shot.json" else _OF_A_RUN
            kept = _stripped(json.loads(path.read_text()), without)
            found[name] = hashlib.sha256(json.dumps(kept).encode()).hexdigest()
    return found


def _stripped(value: object, without: re.Pattern) -> object:
    if isinstance(value, dict):
        return {k: _stripped(v, without) for k, v in value.items() if not without.fullmatch(k)}
    if isinstance(value, list):
        return [_stripped(item, without) for item in value]
    return value


def differences(one: dict[str, str], other: dict[str, str]) -> list[str]:
    """Names of what is not alike."""
    return sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name))
