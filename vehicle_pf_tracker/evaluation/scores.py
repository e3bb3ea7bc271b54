"""Each frame's estimate held against its truth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.evaluation.association import MAX_DIFF, associate
from vehicle_pf_tracker.evaluation.estimates import WAITING, EstimateRow
from vehicle_pf_tracker.features.errors import InputError
from vehicle_pf_tracker.recordings.truth import Occlusion, Truth


@dataclass(frozen=True, slots=True)
class FrameScore:
    """A frame of a recording, and its truth where that is known."""

    row: EstimateRow
    truth: Truth | None

    @property
    def waiting(self) -> bool:
        """Whether there was no target yet."""
        return self.row.mode == WAITING

    @property
    def counts(self) -> bool:
        """Whether the frame is scored: there is truth, and a target to follow."""
        return self.truth is not None and not self.waiting

    @property
    def hidden(self) -> bool:
        """Whether the vehicle is totally occluded; False without truth."""
        return self.truth is not None and self.truth.occlusion is Occlusion.TOTAL

    @property
    def error(self) -> float | None:
        """Distance of the centres in px; None without truth or without a finite estimate."""
        position = self.row.position
        if self.truth is None or position is None or not all(map(math.isfinite, position)):
            return None
        return math.dist(position, self.truth.box.centre)


@dataclass(frozen=True, slots=True)
class Scores:
    """All frames of a recording, in its order, and how many truths have no frame."""

    frames: tuple[FrameScore, ...]
    truths_unmatched: int = 0

    @property
    def counted(self) -> tuple[FrameScore, ...]:
        """The frames that are scored."""
        return tuple(frame for frame in self.frames if frame.counts)


def score_frames(
    rows: Sequence[EstimateRow], truths: Sequence[Truth], max_diff: float = MAX_DIFF
) -> Scores:
    """Hold estimates against truth by stamp.

    Parameters
    ----------
    rows : sequence of EstimateRow
        One per frame.
    truths : sequence of Truth
        May be empty: then nothing has an error.
    max_diff : float
        Largest difference of stamps that belong together, in s.

    Raises
    ------
    InputError
        If there is truth, but none of it belongs to a frame.
    """
    pairs = associate([row.stamp_ns for row in rows], [t.stamp_ns for t in truths], max_diff)
    if truths and not pairs:
        raise InputError(
            f"no stamp of the truth is within {max_diff:g} s of an estimate's "
            f"({_span([t.stamp_ns for t in truths])} and {_span([r.stamp_ns for r in rows])}); "
            "a larger --max-diff may help"
        )
    frames = (
        FrameScore(row, truths[pairs[i]] if i in pairs else None) for i, row in enumerate(rows)
    )
    return Scores(tuple(frames), len(truths) - len(pairs))


def _span(stamps: Sequence[int]) -> str:
    if not stamps:
        return "none"
    return f"{min(stamps) / 1e9:.3f} to {max(stamps) / 1e9:.3f} s"
