# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cells of an evaluation, scored against the truth."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.curves import Curve, curves
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.restarts import measure_restarts
from vehicle_pf_tracker.evaluation.scores import score_frames

_DECIDING = ("vehicle_pf_tracker", "opencv", "numpy")
"""Programs whose version moves estimates."""


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
    curves : mapping of str to Curve
        ``precision``, ``success`` and ``normalised``; empty without truth.
    versions : mapping of str to str or None
        Versions of what it was made with, by program.
    """

    recording: str
    system: str
    seed: int
    metrics: Metrics
    errors: NDArray[np.float64]
    curves: Mapping[str, Curve]
    versions: Mapping[str, str | None]


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

    def of(self, recording: str | None = None, system: str | None = None) -> list[ScoredRun]:
        """Return the runs on a recording, of a system, or both."""
        return [
            run
            for run in self.runs
            if recording in {None, run.recording} and system in {None, run.system}
        ]

    @property
    def notes(self) -> list[str]:
        """Say how many cells have a result, and whether versions are mixed."""
        failed = len(self.failed)
        cells = len(self.runs) + failed
        result = f"All {cells} cells of the grid have a result."
        if failed:
            result = f"{failed} of {cells} cells have no result; see Failed cells."
        return [result, *self.mixed_versions]

    @property
    def mixed_versions(self) -> list[str]:
        """A sentence where runs were made with different versions; baselines have their own."""
        ours = {system.label for system in self.folder.systems if not system.is_baseline}
        runs = [run for run in self.runs if run.system in ours]
        found = {key: {str(run.versions.get(key)) for run in runs} for key in _DECIDING}
        mixed = [f"{key} {' and '.join(sorted(v))}" for key, v in found.items() if len(v) > 1]
        words = "Results of different versions are compared"
        return [f"{words}: {'; '.join(mixed)}; evaluate again to have all of one."] if mixed else []

    def by_system(self, recording: str, order: Sequence[str]) -> dict[str, list[ScoredRun]]:
        """Return the runs on a recording by their systems, of those in `order` that have any."""
        return {label: runs for label in order if (runs := self.of(recording, label))}


def score_folder(folder: EvaluationFolder) -> ScoredEvaluation:
    """Score all cells; those that cannot be read or scored are failed cells."""
    truths = {entry.name: folder.truth(entry.name) for entry in folder.recordings}
    results = [
        _result(folder, (recording.name, system.label, seed), truths[recording.name])
        for recording, system in itertools.product(folder.recordings, folder.systems)
        for seed in system.seeds(folder.seeds)
    ]
    return ScoredEvaluation(
        folder,
        truths,
        tuple(result for result in results if isinstance(result, ScoredRun)),
        tuple(result for result in results if isinstance(result, FailedCell)),
    )


def _result(
    folder: EvaluationFolder, key: tuple[str, str, int], truth: Mapping[int, Truth]
) -> ScoredRun | FailedCell:
    # As it was evaluated; a plan without the option is scored by the default.
    max_diff = float(folder.plan.get("options", {}).get("max_diff", PAIRED_WITHIN_S))
    try:
        rows, run = folder.cell(*key)
        known = list(truth.values())
        scores = score_frames(rows, known, max_diff)
        restarted = folder.restarted(*key)
        with_restarts = restarted and measure_restarts(score_frames(restarted, known, max_diff))
    except InputError as error:
        return FailedCell(*key, str(error))
    errors = [frame.error if frame.counts else None for frame in scores.frames]
    return ScoredRun(
        *key,
        metrics=replace(measure(scores), restarts=with_restarts or None),
        errors=np.array(errors, dtype=np.float64),  # None is NaN
        curves=curves(scores.counted),
        versions=run.get("versions", {}),
    )
