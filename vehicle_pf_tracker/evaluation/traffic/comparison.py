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

"""The tracker of many vehicles and baselines on the same detections of scenes with truth."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.evaluation.baselines.traffic_client import TRAFFIC_BASELINES, TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.identities import counts, kept_identities
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.motion_detector import MotionDetector
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import TrafficTracker

OURS = "traffic"
MOTION = "motion"
"""Source of detections: the embedded detector, whose boxes the baselines get too."""

Maker = Callable[[TrafficParameters], TrafficTracker]
Case = tuple[TrafficSequence, str]
"""A scene with truth, and a key of its detections or `MOTION`."""


@dataclass(frozen=True, slots=True)
class TrafficResult:
    """Result of one system in one case.

    Attributes
    ----------
    scene, source, system : str
        Name of the scene, source of detections, and `OURS` or a baseline.
    seed : int or None
        Seed; None for a baseline.
    values : dict of str to float
        TrackEval's scores by name. ``kept``, percent of total occlusions with the same identity
        afterwards, and ``count_error``, percent of the true crossings of the middle line, where
        there are any. ``step_ms``, mean processor time per frame; without detection, except for
        `MOTION`.
    occlusions, true : int
        Total occlusions that are judged, and true crossings.
    """

    scene: str
    source: str
    system: str
    seed: int | None
    values: dict[str, float]
    occlusions: int
    true: int


def cases_of(
    sequences: Sequence[TrafficSequence], sources: Sequence[str] | None = None
) -> list[Case]:
    """List the cases: each scene with each of its detections and `MOTION`, or with `sources`."""
    return [
        (sequence, source)
        for sequence in sequences
        for source in (*sequence.detections, MOTION)
        if sources is None or source in sources
    ]


def compare(
    cases: Sequence[Case],
    worker: TrafficWorker,
    parameters: TrafficParameters,
    seeds: Sequence[int],
    *,
    baselines: Sequence[str] = tuple(TRAFFIC_BASELINES),
    make: Maker = TrafficTracker,
    on_progress: Callable[[int, int], None] = lambda done, total: None,
) -> Iterator[TrafficResult]:
    """Run all systems on all cases, one after the other.

    Parameters
    ----------
    cases : sequence of Case
        Scenes and detections to run on.
    worker : TrafficWorker
        Runs the baselines and scores.
    parameters : TrafficParameters
        Those of the tracker; the seed is replaced.
    seeds : sequence of int
        Seeds of the tracker, at least one.
    baselines : sequence of str
        Keys of `TRAFFIC_BASELINES`.
    make : callable
        Makes the tracker.
    on_progress : callable
        Called with the number of frames done and of all.
    """
    total, done = sum(sequence.frame_count for sequence, _ in cases), 0
    for case in cases:
        given: list[Array] = []
        for seed in seeds:
            tracks, detections, seconds = follow(case, replace(parameters, seed=seed), make)
            given.append(detections)
            yield judge(case, worker, OURS, seed, (tracks, seconds))
        for name in baselines:
            yield judge(case, worker, name, None, worker.track(name, case[0], given[0]))
        done += case[0].frame_count
        on_progress(done, total)


def judge(
    case: Case, worker: TrafficWorker, system: str, seed: int | None, run: tuple[Array, float]
) -> TrafficResult:
    """Score one run: its tracks, and processor time per frame in s."""
    sequence, source = case
    tracks, seconds = run
    values = worker.score(sequence, tracks)
    kept, occlusions = kept_identities(sequence, tracks)
    counted, true = counts(sequence, tracks)
    if occlusions:
        values["kept"] = 100 * kept / occlusions
    if true:
        values["count_error"] = 100 * (counted / true - 1)
    values["step_ms"] = 1e3 * seconds
    return TrafficResult(sequence.name, source, system, seed, values, occlusions, true)


class _Recorder(MotionDetector):
    """Keeps what it finds as rows."""

    def __init__(self) -> None:
        super().__init__()
        self._number = 0
        self.rows: list[list[float]] = []

    def detect(self, frame: Frame, tracks: Sequence[TrackEstimate] = ()) -> Detections:
        """Find what moves."""
        found = super().detect(frame, tracks)
        self._number += 1
        self.rows += [
            [self._number, *box, score]
            for box, score in zip(found.boxes.tolist(), found.scores.tolist(), strict=True)
        ]
        return found


def follow(
    case: Case, parameters: TrafficParameters, make: Maker = TrafficTracker
) -> tuple[Array, Array, float]:
    """Follow all vehicles of a case with the tracker.

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
    given = None if source == MOTION else sequence.detections[source]
    session = TrafficSession(
        make(parameters),
        (lambda: recorder) if given is None else None,
        frame_rate=sequence.frame_rate,
    )
    tracks: list[list[float]] = []
    seconds = 0.0
    for number, frame in enumerate(sequence.frames(), start=1):
        detections = None
        if given is not None:
            now = given[given[:, 0] == number]
            detections = Detections.make(now[:, 1:5], now[:, 5])
        before = time.process_time()
        estimates = session.feed(frame, round(number * 1e9 / sequence.frame_rate), detections)
        seconds += time.process_time() - before
        tracks += _rows(number, estimates)
    found = np.array(recorder.rows).reshape(-1, 6) if given is None else given
    rows = np.array(tracks, dtype=np.float64).reshape(-1, 6)
    return rows, found, seconds / sequence.frame_count


def _rows(number: int, estimates: Sequence[TrackEstimate]) -> Iterator[list[float]]:
    for one in estimates:
        if one.mode in {TrackMode.TRACKING, TrackMode.OCCLUDED}:
            box = one.box
            yield [number, one.identity, box.x, box.y, box.width, box.height]
