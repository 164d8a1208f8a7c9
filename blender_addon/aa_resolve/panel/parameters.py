# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of the methods as widgets of the panel, from the registry's table.

A scene keeps one text per method, ``alpha=0.1,box=variance``, which holds what differs from the default and nothing
else. The widgets read and write that text. Blender would keep a choice by its number, and a table of another version
may count otherwise; names stay what they were, and one that is no longer known is left out."""

# No postponed annotations here: Blender reads the properties of a class from its annotations.
import textwrap

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import registry


def text_property(method: str) -> str:
    """Name of the property that holds the text of a method's parameters."""
    return f"parameters_{method}"


def widgets_property(method: str) -> str:
    """Name of the property that holds the widgets of a method's parameters."""
    return f"widgets_{method}"


def widget_name(parameter: str) -> str:
    """Name of the widget of one parameter; Blender keeps words such as ``values`` and ``name`` for itself."""
    return f"set_{parameter}"


def table_of(method: str) -> dict[str, dict]:
    """The parameters of a method by name."""
    return {item["name"]: item for item in registry.load_methods()[method]["parameters"]}


def number_text(value: float) -> str:
    """A number as people write it, without the noise of single precision and without an exponent."""
    text = f"{value:.6g}"
    return f"{value:.10f}".rstrip("0").rstrip(".") if "e" in text else text


def default_text(item: dict) -> str:
    """The default of a parameter as a text."""
    return item["default"] if isinstance(item["default"], str) else number_text(item["default"])


def read(method: str, text: str) -> dict[str, str]:
    """The changed parameters of a text, in the table's order; what the table does not know is left out."""
    table = table_of(method)
    said = dict(part.partition("=")[::2] for part in text.split(",") if "=" in part)
    return {
        name: said[name]
        for name, item in table.items()
        if name in said
        and registry.is_known_value(item, said[name])
        and said[name] != default_text(item)
    }


def write(values: dict[str, str]) -> str:
    """The text that ``read`` reads."""
    return ",".join(f"{name}={value}" for name, value in values.items())


def has_effect(item: dict, values: dict[str, str], table: dict[str, dict]) -> bool:
    """False where another parameter switches this one off; the resolver refuses it then."""
    name, _, wanted = item.get("onlyWhen", "").partition("=")
    return not name or values.get(name, default_text(table[name])) in wanted.split("|")


def effective(method: str, text: str) -> dict[str, str]:
    """The changed parameters that have an effect."""
    table, values = table_of(method), read(method, text)
    return {name: value for name, value in values.items() if has_effect(table[name], values, table)}


def tooltip(item: dict) -> str:
    """What a parameter does, its range and default; each on a line of its own that fits on a screen."""
    lines = [item.get("help", "")]
    if "min" in item:
        lines.append(f"From {number_text(item['min'])} to {number_text(item['max'])}")
    lines.append(f"Default: {default_text(item)}")
    if "onlyWhen" in item:
        lines.append(f"Only with {item['onlyWhen'].replace('|', ' or ')}")
    if item.get("source"):
        lines.append(f"Source: {item['source']}")
    return "\n".join(part for line in lines for part in textwrap.wrap(line, 90))


class _Widgets:
    """What the groups of widgets share: the text behind them."""

    method = ""

    def values(self) -> dict[str, str]:
        """The changed parameters."""
        return read(self.method, getattr(self.id_data.aa_resolve, text_property(self.method)))

    def value(self, item: dict) -> str:
        """The present value of one parameter."""
        return self.values().get(item["name"], default_text(item))

    def put(self, item: dict, value: str) -> None:
        """Changes one parameter; its default takes it out of the text."""
        values = {**self.values(), item["name"]: value}
        text = write(read(self.method, write(values)))
        setattr(self.id_data.aa_resolve, text_property(self.method), text)


def _widget(item: dict):
    """The property that shows one parameter."""
    more = {"name": item["name"], "description": tooltip(item)}
    if item["type"] == "flag":
        return BoolProperty(
            default=item["default"] == "on",
            get=lambda group: group.value(item) == "on",
            set=lambda group, value: group.put(item, "on" if value else "off"),
            **more,
        )
    if "choices" in item:
        choices = item["choices"]
        return EnumProperty(
            items=[(name, name, "", number) for number, name in enumerate(choices)],
            default=item["default"],
            get=lambda group: choices.index(group.value(item)),
            set=lambda group, number: group.put(item, choices[number]),
            **more,
        )
    if item["type"] == "integer":
        return IntProperty(
            min=int(item["min"]),
            max=int(item["max"]),
            default=round(item["default"]),
            get=lambda group: round(float(group.value(item))),
            set=lambda group, value: group.put(item, number_text(value)),
            **more,
        )
    return FloatProperty(
        min=item["min"],
        max=item["max"],
        precision=4,
        get=lambda group: float(group.value(item)),
        set=lambda group, value: group.put(item, number_text(value)),
        **more,
    )


def _group(method: str) -> type:
    return type(
        f"AAResolveWidgets_{method}",
        (_Widgets, bpy.types.PropertyGroup),
        {
            "__annotations__": {
                widget_name(name): _widget(item) for name, item in table_of(method).items()
            },
            "method": method,
        },
    )


GROUPS = {
    name: _group(name) for name, known in registry.load_methods().items() if known["parameters"]
}


class AA_RESOLVE_OT_reset_parameters(bpy.types.Operator):
    """Set this parameter, or all of the method, back to the default"""

    bl_idname = "aa_resolve.reset_parameters"
    bl_label = "Reset"
    bl_options = {"UNDO", "INTERNAL"}

    method: StringProperty()
    parameter: StringProperty(description="Empty: all of them")

    def execute(self, context):
        settings = context.scene.aa_resolve
        values = read(self.method, getattr(settings, text_property(self.method)))
        values.pop(self.parameter, None)
        left = write(values) if self.parameter else ""
        setattr(settings, text_property(self.method), left)
        return {"FINISHED"}
