# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scores of each frame's estimate against its truth.

One rule serves all systems. What a system estimates is scored as it stands, whatever mode it
claims. Where it gives no estimate, its last one stands: silence neither helps nor hurts more than
holding still does. Before its first estimate there is nothing to stand, and the frame is a miss.

As in the VOT challenge, an estimate without overlap with the truth is a failure. In a total
occlusion the vehicle cannot be seen: its frames do not fail.
Source: Kristan et al. 2016, "A novel performance evaluation methodology for single-target
trackers".
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S, associate
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.results.estimates import WAITING_MODE, EstimateRow

CLOSE_PX = 15.0
"""Error in px that counts as on the vehicle, however small it is: the threshold of
Abdulla et al. 2022, section V, table III, P(error < 15 px)."""


@dataclass(frozen=True, slots=True)
class FrameScore:
    """A frame of a recording, and its truth where that is known.

    Attributes
    ----------
    row : EstimateRow
        Estimate of this frame.
    truth : Truth or None
        Truth of this frame; None where it is unknown.
    standing : EstimateRow or None
        Last earlier row with an estimate, which is scored where `row` has none.
    """

    row: EstimateRow
    truth: Truth | None
    standing: EstimateRow | None = None

    @property
    def waiting(self) -> bool:
        """True if there was no target yet."""
        return self.row.mode == WAITING_MODE

    @property
    def counts(self) -> bool:
        """True if the frame is scored: there is truth, and a target to track."""
        return self.truth is not None and not self.waiting

    @property
    def hidden(self) -> bool:
        """True if the vehicle is totally occluded; False without truth."""
        return self.truth is not None and self.truth.occlusion is Occlusion.TOTAL

    @property
    def scored_row(self) -> EstimateRow | None:
        """The estimate that is scored here; None before there was any."""
        return self.row if _is_estimate(self.row) else self.standing

    @property
    def stands_still(self) -> bool:
        """True if an earlier estimate is scored because this frame has none."""
        return self.standing is not None and not _is_estimate(self.row)

    @property
    def error(self) -> float | None:
        """Distance of the centres in px; None without truth or before the first estimate."""
        offset = self._offset
        # Centres, as not every system estimates a size.
        return None if offset is None else math.hypot(*offset)

    @property
    def normalised_error(self) -> float | None:
        """Error of the centre in sizes of the true box (Mueller et al. 2018, TrackingNet)."""
        offset = self._offset
        # Without an area there is no size to measure in.
        if offset is None or self.truth is None or self.truth.box.area <= 0:
            return None
        return math.hypot(offset[0] / self.truth.box.width, offset[1] / self.truth.box.height)

    @property
    def overlap(self) -> float | None:
        """Intersection over union of the boxes, 0 to 1; None as `error`, or without a size."""
        box = self.scored_row.box if self.scored_row else None
        return None if self.truth is None or box is None else box.iou(self.truth.box)

    @property
    def _offset(self) -> tuple[float, float] | None:
        position = None if self.scored_row is None else self.scored_row.position
        if self.truth is None or position is None:
            return None
        centre = self.truth.box.centre
        return position[0] - centre[0], position[1] - centre[1]


@dataclass(frozen=True, slots=True)
class Scores:
    """All frames of a recording in order, and the number of truths without a frame."""

    frames: tuple[FrameScore, ...]
    truths_unmatched: int = 0

    @property
    def counted(self) -> tuple[FrameScore, ...]:
        """The frames that are scored."""
        return tuple(frame for frame in self.frames if frame.counts)


def score_frames(
    rows: Sequence[EstimateRow], truths: Sequence[Truth], max_diff: float = PAIRED_WITHIN_S
) -> Scores:
    """Score estimates against truth, associated by stamp.

    Parameters
    ----------
    rows : sequence of EstimateRow
        One per frame.
    truths : sequence of Truth
        True states of the vehicle; if empty, nothing has an error.
    max_diff : float
        Largest difference of stamps that belong together, in s.

    Raises
    ------
    InputError
        If there is truth, but none of it belongs to a frame.
    """
    # By stamps, not by numbers: recordings drop images, and truth may have another rate.
    pairs = associate([row.stamp_ns for row in rows], [t.stamp_ns for t in truths], max_diff)
    # Stamps of two clocks are a mistake; scored, they would look like a tracker that fails.
    if truths and not pairs:
        raise InputError(
            f"no stamp of the truth is within {max_diff:g} s of an estimate's "
            f"({_span([t.stamp_ns for t in truths])} and {_span([r.stamp_ns for r in rows])}); "
            "a larger --max-diff may help"
        )
    frames = (
        FrameScore(row, truths[pairs[i]] if i in pairs else None, standing)
        for i, (row, standing) in enumerate(zip(rows, _standing(rows), strict=True))
    )
    return Scores(tuple(frames), len(truths) - len(pairs))


def _standing(rows: Sequence[EstimateRow]) -> Iterator[EstimateRow | None]:
    """Yield for each row the last estimate before it; waiting for a target discards it."""
    # Kept from row to row: silence is scored as holding still.
    last: EstimateRow | None = None
    for row in rows:
        # A new start: the estimate for the target before is no estimate of the next one.
        if row.mode == WAITING_MODE:
            last = None
        # Before it is replaced: what stands in a frame is from an earlier one.
        yield last
        if _is_estimate(row):
            last = row


def _is_estimate(row: EstimateRow) -> bool:
    # A number that is not finite is no estimate: it would make every mean infinite.
    return row.position is not None and all(map(math.isfinite, row.position))


def _span(stamps: Sequence[int]) -> str:
    if not stamps:
        return "none"
    return f"{min(stamps) / 1e9:.3f} to {max(stamps) / 1e9:.3f} s"


def errors_of(frames: Sequence[FrameScore]) -> list[float]:
    """Return the errors in px of the frames that have one."""
    return [frame.error for frame in frames if frame.error is not None]


def threshold(frame: FrameScore) -> float:
    """Error in px below which the estimate is on the vehicle."""
    assert frame.truth is not None
    return max(CLOSE_PX, frame.truth.box.diagonal / 2)


def is_failure(frame: FrameScore) -> bool:
    """Return whether the estimate has no overlap with a visible vehicle."""
    # No overlap is known before the first estimate, or without a size: a miss, too.
    return frame.counts and not frame.hidden and not frame.overlap


def count_failures(frames: Sequence[FrameScore]) -> int:
    """Count the stretches of frames in which the estimate misses a visible vehicle.

    Frames in which the vehicle is hidden or the truth is unknown do not end a stretch.
    """
    missed = (is_failure(frame) for frame in frames if frame.counts and not frame.hidden)
    # A stretch is one failure however long it is, as no system is started again here; with
    # `restarts` it is.
    return sum(failed for failed, _ in itertools.groupby(missed))
