# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Constant velocity on the road as the camera sees it, fitted to earlier positions and sizes.

Before the fit, sightings that a standing occluder has cut are restored (`standing_occluder.py`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.followed_by_camera import Followed
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES
from vehicle_pf_tracker.trackers.fusion.schedule import UNDISTURBED
from vehicle_pf_tracker.trackers.fusion.standing_occluder import restored_sightings

KEPT_FRAMES = 60.0
"""Age in frames from which a sighting is discarded: two seconds, of which positions count for some
20 frames, and sizes all (errors by age: laboratory/notes/fusion_tried.md, Rate of approach)."""
CLEAR_RESPONSE = 0.75
"""Least response relative to the usual one of a sighting that the fit believes. While an occluder
moves in it drags positions along and shrinks the box; 5 % of visible frames have less than 0.8."""
FASTEST_GROWTH = 0.04
"""Bound of the growth rate per frame: a vehicle that doubles within 17 frames passes the camera.
With rates of approach to 0.15, as many walls are recovered from (83 of 126, and 37 of 105 before
moving cameras: laboratory/notes/fusion_tried.md)."""
_RATES = np.linspace(-FASTEST_GROWTH, FASTEST_GROWTH, 33)
"""Rates of approach per frame that are tried."""
_MEMORY = 10.0
"""Frames after which an older position counts for 1 / e: a vehicle changes its speed. All sizes
that are kept count alike, as the road stays what it is."""
_POSITION_SIGMA = 0.03
"""Standard deviation of a sighting's position, fraction of the size. With positions believed a
third as much, as many walls are recovered (83 of 126: laboratory/notes/fusion_tried.md)."""
_SIZE_SIGMA = 0.04
"""Standard deviation of a sighting's log size. By sizes alone, as many walls are recovered (83 of
126: laboratory/notes/fusion_tried.md)."""
_RATE_SIGMA = 0.02
"""Standard deviation of rates of approach, per frame: half of the largest tried. A prior half as
wide predicts sizes no better (log error .161 and .162: laboratory/notes/fusion_tried.md)."""
_LEAST_DIVISOR = 0.25
"""Least 1 - r t, a bound of growth to fourfold: above that of an occlusion (threefold,
`hypotheses.LARGEST_GROWTH`). A vehicle that comes closer passes the camera."""
_LARGEST_CHANGE = 0.7
"""Largest share of its size, when the oldest sighting was made, that a vehicle may have lost: so
1 - r t is above `_LEAST_DIVISOR` for all sightings of a fit."""
_LAST_WEIGHT = 0.5
"""Weight of the last position against the fitted one, even as neither is known to be better: the
fit averages noise, the last one knows of changes of speed."""


@dataclass(frozen=True, slots=True)
class PerspectiveMotion:
    """Image motion ``p(t) = p0 + V t / (1 - r t)`` and size ``s(t) = s0 / (1 - r t)``.

    From its principal point a pinhole camera sees what drives at constant velocity, to a depth of
    Z (1 - r t), at (p0 + U t) / (1 - r t); with V = U + r p0 that is the motion above.

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
        # At zero the vehicle reaches the camera; beyond, the sign would be wrong.
        return max(1.0 - self.rate * time, _LEAST_DIVISOR)

    def position_at(self, time: float) -> Array:
        """Position, px, `time` frames after time 0."""
        return np.asarray(self.position + self.velocity * (time / self._divisor(time)))

    def velocity_at(self, time: float) -> Array:
        """Velocity, px per frame, `time` frames after time 0."""
        # The derivative of t / (1 - r t).
        return np.asarray(self.velocity / self._divisor(time) ** 2)

    def scale_at(self, time: float) -> float:
        """Size relative to that at time 0."""
        return 1 / self._divisor(time)

    def growth_at(self, time: float) -> float:
        """Change of the logarithm of the size per frame."""
        return self.rate / self._divisor(time)


@dataclass(frozen=True, slots=True, eq=False)
class Sighting:
    """An observation of the vehicle: where it was, and how large.

    Attributes
    ----------
    age : float
        Age of the sighting, frames.
    position, size : (2,) arrays
        Centre, and width and height, px.
    cut : bool
        True where a standing occluder had cut the vehicle; position and size are restored.
    """

    age: float
    position: Array
    size: Array
    cut: bool = False


class Sightings(NamedTuple):
    """The last sightings, carried along with time and with the camera.

    Attributes
    ----------
    rows : (N, 8) array
        Age in frames, position and size in px, response, and place in the image then, px, of each.
    camera_stood : float
        Frames since the camera moved last.
    in_view : int
        Number of the last of them in a row, between which the vehicle was never hidden.
    """

    rows: Array = np.empty((0, 8))
    camera_stood: float = math.inf
    in_view: int = 0

    def added(
        self, position: Array, size: Array, response: float, *, returned: bool = False
    ) -> Sightings:
        """Add a sighting of the present frame; before one that has `returned` it was hidden."""
        rows = np.empty((len(self.rows) + 1, 8))
        rows[:-1] = self.rows
        place = position.tolist()
        rows[-1] = 0.0, *place, *size.tolist(), response, *place
        return self._replace(rows=rows, in_view=1 if returned else self.in_view + 1)

    def rescaled(self, shift: Array, scale: Array) -> Sightings:
        """Move all by a fraction `shift` (2,) of their size, and scale that by `scale` (2,)."""
        rows = self.rows.copy()
        moved = shift * rows[:, 3:5]
        rows[:, 1:3] += moved
        rows[:, 6:8] += moved
        rows[:, 3:5] *= scale
        return self._replace(rows=rows)

    def proven(self) -> Sightings:
        """Leave out those since a return that was short: it may have been to another vehicle."""
        # The usual case first, which needs no look at the rows.
        if self.in_view >= PROOF_FRAMES:
            return self
        before = max(len(self.rows) - self.in_view, 0)
        if not (self.rows[:before, 5] >= CLEAR_RESPONSE).any():
            return self
        # What is left was in view for long enough, or is all there is.
        return self._replace(rows=self.rows[:before], in_view=PROOF_FRAMES)

    def moved_on(self, elapsed: float, camera: CameraMotion, *, stands: bool = False) -> Sightings:
        """Let `elapsed` frames pass and the camera move; `stands` if it only sways."""
        # They are kept from the last clear one on: a vehicle may be hidden for as long again.
        proven = self.proven().rows
        clear = np.flatnonzero(proven[:, 5] >= CLEAR_RESPONSE)
        # The last one is the youngest.
        oldest = KEPT_FRAMES + (proven[clear[-1], 0] if len(clear) else 0.0)
        # A mask copies: the rows of the state before stay as they were.
        rows = self.rows.compress(self.rows[:, 0] < oldest, axis=0)
        rows[:, 0] += elapsed
        if not camera.still:
            rows[:, 1:3] = camera.apply(rows[:, 1:3])
        stood = self.camera_stood + elapsed if camera.still or stands else 0.0
        return self._replace(rows=rows, camera_stood=stood)

    @property
    def are_steady(self) -> bool:
        """True where the camera has stood for as long as sightings are kept."""
        return self.camera_stood > KEPT_FRAMES

    def followed(self) -> Followed | None:
        """Weigh how far a camera that moves follows the vehicle; None where it stands."""
        clear = self.rows[self.rows[:, 5] >= CLEAR_RESPONSE]
        if self.are_steady or not len(clear):
            return None
        # Tried for as long as positions count in the fit: by then the speed is another one.
        return Followed.measured(clear[:, 0], clear[:, 1:3], clear[:, 6:8], _MEMORY)

    def fit(self) -> tuple[PerspectiveMotion, Sighting] | None:
        """Fit the motion to clear sightings; also give the last of them, which is at time 0.

        Before a camera that moves the vehicle keeps its size from then on. A fitted rate does not
        last there: over 22 sequences .6 of it is right for 10 frames, .15 for 20
        (laboratory/notes/fusion_tried.md).
        """
        ages = self.rows[:, 0]
        responses = self.rows[:, 5]
        positions = self.rows[:, 1:3]
        sizes = self.rows[:, 3:5]
        clear = responses >= CLEAR_RESPONSE
        if not clear.any():
            return None
        # Before the clear ones are chosen: the whole vehicle's ratio is taken from all.
        whole = restored_sightings(ages, positions, sizes, responses)
        positions, sizes = whole or (positions, sizes)
        positions = positions[clear]
        sizes = sizes[clear]
        ages = ages[clear]
        last = Sighting(float(ages[-1]), positions[-1], sizes[-1], whole is not None)
        times = last.age - ages
        # Too few believed sizes give no rate; then all clear ones count.
        believed = responses[clear] >= UNDISTURBED
        if believed.sum() < PROOF_FRAMES:
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
        Positions, px.
    sizes : (N,) array
        Geometric means of the sides, px.
    size_weights : (N,) array
        Weight of each size.

    Returns
    -------
    PerspectiveMotion
        Its position is the mean of the fitted and the last one.
    """
    # 1. For each rate the path is linear in t / (1 - r t): only the rate needs a grid. Few
    # sightings give no rate.
    rates = _RATES if len(times) >= PROOF_FRAMES else np.zeros(1)
    weights = np.exp(times / _MEMORY)
    total = weights.sum()
    divisors = np.maximum(1.0 - rates[:, np.newaxis] * times, _LEAST_DIVISOR)
    shares = times / divisors
    # 2. Velocities by weighted regression, for all rates at once. Centred on the means, offset and
    # slope separate.
    centres = shares @ weights / total
    middle = weights @ positions / total
    off = shares - centres[:, np.newaxis]
    # The small summand keeps simultaneous sightings solvable, with a velocity of zero.
    spread = off**2 @ weights + 1e-9
    velocities = (off * weights) @ (positions - middle) / spread[:, np.newaxis]
    residuals = positions - middle - off[..., np.newaxis] * velocities[:, np.newaxis]
    # 3. At the right rate s (1 - r t) is constant: what varies is the error. In the logarithm a
    # size that is a tenth too large is as wrong for a far vehicle as for a near one.
    logs = np.log(sizes * divisors)
    log_sizes = logs @ size_weights / size_weights.sum()
    # 4. Minus twice the log posterior, with a normal prior on the rate; the best possible rate.
    sigma = _POSITION_SIGMA * float(sizes.mean())
    costs = (residuals**2).sum(axis=2) @ weights / sigma**2 + (rates / _RATE_SIGMA) ** 2
    costs += (logs - log_sizes[:, np.newaxis]) ** 2 @ size_weights / _SIZE_SIGMA**2
    possible = rates * times[0] <= _LARGEST_CHANGE
    best = int(np.argmin(np.where(possible, costs, np.inf)))
    # 5. The path at time 0, halfway to the last sighting.
    fitted = middle - centres[best] * velocities[best]
    position = (1 - _LAST_WEIGHT) * fitted + _LAST_WEIGHT * positions[-1]
    return PerspectiveMotion(position, velocities[best], float(rates[best]))
