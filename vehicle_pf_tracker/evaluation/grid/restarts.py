"""Runs that are started anew after each failure, in the manner of VOT (`evaluation.failures`)."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import asdict
from typing import Any, Protocol

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.association import associate
from vehicle_pf_tracker.evaluation.estimates import WAITING, EstimateRow
from vehicle_pf_tracker.evaluation.failures import (
    first_failure,
    restart_index,
    score_restarts,
)
from vehicle_pf_tracker.evaluation.scores import FrameScore, score_frames


class _Footage(Protocol):
    @property
    def truth(self) -> tuple[Truth, ...]: ...

    def frames(self) -> Iterator[tuple[int, Frame | None]]: ...


class _Follower(Protocol):
    def rows(self, frames: Iterable[tuple[int, Frame | None]]) -> Iterator[EstimateRow]: ...


def follow_restarted(
    footage: _Footage, make: Callable[[Truth], _Follower], max_diff: float
) -> tuple[list[EstimateRow], dict[str, Any]]:
    """Follow through a recording, started anew on the truth after each failure.

    Between a failure and the next start the rows are ``WAITING``.

    Parameters
    ----------
    footage : Footage
        The recording.
    make : callable
        Makes what follows the vehicle, from the truth to start on.
    max_diff : float
        Largest difference of stamps that belong together, in s.

    Returns
    -------
    rows : list of EstimateRow
        One per frame.
    summary : dict
        The fields of `failures.RestartedRun`, and the numbers of the frames started in.
    """
    stamps = [stamp for stamp, _ in footage.frames()]
    waiting = [EstimateRow.without(n, stamp, WAITING) for n, stamp in enumerate(stamps, start=1)]
    blank = score_frames(waiting, footage.truth, max_diff).frames
    rows: list[EstimateRow] = []
    starts: list[int] = []
    place = _first(stamps, footage.truth, max_diff)
    while place is not None:
        truth = blank[place].truth
        assert truth is not None
        rows += waiting[len(rows) : place]
        starts.append(place)
        frames = itertools.islice(footage.frames(), place, None)
        failure = _follow(make(truth), frames, blank, rows)
        place = None if failure is None else restart_index(blank, failure)
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
