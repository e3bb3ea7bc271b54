# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The rooms of the package as a graph, read from the import statements of their modules."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

PACKAGE = "vehicle_pf_tracker"
DIVIDED = {"image", "trackers"}
"""Rooms whose folders are drawn too."""

Graph = Mapping[str, set[str]]


def rooms_graph(source: Path) -> dict[str, set[str]]:
    """Return the rooms that each room imports from, itself left out.

    Parameters
    ----------
    source : Path
        Folder of the package.
    """
    modules = {_name(path, source): path for path in sorted(source.rglob("*.py"))}
    # A folder that holds folders alone, and says in its `__init__` what is in them, is no room.
    inside = [name for name in modules if "." in name and not name.endswith(".__init__")]
    graph: dict[str, set[str]] = {_room(name): set() for name in inside}
    for name, path in modules.items():
        room = _room(name)
        for target in _imports(path):
            known = target if target in modules else target.rpartition(".")[0]
            other = _room(known)
            if room in graph and other in graph and other != room:
                graph[room].add(other)
    return graph


def reduced(graph: Graph) -> dict[str, set[str]]:
    """Leave out the arrows that follow from others: A to C where A to B and B to C are drawn."""
    return {
        room: {
            other
            for other in others
            if not any(other in _reach(graph, between, {room}) for between in others - {other})
        }
        for room, others in graph.items()
    }


def _name(path: Path, source: Path) -> str:
    """Return the dotted name below the package: ``ros.node.outputs``."""
    return ".".join(path.relative_to(source).with_suffix("").parts)


def _room(name: str) -> str:
    """Return the room of a module: its folder, with the folder inside where the room is divided."""
    head, *rest = name.split(".")
    return f"{head}/{rest[0]}" if head in DIVIDED and len(rest) > 1 else head


def _imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(f"{PACKAGE}."):
            module = str(node.module).removeprefix(f"{PACKAGE}.")
            yield from (f"{module}.{alias.name}" for alias in node.names)


def _reach(graph: Graph, start: str, seen: set[str]) -> set[str]:
    """Return the rooms that can be reached from `start`, through none of those `seen`."""
    reached: set[str] = set()
    waiting = [start]
    while waiting:
        room = waiting.pop()
        if room not in seen:
            seen = seen | {room}
            reached |= graph[room]
            waiting += graph[room]
    return reached
