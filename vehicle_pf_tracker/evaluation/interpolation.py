"""The path drawn through occlusions: straight from where the vehicle vanished to where it is back.

It is for the eye only. What the tracker said while it did not see the vehicle stays the estimate,
and only estimates are scored.

Source: Scharcanski et al. 2011, figure 5 (the path interpolated over the occlusion).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TypeAlias

from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.trackers.estimate import Mode

Point: TypeAlias = tuple[float, float]


def interpolate_occlusions(rows: Sequence[EstimateRow]) -> list[Point | None]:
    """Replace the positions of every stretch without TRACKING by a straight line.

    Parameters
    ----------
    rows : sequence of EstimateRow
        In the order of the recording.

    Returns
    -------
    list of (float, float) or None
        One per row, px. Frames in TRACKING keep their position. In between, time (the stamps)
        divides the line from the last one before to the first one after. None where there is no
        such pair, or time went back between the two.
    """
    points: list[Point | None] = [
        row.position if row.mode == Mode.TRACKING else None for row in rows
    ]
    known = [index for index, point in enumerate(points) if point is not None]
    for begin, end in pairwise(known):
        for index in range(begin + 1, end):
            points[index] = _between(rows[begin], rows[end], rows[index].stamp_ns)
    return points


def interpolated_columns(rows: Sequence[EstimateRow]) -> dict[str, list[float | None]]:
    """Give the path of `interpolate_occlusions` as columns for `estimates.csv`, by name."""
    points = interpolate_occlusions(rows)
    return {
        "x_interpolated": [None if point is None else point[0] for point in points],
        "y_interpolated": [None if point is None else point[1] for point in points],
    }


def _between(first: EstimateRow, last: EstimateRow, stamp_ns: int) -> Point | None:
    if not first.stamp_ns < last.stamp_ns or not first.stamp_ns <= stamp_ns <= last.stamp_ns:
        return None
    start, end = first.position, last.position
    assert start is not None
    assert end is not None
    gone = (stamp_ns - first.stamp_ns) / (last.stamp_ns - first.stamp_ns)
    return start[0] + gone * (end[0] - start[0]), start[1] + gone * (end[1] - start[1])
