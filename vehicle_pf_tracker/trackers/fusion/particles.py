"""Particles over position, velocity and scale."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.motion import (
    RAYLEIGH_MEAN,
    sample_normal,
    sample_normal_rayleigh,
)
from vehicle_pf_tracker.filtering.resampling import systematic
from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.image.window import keep_inside
from vehicle_pf_tracker.trackers.base import Cloud


@dataclass(frozen=True, slots=True)
class Spread:
    """Standard deviations of positions (px), velocities (px per frame) and log scales."""

    place: float
    velocity: float
    log_scale: float

    def times(self, factor: float) -> Spread:
        """Return all of them larger or smaller."""
        return Spread(self.place * factor, self.velocity * factor, self.log_scale * factor)


@dataclass(frozen=True, slots=True, eq=False)
class Particles:
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
        place: Position,
        velocity: Position,
        scale: float,
        spread: Spread,
    ) -> Particles:
        """Draw particles close to one state."""
        return cls(
            np.asarray(place) + sample_normal(rng, count, spread.place),
            np.asarray(velocity) + sample_normal(rng, count, spread.velocity),
            scale * np.exp(spread.log_scale * rng.standard_normal(count)),
            np.full(count, 1.0 / count),
        )

    @property
    def place(self) -> Position:
        """Weighted mean of the positions."""
        x, y = (self.weights @ self.positions).tolist()
        return x, y

    @property
    def scale(self) -> float:
        """Weighted geometric mean of the scales."""
        return math.exp(float(self.weights @ np.log(self.scales)))

    @property
    def width(self) -> float:
        """Largest standard deviation of the positions along x or y, px."""
        return float(self.positions.std(axis=0).max())

    def carried(self, motion: CameraMotion) -> Particles:
        """Take all along with the background."""
        return Particles(
            motion.apply(self.positions),
            self.velocities * motion.scale,
            self.scales * motion.scale,
            self.weights,
        )

    def moved(
        self, rng: np.random.Generator, elapsed: float, growth: float, spread: Spread
    ) -> Particles:
        """Drive on with constant velocity and growth, disturbed."""
        count, root = len(self.weights), math.sqrt(elapsed)
        noise = sample_normal(rng, count, spread.place * root)
        change = sample_normal(rng, count, spread.velocity * root)
        growths = growth * elapsed + spread.log_scale * root * rng.standard_normal(count)
        return replace(
            self,
            positions=self.positions + self.velocities * elapsed + noise,
            velocities=self.velocities + change,
            scales=self.scales * np.exp(growths),
        )

    def drifted(
        self,
        rng: np.random.Generator,
        elapsed: float,
        velocity: Position,
        scale: float,
        across: float,
        *,
        along: bool,
    ) -> Particles:
        """Let hidden particles drift along the motion (P1 eq. 11), or spread evenly around it.

        Parameters
        ----------
        velocity, scale
            That all of them have now.
        across : float
            Standard deviation across the motion after one frame, px.
        along : bool
            Whether their advance is Rayleigh distributed; its mean is the velocity.
        """
        count, across = len(self.weights), across * math.sqrt(elapsed)
        if along:
            parameter = math.hypot(*velocity) * elapsed / RAYLEIGH_MEAN
            moves = sample_normal_rayleigh(rng, count, velocity, parameter, across)
        else:
            moves = np.asarray(velocity) * elapsed + sample_normal(rng, count, across)
        return Particles(
            self.positions + moves,
            np.tile(velocity, (count, 1)),
            np.full(count, scale),
            self.weights,
        )

    def kept(self, frame: Frame, scales: tuple[float, float]) -> Particles:
        """Keep positions in the image, and scales between two bounds."""
        low, high = scales
        return replace(
            self,
            positions=keep_inside(frame, self.positions),
            scales=np.minimum(np.maximum(self.scales, low), high),
        )

    def drawn_towards(self, place: Position, velocity: Position, scale: float) -> Particles:
        """Move their means of place and velocity half way, that of scale wholly, to better ones."""
        off = np.asarray(place) - np.asarray(self.place)
        return replace(
            self,
            positions=self.positions + 0.5 * off,
            velocities=self.velocities + 0.5 * (velocity - self.velocities.mean(axis=0)),
            scales=self.scales * (scale / self.scale),
        )

    def resampled(self, rng: np.random.Generator, count: int) -> Particles:
        """Draw `count` particles by their weights."""
        return self._selected(systematic(self.weights, count, rng))

    def renewed(self, rng: np.random.Generator, spread: Spread) -> tuple[Particles, int]:
        """Replace particles below the mean weight by disturbed copies of others (P3, Table II).

        Returns
        -------
        particles : Particles
            Whose weights are to be found anew.
        redrawn : int
            How many were replaced.
        """
        low = self.weights < min(1.0 / len(self.weights), float(self.weights.max()))
        count = int(low.sum())
        copies = self._selected(systematic(np.where(low, 0.0, self.weights), count, rng))
        positions, scales = self.positions.copy(), self.scales.copy()
        velocities = self.velocities.copy()
        positions[low] = copies.positions + sample_normal(rng, count, spread.place)
        velocities[low] = copies.velocities
        scales[low] = copies.scales * np.exp(spread.log_scale * rng.standard_normal(count))
        return Particles(positions, velocities, scales, self.weights), count

    def _selected(self, ancestors: np.ndarray) -> Particles:
        count = len(ancestors)
        return Particles(
            self.positions[ancestors],
            self.velocities[ancestors],
            self.scales[ancestors],
            np.full(count, 1.0 / max(count, 1)),
        )

    def cloud(self, *, sound: bool = True) -> Cloud:
        """Give what is reported of the particles."""
        return Cloud(self.positions, self.weights, sound)
