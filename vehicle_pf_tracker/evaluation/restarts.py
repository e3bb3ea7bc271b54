# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Restarts after failure, the supervised protocol of the VOT challenge, and its scores.

Without restarts an early failure decides the rest of a recording. Here a system that lost all
overlap with a visible vehicle is stopped, and starts anew from the truth some frames later.
Source: Kristan et al. 2016, "A novel performance evaluation methodology for single-target
trackers".
"""

from __future__ import annotations

import contextlib
import itertools
import math
import statistics
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from vehicle_pf_tracker.core.association import associate
from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.scores import FrameScore, Scores, is_failure
from vehicle_pf_tracker.results.estimates import REJECTED_MODE, WAITING_MODE, EstimateRow

BURN_IN = 10
"""Frames from each start that accuracy leaves out, VOT's number: they overlap with the truth
because they began on it."""
SPAN = 100
"""Visible frames that robustness is the chance for: three to four seconds of video."""

Start: TypeAlias = Callable[[int, Box], Generator[EstimateRow, None, None]]
"""Starts a system anew on a box in the frame of an index; gives the rows from that frame on."""


def with_restarts(
    rows: Sequence[EstimateRow],
    truths: Sequence[Truth],
    max_diff: float,
    wait: int,
    size: tuple[int, int],
    start: Start,
) -> list[EstimateRow]:
    """Return the rows of a run with restarts: one per frame, `WAITING_MODE` from failure to start.

    Parameters
    ----------
    rows : sequence of EstimateRow
        The run without restarts, whose beginning is the same.
    truths : sequence of Truth
        True states of the vehicle.
    max_diff : float
        Largest difference of stamps that belong together, in s.
    wait : int
        Frames from a failure to the next start; a later one where the vehicle is totally occluded,
        or its box is unknown.
    size : (int, int)
        Width and height of the images, px.
    start : callable
        Starts the system anew; what it gives is closed after a failure.
    """
    pairs = associate([row.stamp_ns for row in rows], [t.stamp_ns for t in truths], max_diff)
    known = [truths[pairs[i]] if i in pairs else None for i in range(len(rows))]
    found = list(_until_failure(rows, known))
    while len(found) < len(rows):
        failed = len(found) - 1
        later = range(failed + wait, len(rows))
        next_start = next((i for i in later if _may_start(rows[i], known[i], size)), len(rows))
        found += (
            EstimateRow.without(row.frame, row.stamp_ns, WAITING_MODE)
            for row in rows[failed + 1 : next_start]
        )
        if next_start < len(rows) and (truth := known[next_start]):
            with contextlib.closing(start(next_start, truth.box)) as part:
                found += _until_failure(part, known[next_start:])
    return found


def _until_failure(
    rows: Iterable[EstimateRow], truths: Sequence[Truth | None]
) -> Iterator[EstimateRow]:
    """Yield rows up to the first failure, itself included."""
    standing: EstimateRow | None = None
    for row, truth in zip(rows, truths, strict=False):
        score = FrameScore(row, truth, standing)
        yield row
        if is_failure(score):
            return
        standing = None if score.waiting else score.scored_row


def _may_start(row: EstimateRow, truth: Truth | None, size: tuple[int, int]) -> bool:
    # What the run without restarts rejected is no image to start in.
    if truth is None or truth.occlusion is Occlusion.TOTAL or row.mode == REJECTED_MODE:
        return False
    try:
        check_target(truth.box, *size)
    except InputError:
        return False
    return True


@dataclass(frozen=True, slots=True)
class RestartScores:
    """Scores of a run with restarts.

    Attributes
    ----------
    frames : int
        Visible frames in which the system was followed.
    failures : int
        Failures, each of which is followed by a start where there is a frame for it.
    accuracy : float or None
        Mean overlap over visible frames without failure, `BURN_IN` frames after each start; None
        without any.
    robustness : float or None
        ``exp(-SPAN failures / frames)``: chance of no failure in `SPAN` visible frames; None
        without frames.
    """

    frames: int
    failures: int
    accuracy: float | None
    robustness: float | None


def measure_restarts(scores: Scores) -> RestartScores:
    """Measure a run with restarts."""
    visible = [frame for frame in scores.counted if not frame.hidden]
    failures = sum(map(is_failure, visible))
    overlaps = [
        frame.overlap
        for part in _parts(scores.frames)
        for frame in part[BURN_IN:]
        if frame.counts and not frame.hidden and not is_failure(frame) and frame.overlap
    ]
    return RestartScores(
        frames=len(visible),
        failures=failures,
        accuracy=statistics.fmean(overlaps) if overlaps else None,
        robustness=math.exp(-SPAN * failures / len(visible)) if visible else None,
    )


def _parts(frames: Sequence[FrameScore]) -> Iterator[list[FrameScore]]:
    """Yield the frames from each start to its failure or the end."""
    part: list[FrameScore] = []
    for frame in itertools.filterfalse(lambda frame: frame.waiting, frames):
        part.append(frame)
        if is_failure(frame):
            yield part
            part = []
    yield part
