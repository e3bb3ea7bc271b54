"""What a run is worth, in numbers.

Scored are the frames that have truth, from the frame on in which the target was set. Hidden frames
are those in which it is totally occluded, visible ones the rest. A frame without an estimate (the
tracker rejected it) counts as a miss in every share, and is left out of means and quantiles.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from vehicle_pf_tracker.evaluation.estimates import REJECTED, WAITING
from vehicle_pf_tracker.evaluation.occlusions import CLOSE_PX, OcclusionScore, score_occlusions
from vehicle_pf_tracker.evaluation.scores import FrameScore, Scores
from vehicle_pf_tracker.trackers.estimate import Mode

PRECISION_PX = 20.0
"""Threshold of the precision that the OTB benchmark ranks by."""


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
    rmse_px, median_px, max_px : float or None
        Error of the centre over all scored frames.
    rmse_visible_px : float or None
        The same over visible frames.
    p_error_lt_15px : float or None
        Share of scored frames with an error below 15 px.
    precision_20px : float or None
        Share of scored frames with an error of at most 20 px, as in OTB.
    on_target : float or None
        Share of visible frames with an error below half the true box's diagonal.
    hidden_not_tracking : float or None
        Share of hidden frames in which the mode is not TRACKING.
    visible_tracking : float or None
        Share of visible frames in which it is.
    frames_by_mode : mapping of str to int
        Number of frames, scored or not.
    step_ms_p50, step_ms_p95 : float or None
        Time of a step in ms.
    occlusions : tuple of OcclusionScore
        The total occlusions in order.
    """

    frames: int
    frames_scored: int
    frames_without_truth: int
    frames_waiting: int
    truths_unmatched: int
    rmse_px: float | None
    rmse_visible_px: float | None
    median_px: float | None
    max_px: float | None
    p_error_lt_15px: float | None
    precision_20px: float | None
    on_target: float | None
    hidden_not_tracking: float | None
    visible_tracking: float | None
    frames_by_mode: Mapping[str, int]
    step_ms_p50: float | None
    step_ms_p95: float | None
    occlusions: tuple[OcclusionScore, ...]

    @property
    def recovered(self) -> tuple[bool | None, ...]:
        """For each total occlusion whether the track recovered; None where that is not judged."""
        return tuple(occlusion.recovered for occlusion in self.occlusions)

    def to_json(self) -> dict[str, Any]:
        """Everything as plain values, `recovered` and the number not judged beside it."""
        return {
            **asdict(self),
            "recovered": list(self.recovered),
            "occlusions_not_judged": self.recovered.count(None),
        }


def measure(scores: Scores) -> Metrics:
    """Take the metrics of a run."""
    counted = scores.counted
    visible = [frame for frame in counted if not frame.hidden]
    hidden = [frame for frame in counted if frame.hidden]
    errors = _errors(counted)
    return Metrics(
        frames=len(scores.frames),
        frames_scored=len(counted),
        frames_without_truth=sum(frame.truth is None for frame in scores.frames),
        frames_waiting=sum(frame.waiting for frame in scores.frames),
        truths_unmatched=scores.truths_unmatched,
        rmse_px=_rms(errors),
        rmse_visible_px=_rms(_errors(visible)),
        median_px=_quantile(errors, 0.5),
        max_px=_quantile(errors, 1.0),
        p_error_lt_15px=_share([e is not None and e < CLOSE_PX for e in _all_errors(counted)]),
        precision_20px=_share([e is not None and e <= PRECISION_PX for e in _all_errors(counted)]),
        on_target=_share([is_on_target(frame) for frame in visible]),
        hidden_not_tracking=_share([frame.row.mode != Mode.TRACKING for frame in hidden]),
        visible_tracking=_share([frame.row.mode == Mode.TRACKING for frame in visible]),
        frames_by_mode=_by_mode(scores.frames),
        step_ms_p50=_quantile(_step_times(scores.frames), 0.5),
        step_ms_p95=_quantile(_step_times(scores.frames), 0.95),
        occlusions=score_occlusions(counted),
    )


def is_on_target(frame: FrameScore) -> bool:
    """Whether the error is below half the true box's diagonal."""
    if frame.truth is None or frame.error is None:
        return False
    return frame.error < frame.truth.box.diagonal / 2


def _all_errors(frames: Sequence[FrameScore]) -> list[float | None]:
    return [frame.error for frame in frames]


def _errors(frames: Sequence[FrameScore]) -> list[float]:
    return [error for error in _all_errors(frames) if error is not None]


def _step_times(frames: Sequence[FrameScore]) -> list[float]:
    return [frame.row.step_ms for frame in frames if frame.row.step_ms is not None]


def _by_mode(frames: Sequence[FrameScore]) -> dict[str, int]:
    counts = Counter(frame.row.mode for frame in frames)
    names = [*(mode.value for mode in Mode), WAITING, REJECTED]
    return {name: counts.pop(name, 0) for name in names} | counts


def _rms(values: Sequence[float]) -> float | None:
    return float(np.sqrt(np.mean(np.square(values)))) if values else None


def _quantile(values: Sequence[float], share: float) -> float | None:
    return float(np.quantile(values, share)) if values else None


def _share(hits: Sequence[bool]) -> float | None:
    return sum(hits) / len(hits) if hits else None
