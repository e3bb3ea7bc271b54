"""The cells of an evaluation on disk: whole or not at all, and found again by their keys."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import FAILED, read_document
from vehicle_pf_tracker.evaluation.grid.cells import BESIDE, GridCell
from vehicle_pf_tracker.evaluation.grid.tracking import Outcome
from vehicle_pf_tracker.evaluation.identity import scoring_digest
from vehicle_pf_tracker.evaluation.output_files import make_folder, output_errors, write_json
from vehicle_pf_tracker.evaluation.results import ESTIMATES, METRICS, RUN, ResultFolder

RESTARTS = "restarts.json"
_PARTIAL = ".partial"


class CellStore:
    """Keeps cells in the folder of an evaluation.

    A cell is written beside its place and then moved there. What a killed run left half written is
    removed.

    Parameters
    ----------
    folder : Path
        Of the evaluation.

    Raises
    ------
    InputError
        If nothing can be written there; also from `add`.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = make_folder(folder)
        self._scoring = scoring_digest()
        with output_errors(folder):
            for left in folder.glob(f"**/*{_PARTIAL}"):
                shutil.rmtree(left, ignore_errors=True)

    def has(self, cell: GridCell) -> bool:
        """Whether the cell was run, as it is to be run now; one that failed is tried again."""
        path = cell.folder(self._folder)
        if not all((path / name).is_file() for name in (ESTIMATES, METRICS, RUN)):
            return False
        try:
            run = read_document(path / RUN)
        except InputError:
            return False
        return run.get("key") == cell.key() and run.get("scored_by") == self._scoring

    def drop_others(self, cells: Iterable[GridCell]) -> None:
        """Remove what is beside the grid and not among `cells`: the report shows all it finds."""
        wanted = {cell.folder(self._folder) for cell in cells}
        with output_errors(self._folder):
            for name in (METRICS, FAILED):
                for path in list((self._folder / BESIDE).glob(f"**/{name}")):
                    if path.parent not in wanted:
                        shutil.rmtree(path.parent)

    def add(self, cell: GridCell, outcome: Outcome, command: list[str]) -> None:
        """Keep what came out of a cell, in place of what an earlier run of it left."""
        place = cell.folder(self._folder)
        partial = place.with_name(f".{place.name}.{os.getpid()}{_PARTIAL}")
        with output_errors(partial):
            shutil.rmtree(partial, ignore_errors=True)
            self._write(partial, cell, outcome, command)
            shutil.rmtree(place, ignore_errors=True)
            partial.rename(place)

    def _write(self, path: Path, cell: GridCell, outcome: Outcome, command: list[str]) -> None:
        if outcome.metrics is None:
            write_json(make_folder(path) / FAILED, {"reason": outcome.reason})
            return
        run: dict[str, Any] = {
            **outcome.run,
            "command": command,
            "key": cell.key(),
            "scored_by": self._scoring,
        }
        results = ResultFolder(path)
        results.write_run(outcome.rows, run)
        results.write_metrics(outcome.metrics)
        if outcome.restarts is not None:
            write_json(path / RESTARTS, outcome.restarts)
