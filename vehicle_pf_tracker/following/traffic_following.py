# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""All vehicles followed through a source, written and drawn as they go."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from types import MappingProxyType

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.counting.zone_occupancy import USUAL_INTERVAL_S
from vehicle_pf_tracker.detection.parameters import MODEL_DETECTOR, MOTION_DETECTOR
from vehicle_pf_tracker.following.counted_vehicles import CountedVehicles
from vehicle_pf_tracker.following.detection_file import DetectionFile
from vehicle_pf_tracker.following.offline_tracker import unreached
from vehicle_pf_tracker.recordings.bags.reader import StampedFrame
from vehicle_pf_tracker.results.estimates import clock_words, start_of_clock
from vehicle_pf_tracker.results.traffic_results import TrackFiles
from vehicle_pf_tracker.results.traffic_summary import TrafficSummary
from vehicle_pf_tracker.showing.live_page import LivePage
from vehicle_pf_tracker.showing.pictures import Numbered, Pictures
from vehicle_pf_tracker.showing.traffic_pictures import TrafficPictures
from vehicle_pf_tracker.trackers.attempts import TrackerError
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession

_MOST_NOTICES = 20
"""Notices kept, what a screen holds: a camera without a clock gives one per frame, for hours."""


class TrafficRun(CountedVehicles):
    """One pass over a source.

    Parameters
    ----------
    session : TrafficSession
        Drives the tracker.
    counter : Counter
        Counts at lines and in zones, if there are any.
    detections : DetectionFile or None
        The detections of each frame; None leaves them to the session.
    zone_interval_s : float
        Length of the intervals of the zones' occupancy, s.

    Attributes
    ----------
    summary : TrafficSummary
        Vehicles and occlusions.
    """

    def __init__(
        self,
        session: TrafficSession,
        counter: Counter,
        detections: DetectionFile | None = None,
        zone_interval_s: float = USUAL_INTERVAL_S,
    ) -> None:
        super().__init__(session, counter)
        self.summary = TrafficSummary(counter, zone_interval_s)
        self._notices = list(detections.notices) if detections is not None else []
        self._more_notices = 0
        self._last_events: list[str] = []
        self._detections = detections
        self._misfit = ""
        self._targets: dict[str, dict[int, Box]] = {}
        self._by_name: dict[str, int] = {}

    @property
    def notices(self) -> list[str]:
        """Irregularities, a sentence each; of very many only the first."""
        more = self._more_notices
        later = [unreached(target) for boxes in self._targets.values() for target in boxes.items()]
        return [*self._notices, *([f"and {more} more notices"] if more else []), *later]

    def _note(self, sentence: str) -> None:
        if len(self._notices) < _MOST_NOTICES:
            self._notices.append(sentence)
        else:
            self._more_notices += 1

    def follow_all(
        self,
        frames: Numbered,
        files: TrackFiles,
        pictures: TrafficPictures | None = None,
        page: LivePage | None = None,
        targets: Mapping[str, Mapping[int, Box]] = MappingProxyType({}),
    ) -> None:
        """Follow all vehicles through `frames`.

        Parameters
        ----------
        frames : iterator of (int, StampedFrame)
            Frames with their numbers in the source.
        files : TrackFiles
            Files of the results.
        pictures : TrafficPictures or None
            Pictures of the frames and of the whole run.
        page : LivePage or None
            Page to show them on.
        targets : mapping of str to mapping of int to Box
            Vehicles given by hand, by name: boxes in px by the numbers of their frames.

        Raises
        ------
        InputError
            If a target is invalid in its frame, or something cannot be written.
        """
        pictures = pictures or TrafficPictures(Pictures())
        self._targets = {name: dict(boxes) for name, boxes in targets.items()}
        start_ns: int | None = None
        with pictures.of_frames.drawing(frames) as (take, all_frames):
            for number, stamped in all_frames:
                start_ns = start_of_clock(start_ns, stamped.stamp_ns)
                crossings = self._step(number, stamped)
                if stamped.frame is None or crossings is None:
                    continue
                # With the first image that was used: the size is known from then on.
                if not self.summary.frames:
                    self._check_plan_and_detections(frame_size(stamped.frame))
                estimates = self.estimates
                # Rows of vehicles whose class may change wait in `files`.
                undecided = self.classes.undecided
                withdrawn = self.counter.withdrawn
                files.write(number, stamped.stamp_ns, estimates, crossings, undecided, withdrawn)
                self.summary.add(estimates)
                files.write_zones(self.summary.zones.add(stamped.stamp_ns, self.counter.occupancy))
                period = self.session.tracker.frame_period
                pictures.add(stamped.frame, estimates, stamped.stamp_ns, period)
                elapsed = clock_words(stamped.stamp_ns - start_ns)
                draw = partial(self.drawn, stamped.frame, f"{elapsed}  frame {number}  ")
                take((), draw, stamped.frame, stamped.stamp_ns)
                facts = partial(self.page_facts, f"{elapsed}, frame {number}")
                pictures.of_frames.show(page, partial(self.shown, stamped.frame), facts)

    def sentences(self, detector: str) -> list[str]:
        """Return the summary, a line for each fact, or why there is no vehicle.

        Parameters
        ----------
        detector : str
            Kind of the detector, or the file of detections.
        """
        if self.summary.vehicles:
            return self.summary.sentences()
        frames = self.summary.frames
        detected = self.session.detected
        inside = detected.boxes - detected.outside
        # From the first cause that would explain it to the last: each further one supposes that
        # those before it hold.
        if detected.disturbed and 2 * detected.images < frames:
            why = (
                "the camera moves, and motion is detected before a standing one only; give "
                "--detections or --model"
            )
        elif not detected.images:
            why = (
                "they are too few to learn what stands, which takes 10 to 20 images; give a "
                "longer clip, or a network with --model"
            )
        elif not detected.boxes:
            why = {
                MOTION_DETECTOR: "nothing moves in them",
                MODEL_DETECTOR: "the network finds no vehicle; try --set detector.min_score=0.1",
            }.get(detector, f"{detector} has no box in them")
        elif self._misfit:
            why = self._misfit
        elif not inside:
            why = f"all {detected.boxes} detections are outside the regions of interest"
        else:
            why = (
                f"detections ({inside}) repeat too rarely to be vehicles, or stand still with "
                "scores too low for that; give them with --target, or a file of `pick` with "
                "--targets"
            )
        return [f"no vehicle was found in {frames} frames: {why}"]

    def _step(self, number: int, stamped: StampedFrame) -> tuple[Crossing, ...] | None:
        """Take a frame; None where it is rejected, so that nothing is known of its time."""
        if stamped.frame is None:
            self._note(f"frame {number} was rejected: it cannot be read")
            return None
        detections = self._detections.of(number) if self._detections is not None else None
        try:
            crossings = super().follow(stamped.frame, stamped.stamp_ns, detections)
        except (InputError, TrackerError) as error:
            # One image is rejected, and the run goes on; a tracker that is broken ends it.
            if isinstance(error, TrackerError) and error.persists:
                raise
            self._note(f"frame {number} was rejected: {error}")
            return None
        if self.has_begun_anew:
            # Vehicles given by hand go on under new numbers where the session has begun anew.
            kept = self.session.successors
            self._by_name = {name: kept[old] for name, old in self._by_name.items() if old in kept}
        for event in self.session.events:
            if event not in self._last_events:  # one that lasts is noted once
                self._note(f"frame {number}: {event}")
        self._last_events = list(self.session.events)
        # After the image was followed: a box is where its vehicle is in it.
        self._add_targets(stamped.frame, number)
        return crossings

    def _check_plan_and_detections(self, size: tuple[int, int]) -> None:
        for name in self.counter.plan.outside(*size):
            self._note(f"{name!r} is outside the image, so that nothing counts there")
        if self._detections is not None:
            self._misfit = self._detections.misfit(size)
        if self._misfit:
            self._note(self._misfit)

    def _add_targets(self, frame: Frame, number: int) -> None:
        """Follow the vehicles given for this frame; a name given again replaces the one before."""
        for name, boxes in self._targets.items():
            if (box := boxes.pop(number, None)) is None:
                continue
            try:
                check_target(box, *frame_size(frame))
            except InputError as error:
                raise InputError(f"in frame {number}, {error}") from None
            # A second box of one name corrects the first: two tracks would be two vehicles.
            if name in self._by_name:
                self.session.remove(self._by_name[name])
            self._by_name[name] = self.session.add(box, "" if name.isdecimal() else name)
