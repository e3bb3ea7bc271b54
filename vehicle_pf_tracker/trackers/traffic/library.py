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

"""Many vehicles for Python programs: arrays in, frozen dataclasses out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy.typing as npt

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.trackers.traffic import tracker
from vehicle_pf_tracker.trackers.traffic.association import check_library
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.motion_detector import MotionDetector
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession


class TrafficTracker:
    """Follow every vehicle of a stream, image by image.

    Parameters
    ----------
    frame_rate : float
        Images per second; stamps, where they are given, tell the time between two images.
    parameters : TrafficParameters, optional
        Parameters of `traffic`; None: the defaults.

    Attributes
    ----------
    session : TrafficSession
        Drives the tracker; its `estimates` have tentative vehicles, too, as counting needs them.
    """

    def __init__(self, frame_rate: float, parameters: TrafficParameters | None = None) -> None:
        check_library()
        self.session = TrafficSession(
            tracker.TrafficTracker(parameters), MotionDetector, frame_rate=frame_rate
        )
        self._period_ns = round(1e9 / frame_rate)
        self._stamp_ns = 0

    def update(
        self,
        frame: Frame,
        boxes: npt.ArrayLike | None = None,
        scores: npt.ArrayLike | None = None,
        labels: Sequence[str] | None = None,
        *,
        stamp_ns: int | None = None,
    ) -> tuple[TrackEstimate, ...]:
        """Follow all vehicles into the next image.

        Parameters
        ----------
        frame : Frame
            RGB image, bytes of the shape (height, width, 3).
        boxes : array-like, shape (N, 4), optional
            Detections: left, top, width and height in px; empty where the detector saw nothing.
            None: what moves before the standing camera is looked for.
        scores : array-like, shape (N,), optional
            Their scores, of any scale; None: all alike.
        labels : sequence of str, optional
            Their classes.
        stamp_ns : int, optional
            Stamp of the image in ns; None: one period after the image before.

        Returns
        -------
        tuple of TrackEstimate
            The confirmed vehicles that are visible or predicted, by `id`.

        Raises
        ------
        InputError
            If the image is not usable.
        ValueError
            If there are not as many scores or labels as boxes.
        """
        self._stamp_ns = self._stamp_ns + self._period_ns if stamp_ns is None else stamp_ns
        detections = None if boxes is None else Detections.make(boxes, scores, labels)
        estimates = self.session.feed(frame, self._stamp_ns, detections)
        return tuple(one for one in estimates if one.id and one.mode is not TrackMode.LOST)
