# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Running cells: those of one scene together, in several processes, each result kept at once."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

import reproduction
from laboratory.result_store import ResultStore
from laboratory.scenes import drives
from reproduction import experiment
from reproduction.runs.cells import Cell, Result
from reproduction.scenes import paper_scenes
from vehicle_pf_tracker.core.progress import ShowCount
from vehicle_pf_tracker.evaluation.cache_key import result_key, source_digest, variant_modules
from vehicle_pf_tracker.trackers.papers import shared
from vehicle_pf_tracker.trackers.registry import find_variant
from vehicle_pf_tracker.workers.processes import run_in_processes

_OF_EVERY_RUN = __name__, paper_scenes.__name__, drives.__name__
"""A module of each folder whose code decides about every run."""
_LARGEST_BATCH = 48
"""Cells that run together: more share a rendering, fewer are lost by an interruption."""


def cell_key(cell: Cell) -> str:
    """Digest the cell's facts, its kind, the code, and the versions of what it runs on."""
    used = {module for name in cell.variants for module in variant_modules(find_variant(name))}
    made_by = {type(cell).__module__, *_OF_EVERY_RUN, *used}
    return result_key({"kind": type(cell).__name__, **cell.facts()}, made_by)


def code_digest() -> str:
    """Digest the code that any experiment depends on: all here, and the papers' trackers'."""
    inside = pkgutil.iter_modules(reproduction.__path__, f"{reproduction.__name__}.")
    folders = {module.name for module in inside if module.ispkg}
    return source_digest(
        frozenset({*folders, *_OF_EVERY_RUN, experiment.__name__, shared.__name__})
    )


_Batch: TypeAlias = tuple[Cell, ...]


def complete(
    cells: Sequence[Cell], store: ResultStore, workers: int, on_progress: ShowCount
) -> Mapping[Cell, Result]:
    """Run the cells that `store` does not have, and return the results of all.

    Parameters
    ----------
    cells : sequence of Cell
        May repeat.
    store : ResultStore
        Takes every result as soon as it is there.
    workers : int
        Processes; with 1 this one does the work. Results do not depend on it.
    on_progress : callable
        Called with the number of cells done, and of all: at the start and after every batch.

    Raises
    ------
    InputError
        If a process is ended from outside, or a cell cannot be run.
    """
    keys = {cell: cell_key(cell) for cell in cells}
    missing = [cell for cell, name in keys.items() if name not in store]
    batches = sorted(_batches(missing), key=_is_alone)
    done = 0
    on_progress(done, len(missing))
    for batch, results in _run(batches, workers):
        for cell, result in zip(batch, results, strict=False):
            store.add(keys[cell], cell.label, result)
        done += len(results)
        on_progress(done, len(missing))
    return {cell: store[name] for cell, name in keys.items()}


def run_together(batch: _Batch) -> list[Result]:
    """Render the scene that all of `batch` are on once, and run all on it."""
    probes = [cell.start() for cell in batch]
    for shown in batch[0].scene.make().frames():
        for probe in probes:
            probe.feed(shown)
    return [probe.result() for probe in probes]


def _batches(cells: Sequence[Cell]) -> Iterator[_Batch]:
    by_scene: dict[object, list[Cell]] = {}
    for cell in cells:
        by_scene.setdefault(cell if cell.alone else cell.scene, []).append(cell)
    for group in by_scene.values():
        for begin in range(0, len(group), _LARGEST_BATCH):
            yield tuple(group[begin : begin + _LARGEST_BATCH])


def _is_alone(batch: _Batch) -> bool:
    return batch[0].alone


def _run(batches: Sequence[_Batch], workers: int) -> Iterator[tuple[_Batch, list[Result]]]:
    """Yield each batch with its results when it is done."""
    beside = [] if workers == 1 else [batch for batch in batches if not _is_alone(batch)]
    if beside:
        yield from run_in_processes(run_together, beside, workers)
    for batch in batches[len(beside) :]:
        yield batch, run_together(batch)
