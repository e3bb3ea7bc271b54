# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Association of truth and estimates: by stamp, nearest first, one to one."""

from __future__ import annotations

import bisect
import heapq
import math
from collections.abc import Sequence

from vehicle_pf_tracker.core.errors import InputError

PAIRED_WITHIN_S = 0.01
"""Largest difference of associated stamps, s: well below a frame period at 30 Hz, 0.033 s."""


def is_nearest(stamp_ns: int, following_ns: int | None, moment_ns: int, limit_ns: int) -> bool:
    """Test whether a stamp is within `limit_ns` of a moment, and the next stamp is not nearer."""
    distance = abs(stamp_ns - moment_ns)
    return distance <= limit_ns and (
        following_ns is None or abs(following_ns - moment_ns) >= distance
    )


def associate(first_ns: Sequence[int], second_ns: Sequence[int], max_diff: float) -> dict[int, int]:
    """Pair stamps of two lists.

    The closest pair is made first, then the closest of what is left, so that no stamp is used
    twice. Stamps need not be sorted and may repeat; of equally close ones the earlier goes first.

    Parameters
    ----------
    first_ns, second_ns : sequence of int
        Stamps in ns.
    max_diff : float
        Largest difference in s, itself allowed.

    Returns
    -------
    dict of int to int
        Index in `second_ns` by index in `first_ns`, for those that have a partner.

    Raises
    ------
    InputError
        If `max_diff` is negative or not finite.
    """
    limit = max_diff_ns(max_diff)
    free = sorted((stamp, index) for index, stamp in enumerate(second_ns))
    pairs: dict[int, int] = {}
    # A difference only grows while others are paired, so that an earlier one is a lower bound.
    waiting = [(0, i) for i in range(len(first_ns))]
    while waiting and free:
        least, i = heapq.heappop(waiting)
        difference, place = _nearest(free, first_ns[i])
        if difference == least:
            pairs[i] = free.pop(place)[1]
        elif difference <= limit:
            heapq.heappush(waiting, (difference, i))
    return dict(sorted(pairs.items()))


def max_diff_ns(max_diff: float) -> int:
    """Check a largest difference in s and return it in ns."""
    if not math.isfinite(max_diff) or max_diff < 0:
        raise InputError(f"the largest difference of stamps must be seconds >= 0, not {max_diff}")
    return round(max_diff * 1e9)


def _nearest(free: Sequence[tuple[int, int]], stamp: int) -> tuple[int, int]:
    """Return the difference in ns of the nearest free stamp, and its place; the earlier of two."""
    after = bisect.bisect_left(free, (stamp, -1))
    # Of repeated stamps the first.
    before = bisect.bisect_left(free, (free[after - 1][0], -1)) if after else after
    places = (place for place in (before, after) if place < len(free))
    return min((abs(free[place][0] - stamp), place) for place in places)
