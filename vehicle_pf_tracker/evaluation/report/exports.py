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

"""The evaluation's runs for other tools: TUM trajectories for evo, recordings for Foxglove."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.estimates_recording import write_with_estimates
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder, safe_name
from vehicle_pf_tracker.evaluation.grid.sources import local_copy
from vehicle_pf_tracker.evaluation.output_files import make_folder, write_text
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.recordings.topics import as_token

TRAJECTORIES = "trajectories"


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
    return evaluation.path / TRAJECTORIES / recording


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


ESTIMATE_RECORDINGS = "estimates"


def write_estimate_recordings(
    evaluation: ScoredEvaluation,
    notify: Callable[[str], object],
    on_stage: Callable[[str], object] = lambda _: None,
) -> list[Path]:
    """Write a recording for each of the evaluation's, and return their folders.

    The estimates are on ``/<system>/seed_<n>/position``, ``box``, ``mode`` and ``annotations``.
    `notify` takes a sentence for each recording that could not be made, and `on_stage` a few words
    before each.
    """
    written = []
    for entry in evaluation.recordings:
        on_stage(f"the recording {entry.name} with estimates")
        path = evaluation.folder.path / ESTIMATE_RECORDINGS / entry.name
        try:
            recording = Recording(local_copy(entry.path), entry.topic)
            runs = _rows(evaluation, entry.name)
            write_with_estimates(path, recording, runs, overwrite=True)
            written.append(path)
        except InputError as error:
            notify(f"there is no recording of {entry.name} with estimates: {error}")
    return written


def topic_name(system: str, seed: int) -> str:
    """Return the namespace of a run."""
    return f"{as_token(system)}/seed_{seed}"


def _rows(evaluation: ScoredEvaluation, recording: str) -> dict[str, tuple[EstimateRow, ...]]:
    rows = {}
    for run in evaluation.of(recording):
        cell = evaluation.folder.cell(recording, run.system, run.seed)
        if cell.rows is not None:
            rows[topic_name(run.system, run.seed)] = cell.rows
    return rows
