# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Cache keys of results: a digest of everything that decides a result, its code included."""

from __future__ import annotations

import ast
import functools
import hashlib
import json
import platform
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.evaluation.run_folder import versions
from vehicle_pf_tracker.trackers.registry import Variant


def result_key(facts: Mapping[str, Any], modules: Iterable[str]) -> str:
    """Digest facts, the code of `modules`, and the versions of what it runs on."""
    code = code_digest(frozenset(modules))
    made_by = {**versions(), "platform": platform.machine(), "code": code}
    text = json.dumps({**facts, "made by": made_by}, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def variant_modules(variant: Variant) -> set[str]:
    """Name the modules that a variant begins in."""
    return {variant.tracker.__module__, variant.parameters.__module__}


@functools.cache
def code_digest(modules: frozenset[str]) -> str:
    """Digest the code of `modules`, and of all that they import from the package or their own."""
    return source_digest(modules)


def scoring_digest() -> str:
    """Digest the code that makes metrics of estimates."""
    return code_digest(frozenset({"vehicle_pf_tracker.evaluation.metrics"}))


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
        waiting |= imported_modules(name, root, packages) - seen - _TABLES
    digest = hashlib.sha256()
    for name in sorted(seen):
        digest.update(name.encode() + b"\0" + _source(name, root) + b"\0")
    return digest.hexdigest()


def _source(name: str, root: Path) -> bytes:
    path = _path(name, root)
    return path.read_bytes() if path else b""


@functools.cache
def imported_modules(name: str, root: Path, packages: frozenset[str]) -> frozenset[str]:
    """Find the modules of `packages` that the module `name` imports, early or late."""
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
