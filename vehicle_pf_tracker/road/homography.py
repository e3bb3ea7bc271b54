# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Homographies from the image to the plane of the road, and their fit by least squares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError

LEAST_PAIRS = 4
"""Pairs that determine the eight numbers of a homography."""
_LEAST_RATIO = 0.006
"""Least ratio of the singular values that a fit rests on, of normalised points (Hartley 1997). A
square has 0.36, a lane of 3.5 m x 200 m from 5 m above it 0.012. Three of four points on a line
have at most 0.006 when rounded to pixels over 400 px: there the rounding would decide."""
_ROUNDS = 20
"""Gauss-Newton steps; from the linear solution three to five settle the twelfth digit."""
_SETTLED = 1e-12
"""Relative change of the parameters at which the steps end."""


@dataclass(frozen=True, slots=True, eq=False)
class Homography:
    """Projective map from points of the image (px) to the plane of the road (m).

    Attributes
    ----------
    matrix : (3, 3) array
        Map from homogeneous pixels to homogeneous metres. Its third coordinate is positive for what
        is in front of the camera, and is the inverse of the depth up to a factor: the size of a
        thing in the image is proportional to it. On the horizon it is 0.
    """

    matrix: Array

    def nearness(self, points: Array) -> Array:
        """Return the inverse depth (…,) of pixels (…, 2), up to a factor; 0 on the horizon."""
        return np.asarray(points @ self.matrix[2, :2] + self.matrix[2, 2])

    def to_road(self, points: Array) -> Array:
        """Map pixels (…, 2) to metres (…, 2); pixels on the horizon are not finite."""
        return _mapped(self.matrix, points)

    def to_image(self, points: Array) -> Array:
        """Map metres (…, 2) to pixels (…, 2)."""
        # Inverted when asked for: trackers map to the road only.
        inverse = np.asarray(np.linalg.inv(self.matrix), np.float64)
        return _mapped(inverse, points)

    def jacobian(self, point: Array) -> Array:
        """Return the derivative (2, 2) of metres by pixels at the pixel `point` (2,)."""
        near = self.nearness(point)
        road = self.to_road(point)
        return np.asarray((self.matrix[:2, :2] - np.outer(road, self.matrix[2, :2])) / near)


def _mapped(matrix: Array, points: Array) -> Array:
    homogeneous = points @ matrix[:, :2].T + matrix[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        mapped: Array = homogeneous[..., :2] / homogeneous[..., 2:]
    return mapped


def fit_homography(pixels: Array, metres: Array) -> Homography:
    """Fit the homography to pairs of points, with the least squares of distances in the image.

    Distances are taken in the image because that is where points are read off with an error.

    Parameters
    ----------
    pixels, metres : (N, 2) arrays
        Points that belong together; at least four.

    Raises
    ------
    InputError
        If there are too few pairs, they do not determine a homography (three of four in line, the
        same point twice), or they lie on both sides of its horizon.
    """
    if len(pixels) < LEAST_PAIRS:
        raise InputError(
            f"the road needs at least {LEAST_PAIRS} pairs of points, got {len(pixels)}"
        )
    # Pixels in hundreds and products of them would cost half of the digits (Hartley 1997).
    to_unit_pixels = _normalising(pixels)
    to_unit_metres = _normalising(metres)
    unit_pixels = _mapped(to_unit_pixels, pixels)
    unit_metres = _mapped(to_unit_metres, metres)
    road_to_image = _refined(_linear_fit(unit_metres, unit_pixels), unit_metres, unit_pixels)
    # Fitted from the road to the image, where the errors are; kept the other way round.
    matrix = np.linalg.inv(to_unit_metres) @ np.linalg.inv(road_to_image) @ to_unit_pixels
    near = Homography(matrix).nearness(pixels)
    if not (np.all(near > 0) or np.all(near < 0)):
        raise InputError(
            "the pairs of the road put points on both sides of its horizon: check that each pixel "
            "has its own road point, in the same order around the area"
        )
    return Homography(matrix * np.sign(near[0]))  # so that the pixels are before the camera


def _normalising(points: Array) -> Array:
    """Return the map that centres points and scales their mean distance to sqrt(2)."""
    middle = points.mean(axis=0)
    spread = np.linalg.norm(points - middle, axis=1).mean()
    if not (np.isfinite(spread) and spread > 0):
        raise InputError("the pairs of the road are all the same point, or not finite")
    scale = np.sqrt(2) / spread
    return np.array([[scale, 0, -scale * middle[0]], [0, scale, -scale * middle[1]], [0, 0, 1]])


def _linear_fit(source: Array, target: Array) -> Array:
    """Solve the direct linear transformation from `source` to `target`, both normalised."""
    # The last singular vector solves A h = 0 with |h| = 1.
    _, values, vectors = np.linalg.svd(_rows(_homogeneous(source), target))
    matrix: Array = vectors[-1].reshape(3, 3)
    # A matrix that is nearly singular maps the road to a line.
    shape = np.linalg.svd(matrix, compute_uv=False)
    if values[7] < _LEAST_RATIO * values[0] or shape[2] < _LEAST_RATIO * shape[0]:
        raise InputError(
            "the pairs of the road do not determine the mapping: it takes four points of which no "
            "three lie on a line, in the image or on the road"
        )
    return np.asarray(matrix / np.linalg.norm(matrix))


def _refined(matrix: Array, source: Array, target: Array) -> Array:
    """Minimise the distances of the mapped `source` from `target`, from a linear solution."""
    points = _homogeneous(source)
    for _ in range(_ROUNDS):
        mapped = _mapped(matrix, source)
        # The rows of the linear fit, divided by the depth, are the derivatives by the nine numbers.
        derivatives = _rows(points / (points @ matrix[2])[:, np.newaxis], mapped)
        step = np.linalg.lstsq(derivatives, (target - mapped).ravel(), rcond=None)[0]
        matrix = matrix + step.reshape(3, 3)
        # The scale of a homography is free: kept at 1, it cannot drift off in the steps.
        matrix = matrix / np.linalg.norm(matrix)
        if np.linalg.norm(step) < _SETTLED:
            break
    return matrix


def _homogeneous(points: Array) -> Array:
    return np.hstack([points, np.ones((len(points), 1))])


def _rows(points: Array, mapped: Array) -> Array:
    """Return what each entry of a matrix adds to x and y of the mapped points, (2 N, 9)."""
    zeros = np.zeros_like(points)
    along = np.hstack([points, zeros, -mapped[:, :1] * points])
    across = np.hstack([zeros, points, -mapped[:, 1:] * points])
    return np.asarray(np.stack([along, across], axis=1).reshape(-1, 9))
