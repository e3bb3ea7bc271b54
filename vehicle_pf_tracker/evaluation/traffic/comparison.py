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

"""The tracker of many vehicles and baselines on the same detections of scenes with truth.

Detections made worse, or scored otherwise, by name.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

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

UNCHANGED = "unchanged"
DROPPED = 0.2
"""Share of detections that `dropped` leaves out."""
_SEED = 20
"""Seed of what is left out: the same for every system."""
_PERIOD, _FIRST = 200, 100
"""Frames from one gap to the next, and the first gap's first frame: the tracks before it are old
enough, and the last clip has four gaps."""

Perturbation = Callable[[Array], Array]
"""Takes rows (frame, left, top, width, height, score) and returns others."""


def _dropped(rows: Array) -> Array:
    kept: Array = rows[np.random.default_rng(_SEED).uniform(size=len(rows)) >= DROPPED]
    return kept


def _with_gaps(length: int) -> Perturbation:
    def without(rows: Array) -> Array:
        late = rows[:, 0] - _FIRST
        kept: Array = rows[(late < 0) | (late % _PERIOD >= length)]
        return kept

    return without


def _scored(change: Callable[[Array], Array]) -> Perturbation:
    return lambda rows: np.column_stack([rows[:, :5], change(rows[:, 5])])


PERTURBATIONS: Mapping[str, Perturbation] = MappingProxyType(
    {
        UNCHANGED: lambda rows: rows,
        "dropped": _dropped,
        "gap20": _with_gaps(20),
        "gap40": _with_gaps(40),
        "squared": _scored(np.square),
        "halved": _scored(lambda scores: scores / 2),
    }
)
"""A fifth of the detections dropped; 20 and 40 of every 200 frames without any; other scores."""


OURS = "traffic"
MOTION = "motion"
"""Source of detections: the embedded detector, whose boxes the baselines get too."""

Maker = Callable[[TrafficParameters], TrafficTracker]


@dataclass(frozen=True, slots=True)
class TrafficCase:
    """A scene with one source of detections.

    Attributes
    ----------
    sequence : TrafficSequence
        The scene.
    source : str
        A key of its detections, or `MOTION`.
    perturbation : str
        A key of `PERTURBATIONS`.
    """

    sequence: TrafficSequence
    source: str
    perturbation: str = UNCHANGED


@dataclass(frozen=True, slots=True)
class TrafficResult:
    """Result of one system in one case.

    Attributes
    ----------
    scene, source, perturbation : str
        The case.
    system : str
        `OURS` or a baseline.
    seed : int or None
        Seed; None for a baseline.
    scores : dict of str to float
        TrackEval's.
    kept, occlusions : int
        Total occlusions after which the identity is the same, and all that are judged.
    counted, true : int
        Crossings of the middle line.
    step_ms : float
        Mean processor time per frame, ms; without detection, but for `MOTION`.
    """

    scene: str
    source: str
    perturbation: str
    system: str
    seed: int | None
    scores: dict[str, float]
    kept: int
    occlusions: int
    counted: int
    true: int
    step_ms: float


def cases_of(
    sequences: Sequence[TrafficSequence],
    sources: Sequence[str] | None = None,
    perturbations: Sequence[str] = tuple(PERTURBATIONS),
) -> list[TrafficCase]:
    """List the cases: each source as it is, and files of detections also perturbed."""
    cases = []
    for sequence in sequences:
        for source in (*sequence.detections, MOTION):
            if sources is None or source in sources:
                kinds = perturbations if source != MOTION else (UNCHANGED,)
                cases += [TrafficCase(sequence, source, kind) for kind in kinds]
    return cases


def compare(
    cases: Sequence[TrafficCase],
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
    cases : sequence of TrafficCase
        What to run on.
    worker : TrafficWorker
        Runs the baselines and scores.
    parameters : TrafficParameters
        Those of the tracker; the seed is replaced.
    seeds : sequence of int
        Seeds of the tracker.
    baselines : sequence of str
        Keys of `TRAFFIC_BASELINES`.
    make : callable
        Makes the tracker.
    on_progress : callable
        Called with the number of frames done and of all.
    """
    total, done = sum(case.sequence.frame_count for case in cases), 0
    for case in cases:
        given: list[Array] = []
        for seed in seeds:
            tracks, detections, seconds = follow(case, replace(parameters, seed=seed), make)
            given.append(detections)
            yield judge(case, worker, OURS, seed, (tracks, seconds))
        for name in baselines if given else ():
            yield judge(case, worker, name, None, worker.track(name, case.sequence, given[0]))
        done += case.sequence.frame_count
        on_progress(done, total)


def judge(
    case: TrafficCase,
    worker: TrafficWorker,
    system: str,
    seed: int | None,
    run: tuple[Array, float],
) -> TrafficResult:
    """Score one run: its tracks, and processor time per frame in s."""
    tracks, seconds = run
    kept, occlusions = kept_identities(case.sequence, tracks)
    counted, true = counts(case.sequence, tracks)
    return TrafficResult(
        scene=case.sequence.name,
        source=case.source,
        perturbation=case.perturbation,
        system=system,
        seed=seed,
        scores=worker.score(case.sequence, tracks),
        kept=kept,
        occlusions=occlusions,
        counted=counted,
        true=true,
        step_ms=1e3 * seconds,
    )


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
    case: TrafficCase, parameters: TrafficParameters, make: Maker = TrafficTracker
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
    sequence = case.sequence
    recorder = _Recorder()
    is_motion = case.source == MOTION
    session = TrafficSession(
        make(parameters),
        (lambda: recorder) if is_motion else None,
        frame_rate=sequence.frame_rate,
    )
    given = (
        np.empty((0, 6))
        if is_motion
        else PERTURBATIONS[case.perturbation](sequence.detections[case.source])
    )
    tracks: list[list[float]] = []
    seconds = 0.0
    for number, frame in enumerate(sequence.frames(), start=1):
        now = given[given[:, 0] == number]
        detections = None if is_motion else Detections.make(now[:, 1:5], now[:, 5])
        before = time.process_time()
        estimates = session.feed(frame, round(number * 1e9 / sequence.frame_rate), detections)
        seconds += time.process_time() - before
        tracks += _rows(number, estimates)
    found = np.array(recorder.rows).reshape(-1, 6) if is_motion else given
    return (
        np.array(tracks, dtype=np.float64).reshape(-1, 6),
        found,
        seconds / sequence.frame_count,
    )


def _rows(number: int, estimates: Sequence[TrackEstimate]) -> Iterator[list[float]]:
    for one in estimates:
        if one.mode in {TrackMode.TRACKING, TrackMode.OCCLUDED}:
            box = one.box
            yield [number, one.identity, box.x, box.y, box.width, box.height]
