"""A digest of the code that decides a number, since a version number does not change with it."""

from __future__ import annotations

import ast
import functools
import hashlib
from collections.abc import Iterable, Iterator
from pathlib import Path

_ROOT = Path(__file__).parents[2]
_PACKAGE = Path(__file__).parents[1].name
_TABLES = frozenset({f"{_PACKAGE}.trackers.registry"})
"""Modules that only list others: what is used of them has to be named as a start."""


def source_digest(modules: Iterable[str], root: Path = _ROOT, package: str = _PACKAGE) -> str:
    """Digest the sources of modules, and of all that they import from the package or their own.

    Parameters
    ----------
    modules : iterable of str
        Full names, such as ``vehicle_pf_tracker.trackers.papers.apf``. The registry of variants
        does not count, so that a variant that comes or changes leaves the others' digests.
    root : Path
        The folder that holds the packages' folders.
    package : str
        The package's name.
    """
    seen: set[str] = set()
    waiting = set(modules)
    packages = frozenset({package, *(name.split(".")[0] for name in waiting)})
    while waiting:
        name = waiting.pop()
        seen.add(name)
        waiting |= _imported(name, root, packages) - seen - _TABLES
    digest = hashlib.sha256()
    for name in sorted(seen):
        digest.update(name.encode() + b"\0" + _source(name, root) + b"\0")
    return digest.hexdigest()


def _source(name: str, root: Path) -> bytes:
    path = _path(name, root)
    return path.read_bytes() if path else b""


@functools.cache
def _imported(name: str, root: Path, packages: frozenset[str]) -> frozenset[str]:
    tree = ast.parse(_source(name, root))
    wanted = (target for node in ast.walk(tree) for target in _targets(node))
    return frozenset(
        target for target in wanted if target.split(".")[0] in packages and _path(target, root)
    )


def _targets(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom) and node.module:
        yield node.module
        yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _path(name: str, root: Path) -> Path | None:
    base = root.joinpath(*name.split("."))
    for path in (base.with_suffix(".py"), base / "__init__.py"):
        if path.is_file():
            return path
    return None
