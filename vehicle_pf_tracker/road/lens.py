# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Distortion of a lens, by the models of sensor_msgs/CameraInfo, and its removal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError

FIRST_PIXEL = 0.5
"""Centre of the first pixel in this package; in CameraInfo, as in OpenCV, it is 0."""
_MODELS: Mapping[str, tuple[int, ...]] = {
    "none": (0,),
    "plumb_bob": (4, 5),
    "rational_polynomial": (8,),
    "equidistant": (4,),
}
"""Numbers of coefficients that each model may have."""
LENS_MODELS = tuple(_MODELS)
_ROUNDS = 30
"""Newton steps of the removal; four to eight settle it where the model can be inverted."""
_TOLERANCE = 1e-9
"""Distance of a removal's result, distorted again, from where it came from, in focal lengths: above
it the point is beyond the fold of the polynomial, where no ray belongs to it."""
_SETTLED = 1e-13
"""Error at which the steps end, in focal lengths: some roundings."""
_STEP = 1e-6
"""Step of numerical derivatives, in focal lengths: some square roots of the rounding error."""


@dataclass(frozen=True, slots=True)
class Lens:
    """Pinhole camera with distortion; pixels in, ideal pixels of the same pinhole out.

    Attributes
    ----------
    focal : (float, float)
        Focal lengths fx, fy in px.
    centre : (float, float)
        Principal point cx, cy in px, as in CameraInfo.
    model : str
        One of `LENS_MODELS`, the names of CameraInfo.
    coefficients : tuple of float
        Coefficients of the distortion, in the order of CameraInfo.
    """

    focal: tuple[float, float]
    centre: tuple[float, float]
    model: str = "none"
    coefficients: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        numbers = (*self.focal, *self.centre, *self.coefficients)
        if not all(map(np.isfinite, numbers)) or min(self.focal) <= 0:
            raise InputError("the camera's focal lengths must be above 0, and all numbers finite")
        if self.model not in _MODELS:
            raise InputError(
                f"the distortion model {self.model!r} is not known; "
                f"use one of {', '.join(LENS_MODELS)}"
            )
        counts = _MODELS[self.model]
        if len(self.coefficients) not in counts:
            wanted = " or ".join(map(str, counts))
            raise InputError(
                f"the distortion model {self.model} has {wanted} coefficients, "
                f"got {len(self.coefficients)}"
            )

    @property
    def matrix(self) -> Array:
        """Camera matrix (3, 3) for pixels of this package."""
        fx, fy = self.focal
        cx, cy = self.centre
        return np.array([[fx, 0, cx + FIRST_PIXEL], [0, fy, cy + FIRST_PIXEL], [0, 0, 1]])

    def to_ideal(self, points: Array) -> Array:
        """Remove the distortion from pixels (…, 2); nan where no ray belongs to a pixel."""
        # All zero is no lens for polynomials, but still bends by the equidistant model.
        if not any(self.coefficients) and self.model != "equidistant":
            return points
        return self._pixels(self._undistorted(self._rays(points)))

    def to_pixels(self, points: Array) -> Array:
        """Distort ideal pixels (…, 2), as the lens does."""
        return self._pixels(self._distorted(self._rays(points)))

    def _rays(self, points: Array) -> Array:
        return np.asarray((points - self.matrix[:2, 2]) / self.focal)

    def _pixels(self, rays: Array) -> Array:
        return np.asarray(rays * self.focal + self.matrix[:2, 2])

    def _distorted(self, rays: Array) -> Array:
        """Distort rays (…, 2), in focal lengths, by the lens's model."""
        if not rays.size:  # OpenCV refuses none
            return rays
        points = rays.reshape(1, -1, 2)
        coefficients = np.array(self.coefficients)
        if self.model == "equidistant":
            bent = cv2.fisheye.distortPoints(points, np.eye(3), coefficients)
        else:
            forward = np.dstack([points, np.ones(points.shape[:2])])
            # `projectPoints` with no rotation and no shift is the distortion alone.
            still = np.zeros(3)
            bent = cv2.projectPoints(forward, still, still, np.eye(3), coefficients)[0]
        return np.asarray(bent, np.float64).reshape(rays.shape)

    def _undistorted(self, distorted: Array) -> Array:
        """Invert the distortion by Newton's method, with derivatives by differences.

        OpenCV's `undistortPoints`, which `image_geometry` calls too, ends after five steps: with
        k1 = -0.3 it is off by 1e-5 focal lengths at half a focal length from the centre, and at a
        whole one, where no ray belongs to a pixel, it returns a point as if there were one.
        """
        # Distorted rays are near enough to start from: the distortion is small beside the ray.
        rays = np.array(distorted)
        with np.errstate(all="ignore"):
            for _ in range(_ROUNDS):
                error = self._distorted(rays) - distorted
                if not (np.abs(error) > _SETTLED).any():
                    break
                columns = [
                    (self._distorted(rays + step) - self._distorted(rays - step)) / (2 * _STEP)
                    for step in np.eye(2) * _STEP
                ]
                (a, c), (b, d) = (np.moveaxis(column, -1, 0) for column in columns)
                # The 2 x 2 systems by hand, for all points at once.
                x, y = np.moveaxis(error, -1, 0)
                move = np.stack([d * x - b * y, a * y - c * x], axis=-1)
                rays = rays - move / (a * d - b * c)[..., np.newaxis]
            off = np.linalg.norm(self._distorted(rays) - distorted, axis=-1)
            # Beyond the fold a polynomial has rays on the other side of the axis.
            turned = (rays * distorted).sum(axis=-1) < -_TOLERANCE
        rays[~(off < _TOLERANCE) | turned] = np.nan
        return rays
