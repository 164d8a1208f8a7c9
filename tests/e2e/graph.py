"""Which file needs which: for the tests that read imports and includes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping


def cycles_of(graph: Mapping[str, Iterable[str]]) -> list[list[str]]:
    """Every cycle that a walk from each file meets first; none where the graph has an order."""
    done: set[str] = set()
    found: list[list[str]] = []

    def visit(file: str, path: list[str]) -> None:
        if file in path:
            found.append([*path[path.index(file) :], file])
        elif file not in done:
            for target in sorted(graph.get(file, ())):
                visit(target, [*path, file])
            done.add(file)

    for file in graph:
        visit(file, [])
    return found
