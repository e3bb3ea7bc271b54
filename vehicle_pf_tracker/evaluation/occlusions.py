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

"""Recovery from total occlusions, and failures with re-starts.

As in the VOT challenge, an estimate without overlap with the truth is a failure. In a total
occlusion the vehicle cannot be seen: its frames do not fail, and no tracker is re-started in them.
Source: Kristan et al. 2016, "A novel performance evaluation methodology for single-target
trackers".
"""

from __future__ import annotations

import itertools
import math
import statistics
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from typing import Any, Protocol

from vehicle_pf_tracker.core.clock import associate
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.scores import FrameScore, score_frames
from vehicle_pf_tracker.offline.estimates import WAITING, EstimateRow

SETTLING_FRAMES = 15
"""Frames after the last hidden one before a track is judged: half a second at 30 Hz, in which a
tracker may re-detect the vehicle."""
FEWEST_JUDGED = 5
"""Fewest frames that a recovery is judged by: the mean of fewer says more of noise."""
CLOSE_PX = 15.0
"""Error in px that counts as on the vehicle, however small it is: the threshold of
Scharcanski et al. 2011, section IV, P(error < 15 px)."""


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
    stretches = list(_hidden_stretches(counted))
    ends = [begin for begin, _ in stretches[1:]] + [len(counted)]
    return tuple(
        _judge(counted[begin:end], counted[end:until])
        for (begin, end), until in zip(stretches, ends, strict=False)
    )


def threshold(frame: FrameScore) -> float:
    """Error in px below which the estimate is on the vehicle."""
    assert frame.truth is not None
    return max(CLOSE_PX, frame.truth.box.diagonal / 2)


def _hidden_stretches(counted: Sequence[FrameScore]) -> Iterator[tuple[int, int]]:
    for hidden, group in itertools.groupby(enumerate(counted), lambda pair: pair[1].hidden):
        if hidden:
            indices = [index for index, _ in group]
            yield indices[0], indices[-1] + 1


def _judge(hidden: Sequence[FrameScore], seen: Sequence[FrameScore]) -> OcclusionScore:
    last = hidden[-1].row.frame
    judged = [f for f in seen if f.row.frame >= last + SETTLING_FRAMES and f.error is not None]
    after, limit = _mean_error(judged), None
    recovered: bool | None = None
    if judged:
        limit = statistics.fmean(map(threshold, judged))
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
        error_at_exit_px=seen[0].error if seen else None,
        frames_to_recover=_frames_to_recover(last, seen),
    )


def _frames_to_recover(last_hidden: int, seen: Sequence[FrameScore]) -> int | None:
    on_vehicle = [frame.error is not None and frame.error < threshold(frame) for frame in seen]
    for index, frame in enumerate(seen[: len(seen) - FEWEST_JUDGED + 1]):
        if all(on_vehicle[index : index + FEWEST_JUDGED]):
            return frame.row.frame - last_hidden
    return None


def _mean_error(frames: Sequence[FrameScore]) -> float | None:
    errors = [frame.error for frame in frames if frame.error is not None]
    return statistics.fmean(errors) if errors else None


RESTART_AFTER = 5
"""Frames from a failure to the first possible re-start: VOT's value (Kristan et al. 2016)."""
BURN_IN = 10
"""Frames from a start left out of the accuracy: VOT's value (Kristan et al. 2016)."""
ROBUSTNESS_FRAMES = 30
"""Frames of which robustness is the probability to survive them: VOT's S = 30."""


@dataclass(frozen=True, slots=True)
class RestartedRun:
    """Score of a run with re-starts.

    Attributes
    ----------
    failures : int
        Number of failures.
    frames : int
        Scored frames that were tracked: those between a failure and the next start are left out.
    accuracy : float or None
        Mean overlap, 0 to 1, over tracked frames that are not hidden and past the burn-in.
    robustness : float or None
        ``exp(-30 failures / frames)``: the probability to survive 30 frames.
    """

    failures: int
    frames: int
    accuracy: float | None
    robustness: float | None


def is_failure(frame: FrameScore) -> bool:
    """Return whether the estimate misses a visible vehicle; False where nothing is scored."""
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
    """Count the stretches of failures in a run without re-starts.

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
        Indices in order; from the second on each follows a failure.
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


class _Footage(Protocol):
    @property
    def truth(self) -> tuple[Truth, ...]: ...

    def frames(self) -> Iterator[tuple[int, Frame | None]]: ...


class _Follower(Protocol):
    def rows(self, frames: Iterable[tuple[int, Frame | None]]) -> Iterator[EstimateRow]: ...


def follow_restarted(
    footage: _Footage, make: Callable[[Truth], _Follower], max_diff: float
) -> tuple[list[EstimateRow], dict[str, Any]]:
    """Track through a recording, started anew on the truth after each failure.

    Between a failure and the next start the rows are ``WAITING``.

    Parameters
    ----------
    footage : Footage
        The recording.
    make : callable
        Makes the tracker of the vehicle, from the truth to start on.
    max_diff : float
        Largest difference of stamps that belong together, in s.

    Returns
    -------
    rows : list of EstimateRow
        One per frame.
    summary : dict
        The fields of `RestartedRun`, and the numbers of the frames started in.
    """
    stamps = [stamp for stamp, _ in footage.frames()]
    waiting = [EstimateRow.without(n, stamp, WAITING) for n, stamp in enumerate(stamps, start=1)]
    blank = score_frames(waiting, footage.truth, max_diff).frames
    rows: list[EstimateRow] = []
    starts: list[int] = []
    begin = _first(stamps, footage.truth, max_diff)
    while begin is not None:
        truth = blank[begin].truth
        assert truth is not None
        rows += waiting[len(rows) : begin]
        starts.append(begin)
        frames = itertools.islice(footage.frames(), begin, None)
        failure = _follow(make(truth), frames, blank, rows)
        begin = None if failure is None else restart_index(blank, failure)
    rows += waiting[len(rows) :]
    run = score_restarts(score_frames(rows, footage.truth, max_diff).frames, starts)
    return rows, {**asdict(run), "start_frames": [start + 1 for start in starts]}


def _first(stamps: Sequence[int], truths: Sequence[Truth], max_diff: float) -> int | None:
    """Return the index of the frame that the first truth belongs to."""
    return min(associate(stamps, [truth.stamp_ns for truth in truths], max_diff), default=None)


def _follow(
    follower: _Follower,
    frames: Iterator[tuple[int, Frame | None]],
    blank: Sequence[FrameScore],
    rows: list[EstimateRow],
) -> int | None:
    """Add rows up to the first failure, and return its index; None if it comes to the end."""
    begin = len(rows)
    standing: EstimateRow | None = None
    generator = follower.rows(frames)
    with closing(generator):  # type: ignore[type-var]
        for row in generator:
            index = len(rows)
            rows.append(EstimateRow(**{**asdict(row), "frame": index + 1}))
            score = FrameScore(rows[-1], blank[index].truth, standing)
            if index > begin and first_failure([score]) is not None:
                return index
            standing = score.scored_row
    return None
