"""Whole inputs for the targets of targets.h that no command of the program writes, one of each kind."""

from __future__ import annotations

import json
import struct
import sys
import zlib
from pathlib import Path
from typing import Callable

import exr

sys.path.append(str(Path(__file__).resolve().parents[1] / "e2e"))

import pictures  # noqa: E402

Keep = Callable[[str, str, object], None]

_PERSPECTIVE = [2.7, 0, 0, 0, 0, 4.1, 0, 0, 0, 0, -1.002, -0.2002, 0, 0, -1, 0]
_UNIT = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
_CAMERA = {
    "kind": "perspective",
    "view": _UNIT,
    "projection": _PERSPECTIVE,
    "near": 0.1,
    "far": 100,
}


def write_documents(keep: Keep) -> None:
    _write_manifests(keep)
    _write_survey(keep)
    _write_layouts(keep)
    angles = {
        "format": "aaresolve-angles",
        "version": 1,
        "degrees": [0, 45],
        "noaaPsnr": [20, "Inf"],
    }
    keep("angles", "angles.json", angles | {"methods": [{"text": "fxaa311", "mse": [0.01, 0.02]}]})
    keep("angles", "bad-format.json", angles | {"format": 3, "methods": []})
    for name, varied in (
        ("list", "kmin=0.5,0.9"),
        ("range", "kmin=0.8..0.98:0.02"),
        ("bad-unknown", "historyFrames=1..8"),
        ("bad-negative", "kmin=-1.5..-0.5:0.25"),
        ("bad-same", "kmin=0.5,0.5"),
        ("bad-descends", "kmin=0.9..0.5:0.1"),
        ("bad-step", "kmin=0..1:x"),
        ("bad-digits", "kmin=0..1:0.0000000001"),
        ("bad-many", "kmin=0..1:0.0001"),
        ("bad-name", "=1"),
    ):
        keep("vary", f"{name}.txt", varied)
    keep("method", "stages.txt", "noaa+fill=fxaa311+sharpen=norm+motionBlur=0.5")
    keep("method", "exponent.txt", "accumReject:nMaxMoving=1e+1")
    for name, text in (
        ("range", "fxaa311:subpix=7"),
        ("choice", "fxaa311:preset=9"),
        ("flag", "taaSimplest:historyClamp=maybe"),
        ("effect", "karis:clipFactor=1"),
        ("name", "fxaa311:presett=12"),
        ("number", "fxaa311:subpix=a"),
        ("whole", "rsaa:rounds=1.5"),
        ("item", "fxaa311:preset"),
        ("none", "noaa:a=1"),
        ("method", "fxa311"),
        ("stage", "noaa+sharpn"),
    ):
        keep("method", f"bad-{name}.txt", text)
    for name, text in (
        ("rank", "rank noaa fxaa311 frames=1-2 fps=8 region=2,3,16,8 zoom=2"),
        ("pairs", "pairs noaa smaa1x region=auto:120x80 text=Which is better?"),
        ("rating", "rating noaa run=two frame=3"),
        ("bad-kind", "rnk noaa"),
        ("bad-zoom", "pair noaa fxaa311 zoom=17"),
        ("bad-fps", "pair noaa fxaa311 fps=0"),
        ("bad-both", "pair noaa fxaa311 frame=1 frames=1-2"),
        ("bad-word", "pair noaa fxaa311 zom=2"),
    ):
        keep("question", f"{name}.txt", text)


def write_results(keep: Keep, whole: dict) -> None:
    """What only some runs hold, and what must not stand in any."""
    run, frame = whole["run"], whole["shot"]["resolution"]

    def kept(name: str, **changed: object) -> None:
        keep("results", f"{name}.json", whole | changed)

    kept("region", run=run | {"region": [1, 2, 8, 4]})
    kept("bad-region", run=run | {"region": [1, 2, *frame]})
    kept("bad-whole", run=run | {"region": [1, 2, 1e12, 4]})
    kept("bad-version", version=2)
    kept("bad-path", truth=whole["truth"] | {"images": {"1": "../000001.exr"}})
    kept("bad-pair", pairs=[pair | {"indices": [0, 99]} for pair in whole["pairs"]])


def _write_manifests(keep: Keep) -> None:
    frame = {
        "frame": -3,
        "file": "frames/-00003.exr",
        "centre": None,
        "truth": "truth/1.exr",
        "jitter": [0.25, -0.5],
    }
    whole = {
        "format": "aaresolve-shot", "version": 1, "name": "a \u00e4", "resolution": [1920, 1080], "fps": 59.94,
        "jitter": {"sequence": "halton23", "start": 1, "period": 16, "projection": "premultiplied", "of": "us"},
        "static": False, "subsamples": {"pattern": "own", "positions": [[0.25, 0.25]], "more": 1},
        "objects": {"1": "left", "4294967295": "right"},
        "truth": {"samples_per_half": 256, "filter": "box", "filter_width": 1, "halves": 2, "exact": True},
        "frames": [
            frame | {"reset": True, "camera": _CAMERA | {"lens": 50}, "render_seconds": {"color": 1.5}, "more": {}},
            frame | {"frame": 4, "truth": None, "camera": _CAMERA | {"kind": "orthographic"}},
        ],
        "producer": {"name": "anyone"},
    }  # fmt: skip
    keep("manifest", "whole.json", whole)
    keep("notes", "notes.json", {"jitter": whole["jitter"], "frames": whole["frames"]})
    for name, change in (
        ("format", {"format": "other"}),
        ("version", {"version": 2}),
        ("resolution", {"resolution": [1920]}),
        ("size", {"resolution": [1920, 16385]}),
        ("fps", {"fps": 0}),
        ("none", {"frames": []}),
        ("twice", {"frames": [frame, frame]}),
        ("order", {"frames": [frame, frame | {"frame": -4}]}),
        ("path", {"frames": [frame | {"file": "../1.exr"}]}),
        ("id", {"objects": {"4294967296": ""}}),
        ("jitter", {"frames": [frame | {"jitter": [0.6, 0]}]}),
        ("no-jitter", {"frames": [{k: v for k, v in frame.items() if k != "jitter"}]}),
        ("projection", {"jitter": {"sequence": "none", "projection": "other"}}),
        ("camera", {"frames": [frame | {"camera": _CAMERA | {"kind": "fisheye"}}]}),
        ("positions", {"subsamples": {"pattern": "own", "positions": [[0, 0]] * 300}}),
        ("huge", {"version": 2**64 - 1}),
        ("types", {"static": "no"}),
        ("text", {"name": 5}),
        ("number", {"frames": [frame | {"jitter": ["a", 0]}]}),
        ("object", {"truth": []}),
        ("array", {"frames": {}}),
    ):
        keep("manifest", f"bad-{name}.json", whole | change)
    keep("notes", "bad-twice.json", {"frames": [frame, frame]})
    keep("manifest", "bad-text.json", '{"format": "aaresolve-shot",\n "version": }')
    keep("manifest", "bad-deep.json", "[" * 100 + "]" * 100)
    keep("manifest", "bad-number.json", '{"fps": 1e999}')


def _write_survey(keep: Keep) -> None:
    """Answers to the questions of targets.cpp, and a page of them."""
    given = [{"ranks": {"aa": 1, "bb": 2}}, {"better": "aa"}, {"ratings": {"aa": 4, "bb": 5}}]
    answers = [
        {"question": f"q{i + 1}", "shown": ["aa", "bb"], "seconds": 1.5, **own}
        for i, own in enumerate(given)
    ]
    whole = {"format": "aaresolve-survey-answers", "version": 1, "survey": "s1", "participant": "p"}
    keep("answers", "answers.json", whole | {"answers": answers, "remarks": "none"})
    for name, change in (
        ("survey", {"survey": "s2"}),
        ("participant", {"participant": ""}),
        ("question", {"answers": [answers[0] | {"question": "q9"}]}),
        ("twice", {"answers": [answers[0], answers[0]]}),
        ("missing", {"answers": answers[:2]}),
        ("rank", {"answers": [answers[0] | {"ranks": {"aa": 1, "bb": 1}}]}),
        ("no-rank", {"answers": [answers[0] | {"ranks": {"aa": 1}}]}),
        ("other", {"answers": [answers[0] | {"ranks": {"cc": 1}}]}),
        ("better", {"answers": [answers[1] | {"better": "cc"}]}),
        ("rating", {"answers": [answers[2] | {"ratings": {"aa": 9, "bb": 5}}]}),
        ("shown", {"answers": [answers[0] | {"shown": ["aa", "aa"]}]}),
        ("shown-other", {"answers": [answers[0] | {"shown": ["cc"]}]}),
        ("seconds", {"answers": [answers[0] | {"seconds": "long"}]}),
        ("list", {"answers": {}}),
        ("text", {"participant": 5}),
    ):
        keep("answers", f"bad-{name}.json", whole | {"answers": answers} | change)
    keep("answers", "bad-object.json", "[]")
    page = {"survey": "s1", "images": {"aa": ["data:image/png;base64,AA=="], "bb": []}}
    keep("page", "page.html", f'<script id="data">{json.dumps(page)}</script>')
    keep("page", "other.html", '<script id="data">{"survey": "s2"}</script>')
    keep("page", "none.html", "<p>nothing</p>")
    picture = {"code": "aa", "method": "noaa", "shown": {"psnr": 30}, "run": {"psnr": "Inf"}}
    question = {
        "id": "q1", "kind": "pair", "text": "", "run": "run", "shot": "s", "frames": [1, -2], "region": [0, 0, 8, 6],
        "zoom": 1, "framesPerSecond": 8, "pictures": [picture, picture | {"code": "bb"}],
    }  # fmt: skip
    key = {
        "format": "aaresolve-survey-key",
        "version": 1,
        "survey": "s1",
        "title": "t",
        "program": "1",
    }
    for name, change in (
        ("kind", {"kind": "duel"}),
        ("region", {"region": [0, 0, 8]}),
        ("one", {"pictures": [picture]}),
        ("zoom", {"zoom": 0}),
        ("figure", {"pictures": [picture, picture | {"run": {"psnr": "large"}}]}),
        ("figures", {"pictures": [picture, picture | {"run": 3}]}),
    ):
        keep("key", f"bad-{name}.json", key | {"questions": [question | change]})
    keep("key", "bad-empty.json", key | {"questions": []})


def _write_layouts(keep: Keep) -> None:
    color = {"files": "color/{frame}.exr", "part": "one", "channels": ["x.R", "x.G", "x.B"]}
    depth = {
        "files": "z_{frame}.exr",
        "channels": ["R"],
        "kind": "reversed",
        "near": 0.1,
        "far": 100,
    }
    motion = {
        "files": "v_{frame}.exr", "units": "uv", "means": "previous-current", "y": "down", "jittered": False,
    }  # fmt: skip
    normal = {"files": "n_{frame}.exr", "space": "view", "encoding": "unsigned"}
    jitter = {
        "sequence": "halton23", "units": "ndc", "y": "up", "of": "image", "offsets": [[0, 0.0025], [-0.01, 0]],
    }  # fmt: skip
    whole = {
        "format": "aaresolve-frames", "version": 1, "name": "street", "fps": 60, "static": True,
        "passes": {"color": color, "depth": depth, "motion": motion, "normal": normal},
        "centre": {"color": color}, "jitter": jitter,
        "truth": {"a": {"files": "a_{frame}.exr"}, "filter": "box", "filter_width": 1, "samples_per_half": 64},
        "frames": [{"frame": 1, "jitter": [0.1, 0.2], "camera": _CAMERA, "reset": True}],
    }  # fmt: skip
    keep("layout", "layout.json", whole)
    planar = {"files": "z_{frame}.exr", "kind": "planar", "scale": 0.01, "background": 1e9}
    keep(
        "layout",
        "planar.json",
        {**whole, "passes": {"color": color, "depth": planar}, "jitter": None},
    )

    def bad(name: str, change: dict) -> None:
        keep("layout", f"bad-{name}.json", whole | change)

    def bad_pass(name: str, which: str, change: dict) -> None:
        bad(name, {"passes": whole["passes"] | {which: whole["passes"][which] | change}})

    bad("format", {"format": "other"})
    bad("version", {"version": 2})
    bad("fps", {"fps": -1})
    bad("member", {"pases": {}})
    bad("passes", {"passes": 3})
    bad("static", {"static": "yes"})
    bad("name", {"name": 3})
    bad("centre", {"centre": {"color": color, "motion": motion}})
    bad("truth", {"truth": {}})
    bad("samples", {"truth": {"a": {"files": "a_{frame}.exr"}, "samples_per_half": 1e300}})
    bad("offsets", {"jitter": jitter | {"offsets": []}})
    bad("offset", {"jitter": jitter | {"offsets": [[1]]}})
    bad("far-offset", {"jitter": jitter | {"offsets": [[1, 1]]}})
    bad("units", {"jitter": jitter | {"units": "inches"}})
    bad_pass("files", "color", {"files": "color.exr"})
    bad_pass("below", "color", {"files": "../{frame}.exr"})
    bad_pass("channels", "color", {"channels": ["R"]})
    bad_pass("channel", "color", {"channels": ["R", "G", 3]})
    bad_pass("near", "depth", {"near": 0})
    bad_pass("far", "depth", {"far": 0.01})
    bad_pass("scale", "depth", {"scale": 2})
    bad_pass("background", "depth", {"background": 2})
    bad_pass("planes", "depth", {"kind": "planar"})
    bad_pass("kind", "depth", {"kind": None})
    bad_pass("number", "depth", {"near": "close"})


def _png(width: int, height: int, *chunks: tuple[bytes, bytes], rows: bytes | None = None) -> bytes:
    """Grey, 8 bits; `chunks` between header and pixels."""
    packed = zlib.compress(b"\0" + bytes(width) if rows is None else rows)
    return pictures.png(width, height, 1, packed, chunks)


def write_pictures(keep: Keep, scratch: Path) -> None:
    """PNGs that lie turned or are damaged, and EXRs whose headers are wrong, each in a way of its own."""
    for name, start, entry in (("little", b"II*\0", "<IHHHIHH"), ("big", b"MM\0*", ">IHHHIHH")):
        exif = start + struct.pack(entry, 8, 1, 0x0112, 3, 1, 6, 0)
        keep("png", f"turned-{name}.png", _png(5, 1, (b"eXIf", exif)))
    keep("png", "odd.png", _png(5, 1, (b"eXIf", b"II*\0" + bytes(20))))
    keep("png", "bad-cut.png", _png(5, 3)[:-30])
    long = _png(5, 1, (b"eXIf", b"MM\0*"))
    at = long.index(b"eXIf") - 4
    keep("png", "bad-long.png", long[:at] + struct.pack(">I", 0x60000000) + long[at + 4 :])
    keep("png", "bad-rows.png", _png(5, 3))
    keep("png", "bad-large.png", _png(16385, 1))
    keep("png", "bad-huge.png", _png(16384, 16384))
    keep("png", "bad-header.png", _png(0, 1))
    rgb = {c: [0.5] * 6 for c in "RGB"}
    exr.write(scratch, 3, 2, rgb, {"about": "x"})
    whole = scratch.read_bytes()

    def changed(after: bytes, content: bytes) -> bytes:
        at = whole.index(after) + len(after)
        return whole[:at] + content + whole[at + len(content) :]

    window, attribute = b"dataWindow\0box2i\0\x10\0\0\0", b"about\0string\0"
    for name, content in (
        ("cut", whole[:-20]),
        ("magic", b"abcd" + whole[4:]),
        ("header", whole[:60]),
        ("wide", changed(window, struct.pack("<iiii", 0, 0, 20000, 1))),
        ("huge", changed(window, struct.pack("<iiii", 0, 0, 16383, 16383))),
        ("empty", changed(window, struct.pack("<iiii", 0, 0, -1, -1))),
        ("attribute", changed(attribute, struct.pack("<i", 0x7FFFFFF0))),
        ("negative", changed(attribute, struct.pack("<i", -5))),
        ("name", whole[:8] + b"x" * 300 + whole[8:]),
        ("sampled", changed(b"R\0\2\0\0\0\0\0\0\0", struct.pack("<ii", 3, 2))),
    ):
        for target in ("parts", "picture"):
            keep(target, f"bad-{name}.exr", content)
    compression = b"compression\0compression\0\1\0\0\0"
    header = whole.index(b"x\0", whole.index(b"about")) + 2
    rows_of_block = {3: 16, 4: 32, 5: 16, 6: 32, 7: 32, 8: 32, 9: 256, 10: 1}  # the last is no kind
    for number, rows in rows_of_block.items():
        # The table of the blocks is there, they are not: each kind unpacks so far and no further.
        last = min(500 * rows, 16384) - 1
        huge = changed(window, struct.pack("<iiii", 0, 0, 16383, last))[:header]
        at = huge.index(compression) + len(compression)
        table = bytes(8 * (last // rows + 1) + 64)
        keep(
            "parts", f"bad-huge-{number}.exr", huge[:at] + bytes([number]) + huge[at + 1 :] + table
        )
    for name, kind, content in (
        ("texts", "stringvector", b"\1\0\0\0a\2\0\0\0bc"),
        ("bad-texts", "stringvector", b"\xff\xff\xff\x7fa"),
        ("preview", "preview", struct.pack("<II", 2, 1) + bytes(8)),
        ("bad-preview", "preview", struct.pack("<II", 1 << 16, 1 << 16) + bytes(8)),
    ):
        exr.write(scratch, 3, 2, rgb, {}, exr.attribute("views", kind, content))
        keep("parts", f"{name}.exr", scratch.read_bytes())
    _write_layers(keep, scratch)


def _write_layers(keep: Keep, scratch: Path) -> None:
    """Pictures of several layers, of which one is meant, or none that could be told."""
    values = [0.25 * i for i in range(6)]

    def layer(prefix: str, letters: str = "RGB") -> dict[str, list[float]]:
        return {f"{prefix}{letter}": values for letter in letters}

    for name, channels in (
        ("plain", layer("", "RGBA") | layer("AO.", "Z")),
        ("combined", layer("View.Combined.", "RGBA") | layer("View.AO.")),
        ("only", layer("View.Noise.") | layer("View.Depth.", "Z")),
        ("single", layer("", "Y")),
        ("pair", layer("View.Depth.", "ZA")),
        ("bad-several", layer("A.") | layer("B.")),
        ("bad-none", layer("A.", "Z") | layer("B.", "Z")),
    ):
        exr.write(scratch, 3, 2, channels, {})
        keep("picture", f"{name}.exr", scratch.read_bytes())


def write_blender_frames(keep: Keep, scratch: Path) -> None:
    """OpenEXR MultiLayer as Blender writes it, in its kinds of ids, albedo, layers and views."""
    width, height = 6, 4
    ramp = [0.01 * i for i in range(width * height)]
    depth = [5.0 if i % 3 else 1e10 for i in range(width * height)]
    ids = [float(i % 3) for i in range(width * height)]

    def rgb(name: str) -> dict[str, list[float]]:
        return {f"{name}.{c}": ramp for c in "RGB"}

    def frame(
        name: str,
        passes: dict[str, list[float]],
        texts: dict[str, str] = {},
        layer: str = "ViewLayer",
    ) -> None:
        channels = {f"{layer}.{key}": values for key, values in (rgb("Combined") | passes).items()}
        exr.write(
            scratch,
            width,
            height,
            channels,
            {"Frame": "1", "cycles.ViewLayer.samples": "16"} | texts,
        )
        keep("blender", f"{name}.exr", scratch.read_bytes())

    surface = {
        "Depth.Z": depth,
        **{f"Normal.{c}": ramp for c in "XYZ"},
        **{f"Vector.{c}": ramp for c in "XYZW"},
    }
    frame(
        "index", surface | {"IndexOB.X": ids} | rgb("Denoising Albedo") | rgb("Emit") | rgb("Env")
    )
    frame("colours", surface | rgb("DiffCol") | rgb("GlossCol") | rgb("TransCol"))
    frame("zero", surface | {"IndexOB.X": [0.0] * len(ids)})
    frame("flat", {"IndexOB.X": ids})
    crypto = {f"CryptoObject00.{c}": ramp for c in "RGBA"}
    about = {"cryptomatte/1/name": "ViewLayer.CryptoObject", "cryptomatte/1/hash": "MurmurHash3_32"}
    frame(
        "cryptomatte",
        surface | crypto,
        about | {"cryptomatte/1/manifest": '{"Cube":"3f800000","B":5}'},
    )
    frame(
        "quote",
        surface | crypto,
        about | {"cryptomatte/1/manifest": '{"a"b":"3f800000","C":"0000000g"}'},
    )
    frame("no-list", surface | crypto, about)
    frame("view", {"Depth.V": depth, "Object Index.X": ids}, layer="A.Normal")
    frame("bad-fraction", surface | {"IndexOB.X": ramp})
    for name, channels in (
        ("bad-layers", rgb("A.Combined") | rgb("B.Combined")),
        ("bad-views", rgb("A.Combined.left") | rgb("A.Combined.right")),
        ("bad-plain", rgb("x")),
        ("bad-colour", {"A.Depth.Z": depth}),
    ):
        exr.write(scratch, width, height, channels, {})
        keep("blender", f"{name}.exr", scratch.read_bytes())
