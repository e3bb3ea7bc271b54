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

"""Association of truth and estimates: by stamp, nearest first, one to one."""

from __future__ import annotations

import bisect
import heapq
import math
from collections.abc import Sequence

from vehicle_pf_tracker.core.errors import InputError

MAX_DIFF = 0.01
"""Largest difference of associated stamps, s: well below a frame period at 30 Hz, 0.033 s."""


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
    taken: set[int] = set()
    offers = [offer for i, stamp in enumerate(first_ns) for offer in _offers(free, stamp, i, limit)]
    heapq.heapify(offers)
    pairs: dict[int, int] = {}
    while offers:
        _, i, j = heapq.heappop(offers)
        if j in taken:  # so offer what is nearest among the rest
            for offer in _offers(free, first_ns[i], i, limit):
                heapq.heappush(offers, offer)
            continue
        pairs[i] = j
        taken.add(j)
        del free[bisect.bisect_left(free, (second_ns[j], j))]
    return dict(sorted(pairs.items()))


def max_diff_ns(max_diff: float) -> int:
    """Check a largest difference in s and return it in ns."""
    if not math.isfinite(max_diff) or max_diff < 0:
        raise InputError(f"the largest difference of stamps must be seconds >= 0, not {max_diff}")
    return round(max_diff * 1e9)


def _offers(
    free: Sequence[tuple[int, int]], stamp: int, i: int, limit: int
) -> list[tuple[int, int, int]]:
    """Return (difference in ns, `i`, j) for the nearest free j, as a list of one or none."""
    right = bisect.bisect_left(free, (stamp, -1))
    sides = [right] if right < len(free) else []
    if right > 0:  # of repeated stamps the first
        sides.append(bisect.bisect_left(free, (free[right - 1][0], -1)))
    near = [(abs(free[side][0] - stamp), side) for side in sides]
    return [
        (distance, i, free[side][1]) for distance, side in sorted(near)[:1] if distance <= limit
    ]
