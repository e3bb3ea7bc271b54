# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The vehicles of one stream, fed with a node's images and detections."""

from __future__ import annotations

import time
from collections.abc import Mapping

from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.detection.detections import MOST_DETECTIONS, Detections
from vehicle_pf_tracker.detection.parameters import TOPIC_DETECTOR
from vehicle_pf_tracker.following.paced_detector import PacedDetector
from vehicle_pf_tracker.image.formats.compressed_image import CodedImage
from vehicle_pf_tracker.image.target_checks.target_pixels import doubts
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import WAITING_MESSAGE, stamp_ns
from vehicle_pf_tracker.ros.node.journal import Journal
from vehicle_pf_tracker.ros.traffic import messages
from vehicle_pf_tracker.ros.traffic.detection_queue import WaitingMessages
from vehicle_pf_tracker.ros.traffic.outputs import TrafficAnswer
from vehicle_pf_tracker.ros.traffic.vehicles import Vehicles
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode


class TrafficFeed:
    """All vehicles in a configured node.

    Parameters
    ----------
    configuration : Configuration
        Parameters of `TRAFFIC_VARIANT`.
    waiting : WaitingImages
        Images that wait for detections, for the node's report.
    journal : Journal
        Log and counts.

    Attributes
    ----------
    vehicles : Vehicles
        All vehicles.

    Raises
    ------
    InputError
        If the network, or the file of lines and zones, cannot be used.
    """

    def __init__(
        self, configuration: Configuration, waiting: WaitingMessages, journal: Journal
    ) -> None:
        self.vehicles = Vehicles(configuration)
        self._configuration = configuration
        self._waiting = waiting
        self._journal = journal
        self._detection_count = 0
        given = configuration.tracker.seed
        journal.note_seed(given, self.vehicles.session.tracker.seed)

    @property
    def facts(self) -> Mapping[str, object]:
        """Values for the node's report: seed, detector, vehicles."""
        tracker = self.vehicles.session.tracker
        found = self.vehicles.session.detected
        detector = self.vehicles.session.detector
        kind = self._configuration.tracker.detector.kind
        waiting = self._waiting
        count = self._detection_count
        seconds = waiting.latency
        if isinstance(detector, PacedDetector):
            count = detector.found
            seconds = detector.seconds
        facts = {
            "variant": TRAFFIC_VARIANT.name,
            "seed": tracker.seed,
            "detector": kind,
            **self.vehicles.summary(),
            "detections of the last image": count,
            "detector's latency (ms)": round(seconds * 1e3, 2),
            "places with false alarms": tracker.cluttered_places,
            "blobs of the last image that may hold several": _known(found.latest),
            "vehicles in them without a number": _known(found.latest_unresolved),
        }
        if kind == TOPIC_DETECTOR:
            facts |= {
                "images with detections": waiting.matched,
                "images without detections": waiting.missed,
                "late detections": waiting.late,
                "detections of no image": waiting.unmatched,
            }
        return facts

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height of the stream's images, px; None before the first."""
        return self.vehicles.session.size

    @property
    def followed(self) -> Box | None:
        """Box of the selected vehicle while it is visible; None where there is none."""
        selected = self.vehicles.selected
        if selected is None or selected.mode is not TrackMode.TRACKING:
            return None
        return selected.box

    def start_on(self, box: Box) -> None:
        """Follow and select the vehicle in `box` of the first image."""
        self.vehicles.select_first(box)

    def reset(self) -> str:
        """Forget all vehicles and counts; begin on the configured target."""
        self.vehicles.reset()
        return "all vehicles are forgotten"

    def reconfigure(self, configuration: Configuration) -> None:
        """Take new parameters between two images."""
        tracker = self.vehicles.session.tracker
        before = tracker.seed
        self._configuration = configuration
        self.vehicles.reconfigure(configuration)
        if tracker.seed != before:
            self._journal.note_seed(configuration.tracker.seed, tracker.seed)

    def take(
        self, image: Frame | CodedImage, header: Header, detections: Detections | None
    ) -> TrafficAnswer:
        """Follow all vehicles in an image with its detections; None of an image without.

        Raises
        ------
        InputError
            If the image cannot be used.
        """
        began = time.perf_counter()
        events = self.vehicles.feed(image, stamp_ns(header), detections)
        frame = image.decode() if isinstance(image, CodedImage) else image
        self._detection_count = len(detections or ())
        self._warn_of_unusable(detections, frame)
        step_ms = (time.perf_counter() - began) * 1e3
        for box in self.vehicles.take_begun():
            events += [f"the target is doubtful: {why}" for why in doubts(frame, box)]
        for event in events:
            self._journal.warnings.say(" ".join(event.split()[:3]), event)  # without numbers
        mode, values = self._of_selected()
        values |= {**self.vehicles.summary(), "step_ms": step_ms}
        if events:
            values["event"] = "; ".join(events)
        session = self.vehicles.session
        return TrafficAnswer(
            header=header,
            mode=mode,
            values=values,
            step_ms=step_ms,
            is_restart=session.recovered,
            frame=frame,
            period=session.tracker.frame_period,
        )

    def _of_selected(self) -> tuple[str, dict[str, object]]:
        """Mode and values of the selected vehicle, or the reason why there is none."""
        selected = self.vehicles.selected
        chosen = self.vehicles.selection.identity
        if selected is not None:
            return selected.mode.value, dict(messages.scalars(selected))
        if not chosen:
            reason = "none is selected"
        elif self.vehicles.begins:
            reason = f"vehicle {chosen} is followed from the next image on"
        else:
            reason = f"vehicle {chosen} is not followed any more"
        return WAITING_MESSAGE, {"reason": reason}

    def _warn_of_unusable(self, detections: Detections | None, frame: Frame) -> None:
        if detections is None:
            return
        usable = detections.usable(*frame_size(frame))
        left_out = min(len(detections), MOST_DETECTIONS) - len(usable)
        if left_out > 0:
            words = f"{left_out} of {len(detections)} detections of an image cannot be used"
            reasons = "not finite, without an area, outside the image, or there twice"
            self._journal.warnings.say("unusable", f"{words}: {reasons}")


def _known(number: float | None) -> float | str:
    """Return a number with one decimal; a word where nobody knows it."""
    return "unknown" if number is None else round(number, 1)
