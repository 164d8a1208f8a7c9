# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel holds: one property per option of the command line, one switch per method."""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    StringProperty,
)

from .. import jitter, registry


def method_property(identity: str) -> str:
    """Name of the property that chooses a method."""
    return f"method_{identity}"


def _tooltip(method: dict) -> str:
    parameters = "; ".join(
        f"{item['name']} = {item['default']}: {item.get('help', '')}"
        for item in method["parameters"]
    )
    text = method.get("summary") or method["title"]
    text += f"\nReads: {', '.join(method['passes'])}"
    if method.get("source"):
        text += f"\nSource: {method['source']}"
    return text + (f"\nParameters: {parameters}" if parameters else "")


class AAResolveSettings(bpy.types.PropertyGroup):
    """What the panel shows; kept in the scene."""

    out: StringProperty(
        name="Shot",
        description="Folder of the shot; an interrupted export resumes there",
        subtype="DIR_PATH",
        default="//shot",
    )
    use_scene_range: BoolProperty(
        name="Scene Range", description="Export the scene's frame range", default=False
    )
    first: IntProperty(name="First", description="First frame", default=1)
    last: IntProperty(name="Last", description="Last frame", default=16)
    use_resolution: BoolProperty(
        name="Own Size", description="Export at another size than the scene's", default=False
    )
    resolution: IntVectorProperty(
        name="Resolution",
        description="Width and height, pixels",
        size=2,
        default=(480, 270),
        min=4,
        max=65536,
    )
    samples: IntProperty(
        name="Shading Samples",
        description="Samples per pixel, all at one point: geometry stays aliased, shading noise is averaged",
        default=1,
        min=1,
        max=65536,
    )
    truth_samples: IntProperty(
        name="Truth Samples",
        description="Samples per pixel in each of the two halves of the ground truth",
        default=256,
        min=1,
        max=1048576,
    )
    truth: EnumProperty(
        name="Truth",
        description="Which frames get ground truth; a shot at rest needs one for all its frames",
        items=(
            ("ALL", "All", "Truth for every frame"),
            ("ENDS", "Three", "Truth for the first, the middle and the last frame"),
            ("NONE", "None", "No ground truth: nothing can be measured"),
        ),
        default="ENDS",
    )
    jitter: EnumProperty(
        name="Jitter",
        description="Where in the pixel each frame is sampled",
        items=[(name, name, text) for name, text in jitter.SEQUENCES.items()],
        default="halton23",
    )
    period: IntProperty(
        name="Period",
        description="Frames after which the jitter repeats",
        default=16,
        min=1,
        max=1048576,
    )
    pattern: EnumProperty(
        name="Sub-samples",
        description="Pattern of the geometry within a pixel, for methods that read it",
        items=[
            ("AUTO", "Automatic", "The pattern that serves all chosen methods, else 8 points"),
            *(
                (name, name.upper(), f"{len(jitter.pattern_positions(name))} points per pixel")
                for name in jitter.D3D_PATTERNS[1:]
            ),
        ],
        default="AUTO",
    )
    lighting: EnumProperty(
        name="Light",
        description="Light of colour and truth alike",
        items=(
            (
                "noise-free",
                "No Noise",
                "Lights without size, ambient in place of the world's light, no bounces",
            ),
            ("as-is", "As It Is", "The scene's own light; noise has to be averaged by samples"),
        ),
        default="noise-free",
    )
    use_ambient: BoolProperty(
        name="Own Ambient",
        description="Set the ambient instead of taking the mean of the world",
        default=False,
    )
    ambient: FloatVectorProperty(
        name="Ambient",
        description="Ambient radiance, linear",
        subtype="COLOR",
        size=3,
        min=0.0,
        soft_max=1.0,
        default=(0.2, 0.2, 0.2),
    )
    color_type: EnumProperty(
        name="Colour",
        description="Type of colour in the files",
        items=(
            ("float", "Float", "32 bits"),
            ("half", "Half", "16 bits: smaller, error up to 2.4e-4"),
        ),
        default="float",
    )
    overwrite: BoolProperty(
        name="Replace Old",
        description="Replace an export with other settings",
        default=False,
    )

    def chosen(self) -> list[str]:
        """Ids of the methods that are ticked."""
        return [
            name for name in registry.load_methods() if getattr(self, method_property(name), False)
        ]

    def options(self, out: str) -> list[str]:
        """The command line that exports what the panel shows."""
        scene = self.id_data
        first, last = (
            (scene.frame_start, scene.frame_end)
            if self.use_scene_range
            else (self.first, self.last)
        )
        methods = self.chosen()
        choices = [registry.MethodChoice(name) for name in methods]
        options = ["--out", out, "--frames", f"{first}-{last}", "--for", ",".join(methods)]
        options += ["--samples", str(self.samples), "--truth-samples", str(self.truth_samples)]
        middle = (first + last) // 2
        truth = {"ALL": "all", "NONE": "none", "ENDS": f"{first},{middle},{last}"}[self.truth]
        options += ["--truth-frames", truth]
        if registry.required_passes(choices, "jittered"):
            options += ["--jitter", self.jitter, "--period", str(self.period)]
        options += ["--lighting", self.lighting, "--color-type", self.color_type]
        if self.use_resolution:
            options += ["--resolution", *map(str, self.resolution)]
        if self.use_ambient and self.lighting == "noise-free":
            options += ["--ambient", *(f"{value:.6g}" for value in self.ambient)]
        if self.pattern != "AUTO" and reads_subsamples(methods):
            options += ["--subsamples", self.pattern]
        if self.overwrite:
            options.append("--overwrite")
        return options


def add_method_properties() -> None:
    """One switch per method of the registry, with its description as the tooltip."""
    for name, method in registry.load_methods().items():
        AAResolveSettings.__annotations__[method_property(name)] = BoolProperty(
            name=method["title"],
            description=_tooltip(method),
            default=name in ("noaa", "taaSimplest"),
        )


def reads_subsamples(methods: list[str]) -> bool:
    """True when one of the methods reads sub-samples."""
    known = registry.load_methods()
    return any(registry.reads_subsamples(known[name]["passes"]) for name in methods)
