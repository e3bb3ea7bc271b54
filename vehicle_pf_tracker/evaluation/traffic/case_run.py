# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Run of the tracker through a case: a scene with truth, and detections of it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import astuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.detector import FollowedVehicle
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.evaluation.traffic.line_counts import LineCounts
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence
from vehicle_pf_tracker.results.backdating import Backdating, Frames
from vehicle_pf_tracker.results.traffic_results import IN_TRACKS
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

MOTION_SOURCE = "motion"
"""Source of detections: the embedded detector, whose boxes the baselines get too."""
Case = tuple[TrafficSequence, str]
"""A scene with truth, and a key of its detections or `MOTION_SOURCE`."""
Maker = Callable[[TrafficParameters], MultiVehicleTracker]
"""Makes a tracker of parameters."""


def follow(
    case: Case,
    parameters: TrafficParameters,
    make: Maker = MultiVehicleTracker,
    lines: LineCounts | None = None,
) -> tuple[Array, Array, float]:
    """Follow all vehicles of a case with the tracker, and count them at `lines` on the way.

    Returns
    -------
    tracks : array, shape (N, 6)
        Frame, identity, left, top, width and height of tracked and occluded vehicles.
    detections : array, shape (M, 6)
        Frame, left, top, width, height, score of what the tracker was given.
    seconds : float
        Processor time per frame, s.
    """
    sequence, source = case
    recorder = _Recorder()
    given = None if source == MOTION_SOURCE else sequence.detections[source]
    detector = (lambda: recorder) if given is None else None
    session = TrafficSession(make(parameters), detector, frame_rate=sequence.frame_rate)
    tracks: list[list[float]] = []
    backdating = Backdating()
    seconds = 0.0
    for number, frame in enumerate(sequence.frames(), start=1):
        detections = None
        if given is not None:
            # Before the clock starts: a baseline is not charged for it either.
            now = given[given[:, 0] == number]
            detections = Detections.make(now[:, 1:5], now[:, 5])
        # CPU of the whole process: the detector may use several threads.
        before = time.process_time()
        stamp_ns = round(number * 1e9 / sequence.frame_rate)
        estimates = session.feed(frame, stamp_ns, detections)
        seconds += time.process_time() - before
        if lines is not None:
            lines.add(number, stamp_ns, session)
        tracks += _rows(backdating.add(number, 0, estimates))
    # Vehicles that are confirmed late get the rows of before, as in `tracks.txt`.
    tracks += _rows(backdating.rest())
    rows = np.array(tracks, dtype=np.float64).reshape(-1, 6)
    detected = np.vstack(recorder.rows) if given is None else given
    return rows, detected, seconds / sequence.frame_count


def _rows(frames: Frames) -> list[list[float]]:
    return [
        [number, estimate.identity, *astuple(estimate.box)]
        for number, _, estimates in frames
        for estimate in estimates
        if estimate.mode in IN_TRACKS
    ]


class _Recorder(MotionDetector):
    """Keeps frame, left, top, width, height and score of all that moved."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[Array] = []

    def detect(
        self,
        frame: Frame,
        tracks: Sequence[FollowedVehicle] = (),
        period: float = DEFAULT_PERIOD,
    ) -> Detections:
        """Find what moves."""
        detections = super().detect(frame, tracks, period)
        numbers = np.full(len(detections.scores), len(self.rows) + 1)
        self.rows.append(np.column_stack([numbers, detections.boxes, detections.scores]))
        return detections
