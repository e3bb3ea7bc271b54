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

"""Results on disk, added one by one, so that interrupted work continues.

The cache key of a result is a digest of everything that determines it, its code included.
"""

from __future__ import annotations

import ast
import contextlib
import functools
import hashlib
import json
import os
import platform
from collections.abc import Iterable, Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeAlias

from vehicle_pf_tracker.core.outputs import output_errors
from vehicle_pf_tracker.offline.output_files import make_folder
from vehicle_pf_tracker.offline.run_folder import versions
from vehicle_pf_tracker.trackers.registry import Variant

Result: TypeAlias = dict[str, Any]
"""Plain values that JSON knows."""


class ResultStore:
    """A file with one line of JSON for each result.

    A line that a killed run left unfinished, or that is no result, is dropped. Lines under keys
    that are no longer requested stay; deleting the file only costs their time.

    Parameters
    ----------
    path : Path
        The file; made, with its folder, where it is missing.

    Raises
    ------
    InputError
        If it cannot be read or written; also from `add`.
    """

    def __init__(self, path: Path) -> None:
        make_folder(path.parent)
        self._path = path
        with output_errors(path):
            self._results = dict(_read(path))

    def __contains__(self, key: str) -> bool:
        return key in self._results

    def __getitem__(self, key: str) -> Result:
        return self._results[key]

    def add(self, key: str, label: str, result: Result) -> None:
        """Keep `result` under `key`; `label` is for those who look into the file."""
        line = json.dumps({"key": key, "label": label, "result": result}, allow_nan=False)
        with output_errors(self._path), self._path.open("a", encoding="utf-8") as file:
            file.write(line + "\n")
            file.flush()
            os.fsync(file.fileno())
        # As read back, so that a result is the same whether it was made now or before.
        self._results[key] = json.loads(line)["result"]


def _read(path: Path) -> Iterator[tuple[str, Result]]:
    if not path.exists():
        return
    whole, newline, unfinished = path.read_bytes().rpartition(b"\n")
    if unfinished:
        os.truncate(path, len(whole) + len(newline))
    for line in whole.splitlines():
        with contextlib.suppress(ValueError, KeyError, TypeError, RecursionError):
            entry = json.loads(line)
            yield entry["key"], entry["result"]


def result_key(facts: Mapping[str, Any], modules: Iterable[str]) -> str:
    """Digest facts, the code of `modules`, and the versions of what it runs on."""
    code = source_digest(frozenset(modules))
    made_by = {**versions(), "platform": platform.machine(), "code": code}
    text = json.dumps({**facts, "made by": made_by}, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def variant_modules(variant: Variant) -> set[str]:
    """Name the modules that a variant begins in."""
    return {variant.tracker.__module__, variant.parameters.__module__}


def scoring_digest() -> str:
    """Digest the code that makes metrics of estimates."""
    return source_digest(frozenset({"vehicle_pf_tracker.evaluation.metrics"}))


_ROOT = Path(__file__).parents[2]
_PACKAGE = Path(__file__).parents[1].name
_TABLES = frozenset({f"{_PACKAGE}.trackers.registry"})
"""Modules that only list others: what is used of them has to be named as a start."""


@functools.cache
def source_digest(modules: frozenset[str], root: Path = _ROOT, package: str = _PACKAGE) -> str:
    """Digest the sources of modules, and of all that they import from the package or their own.

    Parameters
    ----------
    modules : frozenset of str
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
        if name.startswith(f"{package}.") and _path(name, root) is None:
            raise ModuleNotFoundError(f"{name} is to count for a cache key, and is not there")
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
    base = _home(name.partition(".")[0], root).joinpath(*name.split("."))
    for path in (base.with_suffix(".py"), base / "__init__.py"):
        if path.is_file():
            return path
    return None


@functools.cache
def _home(package: str, root: Path) -> Path:
    """Return the folder that a package lies in: `root`, or where a plug-in was installed."""
    spec = None if Path(root, package).exists() else find_spec(package)
    if spec is None:
        return root
    return Path(next(iter(spec.submodule_search_locations or [spec.origin or ""]))).parent
