# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images of a camera that shakes, moved to where the first one was taken."""

from __future__ import annotations

from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.motion.point_flow import PointFlow
from vehicle_pf_tracker.image.motion.shared_motion import shared_similarity

Image: TypeAlias = npt.NDArray[np.uint8]

_CORNERS = 120
"""Most corners that are followed: of thirty that are hidden by vehicles, ninety are left."""
_QUALITY = 0.01
"""Least strength of a corner, of the strongest one's. A choice: the number bounds them first."""
_CORNER_DISTANCE = 10
"""Least distance between two corners, px. A choice: they spread over the image."""
_STEADY_AFTER = 30
"""Images without a shake after which a camera is taken to be steady: one second of 30 Hz. The first
shake after it is seen up to `_CHECKED_EVERY` images late."""
_CHECKED_EVERY = 5
"""After `_STEADY_AFTER` images without a shake only every so many are measured: a choice between
time and a shake that is seen late."""
_RETURN = 0.7
"""Largest distance in px at which a corner that is followed there and back may end: the grid of
pixels makes half a px, each way."""
_LARGEST_SHAKE = 0.1
"""Largest shift of a shake, of the image's width; beyond it the camera was turned. A choice: what
has left a moved image is not seen."""
_RENEWED_AFTER = 300
"""Images after which corners are chosen anew: the light changes. A choice, ten seconds of 30 Hz:
each time a rounding error of the registration goes into the reference."""
# Larger than for a vehicle's points: only the latest shake predicts, and it may be of many px.
_FLOW = PointFlow(window=15, levels=3, steps=10, precision=0.03)
# One object: identity shows that the camera stands.
_STILL = np.eye(2, 3)


class Stabiliser:
    """Registers each image with a reference."""

    def __init__(self) -> None:
        self._reference: Image | None = None
        self._corners = np.empty((0, 2), np.float32)
        self._map = _STILL
        self._age = self._still = 0

    def stabilise(self, image: Image) -> tuple[Image, Image | None]:
        """Move an image to where the reference was taken.

        Parameters
        ----------
        image : (H, W, 3) array
            RGB image.

        Returns
        -------
        image : (H, W, 3) array
            The image itself, where the camera stands.
        seen : (H, W) array or None
            Where it shows something; None where it is not moved.
        """
        self._register(np.asarray(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY), np.uint8))
        if self._map is _STILL:
            return image, None
        return self._moved(image), self._moved(
            np.ones(image.shape[:2], np.uint8), cv2.BORDER_CONSTANT
        )

    def to_reference(self, edges: Array) -> Array:
        """Edges (N, 4) in the latest image, as the reference has them; sizes stay."""
        return self._shifted(edges, self._map)

    def from_reference(self, edges: Array) -> Array:
        """Edges (N, 4) in the reference, as the latest image has them; sizes stay."""
        return self._shifted(edges, np.asarray(cv2.invertAffineTransform(self._map)))

    @staticmethod
    def _shifted(edges: Array, to: Array) -> Array:
        # Only centres move: boxes stay upright, as a shake hardly turns or scales.
        centres = (edges[:, :2] + edges[:, 2:]) / 2
        return np.asarray(edges + np.tile(centres @ to[:, :2].T + to[:, 2] - centres, 2))

    def _register(self, grey: Image) -> None:
        if self._reference is None:
            self._refer_to(grey)
            return
        self._age += 1  # of the reference
        if self._still >= _STEADY_AFTER and self._age % _CHECKED_EVERY:
            return
        # Against the reference, not the image before: errors do not add up.
        found = self._similarity(self._reference, grey)
        if np.abs(found[:, 2]).max() > _LARGEST_SHAKE * grey.shape[1] or (found == _STILL).all():
            found = _STILL
        self._map = found
        self._still = self._still + 1 if found is _STILL else 0
        if self._age >= _RENEWED_AFTER:
            # In the coordinates of the first reference, so that the background stays where it is.
            self._refer_to(grey if found is _STILL else self._moved(grey))

    def _similarity(self, reference: Image, grey: Image) -> Array:
        """Map from the present image to the reference."""
        if not len(self._corners):
            return _STILL
        # The latest map is the guess: a pole swings, and is near where it was.
        back = np.asarray(cv2.invertAffineTransform(self._map))
        guess = (self._corners @ back[:, :2].T + back[:, 2]).astype(np.float32)
        moved, found, error = _FLOW.follow_and_return(reference, grey, self._corners, guess)
        good = found & (np.abs(error).max(axis=1, initial=0.0) < _RETURN)
        return shared_similarity(moved[good].astype(float), self._corners[good].astype(float))

    def _refer_to(self, grey: Image) -> None:
        corners = cv2.goodFeaturesToTrack(grey, _CORNERS, _QUALITY, _CORNER_DISTANCE)
        self._corners = np.asarray([] if corners is None else corners, np.float32).reshape(-1, 2)
        self._reference = grey
        self._age = 0

    def _moved(self, image: Image, border: int = cv2.BORDER_REPLICATE) -> Image:
        size = image.shape[1], image.shape[0]
        return np.asarray(cv2.warpAffine(image, self._map, size, borderMode=border), np.uint8)
