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

"""Constant velocity on the road as the camera sees it, fitted to where the vehicle was seen.

Before the fit, sightings that a standing occluder has cut are made whole.
A vehicle that drives behind a wall slowly is followed while less and less of it shows: the box
shrinks with what is visible. One of its sides then stands with the wall while the opposite one
drives on; and the other dimension tells the size.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.camera_motion import CameraMotion

_JUDGED = 8
"""Last sightings that the sides' motion is fitted to: a quarter of a second."""
_LEAST_RESPONSE = 0.6
"""Response, of the usual one, of sightings that are judged, as sizes are followed from there on."""
_WHOLE_QUANTILE = 0.9
"""Quantile of the ratio of the sides that is the whole vehicle's: two seconds may mostly be cut."""
_CUT = 0.9
"""Ratio of the sides, of the whole vehicle's, below which the box is cut; sizes are good to 4 %."""
_STANDS = 0.4
"""Speed of a side that stands, of the opposite one's."""
_LEAST_SPEED = 0.01
"""Speed of the side that drives on, of the size per frame; below it all sides stand."""


def made_whole(
    ages: Array, positions: Array, sizes: Array, responses: Array
) -> tuple[Array, Array] | None:
    """Restore sightings that were cut from one side; None where the last ones are not cut.

    Parameters
    ----------
    ages : (N,) array
        Frames ago, descending.
    positions, sizes : (N, 2) arrays
        Centres, and widths and heights, px; the background stands.
    responses : (N,) array
        Responses of the filter, fractions of the usual one.

    Returns
    -------
    positions, sizes : (N, 2) arrays
        With the side that drives on where it was seen, and the other one as far away as the whole
        vehicle's ratio of width and height tells.
    """
    judged = np.flatnonzero(responses >= _LEAST_RESPONSE)[-_JUDGED:]
    if len(judged) < _JUDGED or len(ages) < 2 * _JUDGED:
        return None
    seen, positions, sizes, restored = sizes, positions.copy(), sizes.copy(), False
    for axis in (0, 1):
        ratio = seen[:, axis] / seen[:, 1 - axis]
        whole = float(np.quantile(ratio, _WHOLE_QUANTILE))
        low = positions[:, axis] - seen[:, axis] / 2
        sides = np.stack([low, low + seen[:, axis]])
        driving = _driving_side(ages[judged], sides[:, judged], float(np.sqrt(seen[-1].prod())))
        if driving is None or ratio[judged[-1]] > _CUT * whole:
            continue
        cut = ratio < whole
        sizes[cut, axis] = whole * seen[cut, 1 - axis]
        inwards = 0.5 if driving == 0 else -0.5
        positions[cut, axis] = sides[driving, cut] + inwards * sizes[cut, axis]
        restored = True
    return (positions, sizes) if restored else None


def _driving_side(ages: Array, sides: Array, extent: float) -> int | None:
    """Find the one of two sides (2, N) that drives towards the other, if it stands."""
    times = ages.mean() - ages
    spread = float(times @ times)
    if not spread:  # repeated stamps: no time has passed
        return None
    speeds = sides @ times / spread
    driving = int(np.abs(speeds).argmax())
    stands = abs(speeds[1 - driving]) <= _STANDS * abs(speeds[driving])
    moves = abs(speeds[driving]) >= _LEAST_SPEED * extent
    inwards = (speeds[driving] > 0) == (driving == 0)
    return driving if stands and moves and inwards else None


KEPT_FRAMES = 60.0
"""Age in frames from which a sighting tells nothing about the present motion."""
CLEAR_RESPONSE = 0.75
"""Least response, of the usual one, of a sighting that the fit believes. While an occluder moves in
it drags positions along and shrinks the box; 5 % of visible frames have less than 0.8."""
_SIZE_RESPONSE = 0.9
"""The same of one whose size the fit believes: an occluder shrinks the box first."""
_RATES = np.linspace(-0.04, 0.04, 33)
"""Rates of approach per frame that are tried; to 0.15, as many walls are recovered from (83 of 126,
and 37 of 105 before moving cameras: laboratory/notes/fusion_tried.md)."""
_RATE_NEEDS = 8
"""Sightings below which the size is taken to stay. Where fewer sizes can be believed, all count."""
_MEMORY = 10.0
"""Frames after which an older position counts for 1 / e: a vehicle changes its speed. All sizes
that are kept count alike, as the road stays what it is."""
_POSITION_SIGMA = 0.03
"""Standard deviation of a sighting's position, of the size."""
_SIZE_SIGMA = 0.04
"""Standard deviation of the logarithm of a sighting's size."""
_RATE_SIGMA = 0.02
"""Standard deviation of rates of approach, per frame."""
_LEAST_DIVISOR = 0.25
"""A vehicle that comes closer passes the camera; it does not grow without bound."""
_LARGEST_CHANGE = 0.7
"""Largest share of its size, two seconds ago, that a vehicle may have lost."""


@dataclass(frozen=True, slots=True)
class PerspectiveMotion:
    """``p(t) = p0 + V t / (1 - r t)`` and ``s(t) = s0 / (1 - r t)``.

    Attributes
    ----------
    position, velocity : (2,) arrays
        p0 in px and V in px per frame, at time 0.
    rate : float
        Rate of approach r per frame: above 0 the vehicle comes closer.
    """

    position: Array
    velocity: Array
    rate: float

    def _divisor(self, time: float) -> float:
        return max(1.0 - self.rate * time, _LEAST_DIVISOR)

    def position_at(self, time: float) -> Array:
        """Position, px, `time` frames after time 0."""
        return np.asarray(self.position + self.velocity * (time / self._divisor(time)))

    def velocity_at(self, time: float) -> Array:
        """Velocity, px per frame, `time` frames after time 0."""
        return np.asarray(self.velocity / self._divisor(time) ** 2)

    def scale_at(self, time: float) -> float:
        """Size relative to that at time 0."""
        return 1 / self._divisor(time)

    def growth_at(self, time: float) -> float:
        """Change of the logarithm of the size per frame."""
        return self.rate / self._divisor(time)


@dataclass(frozen=True, slots=True, eq=False)
class Sighting:
    """Where the vehicle was seen.

    Attributes
    ----------
    age : float
        Frames ago.
    position, size : (2,) arrays
        Centre, and width and height, px.
    cut : bool
        True where a standing occluder had cut the vehicle, which was made whole.
    """

    age: float
    position: Array
    size: Array
    cut: bool = False


class Sightings:
    """The last sightings, carried along with time and with the camera."""

    def __init__(self) -> None:
        self._rows = np.empty((0, 6))  # age, position, size, response
        self._camera_stood = math.inf

    def add(self, position: Array, size: Array, response: float) -> None:
        """Add a sighting of the present frame."""
        self._rows = np.vstack([self._rows, [0.0, *position, *size, response]])

    def pass_time(self, elapsed: float, camera: CameraMotion) -> None:
        """Let `elapsed` frames pass and the camera move."""
        self._rows = self._rows[self._rows[:, 0] < KEPT_FRAMES]
        self._rows[:, 0] += elapsed
        self._camera_stood += elapsed
        if not camera.still:
            self._camera_stood = 0.0
            self._rows[:, 1:3] = camera.apply(self._rows[:, 1:3])

    @property
    def are_steady(self) -> bool:
        """True where the camera has stood for as long as sightings are kept."""
        return self._camera_stood > KEPT_FRAMES

    def fit(self) -> tuple[PerspectiveMotion, Sighting] | None:
        """Fit the motion to clear sightings; also give the last of them, which is at time 0.

        Before a camera that moves the vehicle keeps its size from then on. A fitted rate does not
        last there: of 22 sequences .6 of it is right for 10 frames, and a fifth for 20
        (laboratory/notes/fusion_tried.md).
        """
        ages, responses = self._rows[:, 0], self._rows[:, 5]
        positions, sizes = self._rows[:, 1:3], self._rows[:, 3:5]
        clear = responses >= CLEAR_RESPONSE
        if not clear.any():
            return None
        whole = made_whole(ages, positions, sizes, responses)
        positions, sizes = whole or (positions, sizes)
        positions, sizes, ages = positions[clear], sizes[clear], ages[clear]
        last = Sighting(float(ages[-1]), positions[-1], sizes[-1], whole is not None)
        times = last.age - ages
        believed = responses[clear] >= _SIZE_RESPONSE
        if believed.sum() < _RATE_NEEDS:
            believed[:] = True
        path = fit_motion(times, positions, np.sqrt(sizes.prod(axis=1)), believed.astype(float))
        return path if self.are_steady else replace(path, rate=0.0), last


def fit_motion(
    times: Array, positions: Array, sizes: Array, size_weights: Array
) -> PerspectiveMotion:
    """Fit to sightings, by weighted least squares over a grid of rates.

    Parameters
    ----------
    times : (N,) array
        Times in frames, ascending, the last of them 0.
    positions : (N, 2) array
        px.
    sizes : (N,) array
        Geometric means of the sides, px.
    size_weights : (N,) array
        Weight of each size.

    Returns
    -------
    PerspectiveMotion
        Its position is half way between the fitted and the last one: the fit averages noise, the
        last one knows of changes of speed.
    """
    rates = _RATES if len(times) >= _RATE_NEEDS else np.zeros(1)
    weights = np.exp(times / _MEMORY)
    total = weights.sum()
    divisors = np.maximum(1.0 - rates[:, np.newaxis] * times, _LEAST_DIVISOR)
    shares = times / divisors
    centres, middle = shares @ weights / total, weights @ positions / total
    off = shares - centres[:, np.newaxis]
    # The small summand keeps simultaneous sightings solvable, with a velocity of zero.
    spread = off**2 @ weights + 1e-9
    velocities = (off * weights) @ (positions - middle) / spread[:, np.newaxis]
    residuals = positions - middle - off[..., np.newaxis] * velocities[:, np.newaxis]
    logs = np.log(sizes * divisors)
    log_sizes = logs @ size_weights / size_weights.sum()
    sigma = _POSITION_SIGMA * float(sizes.mean())
    costs = (residuals**2).sum(axis=2) @ weights / sigma**2 + (rates / _RATE_SIGMA) ** 2
    costs += (logs - log_sizes[:, np.newaxis]) ** 2 @ size_weights / _SIZE_SIGMA**2
    possible = rates * times[0] <= _LARGEST_CHANGE
    best = int(np.argmin(np.where(possible, costs, np.inf)))
    fitted = middle - centres[best] * velocities[best]
    return PerspectiveMotion(0.5 * (fitted + positions[-1]), velocities[best], float(rates[best]))
