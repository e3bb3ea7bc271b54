# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detection of moving vehicles before a standing camera, which may shake."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD
from vehicle_pf_tracker.core.frame import Frame, check_frame
from vehicle_pf_tracker.detection.background import Background, Colours, Mask, Pixels
from vehicle_pf_tracker.detection.blobs import BlobReader, Blobs
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.detector import FollowedVehicle
from vehicle_pf_tracker.detection.motion_thresholds import SHIPPED_THRESHOLDS, MotionThresholds
from vehicle_pf_tracker.detection.stabilising import Stabiliser
from vehicle_pf_tracker.detection.usual_size import WIDEST_MASK

_CLOSED = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (5, 5))
"""Holes and gaps up to this size, px of the mask, are closed: windscreens show the sky. A choice:
larger ones would join vehicles."""
_HOLES_EVERY = 0.19
"""Time between two searches for holes of what has left, s: two find one before what stands could
have a number after half a second. Below whole intervals of 30 and of 25 Hz, for jitter."""
_DISTURBED = 0.5
"""Share of the image that differs above which the camera moves or the light was switched: no
vehicle that is worth following fills half of it."""


class MotionDetector:
    """Model of the background, whose difference to the image shows vehicles.

    Parameters
    ----------
    seed : int
        Seed of the choice of samples that the background is made of.
    thresholds : MotionThresholds
        Thresholds.

    Attributes
    ----------
    disturbed : bool
        True where so much of the latest image differs that nothing was reported: the camera moves,
        or the light was switched. The background is then learnt anew.
    is_blind : bool
        True where nothing was looked for in the latest image: it is disturbed, or one of those that
        the background is learnt from.
    """

    def __init__(self, seed: int = 0, thresholds: MotionThresholds = SHIPPED_THRESHOLDS) -> None:
        self._seed = seed
        self._thresholds = thresholds
        self.disturbed = False
        self.is_blind = False
        self._blobs = BlobReader(thresholds)
        self._shape: tuple[int, ...] = (0, 0)
        self._since_holes = 0.0
        self._restart()

    def detect(
        self,
        frame: Frame,
        tracks: Sequence[FollowedVehicle] = (),
        period: float = DEFAULT_PERIOD,
    ) -> Detections:
        """Find what moves.

        Parameters
        ----------
        frame : Frame
            RGB image.
        tracks : sequence of FollowedVehicle
            Estimates of the frame before; the background is not learnt where they stand.
        period : float
            Nominal time since the image that it looked at before, s: what has changed for long is
            learnt. Not the measured one, as a gap does not show what stood there meanwhile.

        Returns
        -------
        Detections
            Boxes, scored by how full they are.
        """
        # 1. Reduce: a coarse mask is cheaper, and as good.
        small, zoom = _reduced(check_frame(frame))
        if small.shape != self._shape:
            self._shape = small.shape
            self._restart()
        # 2. Register. Estimates are of the image before, and so is where the camera then was.
        # Tentative ones join no pieces: they may be pieces of a lorry.
        tracked = [one for one in tracks if one.is_visible]
        followed = [one for one in tracks if one.is_followed]
        covered = self._stabiliser.to_reference(_edges(tracked) * zoom)
        predicted = self._stabiliser.to_reference(_predicted(followed) * zoom)
        small, seen = self._stabiliser.stabilise(small)
        # 3. Compare with the background, once there is one.
        self.disturbed = False
        self.is_blind = not self._background.is_known
        if self.is_blind:
            self._background.begin(small, period)
            return Detections.none()
        changed = self._background.compare(small)
        if seen is not None:
            changed &= seen > 0
        # Most of the image is no vehicle: begin anew, and report nothing until then.
        if np.count_nonzero(changed) > _DISTURBED * changed.size:
            self.disturbed = self.is_blind = True
            self._restart()
            return Detections.none()
        # 4. Clean the mask, and learn the background with it.
        moving = self._learnt(small, changed, _covered(covered, small), period)
        # 5. Read blobs. All tracks show how vehicles drive here, also tentative ones.
        velocities = np.array([one.velocity for one in tracks]).reshape(-1, 2)
        blobs = self._blobs.read(moving, predicted, velocities)
        # 6. Boxes are of the image as it came.
        return self._detections(blobs, zoom)

    def _detections(self, blobs: Blobs, zoom: float) -> Detections:
        """Return what is in the blobs, with boxes of the image."""
        made = Detections.make(self._boxes(blobs.edges, zoom), blobs.fullness)
        joined = blobs.joined
        if joined is not None:
            joined = np.column_stack([self._boxes(joined[:, :4], zoom), joined[:, 4]])
        return replace(made, are_shapes=True, ambiguous=blobs.ambiguous, joined=joined)

    def _boxes(self, edges: Array, zoom: float) -> Array:
        """Boxes (N, 4), left, top, width and height in the image, of edges in the mask."""
        edges = self._stabiliser.from_reference(edges)
        return np.hstack([edges[:, :2], edges[:, 2:] - edges[:, :2]]) / zoom

    def _learnt(self, small: Colours, changed: Pixels, covered: Pixels, period: float) -> Mask:
        """Learn what has not changed, and holes of what has left; mark what moves."""
        # With the clean mask: the specks that it leaves out are background.
        moving = _cleaned(changed)
        # Holes first: a vehicle that drives over one would be hidden in it.
        self._since_holes += period
        if self._since_holes >= _HOLES_EVERY:
            self._since_holes = 0.0
            moving[self._background.holes(small, moving, period) > 0] = 0
        self._background.learn(small, moving > 0, covered, period)
        return moving

    def _restart(self) -> None:
        self._background = Background(self._shape, self._seed, self._thresholds)
        self._stabiliser = Stabiliser()
        self._since_holes = 0.0


def _cleaned(changed: Pixels) -> Mask:
    """Drop single pixels from a mask, and close its gaps."""
    # Single pixels go first, else closing would join them to vehicles.
    moving = np.asarray(cv2.medianBlur(changed.astype(np.uint8), 3), np.uint8)
    return np.asarray(cv2.morphologyEx(moving, cv2.MORPH_CLOSE, _CLOSED), np.uint8)


def _covered(boxes: Array, image: Colours) -> Pixels:
    """Mark the pixels of vehicles, of which one that stops must not melt in."""
    covered = np.zeros(image.shape[:2], dtype=np.bool_)
    for left, top, right, bottom in np.maximum(boxes, -1).astype(int).tolist():
        covered[max(top, 0) : bottom + 1, max(left, 0) : right + 1] = True
    return covered


def _reduced(frame: Frame) -> tuple[npt.NDArray[np.uint8], float]:
    """Halve the image until it is narrow enough; also its scale."""
    small = np.ascontiguousarray(frame)
    zoom = 1.0
    while small.shape[1] > WIDEST_MASK:
        half = (max(small.shape[1] // 2, 1), max(small.shape[0] // 2, 1))
        # Averages over areas: noise becomes less, and no pixel is left out.
        small = np.asarray(cv2.resize(small, half, interpolation=cv2.INTER_AREA), np.uint8)
        zoom *= 0.5
    return small, zoom


def _edges(tracks: Sequence[FollowedVehicle]) -> Array:
    """Edges (T, 4) of vehicles in px."""
    corners = [(*box.corners[0], *box.corners[2]) for box in (track.box for track in tracks)]
    return np.array(corners).reshape(-1, 4)


def _predicted(tracks: Sequence[FollowedVehicle]) -> Array:
    """Edges (T, 4) in px where vehicles are about to be."""
    velocities = np.array([track.velocity for track in tracks]).reshape(-1, 2)
    return np.asarray(_edges(tracks) + np.tile(velocities, 2))
