"""Particles over position, velocity and scale."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.features.camera_motion import CameraMotion
from vehicle_pf_tracker.filtering.motion import sample_normal
from vehicle_pf_tracker.filtering.resampling import systematic
from vehicle_pf_tracker.trackers.base import Cloud
from vehicle_pf_tracker.trackers.estimate import Array

Place = tuple[float, float]

_LEAST_SIGMA = 0.15
"""px; keeps the particles of tiny targets apart."""


@dataclass(frozen=True, slots=True)
class Spread:
    """Standard deviations of one displacement, and how much of it the velocity takes on."""

    place: float
    log_scale: float
    gain: float

    def times(self, factor: float) -> Spread:
        """Return smaller or larger deviations with the same gain."""
        return Spread(self.place * factor, self.log_scale * factor, self.gain)


@dataclass(frozen=True, slots=True)
class Swarm:
    """Positions and velocities (N, 2) in px and px per frame; scales and weights (N,)."""

    positions: Array
    velocities: Array
    scales: Array
    weights: Array

    @classmethod
    def around(
        cls,
        rng: np.random.Generator,
        count: int,
        place: Place,
        velocity: Place,
        scale: float,
        side: float,
    ) -> Swarm:
        """Draw particles close to one state; `side` is the target's size in px."""
        return cls(
            np.asarray(place) + sample_normal(rng, count, 0.03 * side),
            np.asarray(velocity) + sample_normal(rng, count, 0.02 * side),
            scale * np.exp(0.01 * rng.standard_normal(count)),
            np.full(count, 1.0 / count),
        )

    @property
    def place(self) -> Place:
        """Weighted mean of the positions."""
        x, y = (self.weights @ self.positions).tolist()
        return x, y

    @property
    def velocity(self) -> Place:
        """Weighted mean of the velocities."""
        x, y = (self.weights @ self.velocities).tolist()
        return x, y

    @property
    def scale(self) -> float:
        """Weighted geometric mean of the scales."""
        return float(np.exp(self.weights @ np.log(self.scales)))

    @property
    def width(self) -> float:
        """Largest standard deviation of the positions along x or y, px."""
        return float(self.positions.std(axis=0).max())

    def carried(self, motion: CameraMotion) -> Swarm:
        """Take all along with the background."""
        return Swarm(
            motion.apply(self.positions),
            self.velocities * motion.scale,
            self.scales * motion.scale,
            self.weights,
        )

    def resampled(self, rng: np.random.Generator, count: int) -> Swarm:
        """Draw `count` particles by their weights."""
        ancestors = systematic(self.weights, count, rng)
        return Swarm(
            self.positions[ancestors],
            self.velocities[ancestors],
            self.scales[ancestors],
            np.full(count, 1.0 / count),
        )

    def moved(self, rng: np.random.Generator, elapsed: float, spread: Spread) -> Swarm:
        """Drive on with constant velocity, disturbed; the velocity takes its share of that."""
        root = math.sqrt(elapsed)
        noise = sample_normal(rng, len(self.weights), spread.place * root + _LEAST_SIGMA)
        change = spread.gain * noise / elapsed if elapsed > 0 else 0.0
        factors = np.exp(spread.log_scale * root * rng.standard_normal(len(self.weights)))
        return replace(
            self,
            positions=self.positions + self.velocities * elapsed + noise,
            velocities=self.velocities + change,
            scales=self.scales * factors,
        )

    def jittered(
        self, rng: np.random.Generator, kept: np.ndarray, elapsed: float, spread: Spread
    ) -> Swarm:
        """Replace all but the kept particles by disturbed copies of these (P3, Table II)."""
        missing = int((~kept).sum())
        ancestors = systematic(np.where(kept, self.weights, 0.0), missing, rng)
        copies = replace(self.selected(ancestors), weights=np.zeros(missing))
        noise = sample_normal(rng, missing, spread.place + _LEAST_SIGMA / 3)
        factors = np.exp(spread.log_scale * rng.standard_normal(missing))
        positions, velocities, scales = (
            self.positions.copy(),
            self.velocities.copy(),
            self.scales.copy(),
        )
        positions[~kept] = copies.positions + noise
        velocities[~kept] = copies.velocities + spread.gain * noise / max(elapsed, 0.5)
        scales[~kept] = copies.scales * factors
        return Swarm(positions, velocities, scales, self.weights)

    def selected(self, indices: np.ndarray) -> Swarm:
        """Take some of the particles."""
        return Swarm(
            self.positions[indices],
            self.velocities[indices],
            self.scales[indices],
            self.weights[indices],
        )

    def cloud(self, *, sound: bool = True) -> Cloud:
        """Give what is reported of the particles."""
        return Cloud(self.positions, self.weights, sound)
