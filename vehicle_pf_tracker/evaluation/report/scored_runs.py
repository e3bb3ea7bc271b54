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

"""Cells of an evaluation, scored against the truth."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.association import MAX_DIFF
from vehicle_pf_tracker.evaluation.curves import (
    Curve,
    normalised_precision_curve,
    precision_curve,
    success_curve,
)
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    Cell,
    EvaluationFolder,
    Source,
    SystemEntry,
)
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.scores import FrameScore, score_frames


@dataclass(frozen=True, slots=True)
class ScoredRun:
    """One run with its scores.

    Attributes
    ----------
    recording, system, seed : str, str, int
        Cell of the grid.
    metrics : Metrics
        Metrics of the run.
    errors : (N,) array
        Error of the centre in px by frame of the recording; NaN where nothing is scored.
    boxes : sequence of Box or None
        Box of the scored estimate by frame.
    modes : sequence of str
        Mode by frame.
    curves : mapping of str to Curve
        ``precision``, ``success`` and ``normalised``; empty without truth.
    """

    recording: str
    system: str
    seed: int
    metrics: Metrics
    errors: NDArray[np.float64]
    boxes: Sequence[Box | None]
    modes: Sequence[str]
    curves: Mapping[str, Curve]


@dataclass(frozen=True, slots=True)
class FailedCell:
    """A cell without a result, and the reason in one sentence."""

    recording: str
    system: str
    seed: int
    reason: str


@dataclass(frozen=True, slots=True)
class ScoredEvaluation:
    """The runs and the truth that a report is made of.

    Attributes
    ----------
    folder : EvaluationFolder
        Folder the runs were read from.
    truths : mapping of str to mapping of int to Truth
        Truths by recording and number of the frame.
    runs : tuple of ScoredRun
        Runs in the order of the plan: recordings, systems, seeds.
    failed : tuple of FailedCell
        Failed cells in the same order.
    """

    folder: EvaluationFolder
    truths: Mapping[str, Mapping[int, Truth]]
    runs: tuple[ScoredRun, ...]
    failed: tuple[FailedCell, ...]

    @property
    def recordings(self) -> tuple[Source, ...]:
        """See `EvaluationFolder`."""
        return self.folder.recordings

    @property
    def systems(self) -> tuple[SystemEntry, ...]:
        """See `EvaluationFolder`."""
        return self.folder.systems

    def of(self, recording: str | None = None, system: str | None = None) -> list[ScoredRun]:
        """Return the runs on a recording, of a system, or both."""
        return [
            run
            for run in self.runs
            if recording in {None, run.recording} and system in {None, run.system}
        ]


def score_folder(folder: EvaluationFolder) -> ScoredEvaluation:
    """Score all cells; those that cannot be read or scored are failed cells."""
    truths = {entry.name: folder.truth(entry.name) for entry in folder.recordings}
    results = list(_results(folder, truths))
    return ScoredEvaluation(
        folder,
        truths,
        tuple(result for result in results if isinstance(result, ScoredRun)),
        tuple(result for result in results if isinstance(result, FailedCell)),
    )


def typical(runs: Sequence[ScoredRun]) -> ScoredRun | None:
    """Return the run with the median error (RMSE) of several seeds, the lower of two."""
    judged = [run for run in runs if run.metrics.rmse_px is not None]
    ordered = sorted(judged, key=lambda run: (run.metrics.rmse_px or 0.0, run.seed))
    return ordered[(len(ordered) - 1) // 2] if ordered else None


def _cells(folder: EvaluationFolder) -> Iterator[tuple[Source, SystemEntry, int]]:
    for recording, system in itertools.product(folder.recordings, folder.systems):
        for seed in folder.seeds_of(system):
            yield recording, system, seed


def _results(
    folder: EvaluationFolder, truths: Mapping[str, Mapping[int, Truth]]
) -> Iterator[ScoredRun | FailedCell]:
    max_diff = float(folder.plan.get("options", {}).get("max_diff", MAX_DIFF))
    for recording, system, seed in _cells(folder):
        key = (recording.name, system.label, seed)
        try:
            cell = folder.cell(*key)
            if cell.rows is None:
                yield FailedCell(*key, cell.reason)
            else:
                yield _score(cell, truths[recording.name], max_diff)
        except InputError as error:
            yield FailedCell(*key, str(error))


def _score(cell: Cell, truth: Mapping[int, Truth], max_diff: float) -> ScoredRun:
    scores = score_frames(cell.rows or (), list(truth.values()), max_diff)
    counted, frames = scores.counted, scores.frames
    curves = {
        "precision": precision_curve(counted),
        "success": success_curve(counted),
        "normalised": normalised_precision_curve(counted),
    }
    return ScoredRun(
        recording=cell.recording,
        system=cell.system,
        seed=cell.seed,
        metrics=measure(scores),
        errors=np.array([_error(frame) for frame in frames]),
        boxes=[_box(frame) for frame in frames],
        modes=[frame.row.mode for frame in frames],
        curves={name: curve for name, curve in curves.items() if curve is not None},
    )


def _error(frame: FrameScore) -> float:
    error = frame.error if frame.counts else None
    return float("nan") if error is None else error


def _box(frame: FrameScore) -> Box | None:
    row = frame.scored_row
    if row is None or row.x is None or row.y is None or frame.waiting:
        return None
    return Box.around((row.x, row.y), row.width or 0.0, row.height or 0.0)
