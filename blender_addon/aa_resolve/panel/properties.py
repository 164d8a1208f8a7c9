# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel holds: the properties that the table of options asks for (settings.py), and one switch per method."""

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

from .. import registry
from ..options import Option, Widget, options_of, words_of
from ..settings import Settings


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


def _property(widget: Widget, default, option: Option):
    """One property of Blender's; the type of its default decides its kind."""
    more = {"name": widget.label, "description": widget.text, "default": default}
    if isinstance(default, bool):
        return BoolProperty(**more)
    if isinstance(default, str):
        items = widget.items or tuple((name, *said) for name, said in option.choices.items())
        return (
            EnumProperty(items=items, **more)
            if items
            else StringProperty(**more, subtype=widget.subtype)
        )
    if option.span is not None:
        more["min"], more["max"] = option.span
    if isinstance(default, int):
        return IntProperty(**more)
    if isinstance(default[0], int):
        return IntVectorProperty(size=len(default), **more)
    return FloatVectorProperty(
        size=len(default), subtype=widget.subtype, min=0.0, soft_max=1.0, **more
    )


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
            description=_tooltip(method),
            default=name in ("noaa", "taaSimplest"),
        )
    return made


class AAResolveSettings(bpy.types.PropertyGroup):
    """What the panel shows; kept in the scene."""

    __annotations__ = _properties()

    def chosen(self) -> list[str]:
        """Ids of the methods that are ticked."""
        return [
            name for name in registry.load_methods() if getattr(self, method_property(name), False)
        ]

    def range(self) -> tuple[int, int]:
        """First and last frame."""
        scene = self.id_data
        if self.use_scene_range:
            return scene.frame_start, scene.frame_end
        return self.first, self.last

    def reads_jittered_frames(self) -> bool:
        """True when a chosen method accumulates frames."""
        choices = [registry.MethodChoice(name) for name in self.chosen()]
        return bool(registry.required_passes(choices, "jittered"))

    def reads_subsamples(self) -> bool:
        """True when a chosen method reads sub-samples."""
        known = registry.load_methods()
        return any(registry.reads_subsamples(known[name]["passes"]) for name in self.chosen())

    def applies(self, name: str) -> bool:
        """True when an option has an effect with what is chosen."""
        return any(
            field.name == name and known.applies(self) for field, known in options_of(Settings)
        )

    def options(self, out: str) -> list[str]:
        """The command line that exports what the panel shows."""
        return words_of(Settings, self, out=[out])
