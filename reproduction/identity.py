"""Under which key the result of a cell is kept."""

from __future__ import annotations

from reproduction.cells import Cell
from vehicle_pf_tracker.evaluation.identity import result_key, variant_modules
from vehicle_pf_tracker.trackers.registry import find_variant


def key(cell: Cell) -> str:
    """Digest the cell's facts, its kind, the code, and the versions of what it runs on."""
    used = {module for name in cell.variants for module in variant_modules(find_variant(name))}
    return result_key({"kind": type(cell).__name__, **cell.facts()}, {type(cell).__module__, *used})
