# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""States of vehicles on the plane of the road, as Gaussians.

A box stands on the road where its lower edge is. Its distance from the horizon, v px, is inversely
proportional to the distance from the camera, so that a vehicle of constant speed on the road has a
speed and a size in the image that follow from v: (x, v, width, height) in px, and the velocities
across and along the road, in units in which a place on the road is (x / v, 1 / v). The Gaussian is
carried exactly where measurements are linear in it (boxes), and by particles where they are not
(pixels): the Gaussian particle filter of Kotecha and Djuric (2003).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.edge_observation import (
    ACROSS,
    ALONG,
    Edge,
    H,
    V,
    W,
    X,
    edge_of,
    edge_rows,
)
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Rows, columns

PIXEL_NOISE = 0.7
"""Standard deviation in px of an edge however small its box, and of a point's flow: the grid of
pixels, on both sides."""

USUAL_ASPECT = 0.8
"""Height of a vehicle over its width: that of cars from the front. Only boxes that a border cuts at
first are completed by it."""

_MOST_GROWTH = 2.0
"""Largest growth of a box from image to image, and largest fall. Beyond it the distance is down to
the camera's own height, where the plane no longer describes what is seen."""
_LEAST_PX = 1.0
"""Least distance from the horizon, and least side, px: velocities are divided by both."""
_LARGEST_PX = 1e5
"""Largest distance, side, place and standard deviation, px, which bounds velocities in their units,
too. No image has a third of it (`image.formats.encodings.LARGEST_SIDE_PX`), so that a vehicle there
has left."""
_SIZE_WALK = 0.004
"""Change of a vehicle's shape as the camera sees it, of its size per nominal period: a vehicle that
drives past is seen from behind and then from the side within some 5 s, in which it adds up to a
twentieth."""


_UNCHANGED = np.eye(6)
"""Jacobian of a map that changes no component of the state."""
_LOWEST_MEAN = np.array([-_LARGEST_PX, _LEAST_PX, _LEAST_PX, _LEAST_PX, -_LARGEST_PX, -_LARGEST_PX])
"""Lower bounds of the mean, by component."""
# Keeps a determinant that rounding made zero a divisor.
_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True, slots=True)
class Motion:
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


ANY_SPEED = np.eye(2)
"""Covariance of the speeds of new vehicles, in squares of `top_speed`: as fast in any direction."""


@dataclass(frozen=True, slots=True, eq=False)
class Gaussians(Rows):
    """Gaussians over the place, size and velocity of N vehicles.

    Attributes
    ----------
    mean : (N, 6) array
        Mean of each state, in the order of `X` to `ALONG`.
    covariance : (N, 6, 6) array
        Covariance of each state.
    horizon : (N,) array
        Row of the horizon in px.
    edges : (N, 4) array
        Left, top, right and bottom in px, as `OBSERVATION` says.
    """

    mean: Array
    covariance: Array
    horizon: Array
    edges: Array

    @classmethod
    def of(cls, mean: Array, covariance: Array, horizon: Array) -> Gaussians:
        """Make them, and derive the edges."""
        half = mean[:, W] / 2
        bottom = mean[:, V] + horizon
        edges = columns(mean[:, X] - half, bottom - mean[:, H], mean[:, X] + half, bottom)
        return cls(mean, covariance, horizon, edges)

    @classmethod
    def around(
        cls,
        edges: Array,
        deviations: Array,
        horizon: Array,
        motion: Motion,
        speeds: Array = ANY_SPEED,
    ) -> Gaussians:
        """Make those of vehicles in their first boxes.

        Parameters
        ----------
        edges, deviations : (N, 4) arrays
            Left, top, right and bottom in px, and their standard deviations.
        horizon : (N,) array
            Row of the horizon in px.
        motion : Motion
            Motion of vehicles.
        speeds : (2, 2) array
            Covariance of their speeds across and along the road, in squares of `top_speed`.
        """
        left, top, right, bottom = edges.T
        # On the road a width is proportional to v, so that w / v is the unit of its speed.
        v = np.maximum(bottom - horizon, _LEAST_PX)
        zero = np.zeros(len(edges))
        mean = columns((left + right) / 2, v, right - left, bottom - top, zero, zero)
        by_left, by_top, by_right, by_bottom = (deviations**2).T
        # Sides are differences of two independent edges, the centre is half of their sum.
        width = by_left + by_right
        height = by_top + by_bottom
        speed = (motion.top_speed * (right - left) / v) ** 2
        # A place on the road is (x / v, 1 / v): of the same length in m the second is shorter by
        # the focal length.
        lengths = np.array([[1.0, motion.focal], [motion.focal, motion.focal**2]])
        covariance = np.zeros((len(edges), 6, 6))
        covariance[:, range(4), range(4)] = columns(width / 4, by_bottom, width, height)
        covariance[:, ACROSS:, ACROSS:] = speed[:, np.newaxis, np.newaxis] / lengths * speeds
        return cls.of(mean, covariance, horizon)

    def speeds(self, focal: float) -> Array:
        """Speeds (N, 2) across and along the road, widths per nominal period."""
        _, v, w, _, across, along = self.mean.T
        return np.asarray(columns(across, along * focal) * (v / w)[:, np.newaxis])

    @property
    def edge_covariance(self) -> Array:
        """Covariance of the edges, (N, 4, 4) in px²."""
        rows = edge_rows(self.covariance)
        return np.stack([edge_of(rows, edge) for edge in Edge], axis=-1)

    @property
    def edge_variances(self) -> Array:
        """Variances of the edges, (N, 4) in px²."""
        c = self.covariance
        by_width = 0.5 * c[:, W, X]
        half = 0.5 * c[:, W, W]
        left = c[:, X, X] - by_width - 0.5 * (c[:, X, W] - half)
        right = c[:, X, X] + by_width + 0.5 * (c[:, X, W] + half)
        top = c[:, V, V] - c[:, H, V] - (c[:, V, H] - c[:, H, H])
        return columns(left, top, right, c[:, V, V])

    @property
    def foot_covariance(self) -> Array:
        """Variance of x, covariance, variance of y (N, 3) of the points on the road, px²."""
        covariance = self.covariance
        return columns(covariance[:, X, X], covariance[:, X, V], covariance[:, V, V])

    @property
    def is_sound(self) -> Bools:
        """True (N,) while the state is a Gaussian: finite, and of positive variances."""
        totals = self.mean.sum(axis=-1) + self.covariance.sum(axis=(-2, -1))
        variances = self.covariance.diagonal(axis1=-2, axis2=-1)
        return np.asarray(np.isfinite(totals) & (variances > 0).all(axis=-1))

    @property
    def velocity(self) -> Array:
        """Velocity of the boxes' centres, (N, 2) in px per nominal period."""
        x, v, _, h, across, along = self.mean.T
        growth = -along * v
        return columns(x * growth + across * v, (v - h / 2) * growth)

    @property
    def speed_ratio(self) -> Array:
        """Distance (N,) of the velocity on the road from zero, in standard deviations."""
        across = self.mean[:, ACROSS]
        along = self.mean[:, ALONG]
        first = self.covariance[:, ACROSS, ACROSS]
        second = self.covariance[:, ALONG, ALONG]
        both = self.covariance[:, ACROSS, ALONG]
        squared = across**2 * second - 2 * across * along * both + along**2 * first
        # Mahalanobis distance in two dimensions, by the inverse written out.
        determinant = np.maximum(first * second - both**2, _TINY)
        return np.asarray(np.sqrt(np.maximum(squared, 0.0) / determinant))

    def driven(self, elapsed: float, motion: Motion) -> Gaussians:
        """Drive on for `elapsed` nominal periods."""
        # 1. In units of the road both places move by their speeds, x / v by `across` and 1 / v by
        # `along`. Back in px that is a growth of all by 1 / (1 + v along t).
        x, v, w, h, across, along = self.mean.T
        # It is 0 where the vehicle passes the camera: bounded before it is divided by.
        divisor = 1 + v * along * elapsed
        bounded = np.minimum(np.maximum(divisor, 1 / _MOST_GROWTH), _MOST_GROWTH)
        growth = 1 / bounded
        free = bounded == divisor  # else the growth depends on nothing
        by_v = free * -along * elapsed * growth**2
        by_along = free * -v * elapsed * growth**2
        # 2. Jacobian of this map, as in an extended Kalman filter.
        moved = x + v * across * elapsed
        step = np.empty_like(self.covariance)
        step[:] = _UNCHANGED
        step[:, X, X] = step[:, W, W] = step[:, H, H] = growth
        step[:, X, V] = across * elapsed * growth + moved * by_v
        step[:, X, ACROSS] = v * elapsed * growth
        step[:, X, ALONG] = moved * by_along
        step[:, V, V] = growth + v * by_v
        step[:, V, ALONG] = v * by_along
        step[:, W, V] = w * by_v
        step[:, W, ALONG] = w * by_along
        step[:, H, V] = h * by_v
        step[:, H, ALONG] = h * by_along
        # 3. Mean by the map itself, covariance by its Jacobian.
        mean = columns(moved * growth, v * growth, w * growth, h * growth, across, along)
        covariance = _transformed(self.covariance, step)
        # 4. Noise drives the speeds, from which places get theirs at the next step, and sizes.
        push = motion.acceleration * w / v
        covariance[:, ACROSS, ACROSS] += push**2 * elapsed
        covariance[:, ALONG, ALONG] += (push / motion.focal) ** 2 * elapsed
        covariance[:, W, W] += (_SIZE_WALK * w) ** 2 * elapsed
        covariance[:, H, H] += (_SIZE_WALK * h) ** 2 * elapsed
        # 5. A hidden vehicle may be predicted for long, and go where numbers overflow.
        return _bounded(mean, covariance, self.horizon)

    def under(self, horizon: float) -> Gaussians:
        """Take another row (px) for the horizon; box and velocity of the lower edge stay."""
        if np.all(self.horizon == horizon):
            return self
        x = self.mean[:, X]
        v = self.mean[:, V]
        new = np.maximum(v + self.horizon - horizon, _LEAST_PX)
        # The edge's speed in px is v² along, so that along changes by the square; that across, v
        # across - x v along, fixes the other one.
        ratio = v / new
        step = np.empty_like(self.covariance)
        step[:] = _UNCHANGED
        step[:, ALONG, ALONG] = ratio**2
        step[:, ACROSS, ACROSS] = ratio
        step[:, ACROSS, ALONG] = x * (ratio - 1) * ratio
        mean = (step @ self.mean[..., np.newaxis])[..., 0]
        # It cannot be less than `_LEAST_PX` below the new horizon: its own row then stays above it.
        mean[:, V] = new
        return _bounded(mean, _transformed(self.covariance, step), v + self.horizon - new)

    def resized(self, edges: Array) -> Gaussians:
        """Take boxes (N, 4) for the vehicles' without doubt; they drive as before."""
        left, top, right, bottom = edges.T
        v = np.maximum(bottom - self.horizon, _LEAST_PX)
        mean = self.mean.copy()
        mean[:, :ACROSS] = columns((left + right) / 2, v, right - left, bottom - top)
        return Gaussians.of(mean, self.covariance, self.horizon)

    def measured(self, edges: Array, deviations: Array) -> Gaussians:
        """Take measured edges (N, 4) in px of these standard deviations; infinite: not seen."""
        mean = self.mean
        covariance = self.covariance
        noises = deviations**2
        # Edges as the state has them: top and bottom are relative to the horizon.
        measured = edges.copy()
        measured[:, Edge.TOP :: 2] -= self.horizon[:, np.newaxis]
        for edge in Edge:
            # Edge by edge, as noises of edges are independent: no matrix has to be inverted.
            spread = edge_of(covariance, edge)
            residual = measured[:, edge] - edge_of(mean, edge)
            variance = edge_of(spread, edge) + noises[:, edge]
            mean = mean + spread * (residual / variance)[:, np.newaxis]
            sides = mean[:, V:ACROSS]
            np.maximum(sides, _LEAST_PX, out=sides)  # they stay positive
            # Products of the spread with itself are symmetric to the last bit, as no gain's are.
            known = spread[:, :, np.newaxis] * spread[:, np.newaxis, :]
            covariance = covariance - known / variance[:, np.newaxis, np.newaxis]
        return Gaussians.of(mean, covariance, self.horizon)

    def widened(self, factors: Array) -> Gaussians:
        """Multiply each covariance by a factor (N,)."""
        return replace(self, covariance=self.covariance * factors[:, np.newaxis, np.newaxis])


def _transformed(covariance: Array, step: Array) -> Array:
    # Rounding would make it less symmetric in each frame.
    moved = step @ covariance @ np.swapaxes(step, -2, -1)
    return np.asarray((moved + np.swapaxes(moved, -2, -1)) / 2)


def _bounded(mean: Array, covariance: Array, horizon: Array) -> Gaussians:
    """Keep a prediction within bounds; a vehicle that is in sight is far inside them."""
    mean = np.minimum(np.maximum(mean, _LOWEST_MEAN), _LARGEST_PX)
    variances = covariance.diagonal(axis1=-2, axis2=-1)
    if variances.max(initial=0.0) > _LARGEST_PX**2:
        # Scaled from both sides a covariance stays one, and correlations stay what they are.
        with np.errstate(invalid="ignore"):  # of an unsound one, which is dropped
            shares = np.minimum(_LARGEST_PX / np.sqrt(variances), 1.0)
        covariance = covariance * (shares[..., np.newaxis] * shares[..., np.newaxis, :])
    return Gaussians.of(mean, covariance, horizon)
