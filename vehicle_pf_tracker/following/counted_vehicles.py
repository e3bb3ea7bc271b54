# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""All vehicles of one stream, followed and counted: the same for runs and for nodes."""

from __future__ import annotations

import time
from collections import Counter as Tally
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.progress import ShowShare, silent
from vehicle_pf_tracker.counting.counter import COUNTED_MODES, Counter
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.counting.vehicle_class import VehicleClasses
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.detector import Detector
from vehicle_pf_tracker.following.detectors import detector_maker
from vehicle_pf_tracker.following.live_facts import RecentCrossings, traffic_facts
from vehicle_pf_tracker.following.paced_detector import PacedDetector, Run, call
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.counting_plan import CountingPlan, read_counting_plan
from vehicle_pf_tracker.showing.traffic_drawing import Trails, frame_with_vehicles
from vehicle_pf_tracker.trackers.traffic.association import check_library
from vehicle_pf_tracker.trackers.traffic.colours import load_counting
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

_LEARNING = "learning the background"
"""Words for motion's first 10 to 20 images, in which it detects none, however many drive."""


class CountedVehicles:
    """The vehicles of one stream of images.

    Parameters
    ----------
    session : TrafficSession
        Drives the tracker.
    counter : Counter
        Counts at lines and in zones, if there are any.

    Attributes
    ----------
    session, counter
        Those of the parameters above.
    trails : Trails
        Paths over the last images.
    classes : VehicleClasses
        Decides the vehicles' classes.
    estimates : tuple of TrackEstimate
        Estimates of the last image, with these classes.
    has_begun_anew : bool
        True where the session has discarded all vehicles but its `successors` in the last image.
    """

    def __init__(self, session: TrafficSession, counter: Counter) -> None:
        self.session = session
        self.counter = counter
        self.trails = Trails()
        self._recent = RecentCrossings()
        self.classes = VehicleClasses()
        self.estimates: tuple[TrackEstimate, ...] = ()
        self.has_begun_anew = False
        # To be compared with: the session begins anew by itself, as when time jumps.
        self._restarts = session.restarts

    def follow(
        self, image: Frame | CodedImage, stamp_ns: int, detections: Detections | None
    ) -> tuple[Crossing, ...]:
        """Take the next image, and return what is counted with it.

        Raises
        ------
        InputError
            If the image cannot be used; all vehicles are kept.
        TrackerError
            If the tracker fails, and does not start anew for it.
        """
        began = time.perf_counter()
        self.session.feed(image, stamp_ns, detections)
        detector = self.session.detector
        # After the image, when its whole cost is known; it decides about the next.
        if isinstance(detector, PacedDetector):
            detector.pace(time.perf_counter() - began, self.session.tracker.frame_period)
        self.has_begun_anew = self.session.restarts != self._restarts
        if self.has_begun_anew:  # first: nothing of discarded vehicles is counted with this image
            self.begin_anew()
        # Classes before counts, as a crossing keeps the class that its vehicle has then.
        self.estimates = self.classes.named(self.session.estimates)
        self.trails.add(self.estimates)
        crossings = self.counter.update(self.estimates, stamp_ns, ambiguous=self.session.ambiguous)
        for crossing in crossings:
            # What is counted by class must not change its class in later rows.
            self.classes.decide(crossing.identity)
        self._recent.add(crossings, stamp_ns)
        self._recent.withdraw(self.counter.withdrawn)
        return crossings

    @property
    def is_learning(self) -> bool:
        """True while a detector of motion does not know yet what stands, and reports nothing."""
        return self.session.detector is not None and not self.session.detected.images

    def drawn(self, frame: Frame, head: str = "") -> Frame:
        """Return a copy of the last image with vehicles, counts, `head` and their number."""
        modes = Tally(
            vehicle.mode for vehicle in self.estimates if self.counter.is_vehicle(vehicle.label)
        )
        hidden = f", {modes[TrackMode.OCCLUDED]} hidden" if modes[TrackMode.OCCLUDED] else ""
        total = sum(modes[mode] for mode in COUNTED_MODES)
        count = f"{total} {'vehicle' if total == 1 else 'vehicles'}{hidden}"
        words = f"{head}{_LEARNING if self.is_learning else count}"
        return frame_with_vehicles(frame, words, self.estimates, self.counter, self.trails)

    def shown(self, frame: Frame) -> Frame:
        """Return a copy of the last image with vehicles and counts, without words about all."""
        return frame_with_vehicles(frame, "", self.estimates, self.counter, self.trails)

    def facts(self) -> dict[str, object]:
        """Return the number of vehicles, and what was counted, by name."""
        counter = self.counter
        return {
            "vehicles": sum(
                vehicle.mode in COUNTED_MODES and counter.is_vehicle(vehicle.label)
                for vehicle in self.estimates
            ),
            **{f"{zone}: inside": there for zone, there in counter.occupancy.items()},
            **{
                f"{place}: {to}": counter.count(place, to)
                for place, both in counter.directions.items()
                for to in both
            },
        }

    def page_facts(self, when: str = "") -> dict[str, object]:
        """Return the numbers for a page; `when` is the time of the last image in words."""
        learning = _LEARNING if self.is_learning else ""
        words = ", ".join(filter(None, (when, learning)))
        return traffic_facts(self.counter, self._recent, self.estimates, words)

    def begin_anew(self) -> None:
        """Note that the session has discarded all vehicles but its `successors`."""
        self._restarts = self.session.restarts
        self.counter.forget_vehicles()
        self.classes.clear()


@dataclass(frozen=True)
class _PacedMaker:
    """Maker of detectors that look at every k-th image, k by the parameters in use."""

    make: Callable[[], Detector]
    tracker: MultiVehicleTracker
    run: Run

    def every(self) -> int:
        """Return the parameter in use, which may change."""
        # Looked up for each image: it may be set while the node runs.
        return self.tracker.parameters.detector.every

    def __call__(self) -> PacedDetector:
        return PacedDetector(self.make(), self.every, self.run)


def session_and_counter(
    configuration: Configuration, run: Run = call, progress: ShowShare = silent
) -> tuple[TrafficSession, Counter]:
    """Make the session and the counter that parameters of `TRAFFIC` ask for.

    Parameters
    ----------
    configuration : Configuration
        The parameters.
    run : callable
        Calls the network.
    progress : ShowShare
        Shows how a network is fetched.

    Raises
    ------
    InputError
        If the network or the file of lines and zones cannot be used, or a library is missing.
    """
    # First: a library that is missing is said before a network is fetched.
    check_library()
    load_counting()
    parameters = configuration.tracker
    plane = configuration.session.road.fixed_plane()
    plan = read_counting_plan(Path(parameters.lines)) if parameters.lines else CountingPlan()
    make = detector_maker(parameters.detector, progress)
    tracker = MultiVehicleTracker(parameters, plane)
    session = TrafficSession(
        tracker,
        _PacedMaker(make, tracker, run) if make else None,
        frame_rate=parameters.frame_rate,
        reset_on_time_jump=configuration.session.reset_on_time_jump,
        regions=plan.regions,
    )
    return session, Counter(plan, plane, parameters.detector.classes_apart)
