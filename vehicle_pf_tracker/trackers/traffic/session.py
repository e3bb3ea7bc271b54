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

"""All vehicles followed through one stream of stamped images.

Offline runs and the node both drive their tracker through a session, and so give the same
estimates.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from vehicle_pf_tracker.core.clock import StampClock, StampEvent, Tick
from vehicle_pf_tracker.core.frame import CodedFrame, Frame, check_frame, frame_size
from vehicle_pf_tracker.trackers.base import DEFAULT_PERIOD
from vehicle_pf_tracker.trackers.continuity import Continuation, Continuity
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate
from vehicle_pf_tracker.trackers.traffic.tracker import TrafficTracker

_DISTURBED = (
    "most of the image changed at once: the camera moves, or the light was switched; nothing is "
    "detected until the background is learnt anew"
)


class Detector(Protocol):
    """Finds vehicles in an image.

    Attributes
    ----------
    disturbed : bool
        True where the latest image differs too much from those before to look for vehicles in it.
    is_blind : bool
        True where it has not looked in the latest image, for this reason or another.
    """

    disturbed: bool
    is_blind: bool

    def detect(self, frame: Frame, tracks: Sequence[TrackEstimate] = ()) -> Detections:
        """Find them; `tracks` are the estimates of the frame before."""
        ...


class TrafficSession:
    """Control of the tracker: elapsed time, restarts, detections.

    An image of another size, or out of its time, is rejected unless the next one agrees with it.

    Parameters
    ----------
    tracker : TrafficTracker
        Follows the vehicles.
    make_detector : callable or None
        Makes a detector, at the beginning and whenever the stream begins anew; None where
        detections come from outside, or there are none.
    frame_rate : float
        Nominal rate in 1/s; 0 takes the median of the first ten intervals.
    reset_on_time_jump : bool
        Forget all vehicles when stamps go back and stay back.

    Attributes
    ----------
    estimates : tuple of TrackEstimate
        Those of the last image.
    detector : Detector or None
        The detector in use.
    events : list of str
        Irregularities of the last image.
    restarts : int
        Times that all vehicles were forgotten, so that whoever counts knows.
    """

    def __init__(
        self,
        tracker: TrafficTracker,
        make_detector: Callable[[], Detector] | None = None,
        *,
        frame_rate: float = 0.0,
        reset_on_time_jump: bool = True,
    ) -> None:
        self.tracker = tracker
        self.estimates: tuple[TrackEstimate, ...] = ()
        self.events: list[str] = []
        self.restarts = 0
        self.detector = make_detector() if make_detector else None
        self._make_detector = make_detector
        self._frame_rate = frame_rate
        self._resets = reset_on_time_jump
        self._clock = self._clock_before = StampClock(frame_rate)
        self._continuity = Continuity()
        self._size: tuple[int, int] | None = None

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height in px that images are expected to have; None for any size."""
        return self._continuity.size

    def reset(self) -> None:
        """Forget all vehicles, and size and time of the images before."""
        self._clock = self._clock_before = StampClock(self._frame_rate)
        self._continuity, self._size = Continuity(), None
        self._restart()

    def reconfigure(self, *, frame_rate: float, reset_on_time_jump: bool) -> None:
        """Take new settings between two images; no vehicle is lost by it."""
        self._frame_rate, self._resets = frame_rate, reset_on_time_jump
        for clock in (self._clock, self._clock_before):
            clock.set_frame_rate(frame_rate)

    def feed(
        self, image: Frame | CodedFrame, stamp_ns: int, detections: Detections | None = None
    ) -> tuple[TrackEstimate, ...]:
        """Take the next image.

        Parameters
        ----------
        image : Frame or CodedFrame
            RGB image, not written to; a coded one is decoded only if it continues the stream.
        stamp_ns : int
            Its stamp in ns.
        detections : Detections or None
            Those from outside; None asks the detector, where there is one.

        Raises
        ------
        StrayImageError
            If the image does not continue the stream; all tracks are kept.
        InputError
            If the frame is not usable.
        """
        self.events = []
        size = frame_size(check_frame(image)) if isinstance(image, np.ndarray) else image.size
        continuation = self._continuity.judge(size, stamp_ns, timed=self._size is not None)
        frame = image if isinstance(image, np.ndarray) else image.decode()
        if continuation is Continuation.CORRECTS:
            self.events.append("the last image's stamp was ahead")
            self._clock = self._clock_before
        self._clock_before = copy.deepcopy(self._clock)
        is_timed = continuation is not Continuation.UNTIMED
        tick = self._tick(stamp_ns) if is_timed else Tick(1.0, StampEvent.UNUSABLE)
        if tick.event is not None:
            self.events.append(tick.event.value)
        if self._size is not None and size != self._size:
            self.events.append(f"the images are now of {size[0]}x{size[1]} px; starting again")
            self._restart()
        self._size = size
        self.tracker.frame_period = self._clock.period or DEFAULT_PERIOD
        if detections is None and self.detector is not None:
            detections = self._detected(self.detector, frame)
        self.estimates = self.tracker.step(frame, detections, tick.elapsed)
        return self.estimates

    def _detected(self, detector: Detector, frame: Frame) -> Detections | None:
        """Return the detections; None where it could not look, so that no vehicle is missed."""
        found = detector.detect(frame, self.estimates)
        if detector.disturbed:
            self.events.append(_DISTURBED)
        return None if detector.is_blind else found

    def _tick(self, stamp_ns: int) -> Tick:
        tick = self._clock.tick(stamp_ns)
        if tick.event is StampEvent.JUMP_BACK and self._resets:
            self._clock = StampClock(self._frame_rate)
            self._clock.tick(stamp_ns)
            self._restart()
        return tick

    def _restart(self) -> None:
        self.tracker.reset()
        self.estimates = ()
        self.restarts += 1
        if self._make_detector is not None:
            self.detector = self._make_detector()
