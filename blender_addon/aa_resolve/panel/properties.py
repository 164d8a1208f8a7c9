# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel holds: the properties that the table of options asks for (settings.py), and of every method a switch
and its parameters."""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import textwrap

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
    StringProperty,
)

from .. import compat, registry
from ..options import Option, Widget, options_of, words_of
from ..settings import Settings
from . import parameters


def method_property(identity: str) -> str:
    """Name of the property that chooses a method."""
    return f"method_{identity}"


def unfold_property(identity: str) -> str:
    """Name of the property that shows the parameters of a method."""
    return f"unfold_{identity}"


def families() -> dict[str, dict[str, dict]]:
    """Family -> the methods of it, in the registry's order."""
    found: dict[str, dict[str, dict]] = {}
    for name, method in registry.load_methods().items():
        found.setdefault(method["family"], {})[name] = method
    return found


def _tooltip(name: str, method: dict) -> str:
    lines = textwrap.wrap(method.get("summary") or method["title"], 90)
    lines.append(f"Id: {name}")
    lines.append(f"Reads: {', '.join(method['passes'])}")
    if method.get("source"):
        lines.append(f"Source: {method['source']}")
    return "\n".join(lines)


def _property(widget: Widget, default, option: Option):
    """One property of Blender's; the type of its default decides its kind."""
    more = {"name": widget.label, "description": widget.text, "default": default}
    if isinstance(default, bool):
        return BoolProperty(**more)
    if isinstance(default, str):
        items = widget.items or tuple((name, *said) for name, said in option.choices.items())
        if items:
            return EnumProperty(items=items, **more)
        options = compat.path_options() if widget.subtype.endswith("_PATH") else set()
        return StringProperty(**more, subtype=widget.subtype, options={"ANIMATABLE", *options})
    if option.span is not None:
        more["min"], more["max"] = option.span
    if isinstance(default, int):
        return IntProperty(**more)
    if isinstance(default, float):
        return FloatProperty(**more)
    if isinstance(default[0], int):
        return IntVectorProperty(size=len(default), **more)
    return FloatVectorProperty(size=len(default), subtype=widget.subtype, soft_max=1.0, **more)


def _properties() -> dict:
    """Every property of the panel by name, in the order of the options."""
    made = {}
    for field, option in options_of(Settings):
        for widget in option.panel:
            default = widget.default_for(field)
            made[widget.name or field.name] = _property(widget, default, option)
    for name, method in registry.load_methods().items():
        made[method_property(name)] = BoolProperty(
            name=method["title"],
            description=_tooltip(name, method),
            default=name in ("noaa", "taaSimplest"),
        )
    for name in parameters.GROUPS:
        made[parameters.text_property(name)] = StringProperty(
            name=f"Parameters of {name}", description="What differs from the defaults"
        )
    return made


def _views() -> dict:
    """Properties that show something and decide nothing: the widgets over the texts, and what is unfolded."""
    made = {}
    for name, group in parameters.GROUPS.items():
        made[parameters.widgets_property(name)] = PointerProperty(type=group)
        made[unfold_property(name)] = BoolProperty(
            name="Parameters",
            description="Show the parameters of this method",
            options={"SKIP_SAVE"},
        )
    return made


STORED = _properties()  # what a scene, a preset and an export's command line are made from


class AAResolveSettings(bpy.types.PropertyGroup):
    """What the panel shows; kept in the scene."""

    __annotations__ = {**STORED, **_views()}

    def chosen(self) -> list[str]:
        """Ids of the methods that are ticked."""
        return [
            name for name in registry.load_methods() if getattr(self, method_property(name), False)
        ]

    def changed_parameters(self, method: str) -> dict[str, str]:
        """Parameters of a method that differ from their defaults and have an effect."""
        if method not in parameters.GROUPS:
            return {}
        return parameters.effective(method, getattr(self, parameters.text_property(method)))

    def choices(self) -> list[registry.MethodChoice]:
        """The methods that are ticked, with their parameters."""
        return [
            registry.MethodChoice(name, self.changed_parameters(name)) for name in self.chosen()
        ]

    def method_texts(self) -> list[str]:
        """The methods that are ticked as the command lines of exporter and resolver name them."""
        texts = []
        for choice in self.choices():
            said = parameters.write(choice.parameters)
            texts.append(f"{choice.id}:{said}" if said else choice.id)
        return texts

    def range(self) -> tuple[int, int, int]:
        """First and last frame, and the step between two of them."""
        scene = self.id_data
        if self.use_scene_range:
            return scene.frame_start, scene.frame_end, scene.frame_step
        return self.first, self.last, 1

    def reads_jittered_frames(self) -> bool:
        """True when a chosen method accumulates frames."""
        return bool(registry.required_passes(self.choices(), "jittered"))

    def reads_subsamples(self) -> bool:
        """True when a chosen method reads sub-samples."""
        known = registry.load_methods()
        return any(registry.reads_subsamples(known[name]["passes"]) for name in self.chosen())

    def applies(self, name: str) -> bool:
        """True when an option has an effect with what is chosen."""
        return any(
            field.name == name and known.applies(self) for field, known in options_of(Settings)
        )

    def options(self, out: str, **given: list[str]) -> list[str]:
        """The command line that exports what the panel shows; ``given`` words replace those of some options."""
        words = {"out": [out], "methods": [",".join(self.method_texts())], **given}
        return words_of(Settings, self, **words)
