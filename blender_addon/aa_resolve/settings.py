# SPDX-License-Identifier: GPL-3.0-or-later
"""What an export is asked to do: the table of options, and the fingerprint by which a changed wish is noticed.

Each option is declared once, here. Flags, properties of the panel and the command line of its job follow (options.py).
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field

from . import exr, jitter, registry
from .options import Widget, option, options_of, real_number, size, whole_number

_DEFAULT_SEQUENCE = "halton23"
_SEQUENCES = "; ".join(f"{name}: {text}" for name, text in jitter.SEQUENCES.items())
_SEQUENCE_ITEMS = tuple((name, name, text) for name, text in jitter.SEQUENCES.items())
_PATTERNS = ", ".join(jitter.D3D_PATTERNS)
_DEFAULT_PATTERN = "d3d8"
_AUTOMATIC = "AUTO"
_PATTERN_ITEMS = (
    (_AUTOMATIC, "Automatic", "The pattern that serves all chosen methods, else 8 points"),
    *(
        (name, name.upper(), f"{len(jitter.pattern_positions(name))} points per pixel")
        for name in jitter.D3D_PATTERNS[1:]
    ),
)
_TRUTH_ITEMS = (
    ("ALL", "All", "Truth for every frame"),
    ("ENDS", "Three", "Truth for the first, the middle and the last frame"),
    ("NONE", "None", "No ground truth: nothing can be measured"),
)


def _frame_words(panel) -> list[str]:
    first, last, step = panel.range()
    if step == 1:
        return [f"{first}-{last}"]
    return [",".join(map(str, range(first, last + 1, step)))]


def _truth_words(panel) -> list[str]:
    first, last, step = panel.range()
    steps = (last - first) // step
    ends = f"{first},{first + steps // 2 * step},{first + steps * step}"
    return [{"ALL": "all", "NONE": "none", "ENDS": ends}[panel.truth]]


@dataclass
class Settings:
    """One export. Sizes in pixels, jitter in pixels with y down, colours linear BT.709."""

    out: str = option(
        "--out",
        "folder of the shot; an interrupted export resumes there",
        metavar="SHOT",
        decides_content=False,
        panel=(
            Widget(
                "Shot",
                "Folder of the shot; an interrupted export resumes there",
                "//shot",
                subtype="DIR_PATH",
            ),
        ),
        group="What to export",
    )
    frames: list[int] = option(
        "--frames",
        "frames, e.g. 1-16 or 1,4,8 (default: the scene's range and step, after an estimate of their time and size)",
        metavar="LIST",
        unsaid=None,
        panel=(
            Widget(
                "Scene Range",
                "Export the scene's frame range, in its steps",
                False,
                name="use_scene_range",
            ),
            Widget("First", "First frame", 1, name="first"),
            Widget("Last", "Last frame", 16, name="last"),
        ),
        label="Frames",
        words=_frame_words,
        decides_content=False,  # beyond the first one
        group="What to export",
    )
    methods: list[str] = option(
        "--for",
        "methods the shot must serve, as `aaresolve run -m` names them, e.g. noaa,spatial,karis:box=variance; decides the "
        "passes. "
        "S=8 behind one that reads sub-samples asks for 8 of them: rsaa:S=8 (default: noaa)",
        metavar="METHODS",
        unsaid=[],
        repeated=True,
        decides_content=False,  # beyond the passes
        words=lambda panel: [",".join(panel.chosen())],
        group="What to export",
    )
    passes: list[str] = option(  # of the jittered frames
        "--passes",
        f"passes to write in addition to those of --for, of {', '.join(registry.load_passes())}; a shot keeps those "
        "that it has",
        metavar="LIST",
        unsaid="",
        decides_content=False,  # each stands in a part of its own
        group="What to export",
    )
    # Of the same instants at the pixel centres.
    centre_passes: list[str] = field(default_factory=list)
    # Where the jitter begins; None: with the first of the frames.
    origin: int | None = None
    # What the shot that is added to was begun as: one that moves (True) or one at rest, and then its frames, and whether
    # they share a truth.
    moves: bool = False
    rested: list[int] = field(default_factory=list)
    rested_with_truth: bool = False
    scene: str = ""  # name of the scene in its file; of a shot that does not name its own, empty
    resolution: tuple[int, int] | None = option(
        "--resolution",
        "pixels, e.g. 480x270 (default: the scene's)",
        default=None,
        metavar="WxH",
        number=size,
        span=(4, 65536),  # Blender's own limits
        panel=(
            Widget(
                "Own Size", "Export at another size than the scene's", False, name="use_resolution"
            ),
            Widget("Resolution", "Width and height, pixels", (480, 270)),
        ),
        label="Resolution",
        none="the scene's",
        words=lambda panel: ["{}x{}".format(*panel.resolution)] if panel.use_resolution else None,
        group="What to export",
    )
    samples: int = option(
        "--samples",
        "shading samples per pixel, all at one point: geometry stays aliased (default %(default)s)",
        default=1,
        metavar="N",
        number=whole_number,
        span=(1, 1 << 16),
        panel=(
            Widget(
                "Shading Samples",
                "Samples per pixel, all at one point: geometry stays aliased, shading noise is averaged",
            ),
        ),
        group="Samples and truth",
    )
    truth_samples: int = option(
        "--truth-samples",
        "samples per pixel and half of the truth (%(default)s); more than a shot has: its truth is rendered anew",
        default=256,
        decides_content=False,  # the truth has files of its own
        metavar="N",
        number=whole_number,
        span=(1, 1 << 20),
        panel=(
            Widget(
                "Truth Samples",
                "Samples per pixel in each of the two halves of the ground truth",
            ),
        ),
        group="Samples and truth",
    )
    truth_frames: list[int] = option(
        "--truth-frames",
        "frames with ground truth: all, none or e.g. 1,8,16 (%(default)s); a static shot has one for all frames",
        default="all",  # of the flag; here always the frames
        metavar="LIST",
        decides_content=False,
        panel=(
            Widget(
                "Truth",
                "Which frames get ground truth; a shot at rest needs one for all its frames",
                "ENDS",
                name="truth",
                items=_TRUTH_ITEMS,
            ),
        ),
        words=_truth_words,
        group="Samples and truth",
    )
    jitter: str = option(
        "--jitter",
        f"default {_DEFAULT_SEQUENCE}, or none where no method of --for accumulates frames. {_SEQUENCES}",
        default=_DEFAULT_SEQUENCE,
        metavar="SEQUENCE",
        unsaid=None,
        panel=(
            Widget(
                "Jitter",
                "Where in the pixel each frame is sampled",
                items=_SEQUENCE_ITEMS,
            ),
        ),
        applies=lambda panel: panel.reads_jittered_frames(),
        group="Jitter and sub-samples",
    )
    period: int = option(
        "--period",
        "frames after which the jitter repeats (%(default)s)",
        default=16,
        metavar="N",
        number=whole_number,
        span=(1, 1 << 20),
        panel=(Widget("Period", "Frames after which the jitter repeats"),),
        applies=lambda panel: panel.reads_jittered_frames(),
        group="Jitter and sub-samples",
    )
    jitter_centred: bool = option(
        "--jitter-centred",
        "subtract the mean of one period of the jitter",
        default=False,
        group="Jitter and sub-samples",
    )
    jitter_projection: str = option(
        "--jitter-projection",
        "post: samples move by the jitter; pre: labelled variant, the error of the T2MSAA/ASAA thesis: the camera "
        "moves by (2 jx / W, -2 jy / H) scene units and the picture by jitter x focal length / depth (%(default)s)",
        default="post",
        choices=dict.fromkeys(
            ("post", "pre"), ("", "")
        ),  # pre: scene/camera.py, premultiplied_movement
        group="Jitter and sub-samples",
    )
    texture_filter: str = option(
        "--texture-filter",
        "none: textures are read at a point, as Cycles does; mip: image textures are read from mip maps at the level of "
        "the pixel's footprint, as a rasteriser does. Truth always reads them as they are (%(default)s)",
        default="none",
        choices={
            "none": ("At a Point", "Textures are read at a point, as Cycles does"),
            "mip": (
                "Mip Maps",
                "Image textures are read from mip maps at the level of the pixel's footprint, as a rasteriser does",
            ),
        },
        panel=(
            Widget("Textures", "How jittered frames read textures; truth reads them as they are"),
        ),
        group="Textures",
    )
    mip_bias: float = option(
        "--mip-bias",
        "added to the mip level; below 0 sharper, -0.25 for temporal methods [Castorina 2023] (%(default)g)",
        default=0.0,
        metavar="LEVELS",
        number=real_number,
        span=(-16.0, 16.0),
        panel=(
            Widget(
                "Mip Bias",
                "Added to the mip level; below 0 sharper, -0.25 for methods that accumulate frames",
            ),
        ),
        words=lambda panel: [f"{panel.mip_bias:.6g}"],
        applies=lambda panel: panel.texture_filter == "mip",
        group="Textures",
    )
    unjitter_textures: bool = option(
        "--unjitter-textures",
        "textures are read where the pixel's centre lies on the surface: the jitter moves edges only [Castorina 2023]",
        default=False,
        panel=(
            Widget(
                "Un-jittered Textures",
                "Textures are read where the pixel's centre lies on the surface: the jitter moves edges only",
            ),
        ),
        applies=lambda panel: panel.reads_jittered_frames() and panel.jitter != "none",
        group="Textures",
    )
    pattern: str = option(
        "--subsamples",
        f"sub-sample pattern: {_PATTERNS} or gridN, around pixel centre + jitter (default: what "
        f"serves the methods, else {_DEFAULT_PATTERN}); another one than a shot has: its sub-samples are rendered anew",
        default=_DEFAULT_PATTERN,
        decides_content=False,  # of another part than theirs
        metavar="PATTERN",
        unsaid=None,
        panel=(
            Widget(
                "Sub-samples",
                "Pattern of the geometry within a pixel, for methods that read it",
                _AUTOMATIC,
                items=_PATTERN_ITEMS,
            ),
        ),
        words=lambda panel: [panel.pattern] if panel.pattern != _AUTOMATIC else None,
        applies=lambda panel: panel.reads_subsamples(),
        group="Jitter and sub-samples",
    )
    lighting: str = option(
        "--lighting",
        "noise-free: delta lights, ambient in place of the world's light, no bounces; as-is: the scene's own light",
        default="noise-free",
        choices={
            "noise-free": (
                "No Noise",
                "Lights without size, ambient in place of the world's light, no bounces",
            ),
            "as-is": (
                "As It Is",
                "The scene's own light; noise has to be averaged by samples",
            ),
        },
        panel=(Widget("Light", "Light of colour and truth alike"),),
        group="Light",
    )
    ambient: tuple[float, float, float] | None = option(
        "--ambient",
        "ambient radiance of noise-free light, linear (default: the mean of the world, where it lights surfaces)",
        default=None,
        metavar=("R", "G", "B"),
        number=real_number,
        span=(0.0, 1.0e6),
        panel=(
            Widget(
                "Own Ambient",
                "Set the ambient instead of taking the mean of the world",
                False,
                name="use_ambient",
            ),
            Widget("Ambient", "Ambient radiance, linear", (0.2, 0.2, 0.2), subtype="COLOR"),
        ),
        label="Ambient",
        none="the world's mean",
        words=lambda panel: [f"{value:.6g}" for value in panel.ambient]
        if panel.use_ambient
        else None,
        applies=lambda panel: panel.lighting == "noise-free",
        group="Light",
    )
    color_type: str = option(
        "--color-type",
        "type of colour and albedo (%(default)s)",
        default="float",
        choices={
            "float": ("Float", "32 bits"),
            "half": ("Half", "16 bits: smaller, error up to 2.4e-4"),
        },
        panel=(Widget("Colour", "Type of colour in the files"),),
        group="Files and ids",
    )
    compression: str = option(
        "--compression",
        "of every part (%(default)s)",
        default="zip",
        choices=dict.fromkeys(exr.COMPRESSIONS, ("", "")),
        group="Files and ids",
    )
    view_layer: str | None = option(
        "--view-layer",
        "view layer to render (default: the only one in use)",
        default=None,
        none="the only one in use",
        metavar="NAME",
        panel=(Widget("Layer", "The view layer to export; empty: the only one in use", ""),),
        words=lambda panel: [panel.view_layer] if panel.view_layer else None,
        group="What to export",
    )
    instance_ids: bool = option(
        "--no-instance-ids",
        "instances share the id of their source",
        default=True,
        group="Files and ids",
    )
    name: str = option(
        "--name",
        "name of the shot (default: that of the folder)",
        default="",
        decides_content=False,
        group="What to export",
    )
    source: str = option(
        "--source",
        "identity of the scene, to notice changes (default: SHA-256 of the .blend and of the scripts that Blender's command "
        "line names before the exporter); for a script that does another thing each time",
        default="",
        metavar="HASH",
        changed="the .blend file, or a script that ran on it,",
        group="What to export",
    )
    same_scene: bool = option(
        "--same-scene",
        "add to the shot although the .blend has been saved since it was begun; for changes that no picture shows "
        "(settings of the panel, selection, view), which is yours to know",
        default=False,
        decides_content=False,
        panel=(
            Widget(
                "Same Scene",
                "Add to the shot although the file has changed since it was begun: for when what changed is seen in no "
                "picture, such as this panel's settings, the selection or the view. Nothing checks that",
            ),
        ),
        group="What to export",
    )
    overwrite: bool = option(
        "--overwrite",
        "replace an export with other settings",
        default=False,
        decides_content=False,
        panel=(Widget("Replace Old", "Replace an export with other settings"),),
        group="What to export",
    )

    def shift_and_movement(
        self, offset: tuple[float, float]
    ) -> tuple[tuple[float, float], tuple[float, float]]:
        """A frame's jitter as JitterCamera.aim takes it: what shifts the picture and what moves the camera."""
        nothing = (0.0, 0.0)
        return (nothing, offset) if self.jitter_projection == "pre" else (offset, nothing)

    @property
    def first_frame(self) -> int:
        """The frame with which the jitter begins, of a shot that is added to as of a new one."""
        return self.frames[0] if self.origin is None else self.origin

    def fingerprint(self) -> dict:
        """What decides the content of every picture: equal fingerprints, equal pixels.

        Which frames, passes and truths are wanted is no part of it: a shot takes more of them at any time. The frame
        with which the jitter begins is.
        """
        decides = {
            item.name: getattr(self, item.name)
            for item, known in options_of(Settings)
            if known.decides_content
        }
        further = {"first_frame": self.first_frame, "scene": self.scene}
        return json.loads(json.dumps({**decides, **further}))


@dataclass
class Invocation:
    """Options of one run of the command line that say nothing of the shot."""

    claim_timeout: float = option(
        "--claim-timeout",
        "after this time work claimed by a process on another machine is taken over (%(default)g)",
        default=3600.0,
        metavar="SECONDS",
        number=real_number,
        group="This run",
    )
    plan: bool = option(
        "--plan",
        "say what the shot has and what would be rendered, without rendering anything; write nothing",
        default=False,
        group="This run",
    )
    estimate: bool = option(
        "--estimate",
        "render a frame or two and a little of their truth elsewhere, say how long the export would take and how large "
        "it would be, write nothing",
        default=False,
        group="This run",
    )
    yes: bool = option(
        "--yes",
        "without --frames: export the scene's range also where that takes more than 10 minutes",
        default=False,
        group="This run",
    )
    json: bool = option(
        "--json", "progress as one JSON object per line", default=False, group="This run"
    )
