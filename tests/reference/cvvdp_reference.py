"""Asks the authors' program for ColorVideoVDP what it says of given sequences: https://github.com/gfxdisp/ColorVideoVDP.

    cvvdp_reference.py REPOSITORY vectors [--write]   the sequences of cvvdp_vectors.json, made by formula: compares, or writes
    cvvdp_reference.py REPOSITORY judge TEST REFERENCE [--display D] [--fps F]   two folders of PNG or EXR frames

REPOSITORY is a checkout of it. It needs torch, torchvision, numpy and imageio (Debian: python3-torch python3-torchvision
python3-imageio python3-tqdm python3-matplotlib python3-openimageio); what only its readers of video files and its networks need may be missing.
The unit test Cvvdp.AgreesWithTheReferenceProgram holds ours against the written values; docs/metrics.md tells how far they
agree.
"""

import argparse
import json
import sys
import types
from pathlib import Path

import numpy as np

VECTORS = Path(__file__).with_name("cvvdp_vectors.json")
HDR_WHITE = 203.0  # cd/m2 of linear light 1, as in resolver/metrics/display_model.h


def reference_program(repository: Path):
    """Its package; stands in for modules that Debian 12 lacks or has in older versions."""

    def stand_in(name: str, **members: object) -> None:
        module = types.ModuleType(name)
        module.__dict__.update(members)
        sys.modules[name] = module

    sys.path[:0] = [str(repository), str(repository / "pycvvdp")]
    try:
        import ffmpeg  # noqa: F401
    except ImportError:
        stand_in("ffmpeg")
    try:
        import imageio.v2  # noqa: F401
    except ImportError:
        import imageio

        stand_in("imageio.v2", imread=imageio.imread, imwrite=imageio.imwrite)
        imageio.v2 = sys.modules["imageio.v2"]
    stand_in("pycvvdp.cvvdp_ml_metric", cvvdp_ml_saliency=None, cvvdp_ml_transformer=None)
    import interp

    quick = interp.get_interpolants_quick

    def with_long_indices(x_q, x):  # torch 1.13 indexes with 64-bit integers alone
        low, high, share = quick(x_q, x)
        return low.long(), high.long(), share

    interp.get_interpolants_quick = with_long_indices
    import pycvvdp

    return pycvvdp


def judge(
    program,
    test: np.ndarray,
    reference: np.ndarray,
    display: str,
    fps: float,
    heat_map: bool = False,
) -> dict:
    """test, reference: [frames, height, width, 3], sRGB codes / 255 or, for displays of linear light, cd/m2."""
    import torch

    metric = program.cvvdp(
        display_name=display,
        quiet=True,
        device=torch.device("cpu"),
        heatmap="raw" if heat_map else None,
    )
    to = lambda a: torch.tensor(np.ascontiguousarray(a, dtype=np.float32))
    jod, stats = metric.predict(to(test), to(reference), dim_order="FHWC", frames_per_second=fps)
    result = {"jod": float(jod)}
    if len(test) > 1:  # each frame as if all were as it is
        q = torch.tensor(stats["Q_per_ch"])
        result["perFrame"] = [
            float(metric.do_pooling_and_jods(q[:, :, [f, f], :])) for f in range(q.shape[2])
        ]
    if heat_map:
        lost = 10 * stats["heatmap"][0, 0].float().numpy()
        result["map"] = [[float(m.mean()), float(m.max())] for m in lost]
    return result


def noise(x, y, t, c, seed):
    """0..255, as the unit test computes it: 32-bit arithmetic."""
    with np.errstate(over="ignore"):
        u = lambda v: np.asarray(v, dtype=np.uint32)
        h = u(x) * u(374761393) + u(y) * u(668265263) + u(t) * u(2246822519) + u(c) * u(3266489917)
        h = h + u(seed) * u(2654435761)
        h = (h ^ (h >> u(13))) * u(1274126177)
        return ((h ^ (h >> u(16))) & u(255)).astype(np.int64)


def formula(v: dict) -> "tuple[np.ndarray, np.ndarray]":
    """8-bit codes of the test and the reference: a slope, a moving chequerboard, grain; and what is wrong with the test."""
    w, h, n, kind, a = v["width"], v["height"], v["frames"], v["kind"], v["amount"]
    t, y, x, c = np.meshgrid(np.arange(n), np.arange(h), np.arange(w), np.arange(3), indexing="ij")

    def picture(x):
        squares = (((x + 2 * t) // 8 + y // 8) & 1) * 40
        return (
            30 + x * 120 // w + squares + 10 * c * (y * 3 // h) + noise(x, y, 0, c, 1) * 16 // 256
        )

    reference = picture(x)
    if kind == "grain":
        test = reference + (noise(x, y, t, c, 2) * (2 * a + 1) // 256 - a)
    elif kind == "texture":
        test = reference + (noise(x, y, 0, c, 2) * (2 * a + 1) // 256 - a)
    elif kind == "flicker":
        test = reference + a * (1 - 2 * (t & 1))
    elif kind == "tint":
        test = reference + a * (1 - c)
    elif kind == "shift":
        test = picture(x + a)
    elif kind == "patch":
        test = reference + a * ((x > w // 2) & (y > h // 2))
    else:
        raise ValueError(kind)
    return np.clip(test, 0, 255), np.clip(reference, 0, 255)


def vector(program, v: dict) -> dict:
    test, reference = (p.astype(np.float32) / np.float32(255) for p in formula(v))
    if "hdr" in v["display"]:
        test, reference = (p * np.float32(v["scale"] * HDR_WHITE) for p in (test, reference))
    return judge(program, test, reference, v["display"], v["fps"], heat_map=v.get("heatMap", False))


def encoded(linear: np.ndarray) -> np.ndarray:
    c = np.clip(linear.astype(np.float64), 0, 1)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def folder(path: Path, hdr: bool) -> np.ndarray:
    """Frames in the order of their names: codes / 255, or cd/m2 for displays of linear light."""
    import OpenImageIO as oiio

    frames = []
    for f in sorted(f for f in Path(path).iterdir() if f.suffix in (".png", ".exr")):
        values = oiio.ImageBuf(str(f)).get_pixels(oiio.FLOAT)[..., :3]
        if f.suffix == ".exr":
            values = values * HDR_WHITE if hdr else encoded(values)
        frames.append(values)
    return np.stack(frames)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("repository", type=Path)
    parser.add_argument("what", choices=["vectors", "judge"])
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--write", action="store_true", help="into cvvdp_vectors.json")
    parser.add_argument("--display", default="standard_4k")
    parser.add_argument("--fps", type=float, default=30)
    a = parser.parse_args()
    program = reference_program(a.repository.resolve())
    if a.what == "judge":
        found = judge(
            program, *(folder(f, "hdr" in a.display) for f in a.folders), a.display, a.fps
        )
        print(json.dumps(found))
        return 0
    held = json.loads(VECTORS.read_text())
    worst = 0.0
    for v in held["sequences"]:
        found = vector(program, v)
        worst = max(worst, abs(found["jod"] - v.get("jod", found["jod"])))
        v.update(found)
        print(f"{v['name']}: {found['jod']:.4f}")
    print(f"largest difference from what is written: {worst:.5f}")
    if a.write:
        VECTORS.write_text(json.dumps(held, indent=1) + "\n")
    return 0 if worst < 1e-3 or a.write else 1


if __name__ == "__main__":
    sys.exit(main())
