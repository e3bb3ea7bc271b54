"""Trajectories as TUM files, which evo reads: ``stamp x y z qx qy qz qw``.

Stamps are in s, x and y in px (evo calls them m), z is 0, and nothing is turned.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder, safe_name
from vehicle_pf_tracker.evaluation.output_files import make_folder, write_text
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun

FOLDER = "trajectories"


def write_trajectories(evaluation: ScoredEvaluation) -> list[Path]:
    """Write the truth of each recording and each run's scored estimates where there is truth.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    written = []
    for entry in evaluation.recordings:
        truths = evaluation.truths[entry.name]
        if not truths:
            continue
        folder = make_folder(_folder(evaluation.folder, entry.name))
        written.append(_write(folder / "truth.tum", _true_points(truths)))
        for run in evaluation.of(entry.name):
            name = f"{safe_name(run.system)}_seed-{run.seed}.tum"
            written.append(_write(folder / name, _points(run, truths)))
    return written


def _folder(evaluation: EvaluationFolder, recording: str) -> Path:
    return evaluation.path / FOLDER / recording


Point = tuple[int, float, float]
"""Stamp in ns, x and y in px."""


def _true_points(truths: Mapping[int, Truth]) -> list[Point]:
    return [(truth.stamp_ns, *truth.box.centre) for truth in truths.values()]


def _points(run: ScoredRun, truths: Mapping[int, Truth]) -> list[Point]:
    return [
        (truths[number].stamp_ns, *box.centre)
        for number, box in enumerate(run.boxes, start=1)
        if box is not None and number in truths
    ]


def _write(path: Path, points: Iterable[Point]) -> Path:
    lines = (
        f"{stamp // 10**9}.{stamp % 10**9:09d} {x!r} {y!r} 0 0 0 0 1\n" for stamp, x, y in points
    )
    write_text(path, "".join(lines))
    return path
