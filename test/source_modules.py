# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Modules of the package, and what each imports, read from the source."""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

NAME = "vehicle_pf_tracker"
SOURCE = Path(__file__).resolve().parents[1] / NAME
MESSAGES = {
    "builtin_interfaces", "diagnostic_msgs", "geometry_msgs", "lifecycle_msgs", "rcl_interfaces",
    "rosgraph_msgs", "sensor_msgs", "std_msgs", "std_srvs", "tf2_msgs", "vision_msgs",
    "visualization_msgs",
}  # fmt: skip
ROS = {"rclpy", "ament_index_python", "launch", "launch_ros", *MESSAGES}
"""Modules of ROS."""


class Import(NamedTuple):
    """One module named by an import statement; ``name`` is absolute."""

    name: str
    line: int
    at_start: bool  # runs when the module is imported, not when a function is called


class Module(NamedTuple):
    name: str  # dotted, below the package: "ros.node", "" for the package itself
    path: Path
    tree: ast.Module
    imports: list[Import]

    @property
    def room(self) -> str:
        return self.name.partition(".")[0]

    def at(self, line: int) -> str:
        return f"{self.path.name}:{line} ({self.name})"


def read_modules(source: Path) -> dict[str, Module]:
    """Parse every file of the package: {dotted name below the package: module}."""
    modules = {}
    for path in sorted(source.rglob("*.py")):
        parts = path.relative_to(source).with_suffix("").parts
        package = parts[:-1]
        name = ".".join(package if parts[-1] == "__init__" else parts)
        tree = ast.parse(path.read_text(encoding="utf-8"), str(path))
        modules[name] = Module(name, path, tree, list(imports_of(tree, package)))
    return modules


@functools.cache
def own_modules() -> dict[str, Module]:
    """Parse the package, once for all tests that read it."""
    return read_modules(SOURCE)


def imports_of(tree: ast.Module, package: tuple[str, ...]) -> Iterator[Import]:
    for node, at_start in statements(tree, at_start=True):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(alias.name, node.lineno, at_start)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = (NAME, *package)[: len(package) + 2 - node.level]
                base = ".".join([*above, base]).rstrip(".")
            for alias in node.names:  # the name may be a module or something inside one
                yield Import(f"{base}.{alias.name}", node.lineno, at_start)


def statements(node: ast.AST, *, at_start: bool) -> Iterator[tuple[ast.AST, bool]]:
    """Walk the tree in order; what stands in a function or under TYPE_CHECKING runs later."""
    for child in ast.iter_child_nodes(node):
        later = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        later = later or (isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test))
        yield child, at_start
        yield from statements(child, at_start=at_start and not later)


def inside(name: str) -> str | None:
    """``vehicle_pf_tracker.a.b`` as ``a.b``; None for a module of somebody else."""
    head, _, rest = name.partition(".")
    return rest if head == NAME else None


def covers(allowed: set[str], name: str) -> bool:
    return any(name == entry or name.startswith(f"{entry}.") for entry in allowed)


def made_up(folder: Path, **files: str) -> dict[str, Module]:
    for name, text in {"__init__": "", **files}.items():
        path = folder.joinpath(*name.split("__", 1) if name != "__init__" else [name])
        path = path.with_suffix(".py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return read_modules(folder)
