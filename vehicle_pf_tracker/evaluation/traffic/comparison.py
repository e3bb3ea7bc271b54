# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Comparison of the tracker of many vehicles with baselines on the same detections."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.traffic.baselines import TRAFFIC_BASELINES, TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.case_run import MOTION_SOURCE, Case, Maker, follow
from vehicle_pf_tracker.evaluation.traffic.followed import false_numbers, never_found
from vehicle_pf_tracker.evaluation.traffic.identities import kept_identities
from vehicle_pf_tracker.evaluation.traffic.line_counts import LineCounts, held_and_width
from vehicle_pf_tracker.evaluation.traffic.middle_line import middle_crossings
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

OURS = "traffic"
"""Name of our system among the others."""


@dataclass(frozen=True, slots=True)
class TrafficResult:
    """Result of one system in one case, or the mean of several runs.

    Attributes
    ----------
    scene, source, system : str
        Name of the scene, source of detections, and `OURS` or a baseline.
    seed : int or None
        Seed; None for a baseline or a mean.
    values : dict of str to float
        TrackEval's scores by name. ``kept``, percent of total occlusions with the same identity
        afterwards, and ``count_error``, percent of the true crossings of the middle line, where
        there are any. ``never_found``, vehicles that no box fitted, and ``false_numbers``,
        identities that were on none. ``held`` and ``width``, percent of the lines' intervals that
        hold the true count, and their mean width. ``step_ms``, mean processor time per frame;
        without detection, except for `MOTION_SOURCE`.
    occlusions, true, vehicles : int
        Total occlusions that are judged, true crossings, and vehicles that were in sight.
    runs : int
        Number of runs.
    """

    scene: str
    source: str
    system: str
    seed: int | None
    values: dict[str, float]
    occlusions: int
    true: int
    vehicles: int
    runs: int = 1


def cases_of(
    sequences: Sequence[TrafficSequence], sources: Sequence[str] | None = None
) -> list[Case]:
    """List the cases: each scene with all its detections and `MOTION_SOURCE`, or `sources`."""
    return [
        (sequence, source)
        for sequence in sequences
        for source in (*sequence.detections, MOTION_SOURCE)
        if sources is None or source in sources
    ]


def compare(
    cases: Sequence[Case],
    worker: TrafficWorker,
    parameters: TrafficParameters,
    seeds: Sequence[int],
    *,
    baselines: Sequence[str] = tuple(TRAFFIC_BASELINES),
    make: Maker = MultiVehicleTracker,
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
        Parameters of the tracker; the seed is replaced.
    seeds : sequence of int
        Seeds of the tracker, at least one.
    baselines : sequence of str
        Keys of `TRAFFIC_BASELINES`.
    make : callable
        Makes the tracker.
    on_progress : callable
        Called with the number of frames done and of all.
    """
    total = sum(sequence.frame_count for sequence, _ in cases)
    done = 0
    for case in cases:
        given: list[Array] = []
        for seed in seeds:
            lines = LineCounts(case[0])
            own = replace(parameters, seed=seed)
            tracks, detections, seconds = follow(case, own, make, lines)
            # What moved depends on the tracks, and so on the seed; the baselines get what the
            # first had.
            given.append(detections)
            result = judge(case, worker, OURS, seed, (tracks, seconds))
            if (trust := held_and_width(lines.results())) is not None:
                result.values["held"], result.values["width"] = trust
            yield result
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
    counted, true = middle_crossings(sequence, tracks)
    missed, vehicles = never_found(sequence, tracks)
    if occlusions:
        values["kept"] = 100 * kept / occlusions
    if true:
        values["count_error"] = 100 * (counted / true - 1)
    values["never_found"] = missed
    values["false_numbers"] = false_numbers(sequence, tracks)
    values["step_ms"] = 1e3 * seconds
    return TrafficResult(sequence.name, source, system, seed, values, occlusions, true, vehicles)
