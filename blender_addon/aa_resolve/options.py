# SPDX-License-Identifier: GPL-3.0-or-later
"""What one option of the exporter is: a field of a dataclass that makes a flag of the command line, properties of the
panel, and the words by which the panel's job says them to its child process. The options themselves: settings.py."""

from __future__ import annotations

import argparse
import dataclasses
import difflib
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NoReturn

from .errors import UsageError

_SAME = object()  # without the flag the command line holds the default of the field
Span = tuple[float, float]  # least and largest value


@dataclass(frozen=True)
class Widget:
    """One property of the panel. The type of its default decides what it is: a switch, a number, a path, a choice
    where it has items, a size, a colour."""

    label: str
    text: str  # the tooltip
    default: object = _SAME
    name: str = ""  # of the property, where it is not the field's
    subtype: str = "NONE"  # Blender's
    # Value, label and tooltip of a choice, where they are not the choices of the option.
    items: tuple[tuple[str, str, str], ...] = ()

    def default_for(self, item: dataclasses.Field) -> Any:
        """Its own default, else that of the option's field."""
        return item.default if self.default is _SAME else self.default


@dataclass(frozen=True)
class Option:
    """All that is known of one option beside its type and default, which are the field's."""

    flag: str
    help: str
    metavar: str | tuple[str, ...] | None = None  # one name per value
    group: str = ""  # heading of the help under which it stands
    number: Callable[
        [str], Any
    ] | None = None  # reads a value from its text; texts as they are otherwise
    choices: Mapping[str, tuple[str, str]] = field(default_factory=dict)  # value -> label, tooltip
    span: Span | None = None  # refused outside
    unsaid: object = _SAME  # what the command line holds without the flag, if not the default
    repeated: bool = False  # the flag may come again
    decides_content: bool = True  # another value makes other files
    changed: str = ""  # how a change is named when an export resumes, if not by the flag
    none: str = ""  # what the value None means, in words
    panel: tuple[Widget, ...] = ()
    label: str = ""  # what a panel calls it, where it has several widgets
    # What stands behind the flag where the panel says it, None where it does not; by default the property's value.
    words: Callable[[Any], list[str] | None] | None = None
    applies: Callable[[Any], bool] = lambda _panel: True  # has an effect with what the panel holds


def option(flag: str, help: str, *, default: object = dataclasses.MISSING, **known) -> Any:
    """A field of a dataclass that is an option; ``known`` are members of Option."""
    return field(default=default, metadata={"option": Option(flag, help, **known)})


def options_of(table: type) -> Iterator[tuple[dataclasses.Field, Option]]:
    """Fields of a dataclass that are options, in their order."""
    for item in dataclasses.fields(table):
        if "option" in item.metadata:
            yield item, item.metadata["option"]


class FlagParser(argparse.ArgumentParser):
    """Takes flags by their whole names only, and says what is wrong in one line."""

    def __init__(self, **known) -> None:
        super().__init__(
            allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter, **known
        )

    def parse_args(self, words, namespace=None):
        """As ever; of an unknown flag the nearest one is named, and a value may begin with a minus and a digit."""
        said: list[str] = []
        for word in words:
            flag, equals, value = word.partition("=")
            if word.startswith("--") and flag not in self._option_string_actions:
                near = difflib.get_close_matches(flag, self._option_string_actions, 1)
                hint = f"; did you mean {near[0]}?" if near else ""
                self.error(f"unknown option {flag}{hint}")
            before = said[-1] if said and said[-1] in self._option_string_actions else ""
            if not word and before or equals and not value and flag in self._option_string_actions:
                # Of a script's variable that was never set: the default must not take its place unasked.
                self.error(f"{before or flag}: expected a value, found an empty text")
            if before and re.match(r"-[0-9]", word):
                word = f"{said.pop()}={word}"
            said.append(word)
        parsed, unknown = self.parse_known_args(said, namespace)
        if unknown:
            self.error(f"unexpected '{unknown[0]}': every value belongs to a flag")
        return parsed

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message.removeprefix('argument ')} (--help lists every option)")


def whole_number(text: str) -> int:
    """An option's value that is a whole number."""
    return _read(int, text, "a whole number")


def real_number(text: str) -> float:
    """An option's value that is a finite number."""
    return _read(float, text, "a number")


def size(text: str) -> tuple[int, int]:
    """Width and height, written WxH as everywhere."""
    found = re.fullmatch(r"([0-9]+)x([0-9]+)", text)
    if not found:
        raise argparse.ArgumentTypeError(
            f"expected WIDTHxHEIGHT in one word, as in 480x270, found '{text}'"
        )
    return int(found[1]), int(found[2])


def _read(kind: type, text: str, expected: str):
    try:
        value = kind(text)
        if "_" in text or not math.isfinite(value):  # Python reads both, nobody means them
            raise ValueError
        return value
    except (ValueError, OverflowError):
        raise argparse.ArgumentTypeError(f"expected {expected}, found '{text}'") from None


def add_flags(parser: argparse.ArgumentParser, *tables: type) -> None:
    """One flag per option, under the headings of their groups; parsed values carry the names of the fields."""
    groups: dict[str, Any] = {}
    for item, known in (pair for table in tables for pair in options_of(table)):
        if known.group not in groups:
            groups[known.group] = parser.add_argument_group(known.group)
        _add_flag(groups[known.group], item, known)


def _add_flag(group, item: dataclasses.Field, known: Option) -> None:
    default = item.default if known.unsaid is _SAME else known.unsaid
    more: dict[str, Any] = {"dest": item.name, "help": known.help}
    if isinstance(default, bool):
        group.add_argument(known.flag, action=f"store_{not default}".lower(), **more)
        return
    if default is dataclasses.MISSING:
        more["required"] = True
    else:
        more["default"] = default
    if known.repeated:
        more["action"] = "append"
    if known.number is not None:
        more["type"] = known.number
    if known.choices:
        more["choices"] = tuple(known.choices)
    if isinstance(known.metavar, tuple):
        more["nargs"] = len(known.metavar)
    group.add_argument(known.flag, metavar=known.metavar, **more)


def check_spans(values: Mapping[str, Any], table: type) -> None:
    """Raises UsageError for a number outside of its option's span; ``values`` by the names of the fields."""
    for item, known in options_of(table):
        if known.span is None or values[item.name] is None:
            continue
        found = values[item.name]
        low, high = known.span
        for value in found if isinstance(found, (list, tuple)) else (found,):
            if not low <= value <= high:
                raise UsageError(f"{known.flag}: expected {low} to {high}, found {value}")


def words_of(table: type, panel, **given: list[str]) -> list[str]:
    """The command line for what a panel holds; ``given`` replaces the words of some fields."""
    said: list[str] = []
    for item, known in options_of(table):
        if not (known.panel or known.words) or not known.applies(panel):
            continue
        words = given.get(item.name) or (known.words or _own_words(item.name))(panel)
        if words is not None:
            said += [known.flag, *words]
    return said


def as_labels(text: str, table: type) -> str:
    """A sentence of the command line for a panel: flags by the labels of their widgets, where they have one."""
    for _, known in options_of(table):
        label = known.label or (known.panel[0].label if len(known.panel) == 1 else "")
        if label:
            label = f"'{label}'"
            text = re.sub(rf"(?<![\w-]){known.flag}(?![\w-])", lambda _, label=label: label, text)
    return text


def _own_words(name: str) -> Callable[[Any], list[str] | None]:
    """The property of that name as it stands; a switch is said by its flag alone."""

    def words(panel) -> list[str] | None:
        value = getattr(panel, name)
        if isinstance(value, bool):
            return [] if value else None
        return [str(value)]

    return words
