"""Under which key a result is kept: a digest of everything that decides it."""

from __future__ import annotations

import functools
import hashlib
import json
import platform
from typing import Any

from vehicle_pf_tracker.evaluation.experiments.cells import Cell
from vehicle_pf_tracker.evaluation.run_info import versions
from vehicle_pf_tracker.evaluation.source_digest import source_digest
from vehicle_pf_tracker.trackers.registry import find_variant


def key(cell: Cell) -> str:
    """Digest the cell's facts, its kind, the code, and the versions of what it runs on."""
    made_by = {**versions(), "platform": platform.machine(), "code": _code(cell)}
    return _digest({"kind": type(cell).__name__, **cell.facts(), "made by": made_by})


def _code(cell: Cell) -> str:
    variants = [find_variant(name) for name in cell.variants]
    used = {
        kind.__module__ for variant in variants for kind in (variant.tracker, variant.parameters)
    }
    return _code_of(frozenset({type(cell).__module__, *used}))


@functools.cache
def _code_of(modules: frozenset[str]) -> str:
    return source_digest(modules)


def _digest(document: Any) -> str:
    text = json.dumps(document, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:32]
