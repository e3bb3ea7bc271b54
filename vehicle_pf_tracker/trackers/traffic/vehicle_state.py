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

"""State of one vehicle on the plane of the road, and its measurement edge by edge.

A box stands on the road where its lower edge is. Its distance from the horizon, v px, is inversely
proportional to the distance from the camera, so that a vehicle of constant speed on the road has a
speed and a size in the image that follow from v: (x, v, width, height) in px, and the velocities
across and along the road, in units in which a place on the road is (x / v, 1 / v). The Gaussian is
carried exactly where measurements are linear in it (boxes), and by particles where they are not
(pixels): the Gaussian particle filter of Kotecha and Djuric (2003).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box

X, V, W, H, ACROSS, ALONG = range(6)
"""Components of the state: centre and distance from the horizon, size (px), road velocities."""

_NEAREST_HORIZON = 3.0
"""Least distance of a lower edge from the horizon in px; at zero the road is infinitely far."""
_FASTEST_APPROACH = 1.3
"""Largest growth of a box in a nominal frame period. Beyond it the distance is down to the
camera's own height, where the plane no longer describes what is seen."""
_LONGEST_APPROACH = 35.0
"""Nominal periods that this bound is raised to at most: by then a box has grown ten thousandfold,
from a px to more than an image's side, and after a longer gap the power itself would overflow."""
_LEAST = 1e-2
"""Least distance from the horizon, and least side, that is predicted, px: a hundredth of a pixel is
nothing in sight, and any two boxes still have a finite ratio."""
_LARGEST = 1e5
"""Largest place and side, px; in their units it bounds velocities too. No image has a third of it
(`image.encodings.MAX_SIDE`), so that a vehicle there has left."""
_VAGUEST = 1e4
"""Largest standard deviation, px; in their units it bounds those of velocities too. Of a place in
an image nothing is known then, and the measurement of half a px after it still leaves seven of a
variance's 16 digits."""
_HORIZON_MOVED = 0.05
"""Change of the horizon that is applied, of the lower edge's distance from it: speeds are known no
better when a vehicle is new."""
_HORIZON_LEAPT = 0.3
"""Change of the logarithm of the distance from the horizon above which it leaps: less is the
usual error of an estimate."""
_SIZE_WALK = 0.004
"""Change of a vehicle's shape as the camera sees it, of its size per nominal period: a vehicle that
drives past is seen from behind and then from the side within some 5 s."""


class Edge(IntEnum):
    """Edges of a box, in the order of measurements."""

    LEFT = 0
    TOP = 1
    RIGHT = 2
    BOTTOM = 3


OBSERVATION = np.array(
    [
        [1.0, 0.0, -0.5, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, -1.0, 0.0, 0.0],
        [1.0, 0.0, 0.5, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    ]
)
"""Edges of the box as linear functions of the state (relative to the horizon)."""

_HIGHEST_MEAN = np.full(6, _LARGEST)
_LOWEST_MEAN = np.array([-_LARGEST, _LEAST, _LEAST, _LEAST, -_LARGEST, -_LARGEST])
"""Bounds of the mean, by component."""


@dataclass(frozen=True, slots=True)
class Drive:
    """Motion model that all vehicles share.

    Attributes
    ----------
    acceleration : float
        Standard deviation of the change of speed, widths of the vehicle per nominal period squared.
    top_speed : float
        Standard deviation of the speed before it is measured, widths per nominal period.
    focal : float
        Focal length in px.
    """

    acceleration: float
    top_speed: float
    focal: float


class VehicleState:
    """Gaussian over a vehicle's place, size and velocity.

    Parameters
    ----------
    edges : (4,) array
        First box: left, top, right, bottom in px.
    deviations : (4,) array
        Standard deviations of these.
    horizon : float
        Row of the horizon in px.
    drive : Drive
        Motion of vehicles.
    """

    def __init__(self, edges: Array, deviations: Array, horizon: float, drive: Drive) -> None:
        self.horizon = horizon
        self._drive = drive
        left, top, right, bottom = edges.tolist()
        width, height = right - left, bottom - top
        v = max(bottom - horizon, _NEAREST_HORIZON)
        self.mean = np.array([(left + right) / 2, v, width, height, 0.0, 0.0])
        sides = deviations**2
        speed = drive.top_speed * width / v
        self.covariance = np.diag(
            [
                (sides[Edge.LEFT] + sides[Edge.RIGHT]) / 4,
                sides[Edge.BOTTOM],
                sides[Edge.LEFT] + sides[Edge.RIGHT],
                sides[Edge.TOP] + sides[Edge.BOTTOM],
                speed**2,
                (speed / drive.focal) ** 2,
            ]
        )

    @property
    def edges(self) -> Array:
        """Left, top, right and bottom in px."""
        # As `OBSERVATION` says, without its product: this is asked most often of all.
        x, v, w, h = self.mean[:ACROSS].tolist()
        return np.array([x - w / 2, v - h + self.horizon, x + w / 2, v + self.horizon])

    @property
    def box(self) -> Box:
        """Box in px."""
        left, top, right, bottom = self.edges.tolist()
        return Box(left, top, max(right - left, 1.0), max(bottom - top, 1.0))

    @property
    def edge_covariance(self) -> Array:
        """Covariance of the edges, (4, 4) in px²."""
        return np.asarray(OBSERVATION @ self.covariance @ OBSERVATION.T)

    @property
    def is_sound(self) -> bool:
        """True while the state is a Gaussian: finite, and of positive variances."""
        total = float(self.mean.sum() + self.covariance.sum())
        return math.isfinite(total) and float(self.covariance.diagonal().min()) > 0

    @property
    def velocity(self) -> tuple[float, float]:
        """Velocity of the box's centre in px per nominal period."""
        x, v, _, h, across, along = self.mean.tolist()
        growth = -along * v
        return x * growth + across * v, (v - h / 2) * growth

    @property
    def road_size(self) -> float:
        """Side of the box over the distance from the horizon: the same all along the road."""
        return math.sqrt(self.mean[W] * self.mean[H]) / float(self.mean[V])

    @property
    def speed_ratio(self) -> float:
        """Distance of the velocity on the road from zero, in standard deviations."""
        velocity = self.mean[ACROSS:]
        return math.sqrt(velocity @ np.linalg.solve(self.covariance[ACROSS:, ACROSS:], velocity))

    def predict(self, elapsed: float) -> None:
        """Drive on for `elapsed` nominal periods."""
        x, v, w, h, across, along = self.mean.tolist()
        bound = _FASTEST_APPROACH ** min(elapsed, _LONGEST_APPROACH)
        divisor = 1 + v * along * elapsed
        growth = 1 / min(max(divisor, 1 / bound), bound)
        by_v, by_along = -along * elapsed * growth**2, -v * elapsed * growth**2
        if not 1 / bound <= divisor <= bound:  # there the growth depends on nothing
            by_v = by_along = 0.0
        driven = x + v * across * elapsed
        self.mean = np.array([driven * growth, v * growth, w * growth, h * growth, across, along])
        step = np.eye(6)
        step[X, X] = step[W, W] = step[H, H] = growth
        step[X, V] = across * elapsed * growth + driven * by_v
        step[X, ACROSS] = v * elapsed * growth
        step[X, ALONG] = driven * by_along
        step[V, V] = growth + v * by_v
        step[V, ALONG] = v * by_along
        step[W, V], step[W, ALONG] = w * by_v, w * by_along
        step[H, V], step[H, ALONG] = h * by_v, h * by_along
        push = self._drive.acceleration * w / v
        self.covariance = step @ self.covariance @ step.T
        self.covariance[ACROSS, ACROSS] += push**2 * elapsed
        self.covariance[ALONG, ALONG] += (push / self._drive.focal) ** 2 * elapsed
        self.covariance[W, W] += (_SIZE_WALK * w) ** 2 * elapsed
        self.covariance[H, H] += (_SIZE_WALK * h) ** 2 * elapsed
        self._bound()

    def resize(self, edges: Array) -> None:
        """Take a box (4,) for the vehicle's without doubt; it drives as before."""
        left, top, right, bottom = edges.tolist()
        v = max(bottom - self.horizon, _NEAREST_HORIZON)
        self.mean[:ACROSS] = (left + right) / 2, v, right - left, bottom - top

    def move_horizon(self, horizon: float) -> None:
        """Take another row (px) for the horizon; box and velocity of the lower edge stay.

        Where the horizon leaps, size and speed become uncertain.
        """
        if abs(horizon - self.horizon) < _HORIZON_MOVED * self.mean[V]:
            return
        x, v = self.mean[: V + 1].tolist()
        new = max(v + self.horizon - horizon, _NEAREST_HORIZON)
        ratio, self.horizon = v / new, v + self.horizon - new
        step = np.eye(6)
        step[ALONG, ALONG] = ratio**2
        step[ACROSS, ACROSS] = ratio
        step[ACROSS, ALONG] = x * (ratio - 1) * ratio
        self.mean = step @ self.mean
        self.mean[V] = new
        self.covariance = step @ self.covariance @ step.T
        # Size and speed along the road were learnt with the other horizon, and hold the less, the
        # farther it was; the speed across was seen.
        doubt = max(abs(np.log(ratio)) - _HORIZON_LEAPT, 0.0) * self.mean
        doubt[[X, V, ACROSS]] = 0.0
        self.covariance += np.diag(doubt**2)
        self._bound()

    def measure(self, edge: Edge, value: float, deviation: float) -> None:
        """Take the measurement of an edge in px, of this standard deviation."""
        row = OBSERVATION[edge]
        offset = self.horizon if edge in (Edge.TOP, Edge.BOTTOM) else 0.0
        self._correct(row, value - offset - float(row @ self.mean), deviation**2)

    def _correct(self, row: Array, residual: float, variance: float) -> None:
        spread = self.covariance @ row
        gain = spread / (float(row @ spread) + variance)
        self.mean = self.mean + gain * residual
        self.covariance = self.covariance - np.outer(gain, spread)
        self.mean[V] = max(self.mean[V], _NEAREST_HORIZON)
        self.mean[W], self.mean[H] = max(self.mean[W], 1.0), max(self.mean[H], 1.0)

    def _bound(self) -> None:
        """Keep a prediction within bounds; a vehicle that is in sight is far inside them."""
        self.mean = np.clip(self.mean, _LOWEST_MEAN, _HIGHEST_MEAN)
        variances = self.covariance.diagonal()
        if variances.max() <= _VAGUEST**2:
            return
        # Scaled from both sides a covariance stays one, and correlations stay what they are.
        shares = np.minimum(_VAGUEST / np.sqrt(variances), 1.0)
        bounded = self.covariance * np.outer(shares, shares)
        self.covariance = (bounded + bounded.T) / 2
