# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Spread of the scores of `traffic` over changes that ought to change nothing.

    python -m laboratory.traffic.spread FOLDER... --runs 6

Run k begins k frames later, with seed k of the tracker and of the detector of motion. The scores
from motion are chaotic: two runs differ by more than most changes of the tracker are worth, so that
only their mean over runs is compared.
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.evaluation.traffic.baselines import TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.case_run import MOTION_SOURCE
from vehicle_pf_tracker.evaluation.traffic.identities import kept_identities
from vehicle_pf_tracker.evaluation.traffic.middle_line import middle_crossings
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker


@dataclass(frozen=True)
class Run:
    """Scores of one run: percent, percent, count, percent (NaN without occlusions), percent."""

    hota: float
    idf1: float
    switches: float
    kept: float
    count_error: float


def shortened(sequence: TrafficSequence, first: int, last: int) -> TrafficSequence:
    """Leave out the truth before frame `first`, and all after `last`."""
    # Hidden vehicles are a mask over the rows of the truth, and are cut with them.
    inside = (sequence.truth[:, 0] >= first) & (sequence.truth[:, 0] <= last)
    return replace(
        sequence,
        frame_count=last,
        truth=sequence.truth[inside],
        hidden=sequence.hidden[inside],
    )


def follow(sequence: TrafficSequence, source: str, number: int) -> Array:
    """Return the tracks (frame, identity, left, top, width, height) of run `number`."""
    parameters = TrafficParameters(seed=number)
    session = TrafficSession(
        MultiVehicleTracker(parameters),
        (lambda: MotionDetector(number)) if source == MOTION_SOURCE else None,
        frame_rate=sequence.frame_rate,
    )
    rows = []
    for frame, image in enumerate(sequence.frames(), start=1):
        # A later start is a change that ought to change nothing.
        if frame <= number:
            continue
        # With motion the session detects by itself; else it gets the rows of this frame.
        given = None
        if source != MOTION_SOURCE:
            boxes = sequence.detections[source]
            now = boxes[boxes[:, 0] == frame]
            given = Detections.make(now[:, 1:5], now[:, 5])
        stamp_ns = round(frame * 1e9 / sequence.frame_rate)
        rows += [
            (frame, one.identity, one.box.x, one.box.y, one.box.width, one.box.height)
            for one in session.feed(image, stamp_ns, given)
            if one.mode in {TrackMode.TRACKING, TrackMode.OCCLUDED}
        ]
    return np.array(rows, dtype=np.float64).reshape(-1, 6)


def judged(worker: TrafficWorker, sequence: TrafficSequence, source: str, number: int) -> Run:
    """Follow all vehicles in run `number`, and score it."""
    tracks = follow(sequence, source, number)
    # The truth from the run's own start: frames that it has not seen are no misses.
    seen = shortened(sequence, number + 1, sequence.frame_count)
    scores = worker.score(seen, tracks)
    kept, occlusions = kept_identities(seen, tracks)
    counted, true = middle_crossings(seen, tracks)
    return Run(
        hota=scores["HOTA"],
        idf1=scores["IDF1"],
        switches=scores["IDSW"],
        kept=100 * kept / occlusions if occlusions else float("nan"),
        count_error=100 * (counted - true) / true if true else float("nan"),
    )


def summary(runs: Sequence[Run]) -> str:
    """Return the cells of a table: means, and in brackets the standard deviations."""

    def cell(values: Sequence[float]) -> str:
        # One run without occlusions is as good as all: they have the same scene.
        if np.isnan(values).any():
            return "–"
        spread = f" ({statistics.stdev(values):.1f})" if len(values) > 1 else ""
        return f"{statistics.fmean(values):.1f}{spread}"

    columns = (
        [run.hota for run in runs],
        [run.idf1 for run in runs],
        [run.switches for run in runs],
        [run.kept for run in runs],
        [run.count_error for run in runs],
    )
    return " | ".join(map(cell, columns))


HEAD = "| | HOTA | IDF1 | switches | kept, % | count error, % |\n|---|---:|---:|---:|---:|---:|"


def main() -> None:
    """Print a row for each scene."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=Path, help="scenes in MOTChallenge's layout")
    parser.add_argument("--runs", type=int, default=6)
    parser.add_argument("--source", default=MOTION_SOURCE, help="motion, or a file of det/ by name")
    parser.add_argument("--frames", type=int, help="only the first frames")
    args = parser.parse_args()
    print(HEAD)
    with TrafficWorker() as worker:
        for folder in args.folders:
            scene = read_sequence(folder)
            scene = shortened(scene, 1, min(args.frames or scene.frame_count, scene.frame_count))
            runs = [judged(worker, scene, args.source, number) for number in range(args.runs)]
            print(f"| {scene.name} | {summary(runs)} |", flush=True)


if __name__ == "__main__":
    main()
