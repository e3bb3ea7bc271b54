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
from vehicle_pf_tracker.core.frame import Frame, check_frame
from vehicle_pf_tracker.trackers.traffic.background import Background
from vehicle_pf_tracker.trackers.traffic.blobs import BlobReader
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.numbers import SHIPPED, TrafficNumbers

_WIDEST = 400
"""Width in px above which the image is halved: finer says nothing more about vehicles."""
_CLOSED = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (5, 5))
"""Holes and gaps up to this size are closed: windscreens show the sky."""
_ALL_MOVES = 0.5
"""Share of the image that moves from which on it is the camera that does, or the light."""


class MotionDetector:
    """Model of the background, whose difference to the image shows vehicles.

    Parameters
    ----------
    seed : int
        Seed of the choice of samples that the background is made of.
    numbers : TrafficNumbers
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

    def __init__(self, seed: int = 0, numbers: TrafficNumbers = SHIPPED) -> None:
        self._seed, self._numbers = seed, numbers
        self.disturbed = False
        self.is_blind = False
        self._blobs = BlobReader(numbers)
        self._shape: tuple[int, ...] = (0, 0)
        self._restart()

    def detect(self, frame: Frame, tracks: Sequence[TrackEstimate] = ()) -> Detections:
        """Find what moves.

        Parameters
        ----------
        frame : Frame
            RGB image.
        tracks : sequence of TrackEstimate
            Estimates of the frame before; the background is not learnt where they stand.

        Returns
        -------
        Detections
            Boxes, scored by how full they are.
        """
        small, zoom = _reduced(check_frame(frame))
        if small.shape != self._shape:
            self._shape = small.shape
            self._restart()
        self.disturbed = False
        self.is_blind = not self._background.is_known
        if self.is_blind:
            self._background.begin(small)
            return Detections.none()
        changed = self._background.compare(small)
        if np.count_nonzero(changed) > _ALL_MOVES * changed.size:
            self.disturbed = self.is_blind = True
            self._restart()
            return Detections.none()
        moving = np.asarray(cv2.medianBlur(changed.astype(np.uint8), 3), np.uint8)
        moving = np.asarray(cv2.morphologyEx(moving, cv2.MORPH_CLOSE, _CLOSED), np.uint8)
        tracked = [one for one in tracks if one.mode is TrackMode.TRACKING]
        self._background.learn(small, moving > 0, _covered(tracked, zoom, small))
        followed = [one for one in tracks if one.mode in (TrackMode.TRACKING, TrackMode.OCCLUDED)]
        edges, fullness = self._blobs.read(moving, _predicted(followed) * zoom)
        boxes = np.hstack([edges[:, :2], edges[:, 2:] - edges[:, :2]]) / zoom
        return Detections.make(boxes, fullness)

    def _restart(self) -> None:
        self._background = Background(self._shape, self._seed, self._numbers)


def _covered(
    tracks: Sequence[TrackEstimate], zoom: float, image: npt.NDArray[np.uint8]
) -> npt.NDArray[np.bool_]:
    """Mark the pixels of vehicles, of which one that stops must not melt in."""
    covered = np.zeros(image.shape[:2], dtype=np.bool_)
    for track in tracks:
        left, top, right, bottom = np.maximum(_edges(track) * zoom, -1).astype(int).tolist()
        covered[max(top, 0) : bottom + 1, max(left, 0) : right + 1] = True
    return covered


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
