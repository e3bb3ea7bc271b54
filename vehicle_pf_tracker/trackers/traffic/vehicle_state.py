# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""State of one vehicle on the plane of the road, and its measurement edge by edge.

A box stands on the road where its lower edge is. Its distance from the horizon, v px, is inversely
proportional to the distance from the camera, so that a vehicle of constant speed on the road has a
speed and a size in the image that follow from v: (x, v, width, height) in px, and the velocities
across and along the road, in units in which a place on the road is (x / v, 1 / v). The Gaussian is
carried exactly where measurements are linear in it (boxes), and by particles where they are not
(pixels): the Gaussian particle filter of Kotecha and Djuric (2003). The states of all vehicles are
stacked, predicted and measured in one go.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box

FAR = 3.0
"""Standard deviations beyond which two values do not belong together: one in 400 is as far."""
PIXEL_NOISE = 0.7
"""Standard deviation in px of an edge however small its box, and of a point's flow: the grid of
pixels, on both sides."""

SETTLED_AFTER = 30
"""Detections or nominal periods, one second of 30 Hz, by which what is seen is no passing state: a
covered edge, a part of another vehicle, standing still."""

USUAL_ASPECT = 0.8
"""Height of a vehicle over its width: that of cars from the front."""

X, V, W, H, ACROSS, ALONG = range(6)
"""Components of the state: centre and distance from the horizon, size (px), road velocities."""

_MOST_GROWTH = 2.0
"""Largest growth of a box from image to image, and largest fall. Beyond it the distance is down to
the camera's own height, where the plane no longer describes what is seen."""
_LEAST, _LARGEST = 1.0, 1e5
"""Least distance from the horizon and least side, px; and largest of these, of places and of
standard deviations, which bounds velocities in their units, too. No image has a third of it
(`image.encodings.MAX_SIDE`), so that a vehicle there has left."""
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

_LOWEST_MEAN = np.array([-_LARGEST, _LEAST, _LEAST, _LEAST, -_LARGEST, -_LARGEST])
"""Lower bounds of the mean, by component."""
_TINY = float(np.finfo(float).tiny)


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
    """Gaussian over a vehicle's place, size and velocity, or over those of N vehicles at once.

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

    Attributes
    ----------
    mean : (6,) or (N, 6) array
        Mean of the state.
    covariance : (6, 6) or (N, 6, 6) array
        Its covariance.
    horizon : () or (N,) array
        Row of the horizon in px.
    edges : (4,) or (N, 4) array
        Left, top, right and bottom in px.
    """

    def __init__(self, edges: Array, deviations: Array, horizon: float, drive: Drive) -> None:
        left, top, right, bottom = edges.tolist()
        v = max(bottom - horizon, _LEAST)
        self.horizon = np.array(horizon)
        self.mean = np.array([(left + right) / 2, v, right - left, bottom - top, 0.0, 0.0])
        by_left, by_top, by_right, by_bottom = (deviations**2).tolist()
        width, height = by_left + by_right, by_top + by_bottom
        speed = (drive.top_speed * (right - left) / v) ** 2
        along = speed / drive.focal**2
        variances = width / 4, by_bottom, width, height, speed, along
        self.covariance: Array = np.diag(variances)
        self._settle()

    @classmethod
    def stacked(cls, states: Sequence[VehicleState]) -> VehicleState:
        """Stack the states of several vehicles; `give_back` hands them what became of it."""
        self = cls.__new__(cls)
        self.mean = np.array([one.mean for one in states]).reshape(-1, 6)
        self.covariance = np.array([one.covariance for one in states]).reshape(-1, 6, 6)
        self.horizon = np.array([one.horizon for one in states])
        self.edges = np.array([one.edges for one in states]).reshape(-1, 4)
        return self

    def give_back(self, states: Sequence[VehicleState]) -> None:
        """Let each vehicle have its row of the stack."""
        for index, one in enumerate(states):
            one.mean, one.covariance = self.mean[index], self.covariance[index]
            one.horizon, one.edges = self.horizon[index], self.edges[index]

    @property
    def box(self) -> Box:
        """Box of one vehicle in px."""
        return self.shown(np.zeros(len(Edge)))

    def shown(self, lag: Array) -> Box:
        """Make the box of one vehicle whose edges lag behind (4,) px."""
        left, top, right, bottom = (self.edges + lag).tolist()
        return Box(left, top, max(right - left, 1.0), max(bottom - top, 1.0))

    @property
    def edge_covariance(self) -> Array:
        """Covariance of the edges, (..., 4, 4) in px²."""
        return np.asarray(OBSERVATION @ self.covariance @ OBSERVATION.T)

    @property
    def foot_covariance(self) -> tuple[float, float, float]:
        """Of one vehicle's point on the road: variances of x and y around their covariance, px²."""
        (by_x, both), (_, by_y) = self.covariance[: V + 1, : V + 1].tolist()
        return by_x, both, by_y

    @property
    def is_sound(self) -> npt.NDArray[np.bool_]:
        """True while the state is a Gaussian: finite, and of positive variances."""
        totals = self.mean.sum(axis=-1) + self.covariance.sum(axis=(-2, -1))
        variances = self.covariance.diagonal(axis1=-2, axis2=-1)
        return np.asarray(np.isfinite(totals) & (variances > 0).all(axis=-1))

    @property
    def velocity(self) -> tuple[float, float]:
        """Velocity of the box's centre of one vehicle, px per nominal period."""
        x, v, _, h, across, along = self.mean.tolist()
        growth = -along * v
        return x * growth + across * v, (v - h / 2) * growth

    @property
    def speed_ratio(self) -> float:
        """Distance of a velocity on the road from zero, in standard deviations."""
        across, along = self.mean[ACROSS:].tolist()
        (first, both), (_, second) = self.covariance[ACROSS:, ACROSS:].tolist()
        squared = across**2 * second - 2 * across * along * both + along**2 * first
        return math.sqrt(max(squared, 0.0) / max(first * second - both**2, _TINY))

    def predict(self, elapsed: float, drive: Drive) -> None:
        """Drive on for `elapsed` nominal periods."""
        x, v, w, h, across, along = np.moveaxis(self.mean, -1, 0)
        divisor = 1 + v * along * elapsed
        bounded = np.clip(divisor, 1 / _MOST_GROWTH, _MOST_GROWTH)
        growth, free = 1 / bounded, bounded == divisor  # else the growth depends on nothing
        by_v, by_along = free * -along * elapsed * growth**2, free * -v * elapsed * growth**2
        driven = x + v * across * elapsed
        step = np.zeros_like(self.covariance)
        step[..., ACROSS, ACROSS] = step[..., ALONG, ALONG] = 1.0
        step[..., X, X] = step[..., W, W] = step[..., H, H] = growth
        step[..., X, V] = across * elapsed * growth + driven * by_v
        step[..., X, ACROSS] = v * elapsed * growth
        step[..., X, ALONG] = driven * by_along
        step[..., V, V] = growth + v * by_v
        step[..., V, ALONG] = v * by_along
        step[..., W, V], step[..., W, ALONG] = w * by_v, w * by_along
        step[..., H, V], step[..., H, ALONG] = h * by_v, h * by_along
        sides = [driven * growth, v * growth, w * growth, h * growth, across, along]
        self.mean = np.stack(sides, axis=-1)
        push = drive.acceleration * w / v
        self._transform(step)
        self.covariance[..., ACROSS, ACROSS] += push**2 * elapsed
        self.covariance[..., ALONG, ALONG] += (push / drive.focal) ** 2 * elapsed
        self.covariance[..., W, W] += (_SIZE_WALK * w) ** 2 * elapsed
        self.covariance[..., H, H] += (_SIZE_WALK * h) ** 2 * elapsed
        self._bound()
        self._settle()

    def resize(self, edges: Array) -> None:
        """Take a box (4,) for the vehicle's without doubt; it drives as before."""
        left, top, right, bottom = edges.tolist()
        v = max(bottom - float(self.horizon), _LEAST)
        self.mean[:ACROSS] = (left + right) / 2, v, right - left, bottom - top
        self._settle()

    def move_horizon(self, horizon: float) -> None:
        """Take another row (px) for the horizon; box and velocity of the lower edge stay."""
        if np.all(self.horizon == horizon):
            return
        x, v = self.mean[..., X], self.mean[..., V].copy()
        new = np.maximum(v + self.horizon - horizon, _LEAST)
        ratio, self.horizon = v / new, v + self.horizon - new
        step = np.zeros_like(self.covariance)
        step[..., range(6), range(6)] = 1.0
        step[..., ALONG, ALONG] = ratio**2
        step[..., ACROSS, ACROSS] = ratio
        step[..., ACROSS, ALONG] = x * (ratio - 1) * ratio
        self.mean = (step @ self.mean[..., np.newaxis])[..., 0]
        self.mean[..., V] = new
        self._transform(step)
        self._bound()
        self._settle()

    def measure(self, edges: Array, deviations: Array) -> None:
        """Take measured edges (..., 4) in px of these standard deviations; infinite: not seen."""
        for edge in Edge:
            row = OBSERVATION[edge]
            spread = self.covariance @ row
            offset = self.horizon if edge in (Edge.TOP, Edge.BOTTOM) else 0.0
            residual = edges[..., edge] - offset - self.mean @ row
            variance = spread @ row + deviations[..., edge] ** 2
            self.mean = self.mean + spread * (residual / variance)[..., np.newaxis]
            self.mean[..., V:ACROSS] = np.maximum(self.mean[..., V:ACROSS], _LEAST)
            # Products of the spread with itself are symmetric to the last bit, as no gain's are.
            known = spread[..., np.newaxis] * spread[..., np.newaxis, :]
            self.covariance = self.covariance - known / variance[..., np.newaxis, np.newaxis]
        self._settle()

    def _transform(self, step: Array) -> None:
        moved = step @ self.covariance @ np.swapaxes(step, -2, -1)
        self.covariance = (moved + np.swapaxes(moved, -2, -1)) / 2

    def _bound(self) -> None:
        """Keep a prediction within bounds; a vehicle that is in sight is far inside them."""
        self.mean = np.clip(self.mean, _LOWEST_MEAN, _LARGEST)
        variances = self.covariance.diagonal(axis1=-2, axis2=-1)
        if variances.max(initial=0.0) <= _LARGEST**2:
            return
        # Scaled from both sides a covariance stays one, and correlations stay what they are.
        with np.errstate(invalid="ignore"):  # of an unsound one, which is dropped
            shares = np.minimum(_LARGEST / np.sqrt(variances), 1.0)
        self.covariance = self.covariance * (shares[..., np.newaxis] * shares[..., np.newaxis, :])

    def _settle(self) -> None:
        """Derive the edges, as `OBSERVATION` says."""
        x, v, half = self.mean[..., X], self.mean[..., V], self.mean[..., W] / 2
        self.edges = np.empty((*self.mean.shape[:-1], len(Edge)))
        self.edges[..., Edge.LEFT], self.edges[..., Edge.RIGHT] = x - half, x + half
        self.edges[..., Edge.BOTTOM] = bottom = v + self.horizon
        self.edges[..., Edge.TOP] = bottom - self.mean[..., H]
