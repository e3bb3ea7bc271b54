"""Failures in the manner of the VOT challenge: the estimate has nothing in common with the truth.

A total occlusion is no failure, since nobody could see the vehicle: neither are its frames
failures, nor is a tracker started anew in them. Source: Kristan et al. 2016, "A novel performance
evaluation methodology for single-target trackers".
"""

from __future__ import annotations

import itertools
import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.core.truth import Occlusion
from vehicle_pf_tracker.evaluation.scores import FrameScore

RESTART_AFTER = 5
"""Frames from a failure to the first in which the tracker may be started anew."""
BURN_IN = 10
"""Frames from a start that say little about accuracy, the start itself among them."""
ROBUSTNESS_FRAMES = 30
"""Robustness is the chance to live through so many frames."""


@dataclass(frozen=True, slots=True)
class RestartedRun:
    """What a run with re-starts is worth.

    Attributes
    ----------
    failures : int
        How often the track failed.
    frames : int
        Scored frames that were tracked: those between a failure and the next start are left out.
    accuracy : float or None
        Mean overlap, 0 to 1, over tracked frames that are not hidden and past the burn-in.
    robustness : float or None
        ``exp(-30 failures / frames)``: the chance to live through 30 frames.
    """

    failures: int
    frames: int
    accuracy: float | None
    robustness: float | None


def is_failure(frame: FrameScore) -> bool:
    """Whether the estimate misses a vehicle that can be seen; False where nothing is scored."""
    return frame.counts and not frame.hidden and not frame.overlap


def first_failure(frames: Sequence[FrameScore], begin: int = 0) -> int | None:
    """Return the index of the first failure from the index `begin` on; None if there is none."""
    return next((i for i in range(begin, len(frames)) if is_failure(frames[i])), None)


def restart_index(frames: Sequence[FrameScore], failure: int) -> int | None:
    """Return the index at which to start anew after the failure at index `failure`.

    That is the first frame, `RESTART_AFTER` frames on or later, in which the vehicle is in full
    view; None if there is none.
    """
    later = range(failure + RESTART_AFTER, len(frames))
    return next((i for i in later if _in_full_view(frames[i])), None)


def count_failures(frames: Sequence[FrameScore]) -> int:
    """Count the stretches of failures in a run that nobody re-started.

    Frames in which the vehicle is hidden or the truth is unknown do not end a stretch.
    """
    judged = (is_failure(frame) for frame in frames if frame.counts and not frame.hidden)
    return sum(failed for failed, _ in itertools.groupby(judged))


def score_restarts(frames: Sequence[FrameScore], starts: Sequence[int]) -> RestartedRun:
    """Score a run that was started at the indices `starts`.

    Parameters
    ----------
    frames : sequence of FrameScore
        The whole recording; each frame with the estimate of the start before it.
    starts : sequence of int
        In order; from the second on each follows a failure.
    """
    ends = [*starts[1:], len(frames)]
    failures, tracked, overlaps = 0, 0, list[float]()
    for start, end in zip(starts, ends, strict=True):
        failure = first_failure(frames[:end], start)
        failures += failure is not None
        lived = frames[start : end if failure is None else failure]
        tracked += sum(frame.counts for frame in lived)
        clear = (frame for frame in lived[BURN_IN:] if frame.counts and not frame.hidden)
        overlaps += [frame.overlap or 0.0 for frame in clear]
    return RestartedRun(
        failures=failures,
        frames=tracked,
        accuracy=statistics.fmean(overlaps) if overlaps else None,
        robustness=math.exp(-ROBUSTNESS_FRAMES * failures / tracked) if tracked else None,
    )


def _in_full_view(frame: FrameScore) -> bool:
    return frame.truth is not None and frame.truth.occlusion is Occlusion.NONE
