"""Under which key a result is kept: a digest of everything that decides it."""

from __future__ import annotations

import functools
import hashlib
import json
import platform
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.evaluation.experiments.cells import Cell
from vehicle_pf_tracker.evaluation.run_info import versions

_PACKAGE = Path(__file__).parents[2]
_DECIDING = (
    "features",
    "filtering",
    "trackers",
    "scenes",
    "recordings/truth.py",
    "evaluation/association.py",
    "evaluation/metrics.py",
    "evaluation/occlusions.py",
    "evaluation/scores.py",
    "evaluation/experiments/cells.py",
    "evaluation/experiments/timing_cell.py",
)
"""The sources that a result can depend on, since a version number does not change with each."""


def key(cell: Cell) -> str:
    """Digest the cell's facts, its kind, the code, and the versions of what it runs on."""
    return _digest({"kind": type(cell).__name__, **cell.facts(), "made by": _makers()})


@functools.cache
def _makers() -> dict[str, Any]:
    made_by: dict[str, Any] = {**versions(), "platform": platform.machine()}
    return {**made_by, "code": source_digest(_PACKAGE)}


def source_digest(package: Path) -> str:
    """Digest the sources of the package in the folder `package` that decide about numbers."""
    digest = hashlib.sha256()
    for entry in _DECIDING:
        path = package / entry
        for source in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
            digest.update(source.relative_to(package).as_posix().encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()


def _digest(document: Any) -> str:
    text = json.dumps(document, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:32]
