# SPDX-License-Identifier: GPL-3.0-or-later
"""What the anti-aliasing methods need, from ``methods.json`` (the output of ``aaresolve list --json``)."""

from __future__ import annotations

import difflib
import json
import os
from dataclasses import dataclass, field

from .errors import UsageError

PASSES = (
    "color",
    "albedo",
    "depth",
    "normal",
    "object",
    "motion",
    "subsamples",
    "subsampleColor",
    "edges",
)


@dataclass(frozen=True)
class MethodChoice:
    """One method with the parameters written behind it, as in ``rsaa:S=8,measure=sadp``."""

    id: str
    parameters: dict[str, str] = field(default_factory=dict)


def load_methods() -> dict[str, dict]:
    """Method id -> its description."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "methods.json")
    with open(path, encoding="utf-8") as file:
        return {method["id"]: method for method in json.load(file)["methods"]}


def parse_choices(texts: list[str]) -> list[MethodChoice]:
    """Reads ``m1,m2:k=v,k=v,m3``: a part with ``=`` and no ``:`` belongs to the method before it."""
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
    for name, _ in choices:
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = (
                f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(sorted(known))}"
            )
            raise UsageError(f"--for: unknown method '{name}'{hint}")
    return [MethodChoice(name, parameters) for name, parameters in choices]


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
    return needed & set(PASSES)


def pattern_from(choices: list[MethodChoice], passes: set[str]) -> str | None:
    """Sub-sample pattern that the methods' own parameters ask for (``S=8``, ``samples=4``, ``N=4``), if any.

    Raises UsageError when two of them ask for different ones."""
    known = load_methods()
    wishes: dict[str, str] = {}
    for choice in choices:
        if not {"subsamples", "subsampleColor"} & set(known[choice.id]["passes"]):
            continue
        for key in ("S", "samples"):
            if key in choice.parameters:
                wishes[choice.id] = f"d3d{choice.parameters[key]}"
        if "N" in choice.parameters:
            wishes[choice.id] = f"grid{choice.parameters['N']}"
    if len(set(wishes.values())) > 1:
        listed = ", ".join(f"{name} wants {pattern}" for name, pattern in sorted(wishes.items()))
        raise UsageError(
            f"--for: one shot holds one sub-sample pattern, but {listed}; export them as two shots"
        )
    return next(iter(wishes.values()), None) if passes else None
