# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scores of a tracker's run through a case."""

from __future__ import annotations

import hashlib
import itertools
import statistics
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from laboratory.stress.calibration import Reliability
from laboratory.stress.cases import Case
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.metrics import is_on_target
from vehicle_pf_tracker.evaluation.occlusion_scores import score_occlusions
from vehicle_pf_tracker.evaluation.scores import FrameScore, score_frames
from vehicle_pf_tracker.recordings.footage import stamp_of
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode

LOST_BELOW = 0.9
"""A run with a smaller share of visible frames on target counts as lost."""


@dataclass(frozen=True, slots=True)
class Score:
    """Measures of a run; None where there is no frame to take them from.

    Attributes
    ----------
    frames, visible, hidden : int
        Scored frames, those with the vehicle in view, those with it totally hidden.
    on_target : float or None
        Share of visible frames with an error below half the true box's diagonal.
    mean_iou : float or None
        Mean overlap with the true box over visible frames.
    rmse_visible_px : float or None
        Error of the centre over visible frames.
    lost : bool or None
        `on_target` is below `LOST_BELOW`.
    recovered, judged : int
        Total occlusions after which the track recovered, and those that could be judged, by the
        rule of `occlusions`.
    occlusions : tuple of (int, bool or None)
        Hidden frames of each total occlusion, and whether the track recovered.
    doubted : float or None
        Share of visible frames with the mode OCCLUDED or LOST.
    doubted_in_full_view : float or None
        Share of frames in which nothing is hidden, with the mode OCCLUDED or LOST.
    claimed_hidden : float or None
        Share of totally hidden frames with the mode TRACKING.
    longest_false_tracking : int
        Longest run of frames with the mode TRACKING and an error above the true box's diagonal.
    reliability_visible, reliability_hidden : Reliability
        Confidence against being on target, first frame left out, which is given.
    estimates : str
        Digest of all estimates but for their times: equal for bit-identical runs.
    fault : str
        Reason why the tracker did not come to the end; then no frame is on target. Empty if it did.
    """

    frames: int
    visible: int
    hidden: int
    on_target: float | None
    mean_iou: float | None
    rmse_visible_px: float | None
    lost: bool | None
    recovered: int
    judged: int
    occlusions: tuple[tuple[int, bool | None], ...]
    doubted: float | None
    doubted_in_full_view: float | None
    claimed_hidden: float | None
    longest_false_tracking: int
    reliability_visible: Reliability
    reliability_hidden: Reliability
    estimates: str
    fault: str = ""

    def to_json(self) -> dict[str, Any]:
        """Everything as plain values."""
        return asdict(self)

    @classmethod
    def from_json(cls, entry: dict[str, Any]) -> Score:
        """Read what `to_json` gave."""
        parts = {
            "occlusions": tuple((int(n), recovered) for n, recovered in entry["occlusions"]),
            "reliability_visible": Reliability.from_json(entry["reliability_visible"]),
            "reliability_hidden": Reliability.from_json(entry["reliability_hidden"]),
        }
        return cls(**{**entry, **parts})


def score_case(case: Case, estimates: Iterable[Estimate | EstimateRow], fault: str = "") -> Score:
    """Score a tracker's estimates in the frames of a case.

    Parameters
    ----------
    case : Case
        Case, whose truth is computed anew without decoding an image.
    estimates : iterable of Estimate or EstimateRow
        Estimates, one per frame; fewer only if there was a fault.
    fault : str
        Reason why there are fewer.
    """
    return score_estimates(case.truths(), estimates, case.fps, fault)


def score_estimates(
    truths: Sequence[Truth | None],
    estimates: Iterable[Estimate | EstimateRow],
    fps: float = 30.0,
    fault: str = "",
) -> Score:
    """Score estimates against the truth of the same frames; see `score_case`."""
    # A frame without truth has an estimate, too, which needs a stamp.
    stamps = [t.stamp_ns if t else stamp_of(i, fps) for i, t in enumerate(truths)]
    rows = [_row(i, stamps[i - 1], each) for i, each in enumerate(estimates, start=1)]
    # Fewer estimates without a fault would score the missing frames as lost, and hide the bug.
    assert len(rows) == len(truths) or fault, "a frame without an estimate"
    # A tracker that failed has lost its vehicle in all later frames, and is scored as that.
    rows += [
        EstimateRow.without(i + 1, stamps[i], Mode.LOST) for i in range(len(rows), len(truths))
    ]
    # A tolerance of 0: estimates have the very stamps of the truth.
    counted = score_frames(rows, [truth for truth in truths if truth is not None], 0.0).counted
    visible = [frame for frame in counted if not frame.hidden]
    hidden = [frame for frame in counted if frame.hidden]
    return Score(
        frames=len(counted),
        visible=len(visible),
        hidden=len(hidden),
        **_accuracy(visible, fault),
        **_recoveries(counted),
        **_modes(visible, hidden),
        longest_false_tracking=_longest(map(_is_false_tracking, counted)),
        reliability_visible=Reliability.of(_pairs(counted[1:], hidden=False)),
        reliability_hidden=Reliability.of(_pairs(counted[1:], hidden=True)),
        estimates=_digest(rows),
        fault=fault,
    )


def _accuracy(visible: Sequence[FrameScore], fault: str) -> dict[str, Any]:
    # One fault fails the whole run: half a run is no measure of the tracker.
    on_target = _share([is_on_target(frame) and not fault for frame in visible])
    return {
        "on_target": on_target,
        # Without a box there is no overlap.
        "mean_iou": statistics.fmean(f.overlap or 0.0 for f in visible) if visible else None,
        "rmse_visible_px": _rms([f.error for f in visible if f.error is not None]),
        "lost": None if on_target is None else on_target < LOST_BELOW,
    }


def _recoveries(counted: Sequence[FrameScore]) -> dict[str, Any]:
    judged = score_occlusions(counted)
    return {
        "recovered": sum(each.recovered is True for each in judged),
        "judged": sum(each.recovered is not None for each in judged),
        "occlusions": tuple((each.hidden_frames, each.recovered) for each in judged),
    }


def _modes(visible: Sequence[FrameScore], hidden: Sequence[FrameScore]) -> dict[str, Any]:
    clear = [frame for frame in visible if _occlusion(frame) is Occlusion.NONE]
    return {
        "doubted": _share([frame.row.mode != Mode.TRACKING for frame in visible]),
        "doubted_in_full_view": _share([frame.row.mode != Mode.TRACKING for frame in clear]),
        "claimed_hidden": _share([frame.row.mode == Mode.TRACKING for frame in hidden]),
    }


def _row(number: int, stamp_ns: int, estimate: Estimate | EstimateRow) -> EstimateRow:
    if isinstance(estimate, EstimateRow):
        # A baseline's row has no number and no stamp.
        return replace(estimate, frame=number, stamp_ns=stamp_ns)
    return EstimateRow.from_scalars(number, stamp_ns, estimate.scalars())


def _occlusion(frame: FrameScore) -> Occlusion:
    assert frame.truth is not None
    return frame.truth.occlusion


def _is_false_tracking(frame: FrameScore) -> bool:
    assert frame.truth is not None
    is_far = frame.error is not None and frame.error > frame.truth.box.diagonal
    return is_far and frame.row.mode == Mode.TRACKING


def _longest(hits: Iterable[bool]) -> int:
    runs = (sum(1 for _ in run) for hit, run in itertools.groupby(hits) if hit)
    return max(runs, default=0)


def _pairs(frames: Sequence[FrameScore], *, hidden: bool) -> list[tuple[float, bool]]:
    return [
        (frame.row.confidence, is_on_target(frame))
        for frame in frames
        if frame.row.confidence is not None and frame.hidden is hidden
    ]


def _digest(rows: Sequence[EstimateRow]) -> str:
    # Without step times, which differ from run to run.
    words = ((r.x, r.y, r.width, r.height, r.mode, r.confidence) for r in rows)
    # 16 digits are 64 bits: more than enough to tell runs of one battery apart.
    return hashlib.sha256(repr(list(words)).encode()).hexdigest()[:16]


def _share(hits: Sequence[bool]) -> float | None:
    return sum(hits) / len(hits) if hits else None


def _rms(values: Sequence[float]) -> float | None:
    return statistics.fmean(value**2 for value in values) ** 0.5 if values else None
