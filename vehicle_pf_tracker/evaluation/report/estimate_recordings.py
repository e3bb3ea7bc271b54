"""Each recording anew with its truth and all estimates beside its images, for Foxglove and evo."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.estimates_recording import write_with_estimates
from vehicle_pf_tracker.evaluation.grid.locations import at_hand
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation
from vehicle_pf_tracker.recordings.reader import Recording

FOLDER = "estimates"


def write_estimate_recordings(
    evaluation: ScoredEvaluation, tell: Callable[[str], object]
) -> list[Path]:
    """Write a recording for each of the evaluation's, and return their folders.

    The estimates are on ``/<system>/seed_<n>/position``, ``box`` and ``mode``. `tell` takes a
    sentence for each recording that could not be made.
    """
    written = []
    for entry in evaluation.recordings:
        path = evaluation.folder.path / FOLDER / entry.name
        try:
            recording = Recording(at_hand(entry.path), entry.topic)
            runs = _rows(evaluation, entry.name)
            write_with_estimates(path, recording, runs, overwrite=True)
            written.append(path)
        except InputError as error:
            tell(f"there is no recording of {entry.name} with estimates: {error}")
    return written


def topic_name(system: str, seed: int) -> str:
    """Return the namespace of a run: letters, digits and underscores, no digit first."""
    name = "".join(c if c.isascii() and c.isalnum() else "_" for c in system)
    name = f"_{name}" if name[:1].isdigit() else name
    return f"{name}/seed_{seed}"


def _rows(evaluation: ScoredEvaluation, recording: str) -> dict[str, tuple[EstimateRow, ...]]:
    rows = {}
    for run in evaluation.of(recording):
        cell = evaluation.folder.cell(recording, run.system, run.seed)
        if cell.rows is not None:
            rows[topic_name(run.system, run.seed)] = cell.rows
    return rows
