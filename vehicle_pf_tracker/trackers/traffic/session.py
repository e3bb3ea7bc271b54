# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""All vehicles followed through one stream of stamped images.

Offline runs and the node both drive their tracker through a session, and so give the same
estimates.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.detector import Detector
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage
from vehicle_pf_tracker.parameters.counting_plan import Region
from vehicle_pf_tracker.trackers.attempts import Attempts
from vehicle_pf_tracker.trackers.image_stream import ImageStream, Turn
from vehicle_pf_tracker.trackers.traffic.detection_totals import DetectionTotals
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

_DISTURBED = (
    "most of the image changed at once: the camera moves, or the light was switched; nothing is "
    "detected until the background is learnt anew"
)


class TrafficSession:
    """Control of the tracker: elapsed time, restarts, detections.

    Odd images are rejected, or admitted after all, by `ImageStream`; then only the estimates of the
    first one are missing. A tracker that fails twice in a row starts anew with the vehicles that
    were given by hand.

    Parameters
    ----------
    tracker : MultiVehicleTracker
        Follows the vehicles.
    make_detector : callable or None
        Makes a detector, at the beginning and whenever the stream begins anew; None where
        detections come from outside, or there are none.
    frame_rate : float
        Nominal rate in 1/s; 0 takes the median of the first ten intervals.
    reset_on_time_jump : bool
        Discard all vehicles when stamps go back and stay back.
    regions : sequence of Region
        Detections elsewhere are ignored; none: all count.

    Attributes
    ----------
    estimates : tuple of TrackEstimate
        Estimates of the last image.
    detector : Detector or None
        The detector in use.
    detected : DetectionTotals
        Totals of what was detected.
    tracker : MultiVehicleTracker
        As given.
    restarts : int
        Times that all vehicles were discarded, so that whoever counts knows.
    successors : mapping of int to int
        Identities before the last restart of the vehicles that it kept, with those after it.
    """

    def __init__(
        self,
        tracker: MultiVehicleTracker,
        make_detector: Callable[[], Detector] | None = None,
        *,
        frame_rate: float = 0.0,
        reset_on_time_jump: bool = True,
        regions: Sequence[Region] = (),
    ) -> None:
        self.tracker = tracker
        self._stream = ImageStream(frame_rate, reset_on_time_jump)
        self._attempts = Attempts()
        self.estimates: tuple[TrackEstimate, ...] = ()
        self.detected = DetectionTotals()
        self.restarts = 0
        self.successors: Mapping[int, int] = {}
        self.detector = make_detector() if make_detector else None
        self._make_detector = make_detector
        self._regions = tuple(regions)
        self._by_hand: dict[int, tuple[Box, str]] = {}
        self._detections: Detections | None = None

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height in px that images are expected to have; None for any size."""
        return self._stream.size

    @property
    def events(self) -> list[str]:
        """Irregularities of the last image, for logs and diagnostics."""
        return self._attempts.events

    @property
    def recovered(self) -> bool:
        """True where the tracker failed and started anew in the last image."""
        return self._attempts.recovered

    @property
    def ambiguous(self) -> int | None:
        """Blobs of the last image that may hold several vehicles; None where it has no blobs."""
        return self.detected.latest

    def add(self, box: Box, label: str = "") -> int:
        """Follow the vehicle in `box` of the last image; see `MultiVehicleTracker.add`."""
        identity = self.tracker.add(box, label)
        self._by_hand[identity] = box, label
        return identity

    def remove(self, identity: int) -> bool:
        """Discard a vehicle; False if there is none of this identity."""
        self._by_hand.pop(identity, None)
        return self.tracker.remove(identity)

    def reset(self) -> None:
        """Discard all vehicles, and size and time of the images before."""
        self._stream.reset()
        self._restart()

    def reconfigure(self, *, frame_rate: float, reset_on_time_jump: bool) -> None:
        """Take new settings between two images; no vehicle is lost by it."""
        self._stream.reconfigure(frame_rate, reset_on_time_jump)

    def feed(
        self, image: Frame | CodedImage, stamp_ns: int, detections: Detections | None = None
    ) -> tuple[TrackEstimate, ...]:
        """Take the next image.

        Parameters
        ----------
        image : Frame or CodedImage
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
        TrackerError
            If the tracker fails, and does not start anew for it.
        """
        # One image that was rejected before may be admitted together with this one: `turns` are
        # then two, and each needs its own detections.
        latest = self._detections, detections  # of the image before, which may be admitted only now
        self._detections = detections
        self._attempts.begin_image()
        turns = self._stream.admit(image, stamp_ns)
        for turn, found in zip(turns, latest[-len(turns) :], strict=True):
            self._take(turn, found)
        return self.estimates

    def _take(self, turn: Turn, detections: Detections | None) -> None:
        """Take an admitted image; start anew if the tracker fails twice in a row."""
        self.events.extend(turn.events)
        if turn.begins_anew:
            self._restart()
        # Seconds in parameters become frames by it, so that it is set before the step.
        self.tracker.frame_period = turn.period
        self._attempts.take(partial(self._step, turn, detections), self._start_anew)

    def _step(self, turn: Turn, detections: Detections | None) -> None:
        """Detect, leave out what is outside the regions, and follow the vehicles."""
        # 1. Detections from outside have precedence; else the detector looks.
        if detections is None and self.detector is not None:
            detections = self._detected(self.detector, turn)
        # 2. Count before regions apply, so that a user sees what they took. Reset first: without
        # detections the number of the image before would stay.
        self.detected.latest = None
        self.detected.latest_unresolved = None
        if detections is not None:
            self.detected.count(detections)
            # Regions bound detections, not vehicles: one that is followed may leave them.
            inside = detections.within(self._regions) if self._regions else detections
            self.detected.count_inside(detections, inside)
            detections = inside
        # 3. None, unlike no detections, says that nobody has looked: nothing is missed.
        self.estimates = self.tracker.step(turn.frame, detections, turn.elapsed)
        # 4. Keep where those given by hand are now: a restart begins them there, as no detector may
        # find them.
        if self._by_hand:
            followed = {one.identity: (one.box, one.label) for one in self.estimates}
            self._by_hand = {
                number: followed[number] for number in self._by_hand if number in followed
            }

    def _detected(self, detector: Detector, turn: Turn) -> Detections | None:
        """Return the detections; None where it did not look, so that no vehicle is missed."""
        found = detector.detect(turn.frame, self.estimates, turn.period)
        if detector.disturbed:
            self.detected.disturbed += 1
            self.events.append(_DISTURBED)
        return None if detector.is_blind else found

    def _restart(self) -> None:
        """Discard all vehicles and all that was learnt about the stream."""
        self.tracker.reset()
        self.estimates = ()
        self.successors = {}
        self._by_hand = {}
        self.restarts += 1
        # A new detector: the background of the old one is of another stream.
        if self._make_detector is not None:
            self.detector = self._make_detector()

    def _start_anew(self) -> None:
        """Start anew with the vehicles given by hand, where each was in the last estimates."""
        # Kept before the restart, which empties it.
        by_hand = self._by_hand
        successors = {}
        self._restart()
        for identity, (box, label) in by_hand.items():
            with suppress(InputError):  # of a box that has left the image
                successors[identity] = self.add(box, label)
        self.successors = successors
