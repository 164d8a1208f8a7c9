# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes of a shot and what the anti-aliasing methods need of them, from ``methods.json``.

That file is the output of ``aaresolve list --json``: names, channels and types are the resolver's own."""

from __future__ import annotations

import difflib
import functools
import json
import os
from dataclasses import dataclass, field
from typing import Iterable

from .errors import UsageError


# Behind a method that reads sub-samples, the exporter's own: how many, in which pattern; the resolver reads them from
# the shot.
_SUB_SAMPLES = {"S": "d3d", "samples": "d3d", "N": "grid"}


@dataclass(frozen=True)
class MethodChoice:
    """One method with the parameters written behind it, as in ``rsaa:S=8,measure=sadp``."""

    id: str
    parameters: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class PassFacts:
    """One pass of a shot as the resolver reads it."""

    name: str
    part: str  # of the EXR
    meaning: str
    per_sub_sample: bool  # its channels exist for each sub-sample: sNN.<name> in the file
    types: dict[str, str]  # channel -> float | uint
    shared: tuple[str, ...]  # those of a pass per sub-sample that exist once per pixel
    is_list: bool  # entries of a list, not pixels of the picture
    bytes_per_pixel: int  # of the channels that are not shared; 0 for a list

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels that are not shared, in the table's order."""
        return tuple(name for name in self.types if name not in self.shared)

    def channels_of(self, view: str) -> tuple[str, ...]:
        """Names in the file of the channels of one sub-sample (``s00``, ``s01`` ...)."""
        return tuple(f"{view}.{name}" for name in self.channels)

    def kind_of(self, channel: str) -> str:
        """Type of a channel by its name in the file."""
        own = not self.per_sub_sample or channel in self.shared
        return self.types[channel if own else channel.partition(".")[2]]


@functools.cache
def _content() -> dict:
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "methods.json")
    with open(path, encoding="utf-8") as file:
        return json.load(file)


@functools.cache
def load_methods() -> dict[str, dict]:
    """Method id -> its description, which nobody changes."""
    return {method["id"]: method for method in _content()["methods"]}


@functools.cache
def load_passes() -> dict[str, PassFacts]:
    """Pass name -> its facts, in the order of the resolver's table."""
    return {item["name"]: _facts(item) for item in _content()["passes"]}


def _facts(item: dict) -> PassFacts:
    channels, shared = item["channels"], item.get("shared", [])
    return PassFacts(
        item["name"],
        item["part"],
        item["meaning"],
        item["perSubSample"],
        {channel["name"]: channel["type"] for channel in (*channels, *shared)},
        tuple(channel["name"] for channel in shared),
        item.get("list", False),
        item["bytesPerPixel"],
    )


def reads_subsamples(passes: Iterable[str]) -> bool:
    """True when one of these passes holds something for every sub-sample."""
    return any(load_passes()[name].per_sub_sample for name in passes)


def sets() -> dict[str, list[str]]:
    """Set -> its methods, as the resolver names sets: ``all`` and the families."""
    found: dict[str, list[str]] = {"all": list(load_methods())}
    for name, method in load_methods().items():
        found.setdefault(method["family"], []).append(name)
    return found


def parse_choices(texts: list[str]) -> list[MethodChoice]:
    """Reads ``m1,m2:k=v,k=v,set,m3``: a part with ``=`` and no ``:`` belongs to the method before it."""
    choices: list[tuple[str, dict[str, str]]] = []
    for part in (part.strip() for text in texts for part in text.split(",")):
        if not part:
            continue
        if ":" in part or "=" not in part:
            name, _, parameter = part.partition(":")
            choices.append((name, {}))
            part = parameter
            if not part:
                continue
        if not choices:
            raise UsageError(f"--for: expected METHOD before the parameter '{part}'")
        key, equals, value = part.partition("=")
        if not equals:
            raise UsageError(f"--for: expected KEY=VALUE after '{choices[-1][0]}:', found '{part}'")
        choices[-1][1][key] = value
    known = load_methods()
    choices = [
        each
        for name, parameters in choices
        for each in (
            [(member, {}) for member in sets()[name]]
            if name in sets() and not parameters
            else [(name, parameters)]
        )
    ]
    for name, parameters in choices:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = (
                f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(sorted(known))}"
            )
            raise UsageError(f"--for: unknown method '{name}'{hint}")
        _check_parameters(name, parameters)
    return [MethodChoice(name, parameters) for name, parameters in choices]


def _check_parameters(method: str, said: dict[str, str]) -> None:
    """Raises UsageError for what the resolver would refuse, before anything is rendered for it."""
    table = {item["name"]: item for item in load_methods()[method]["parameters"]}
    ours = _SUB_SAMPLES if reads_subsamples(load_methods()[method]["passes"]) else {}
    for name, value in said.items():
        if name in ours and value.isdecimal():
            continue
        if name not in table:
            known = f"known: {', '.join(table)}" if table else "it has none"
            raise UsageError(f"--for: {method} has no parameter '{name}'; {known}")
        item = table[name]
        if not is_known_value(item, value):
            expected = (
                ", ".join(item["choices"])
                if "choices" in item
                else f"{item['min']:g} to {item['max']:g}"
            )
            raise UsageError(f"--for: {method}:{name}: expected {expected}, found '{value}'")


def is_known_value(item: dict, text: str) -> bool:
    """True when the parameter of this table can take the value."""
    if "choices" in item:
        return text in item["choices"]
    try:
        return item["min"] <= float(text) <= item["max"]
    except ValueError:
        return False


def required_passes(choices: list[MethodChoice], sampling: str | None = None) -> set[str]:
    """Union of the passes the methods read, colour always among them; empty where no method reads this sampling.

    Methods that accumulate frames read ``jittered`` ones, all others the pixel ``centre``."""
    known = load_methods()
    needed: set[str] = set()
    for choice in choices:
        if sampling in (None, known[choice.id]["sampling"]):
            needed |= {"color", *known[choice.id]["passes"]}
            more = known[choice.id]["passesWhen"]
            for key, value in choice.parameters.items():
                needed.update(more.get(f"{key}={value}", ()))
    return needed & set(load_passes())


def patterns_of(choice: MethodChoice) -> list[str]:
    """Sub-sample patterns that serve a method, the best first; empty where any does, or where it reads none."""
    method = load_methods()[choice.id]
    if not reads_subsamples(method["passes"]):
        return []
    for key, pattern in _SUB_SAMPLES.items():
        if key in choice.parameters:
            return [f"{pattern}{choice.parameters[key]}"]
    return method.get("patterns", [])


def pattern_from(choices: list[MethodChoice], asked: str | None = None) -> str | None:
    """Sub-sample pattern that serves all methods, ``asked`` if that does; None where any pattern would.

    Raises UsageError when there is none."""
    wishes = {choice.id: patterns_of(choice) for choice in choices if patterns_of(choice)}
    common = [asked] if asked else next(iter(wishes.values()), None)
    for known in wishes.values():
        common = [pattern for pattern in common if pattern in known]
    if common == []:
        listed = ", ".join(
            f"{name} wants {' or '.join(known)}" for name, known in sorted(wishes.items())
        )
        if asked:
            raise UsageError(f"--subsamples: found '{asked}', but {listed}")
        raise UsageError(
            f"--for: one shot holds one sub-sample pattern, but {listed}; export them as two shots"
        )
    return common[0] if common else None
