# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Detection of moving vehicles before a standing camera."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, check_frame, frame_size
from vehicle_pf_tracker.trackers.traffic.blobs import BlobReader
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode

_WIDEST = 400
"""Width in px above which the image is halved: finer says nothing more about vehicles."""
_RATE = 0.03
"""Rate per image at which samples of the background are renewed: some 30 images, so that leaves and
light do not stay foreground for long."""
_WARM_UP = 15
"""Frames in which the background is learnt and nothing is reported."""
_THRESHOLD = 400.0
"""Squared distance of colours, three channels together, from which on a pixel has changed."""
_SHADOW = 0.35
"""Least brightness of a shadow, of the background's."""
_RESTORED_EVERY = 3
"""Images between two in which the background is restored where vehicles are: a second pass."""
_VEHICLE = 255
"""Value that OpenCV marks what moves by; shadows have another."""
_CLOSED = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (7, 7))
"""Holes and gaps up to this size are closed: windscreens show the sky."""
_HELD = (TrackMode.TRACKING, TrackMode.TENTATIVE)
"""Modes of tracks where the background is restored. New ones count: a vehicle that nobody knows yet
would melt in before it is confirmed."""
_SEEDS = 2**31
"""Number of seeds that OpenCV takes."""
_ALL_MOVES = 0.5
"""Share of the image that moves from which on it is the camera that does, or the light."""


class MotionDetector:
    """Model of the background, whose difference to the image shows vehicles.

    Parameters
    ----------
    seed : int
        Seed of the choice of samples that the background is made of.

    Attributes
    ----------
    disturbed : bool
        True where so much of the latest image differs that nothing was reported: the camera moves,
        or the light was switched. The background is then learnt anew.
    is_blind : bool
        True where nothing was looked for in the latest image: it is disturbed, or one of those that
        the background is learnt from.
    """

    def __init__(self, seed: int = 0) -> None:
        self._seed = seed
        self.disturbed = False
        self.is_blind = False
        self._blobs = BlobReader()
        self._shape: tuple[int, ...] = ()
        self._restart()

    def detect(self, frame: Frame, tracks: Sequence[TrackEstimate] = ()) -> Detections:
        """Find what moves.

        Parameters
        ----------
        frame : Frame
            RGB image.
        tracks : sequence of TrackEstimate
            Estimates of the frame before; the background is restored where they stand.

        Returns
        -------
        Detections
            Boxes, scored by how full they are.
        """
        small, zoom = _reduced(check_frame(frame))
        if small.shape != self._shape:
            self._shape = small.shape
            self._restart()
        self._count += 1
        self.disturbed = False
        self.is_blind = self._count <= _WARM_UP
        if self.is_blind:
            self._apply(small, -1)
            return Detections.none()
        mask = self._apply(small, _RATE)
        followed = [one for one in tracks if one.mode in (TrackMode.TRACKING, TrackMode.OCCLUDED)]
        if self._count % _RESTORED_EVERY == 0:
            self._restore(small, [one for one in tracks if one.mode in _HELD], zoom)
        moving = np.where(mask == _VEHICLE, mask, 0).astype(np.uint8)
        if np.count_nonzero(moving) > _ALL_MOVES * moving.size:
            self.disturbed = self.is_blind = True
            self._restart()
            return Detections.none()
        moving = np.asarray(cv2.medianBlur(moving, 3), np.uint8)
        moving = np.asarray(cv2.morphologyEx(moving, cv2.MORPH_CLOSE, _CLOSED), np.uint8)
        edges, fullness = self._blobs.read(moving, _predicted(followed) * zoom)
        boxes = np.hstack([edges[:, :2], edges[:, 2:] - edges[:, :2]]) / zoom
        return Detections.make(boxes, fullness)

    def _restart(self) -> None:
        self._model = cv2.createBackgroundSubtractorKNN(round(1 / _RATE), _THRESHOLD, True)
        self._model.setShadowThreshold(_SHADOW)
        self._count = 0

    def _restore(
        self, small: npt.NDArray[np.uint8], standing: Sequence[TrackEstimate], zoom: float
    ) -> None:
        """Learn the background again where vehicles are: one that stops must not melt in."""
        image = small
        if standing:
            image, known = small.copy(), self._model.getBackgroundImage()
            width, height = frame_size(small)
            for track in standing:
                left, top, right, bottom = (_edges(track) * zoom).tolist()
                columns = slice(max(int(left), 0), max(min(int(right) + 1, width), 0))
                rows = slice(max(int(top), 0), max(min(int(bottom) + 1, height), 0))
                image[rows, columns] = known[rows, columns]
        self._apply(image, _RATE)

    def _apply(self, image: npt.NDArray[np.uint8], rate: float) -> npt.NDArray[np.uint8]:
        # OpenCV draws from one generator per process; seeded here, the same images give the same
        # masks whatever else the process does.
        cv2.setRNGSeed((self._seed + self._count) % _SEEDS)
        return np.asarray(self._model.apply(image, None, rate), np.uint8)


def _reduced(frame: Frame) -> tuple[npt.NDArray[np.uint8], float]:
    """Halve the image until it is narrow enough; also its scale."""
    small, zoom = np.ascontiguousarray(frame), 1.0
    while small.shape[1] > _WIDEST:
        half = (max(small.shape[1] // 2, 1), max(small.shape[0] // 2, 1))
        small = np.asarray(cv2.resize(small, half, interpolation=cv2.INTER_AREA), np.uint8)
        zoom *= 0.5
    return small, zoom


def _edges(track: TrackEstimate) -> Array:
    box = track.box
    return np.array([box.x, box.y, box.x + box.width, box.y + box.height])


def _predicted(tracks: Sequence[TrackEstimate]) -> Array:
    """Edges (T, 4) in px where vehicles are about to be."""
    moved = [_edges(track) + np.tile(track.velocity, 2) for track in tracks]
    return np.array(moved).reshape(-1, 4)
