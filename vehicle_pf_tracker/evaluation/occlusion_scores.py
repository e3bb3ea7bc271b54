# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scores of total occlusions: whether, when and how well the vehicle was found again."""

from __future__ import annotations

import itertools
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.evaluation.scores import FrameScore, errors_of, threshold

SETTLING_FRAMES = 15
"""Frames after the last hidden one before a track is judged: half a second at 30 Hz, in which a
tracker may re-detect the vehicle."""
FEWEST_JUDGED = 5
"""Fewest frames that a recovery is judged by, a choice: the mean of fewer says more of noise."""


@dataclass(frozen=True, slots=True)
class OcclusionScore:
    """One total occlusion.

    Attributes
    ----------
    first_frame, last_frame : int
        Numbers of the first and the last hidden frame.
    hidden_frames : int
        Number of hidden frames with truth.
    error_inside_px : float or None
        Mean error over the hidden frames.
    judged_frames : int
        Frames from `SETTLING_FRAMES` after `last_frame` until the next total occlusion or the end.
    error_after_px : float or None
        Mean error over the judged frames.
    threshold_px : float or None
        Mean over them of the larger of `CLOSE_PX` and half the true box's diagonal.
    recovered : bool or None
        True if `error_after_px` is below `threshold_px`; None where there are fewer than
        `FEWEST_JUDGED` frames to judge by.
    error_at_exit_px : float or None
        Error in the first frame after `last_frame`.
    frames_to_recover : int or None
        Frames from `last_frame` to the first of `FEWEST_JUDGED` scored frames in a row that are on
        the vehicle (see `threshold`); None where there are none before the next total occlusion.
    """

    first_frame: int
    last_frame: int
    hidden_frames: int
    error_inside_px: float | None
    judged_frames: int
    error_after_px: float | None
    threshold_px: float | None
    recovered: bool | None
    error_at_exit_px: float | None
    frames_to_recover: int | None


def score_occlusions(counted: Sequence[FrameScore]) -> tuple[OcclusionScore, ...]:
    """Judge every total occlusion in the scored frames of a recording, given in its order."""
    # Stretches of hidden and of other frames by turns: each hidden one is judged by the next.
    parts = [list(part) for _, part in itertools.groupby(counted, lambda frame: frame.hidden)]
    # After the last stretch nothing follows: such an occlusion is not judged.
    pairs = zip(parts, [*parts[1:], []], strict=False)
    return tuple(_judge(part, seen) for part, seen in pairs if part[0].hidden)


def _judge(hidden: Sequence[FrameScore], seen: Sequence[FrameScore]) -> OcclusionScore:
    last = hidden[-1].row.frame
    # By the number of the frame: time passes in frames without truth, too.
    judged = [f for f in seen if f.row.frame >= last + SETTLING_FRAMES and f.error is not None]
    after = _mean_error(judged)
    # Both are means over the same frames, as the vehicle may grow meanwhile.
    limit = statistics.fmean(map(threshold, judged)) if judged else None
    # Three answers: too few frames say neither yes nor no.
    recovered: bool | None = None
    if after is not None and limit is not None and len(judged) >= FEWEST_JUDGED:
        recovered = after < limit
    return OcclusionScore(
        first_frame=hidden[0].row.frame,
        last_frame=last,
        hidden_frames=len(hidden),
        error_inside_px=_mean_error(hidden),
        judged_frames=len(judged),
        error_after_px=after,
        threshold_px=limit,
        recovered=recovered,
        # Before the settling: how far off it is when the vehicle can be seen again.
        error_at_exit_px=seen[0].error if seen else None,
        frames_to_recover=_frames_to_recover(last, seen),
    )


def _frames_to_recover(last_hidden: int, seen: Sequence[FrameScore]) -> int | None:
    # Each frame by its own threshold, as the vehicle grows or shrinks meanwhile.
    on_vehicle = [frame.error is not None and frame.error < threshold(frame) for frame in seen]
    starts = max(len(seen) - FEWEST_JUDGED + 1, 0)
    for index, frame in enumerate(seen[:starts]):
        # A row of them: an estimate that drifts across the vehicle has not recovered it.
        if all(on_vehicle[index : index + FEWEST_JUDGED]):
            return frame.row.frame - last_hidden
    return None


def _mean_error(frames: Sequence[FrameScore]) -> float | None:
    errors = errors_of(frames)
    return statistics.fmean(errors) if errors else None
