# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cache keys of results: a digest of everything that determines them, their code included."""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import json
import platform
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.results.code_digest import CODE, code_digest
from vehicle_pf_tracker.results.run_folder import versions
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT, Variant


def result_key(facts: Mapping[str, Any], modules: Iterable[str]) -> str:
    """Digest facts, the code of `modules`, and the versions of what it runs on."""
    code = source_digest(frozenset(modules))
    # Another NumPy, OpenCV or processor may move the last digits, and these a random choice.
    made_by = {**versions(), "platform": platform.machine(), "code": code}
    text = json.dumps({**facts, "made by": made_by}, sort_keys=True, allow_nan=False)
    # 128 bits: no two results of any evaluation share them.
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def variant_modules(variant: Variant) -> set[str]:
    """Name the modules that a variant begins in."""
    # The tracker of many vehicles is none of the contract; its parameters lie beside it.
    classes = (
        [variant.parameters]
        if variant == TRAFFIC_VARIANT
        else [variant.tracker, variant.parameters]
    )
    return {kind.__module__ for kind in classes}


_PACKAGE = Path(__file__).parents[1]
"""Folder of our code."""
_WHOLE = (
    "core",
    "road",
    "parameters",
    "filtering",
    "image",
    "detection",
    "counting",
    "recordings",
    "scenes",
    "following",
    "workers",
    "results",
)
"""Rooms whose code counts for every result, with all folders inside."""
_ALONE = ("trackers", "evaluation", "evaluation/grid")
"""Folders whose own files count for every result: of those inside only some decide about one."""


@functools.cache
def source_digest(modules: frozenset[str], package: Path = _PACKAGE) -> str:
    """Digest the code of `_WHOLE` rooms, of `_ALONE` folders and of those that `modules` are in.

    Parameters
    ----------
    modules : frozenset of str
        Full names, such as ``vehicle_pf_tracker.trackers.papers.apf``: of the trackers, only those
        beside the modules count. Of a module without a package only its own file counts.
    package : Path
        Folder of the package that has the shared folders.
    """
    paths = {path for name in _WHOLE for kind in CODE for path in (package / name).rglob(kind)}
    paths |= {path for name in _ALONE for path in (package / name).glob("*.py")}
    for name in modules:
        found = importlib.util.find_spec(name)
        if found is None or found.origin is None:
            raise ModuleNotFoundError(f"{name} is to count for a cache key, and is not there")
        own = Path(found.origin)
        paths |= set(own.parent.glob("*.py")) if "." in name else {own}
    return code_digest((f"{path.parent.name}/{path.name}", path) for path in paths)
