# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Who hides a vehicle: `hidden_by` of hidden tracks against the truth of synthetic scenes.

    python -m laboratory.traffic.occluders FOLDER [FOLDER ...] [--detections good]

FOLDER is one that `synth traffic-*` writes, with `gt/occluders.csv`.
"""

from __future__ import annotations

import argparse
import csv
from collections import Counter
from pathlib import Path

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.evaluation.traffic.box_matches import matches
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence
from vehicle_pf_tracker.trackers.traffic.estimate import SCENE_OCCLUDER, TrackEstimate, TrackMode
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker


def main() -> None:
    """Print a line for each folder."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    parser.add_argument("--detections", default="good", help="a file of det/ (default: good)")
    args = parser.parse_args()
    for folder in args.folders:
        found = judged(read_sequence(folder), args.detections)
        print(
            f"{folder.name}: {found['right']} right, {found['wrong']} wrong, "
            f"{found['unnamed']} 'scene' for a vehicle, {found['seen']} taken for seen"
        )


def judged(sequence: TrafficSequence, source: str) -> Counter[str]:
    """Count the frames of totally hidden vehicles by what their tracks say of the occluder."""
    true = _occluders(sequence.folder / "gt" / "occluders.csv")
    given = sequence.detections[source]
    session = TrafficSession(MultiVehicleTracker(), frame_rate=sequence.frame_rate)
    names: dict[int, int] = {}
    counts: Counter[str] = Counter()
    for number, frame in enumerate(sequence.frames(), start=1):
        # The boxes of this frame, as a detector would publish them.
        now = given[given[:, 0] == number]
        stamp_ns = round(number * 1e9 / sequence.frame_rate)
        estimates = session.feed(frame, stamp_ns, Detections.make(now[:, 1:5], now[:, 5]))
        rows = sequence.truth[:, 0] == number
        # Tracks get their vehicle's name while it is visible; hidden ones keep the last.
        _name(names, sequence.truth[rows & ~sequence.hidden], estimates)
        by_vehicle = {
            names[estimate.identity]: estimate
            for estimate in estimates
            if estimate.identity in names
        }
        for vehicle in sequence.truth[rows & sequence.hidden, 1].astype(int).tolist():
            if vehicle in by_vehicle:
                counts[_verdict(by_vehicle[vehicle], true[number, vehicle], names)] += 1
    return counts


def _occluders(path: Path) -> dict[tuple[int, int], str]:
    with path.open(encoding="utf-8") as file:
        return {
            (int(row["frame"]), int(row["id"])): row["hidden_by"] for row in csv.DictReader(file)
        }


def _name(names: dict[int, int], seen: Array, estimates: tuple[TrackEstimate, ...]) -> None:
    """Note which vehicle each track was last seen on."""
    boxes = np.array(
        [
            [estimate.box.x, estimate.box.y, estimate.box.width, estimate.box.height]
            for estimate in estimates
        ]
    ).reshape(-1, 4)
    for row, column in zip(*matches(seen[:, 2:], boxes), strict=True):
        names[estimates[column].identity] = int(seen[row, 1])


def _verdict(one: TrackEstimate, true: str, names: dict[int, int]) -> str:
    # The tracker must know that it is hidden before it can say by whom.
    if one.mode not in {TrackMode.OCCLUDED, TrackMode.LOST}:
        return "seen"
    # The name of the true vehicle, as tracks have numbers of their own.
    claimed = (
        SCENE_OCCLUDER
        if one.hidden_by == SCENE_OCCLUDER
        else str(names.get(int(one.hidden_by or 0)))
    )
    if claimed == true:
        return "right"
    return "unnamed" if claimed == SCENE_OCCLUDER else "wrong"


if __name__ == "__main__":
    main()
