# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Signs at a line, by which its count is trusted: how crossings were seen, and what was missed."""

from __future__ import annotations

from enum import Enum

from vehicle_pf_tracker.counting.foot_point import FootPoint
from vehicle_pf_tracker.counting.side_watch import Edge

_HIDDEN_LENGTHS = 1.0
"""Lengths of a vehicle, before or behind a line, within which an end of its track may hide a
crossing: a detector misses a vehicle for about as long as it drives its own length."""
_DRIVEN = 0.5
"""Lengths that a track has driven before its direction is known: noise of boxes is a quarter."""


class Sign(str, Enum):
    """Sign for or against a count."""

    SEEN = "seen"
    """A crossing of a vehicle that was seen, and detected in most of its images."""
    VAGUE = "vague"
    """A crossing that was predicted, or of a vehicle that was predicted in most of its images."""
    DOUBTED = "doubted"
    """An implausible crossing, which is in no total."""
    JOINED = "joined"
    """A crossing in an image with ambiguous blobs, beside the sign that it has anyway."""
    PASSED = "passed"
    """A vehicle that was seen on both sides, and was never clearly over the line."""
    BROKEN = "broken"
    """A vehicle whose track ended shortly before the line, or began shortly behind it."""
    UNCONFIRMED = "unconfirmed"
    """A track that drove over the line, or was lost at it, and was never confirmed as a vehicle."""


def missed_at(
    edge: Edge, first: FootPoint, last: FootPoint, *, has_ended: bool
) -> tuple[int, Sign] | None:
    """Judge a track that has not crossed an edge by the ends of what was seen of it.

    Parameters
    ----------
    edge : Edge
        The edge.
    first, last : FootPoint
        First and last point at which it was seen.
    has_ended : bool
        False of a vehicle that is still followed, and may cross yet.

    Returns
    -------
    (int, Sign) or None
        The side to which it may have crossed, and `PASSED` or `BROKEN`; None where it ended far
        from the edge, passed its ends, or has hardly driven.
    """
    # 1. How far it has driven across the edge: within the noise of its boxes there is no
    # direction, and so nothing that it may have missed.
    begin = edge.distance(first.point)
    end = edge.distance(last.point)
    driven = end - begin
    length = last.extent(edge.normal(last.point))
    if abs(driven) <= _DRIVEN * length:
        return None
    side = 1 if driven > 0 else -1
    # 2. Whether the edge lies between its ends, or how near to an end, in lengths that it has at
    # that end: perspective changes the length in px along the way.
    is_over = begin * end < 0
    gap = abs(begin) / first.extent(edge.normal(first.point))
    if has_ended:
        gap = min(gap, abs(end) / length)
    elif side * begin < 0:
        # Followed still: a crossing ahead, or one that is not yet clear, may be counted later.
        # Only one before its first point is missed for good.
        return None
    # 3. Where a straight drive meets the endless line: beside the ends it is no crossing.
    share = begin / (begin - end)  # of a straight drive at the line, beyond 0 to 1 before or after
    x, y = first.point
    to_x, to_y = last.point
    at = x + share * (to_x - x), y + share * (to_y - y)
    if not ((is_over or gap < _HIDDEN_LENGTHS) and edge.has(at)):
        return None
    return side, Sign.PASSED if is_over else Sign.BROKEN
