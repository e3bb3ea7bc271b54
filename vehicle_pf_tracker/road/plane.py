# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The plane of the road as a camera sees it: pixels to metres, where that is calibrated.

The map is a homography, fitted to pairs of points by least squares, or made of the camera's pose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.road.homography import Homography, fit_homography
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.poses import Pose


@dataclass(frozen=True, slots=True)
class Pair:
    """A pixel and the point of the road that it shows, in px and m."""

    pixel: tuple[float, float]
    road: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class RoadPlane:
    """Map from the image to the road within its calibrated area.

    Attributes
    ----------
    homography : Homography
        From ideal pixels, free of distortion, to metres.
    lens : Lens or None
        Distortion that is removed first; None where the image has none.
    hull : (N, 2) array or None
        Corners of the calibrated area in ideal px, in order around it; None without such a bound.
    coarsest : float
        Largest length on the road that a pixel may stand for, m.
    """

    homography: Homography
    lens: Lens | None
    hull: Array | None
    coarsest: float

    @classmethod
    def of_pairs(
        cls, pairs: Sequence[Pair], lens: Lens | None, *, margin: float, coarsest: float
    ) -> RoadPlane:
        """Fit the plane to pairs; the area is their hull, larger by the share `margin`.

        Raises
        ------
        InputError
            If the pairs do not determine it; see `fit_homography`.
        """
        pixels = np.array([pair.pixel for pair in pairs], np.float64).reshape(-1, 2)
        metres = np.array([pair.road for pair in pairs], np.float64).reshape(-1, 2)
        ideal = pixels if lens is None else lens.to_ideal(pixels)
        if not np.isfinite(ideal).all():
            raise InputError("a pixel of the road's pairs is outside what the lens can show")
        homography = fit_homography(ideal, metres)
        hull = convex_hull(ideal)
        middle = hull.mean(axis=0)
        # Grown from its middle: beyond the pairs a homography extrapolates, and soon badly.
        return cls(homography, lens, middle + (1 + margin) * (hull - middle), coarsest)

    @classmethod
    def of_camera(cls, lens: Lens, pose: Pose, *, coarsest: float) -> RoadPlane:
        """Make the plane ``z = 0`` of the frame in which `pose` is that of the optical frame.

        The camera's optical frame has x to the right in the image, y down and z along the view.

        Raises
        ------
        InputError
            If the camera is not above the plane, or does not see it.
        """
        if pose.position[2] <= 0:
            raise InputError(
                f"the camera is {pose.position[2]:g} m above the road's plane z = 0; "
                "it must be above it, and the road's frame have z upwards"
            )
        # Road to camera: with z = 0 the third column of the rotation falls out.
        turned = pose.rotation.T
        to_image = lens.matrix @ np.column_stack([turned[:, :2], -turned @ pose.position])
        # Beyond it the inverse has no digits left: the plane is seen as a line.
        if np.linalg.cond(to_image) > 1e12:
            raise InputError("the camera's view lies within the road's plane")
        # The third coordinate of this map is 1 / depth: positive in front of the camera.
        return cls(Homography(np.linalg.inv(to_image)), lens, None, coarsest)

    def to_road(self, points: Array) -> Array:
        """Map pixels (…, 2) to metres (…, 2), wherever that is; nan where the lens has no ray."""
        return self.homography.to_road(self.ideal(points))

    def to_image(self, points: Array) -> Array:
        """Map metres (…, 2) to pixels (…, 2)."""
        ideal = self.homography.to_image(points)
        return ideal if self.lens is None else self.lens.to_pixels(ideal)

    def ideal(self, points: Array) -> Array:
        """Remove the lens's distortion from pixels (…, 2)."""
        return points if self.lens is None else self.lens.to_ideal(points)

    def pixel_length(self, ideal: Array) -> float:
        """Return the length on the road of one pixel at the ideal pixel (2,), m."""
        return float(np.linalg.norm(self.homography.jacobian(ideal), 2))

    def objection(self, ideal: Array) -> str:
        """Say why the ideal pixel (2,) is outside the calibrated area; empty where it is not."""
        if not np.isfinite(ideal).all():
            return "outside what the lens can show"
        if self.homography.nearness(ideal) <= 0:
            return "above the horizon of the road"
        if self.hull is not None and not is_inside(self.hull, ideal):
            return "outside the calibrated area"
        length = self.pixel_length(ideal)
        if not length <= self.coarsest:
            return f"too far away: a pixel is {length:.2g} m of road"
        return ""


def residuals(plane: RoadPlane, pairs: Sequence[Pair]) -> tuple[Array, Array]:
    """Return the distances (N,) of each pair from the fit, in px of the image and in m."""
    pixels = np.array([pair.pixel for pair in pairs], np.float64)
    metres = np.array([pair.road for pair in pairs], np.float64)
    in_image = np.linalg.norm(plane.to_image(metres) - pixels, axis=1)
    return in_image, np.linalg.norm(plane.to_road(pixels) - metres, axis=1)


def convex_hull(points: Array) -> Array:
    """Return the corners (M, 2) of the convex hull of points (N, 2), in order around it."""
    # Indices, not points: OpenCV knows float32 only, and the corners shall keep their digits.
    corners = cv2.convexHull(points.astype(np.float32), clockwise=False, returnPoints=False)
    return np.asarray(points[corners.ravel()])


def is_inside(hull: Array, point: Array) -> bool:
    """Return whether `point` (2,) is in the convex hull or on its edge."""
    along = np.roll(hull, -1, axis=0) - hull
    to_point = point - hull
    # A convex outline has every inner point on the same side of each edge.
    turns = along[:, 0] * to_point[:, 1] - along[:, 1] * to_point[:, 0]
    return bool(np.all(turns >= 0))
