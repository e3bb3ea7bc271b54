# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sightings that a standing occluder has cut, restored to those of the whole vehicle.

A vehicle that drives behind a wall slowly is followed while less and less of it is visible: the box
shrinks with it. One of its sides then stands with the wall while the opposite one drives on; the
other dimension gives the size.
"""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES, SIZE_RESPONSE

_WHOLE_QUANTILE = 0.9
"""Quantile of the ratio of the sides that is the whole vehicle's: two seconds may mostly be cut. It
is a choice: a tenth of them, 6 frames, has to show all of it, and the maximum would be noise."""
_CUT = 0.9
"""Ratio of the sides, of the whole vehicle's, below which the box is cut: a tenth less is above the
error of a size, 4 % (`perspective._SIZE_SIGMA`)."""
_STANDS = 0.4
"""Speed of a side that stands, at most, as a fraction of the opposite side's. It would be 0 at a
wall and 1 in the open; below one half, as a box that follows the peak trails into the wall."""
_LEAST_SPEED = 0.01
"""Least speed of the side that drives on, fraction of the size per frame. Within `PROOF_FRAMES` it
moves by .08, twice the error of a size; a slower vehicle cannot be separated from a standing one.
"""


def restored_sightings(
    ages: Array, positions: Array, sizes: Array, responses: Array
) -> tuple[Array, Array] | None:
    """Restore sightings that were cut from one side; None where the last ones are not cut.

    Parameters
    ----------
    ages : (N,) array
        Ages of the sightings, frames, descending.
    positions, sizes : (N, 2) arrays
        Centres, and widths and heights, px, carried along with the background.
    responses : (N,) array
        Responses of the filter, fractions of the usual one.

    Returns
    -------
    positions, sizes : (N, 2) arrays
        With the side that drives on where it was seen, and the other one as far away as the whole
        vehicle's ratio of width and height says.
    """
    # 1. The last clear frames show whether a side stands; as many again show the whole vehicle.
    judged = np.flatnonzero(responses >= SIZE_RESPONSE)[-PROOF_FRAMES:]
    if len(judged) < PROOF_FRAMES or len(ages) < 2 * PROOF_FRAMES:
        return None
    seen = sizes
    positions = positions.copy()
    sizes = sizes.copy()
    restored = False
    # 2. Each axis by itself, as seen: a restored width must not become the measure of a height.
    for axis in (0, 1):
        # 3. The whole vehicle's ratio: a high quantile, as cuts lower it and only noise raises it.
        ratio = seen[:, axis] / seen[:, 1 - axis]
        whole = float(np.quantile(ratio, _WHOLE_QUANTILE))
        # 4. One side stands and the other one drives towards it, or the box is not cut but small.
        low = positions[:, axis] - seen[:, axis] / 2
        sides = np.stack([low, low + seen[:, axis]])
        driving = _driving_side(ages[judged], sides[:, judged], float(np.sqrt(seen[-1].prod())))
        if driving is None or ratio[judged[-1]] > _CUT * whole:
            continue
        # 5. The cut side is placed anew; the driving one was seen, and stays.
        cut = ratio < whole
        sizes[cut, axis] = whole * seen[cut, 1 - axis]
        inwards = 0.5 if driving == 0 else -0.5
        positions[cut, axis] = sides[driving, cut] + inwards * sizes[cut, axis]
        restored = True
    return (positions, sizes) if restored else None


def _driving_side(ages: Array, sides: Array, extent: float) -> int | None:
    """Find the one of two sides (2, N), px, that drives towards the other, if that one stands."""
    # Slopes by least squares: the times are centred, so that the sides need not be.
    times = ages.mean() - ages
    spread = float(times @ times)
    if not spread:  # repeated stamps: no time has passed
        return None
    speeds = sides @ times / spread
    driving = int(np.abs(speeds).argmax())
    stands = abs(speeds[1 - driving]) <= _STANDS * abs(speeds[driving])
    moves = abs(speeds[driving]) >= _LEAST_SPEED * extent
    # Outwards the vehicle comes out from behind the wall: its box grows back by itself.
    inwards = (speeds[driving] > 0) == (driving == 0)
    return driving if stands and moves and inwards else None
