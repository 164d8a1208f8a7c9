"""Inside Blender, whose Python reads EXR: how far two shots of the same scene lie apart, as one line of JSON.

usage: blender -b --factory-startup --python-exit-code 9 -P import_compare.py -- SHOT SHOT
"""

from __future__ import annotations

import json
import os
import sys

import numpy as np
import OpenImageIO as oiio


def parts(path: str) -> dict[str, np.ndarray]:
    """Part name -> H x W x C."""
    file = oiio.ImageInput.open(path)
    found = {}
    index = 0
    while file.seek_subimage(index, 0):
        spec = file.spec()
        kind = "uint32" if spec.format == oiio.TypeDesc("uint") else "float"
        found[spec.getattribute("oiio:subimagename")] = file.read_image(
            index, 0, 0, spec.nchannels, kind
        )
        index += 1
    return found


first, second = sys.argv[sys.argv.index("--") + 1 :]
worst = {"depth": 0.0, "motion": 0.0, "normal": 0.0, "albedo": 0.0}
pairs: set[tuple[int, int]] = set()
fastest = background = 0.0
for frame in (1, 2, 3):
    a, b = (parts(os.path.join(shot, "frames", f"{frame:06d}.exr")) for shot in (first, second))
    for part in worst:
        x, y = a[part][:, :, :3].astype(np.float64), b[part][:, :, :3].astype(np.float64)
        scale = np.maximum(np.abs(x), 1.0) if part == "depth" else 1.0
        if part == "motion" and frame == 1:
            continue  # the exporter's first frame has no frame before it
        worst[part] = max(worst[part], float((np.abs(x - y) / scale).max()))
    pairs |= set(zip(a["object"].ravel().tolist(), b["object"].ravel().tolist()))
    if frame > 1:
        speed = np.hypot(a["motion"][:, :, 0], a["motion"][:, :, 1])
        fastest = max(fastest, float(speed.max()))
        background = max(background, float(speed[a["depth"][:, :, 0] > 1e9].max()))
print(json.dumps({**worst, "pairs": sorted(pairs), "fastest": fastest, "background": background}))
