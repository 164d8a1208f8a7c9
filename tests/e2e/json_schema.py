"""The part of JSON Schema that docs/schema uses, in the standard library: what is wrong with a document, as lines.

A keyword that this file does not know is an error, so that no schema says more than is tested.
"""

from __future__ import annotations

import re
from typing import Any

TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "null": type(None),
}
SILENT = {"$schema", "$defs", "title", "description"}


def _is(value: Any, name: str) -> bool:
    if name == "number":
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    if name == "integer":
        return _is(value, "number") and value == int(value)
    return isinstance(value, TYPES[name])


class Schema:
    def __init__(self, document: dict) -> None:
        self.document = document

    def faults(self, value: Any) -> list[str]:
        return list(self._faults(self.document, value, ""))

    def _faults(self, schema: Any, value: Any, at: str):
        if schema is True:
            return
        if schema is False:
            yield f"{at}: must not be there"
            return
        for keyword, rule in schema.items():
            if keyword not in SILENT:
                yield from getattr(self, "_" + keyword.lstrip("$"))(rule, value, at, schema)

    def _fits(self, schema: Any, value: Any) -> bool:
        return not list(self._faults(schema, value, ""))

    def _ref(self, rule, value, at, schema):
        node = self.document
        for step in rule.removeprefix("#/").split("/"):
            node = node[step]
        yield from self._faults(node, value, at)

    def _type(self, rule, value, at, schema):
        names = [rule] if isinstance(rule, str) else rule
        if not any(_is(value, n) for n in names):
            yield f"{at}: expected {' or '.join(names)}, found {value!r}"

    def _const(self, rule, value, at, schema):
        if value != rule:
            yield f"{at}: expected {rule!r}, found {value!r}"

    def _enum(self, rule, value, at, schema):
        if not any(value == v and isinstance(value, bool) == isinstance(v, bool) for v in rule):
            yield f"{at}: expected one of {rule}, found {value!r}"

    def _required(self, rule, value, at, schema):
        if isinstance(value, dict):
            yield from (f"{at}: lacks {name}" for name in rule if name not in value)

    def _properties(self, rule, value, at, schema):
        if isinstance(value, dict):
            for name, inner in rule.items():
                if name in value:
                    yield from self._faults(inner, value[name], f"{at}.{name}")

    def _additionalProperties(self, rule, value, at, schema):
        if isinstance(value, dict):
            for name in value.keys() - schema.get("properties", {}).keys():
                yield from self._faults(rule, value[name], f"{at}.{name}")

    def _propertyNames(self, rule, value, at, schema):
        if isinstance(value, dict):
            for name in value:
                yield from self._faults(rule, name, f"{at}: name {name}")

    def _items(self, rule, value, at, schema):
        if isinstance(value, list):
            for i, item in enumerate(value):
                yield from self._faults(rule, item, f"{at}[{i}]")

    def _minItems(self, rule, value, at, schema):
        if isinstance(value, list) and len(value) < rule:
            yield f"{at}: fewer than {rule} items"

    def _maxItems(self, rule, value, at, schema):
        if isinstance(value, list) and len(value) > rule:
            yield f"{at}: more than {rule} items"

    def _minLength(self, rule, value, at, schema):
        if isinstance(value, str) and len(value) < rule:
            yield f"{at}: shorter than {rule}"

    def _pattern(self, rule, value, at, schema):
        if isinstance(value, str) and not re.search(rule, value):
            yield f"{at}: {value!r} does not match {rule}"

    def _minimum(self, rule, value, at, schema):
        if _is(value, "number") and value < rule:
            yield f"{at}: {value} is below {rule}"

    def _maximum(self, rule, value, at, schema):
        if _is(value, "number") and value > rule:
            yield f"{at}: {value} is above {rule}"

    def _exclusiveMinimum(self, rule, value, at, schema):
        if _is(value, "number") and value <= rule:
            yield f"{at}: {value} is not above {rule}"

    def _anyOf(self, rule, value, at, schema):
        if not any(self._fits(option, value) for option in rule):
            yield f"{at}: fits none of the choices, found {value!r:.80}"

    def _allOf(self, rule, value, at, schema):
        for part in rule:
            yield from self._faults(part, value, at)

    def _if(self, rule, value, at, schema):
        branch = "then" if self._fits(rule, value) else "else"
        yield from self._faults(schema.get(branch, True), value, at)

    def _then(self, rule, value, at, schema):
        yield from ()

    _else = _then
