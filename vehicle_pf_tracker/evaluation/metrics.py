# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Metrics of a run.

Frames with truth are scored, beginning with the one in which the target was set. Hidden frames are
those in which it is totally occluded, visible ones the rest. `scores` says what is scored where an
estimate is missing; a frame before the first estimate counts as a miss in every share, and is left
out of means and quantiles.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.evaluation.curves import curves
from vehicle_pf_tracker.evaluation.occlusion_scores import OcclusionScore, score_occlusions
from vehicle_pf_tracker.evaluation.restarts import RestartScores
from vehicle_pf_tracker.evaluation.scores import (
    CLOSE_PX,
    FrameScore,
    Scores,
    count_failures,
    errors_of,
)
from vehicle_pf_tracker.results.estimates import REJECTED_MODE, WAITING_MODE
from vehicle_pf_tracker.trackers.estimate import Mode

PRECISION_PX = 20.0
"""Threshold of the precision that the OTB benchmark ranks by."""
NORMALISED_PRECISION = 0.2
"""Threshold of the normalised precision that the LaSOT benchmark ranks by."""
# Modes whose frames are counted.
_MODES = (*(mode.value for mode in Mode), WAITING_MODE, REJECTED_MODE)


# A table by name: its fields are the keys of metrics.json and the metrics that options name.
@dataclass(frozen=True, slots=True)
class Metrics:
    """Metrics of one run; None where there is nothing to take them from.

    Attributes
    ----------
    frames : int
        Frames of the recording.
    frames_scored, frames_without_truth, frames_waiting : int
        Scored frames; frames whose true position is not known; frames before the target was set.
    truths_unmatched : int
        Truths that belong to no frame.
    frames_standing : int
        Scored frames without an estimate, in which the last one stands.
    rmse_px, median_px, p95_px, max_px : float or None
        Root mean square and quantiles of the centre's error over all scored frames.
    rmse_visible_px : float or None
        Root of the mean squared error of the centre over visible frames.
    p_error_lt_15px : float or None
        Share of scored frames with an error below 15 px.
    precision_20px : float or None
        Share of scored frames with an error of at most 20 px, as in OTB.
    precision_auc, success_auc, normalised_precision_auc : float or None
        Areas under the curves over all scored frames.
    normalised_precision_20 : float or None
        Share of scored frames with a normalised error of at most 0.2, as in LaSOT.
    on_target : float or None
        Share of visible frames with an error below half the true box's diagonal.
    hidden_not_tracking : float or None
        Share of hidden frames in which the mode is not TRACKING.
    visible_tracking : float or None
        Share of visible frames in which the mode is TRACKING.
    occluded_precision : float or None
        Share of the scored frames with the mode OCCLUDED that are hidden.
    occluded_precision_partial : float or None
        Share of the scored frames with the mode OCCLUDED that are hidden or partially occluded.
    occluded_recall : float or None
        Share of hidden frames with the mode OCCLUDED; LOST is no such claim.
    lost_hidden, lost_visible : int
        Hidden and visible frames with the mode LOST.
    failures : int
        Number of times that the estimate lost all overlap with a visible vehicle; see
        `count_failures`.
    frames_by_mode : mapping of str to int
        Number of frames by mode, scored or not.
    step_ms_p50, step_ms_p95 : float or None
        Median and 95 % quantile of the time of a step, ms.
    occlusions : tuple of OcclusionScore
        Scores of the total occlusions in order.
    restarts : RestartScores or None
        Scores of a second run, with restarts after failure; None where there was none. No other
        metric is of that run.
    """

    frames: int
    frames_scored: int
    frames_without_truth: int
    frames_waiting: int
    truths_unmatched: int
    frames_standing: int
    rmse_px: float | None
    rmse_visible_px: float | None
    median_px: float | None
    p95_px: float | None
    max_px: float | None
    p_error_lt_15px: float | None
    precision_20px: float | None
    precision_auc: float | None
    success_auc: float | None
    normalised_precision_auc: float | None
    normalised_precision_20: float | None
    on_target: float | None
    hidden_not_tracking: float | None
    visible_tracking: float | None
    occluded_precision: float | None
    occluded_precision_partial: float | None
    occluded_recall: float | None
    lost_hidden: int
    lost_visible: int
    failures: int
    frames_by_mode: Mapping[str, int]
    step_ms_p50: float | None
    step_ms_p95: float | None
    occlusions: tuple[OcclusionScore, ...]
    restarts: RestartScores | None = None

    @property
    def restart_accuracy(self) -> float | None:
        """Mean overlap with restarts."""
        return None if self.restarts is None else self.restarts.accuracy

    @property
    def restart_robustness(self) -> float | None:
        """Chance of no failure in 100 visible frames, with restarts."""
        return None if self.restarts is None else self.restarts.robustness

    @property
    def restart_failures(self) -> int | None:
        """Number of failures with restarts."""
        return None if self.restarts is None else self.restarts.failures

    @property
    def recovered(self) -> tuple[bool | None, ...]:
        """Recovery of the track after each total occlusion; None where that is not judged."""
        return tuple(occlusion.recovered for occlusion in self.occlusions)

    def to_json(self) -> dict[str, Any]:
        """Return plain values for JSON, with `recovered` and the number not judged."""
        values = asdict(self)
        if self.restarts is None:
            del values["restarts"]
        return {
            **values,
            "recovered": list(self.recovered),
            "occlusions_not_judged": self.recovered.count(None),
        }


def measure(scores: Scores) -> Metrics:
    """Take the metrics of a run."""
    # 1. Groups of frames: a metric differs from the next by its group more than by its formula.
    counted = scores.counted
    by_name = curves(scores.counted)
    visible = [frame for frame in counted if not frame.hidden]
    hidden = [frame for frame in counted if frame.hidden]
    occluded = [frame for frame in counted if frame.row.mode == Mode.OCCLUDED]
    errors = errors_of(counted)
    precision, success, normalised = map(by_name.get, ("precision", "success", "normalised"))
    times = [frame.row.step_ms for frame in scores.frames if frame.row.step_ms is not None]
    modes = Counter(frame.row.mode for frame in scores.frames)
    # 2. Each metric of its group.
    return Metrics(
        frames=len(scores.frames),
        frames_scored=len(counted),
        frames_without_truth=sum(frame.truth is None for frame in scores.frames),
        frames_waiting=sum(frame.waiting for frame in scores.frames),
        truths_unmatched=scores.truths_unmatched,
        frames_standing=sum(frame.stands_still for frame in counted),
        rmse_px=_rms(errors),
        rmse_visible_px=_rms(errors_of(visible)),
        median_px=_quantile(errors, 0.5),
        p95_px=_quantile(errors, 0.95),
        max_px=_quantile(errors, 1.0),
        # In a share a frame without an error is a miss; in means and quantiles it is not there.
        p_error_lt_15px=_share([f.error is not None and f.error < CLOSE_PX for f in counted]),
        precision_20px=precision.at(PRECISION_PX) if precision else None,
        precision_auc=precision.auc if precision else None,
        success_auc=success.auc if success else None,
        normalised_precision_auc=normalised.auc if normalised else None,
        normalised_precision_20=normalised.at(NORMALISED_PRECISION) if normalised else None,
        on_target=_share([is_on_target(frame) for frame in visible]),
        # Claims are taken from the row itself, also where an earlier estimate is scored.
        hidden_not_tracking=_share([frame.row.mode != Mode.TRACKING for frame in hidden]),
        visible_tracking=_share([frame.row.mode == Mode.TRACKING for frame in visible]),
        occluded_precision=_share([frame.hidden for frame in occluded]),
        # Once more with partial occlusions: who reports these as OCCLUDED is not wrong.
        occluded_precision_partial=_share([_is_occluded(frame) for frame in occluded]),
        occluded_recall=_share([frame.row.mode == Mode.OCCLUDED for frame in hidden]),
        lost_hidden=sum(frame.row.mode == Mode.LOST for frame in hidden),
        lost_visible=sum(frame.row.mode == Mode.LOST for frame in visible),
        # All frames: it leaves out by itself those that cannot fail.
        failures=count_failures(scores.frames),
        # Known modes in a fixed order, absent ones as 0; then what else a file has.
        frames_by_mode={name: modes.pop(name, 0) for name in _MODES} | modes,
        step_ms_p50=_quantile(times, 0.5),
        step_ms_p95=_quantile(times, 0.95),
        occlusions=score_occlusions(counted),
    )


def is_on_target(frame: FrameScore) -> bool:
    """Return whether the error is below half the true box's diagonal."""
    error = frame.error
    truth = frame.truth
    # Relative to the vehicle alone; `threshold` excuses 15 px, this does not.
    return truth is not None and error is not None and error < truth.box.diagonal / 2


def _is_occluded(frame: FrameScore) -> bool:
    return frame.truth is not None and frame.truth.occlusion is not Occlusion.NONE


def _rms(values: Sequence[float]) -> float | None:
    return float(np.sqrt(np.mean(np.square(values)))) if values else None


def _quantile(values: Sequence[float], share: float) -> float | None:
    return float(np.quantile(values, share)) if values else None


def _share(hits: Sequence[bool]) -> float | None:
    return sum(hits) / len(hits) if hits else None
