# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Identity of single vehicles with truth among all that `traffic` follows in a clip.

    python -m laboratory.traffic.clips CLIP FRAME TRUTH.csv [FRAME TRUTH.csv ...]

FRAME is the number in the clip, from 0, of the truth's first row (`frame,x,y,w,h,visible,occ`, as
in a frame folder). Vehicles are found by the embedded motion detector alone; the run of seed k
begins in the clip's frame k, and its detector has the same seed.
"""

from __future__ import annotations

import argparse
import csv
from collections import Counter
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.evaluation.traffic.box_matches import overlaps
from vehicle_pf_tracker.parameters.table import from_mapping, parse_assignments, specs
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

UNDER = 0.3
"""Least overlap of a track with the true box: moving shadows and neighbours widen blobs."""
WINDOW = 30
"""Frames after an occlusion in which the identity is looked for."""


@dataclass(frozen=True)
class Row:
    """Truth in one frame of the clip, from 0; hidden as much as the vehicle ever is."""

    frame: int
    box: tuple[float, ...]
    hidden: bool


def main() -> None:
    """Print a line for each seed and vehicle."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("clip", type=Path)
    parser.add_argument("truths", nargs="+", metavar="FRAME TRUTH.csv")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--set", action="append", default=[], dest="assignments")
    args = parser.parse_args()
    pairs = list(zip(args.truths[::2], args.truths[1::2], strict=True))
    values = parse_assignments(specs(TrafficParameters), args.assignments)
    print("| vehicle | seed | occlusion | identity before | after | kept | followed | identities |")
    print("|---|---:|---|---:|---:|---|---:|---:|")
    for seed in range(args.seeds):
        tracks = follow(args.clip, from_mapping(TrafficParameters, {**values, "seed": seed}))
        for first, path in pairs:
            report(Path(path), seed, read_truth(Path(path), int(first)), tracks)


def follow(clip: Path, parameters: TrafficParameters) -> list[np.ndarray]:
    """Return rows (identity, left, top, width, height) of every frame."""
    video = cv2.VideoCapture(str(clip))
    rate = video.get(cv2.CAP_PROP_FPS)
    session = TrafficSession(
        MultiVehicleTracker(parameters), lambda: MotionDetector(parameters.seed), frame_rate=rate
    )
    found: list[Array] = []
    while True:
        read, image = video.read()
        if not read:
            return found
        # Frames before the run's start: no tracks, so that indices stay those of the clip.
        if len(found) < parameters.seed:
            found.append(np.empty((0, 5)))
            continue
        frame = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB), dtype=np.uint8)
        estimates = session.feed(frame, round((len(found) + 1) * 1e9 / rate))
        rows = [
            (
                estimate.identity,
                estimate.box.x,
                estimate.box.y,
                estimate.box.width,
                estimate.box.height,
            )
            for estimate in estimates
            # Lost and tentative ones are no claim about where the vehicle is.
            if estimate.mode in {TrackMode.TRACKING, TrackMode.OCCLUDED}
        ]
        found.append(np.array(rows, dtype=float).reshape(-1, 5))


def read_truth(path: Path, first: int) -> list[Row]:
    """Read the truth of a frame folder; its row of frame 1 is the clip's frame `first`."""
    with path.open(newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["w"]]
    # The deepest occlusion that the truth has: total ones, or partial ones where none is total.
    deepest = max(int(row["occ"]) for row in rows)
    return [
        Row(
            first + int(row["frame"]) - 1,
            tuple(float(row[side]) for side in "xywh"),
            0 < deepest == int(row["occ"]),
        )
        for row in rows
    ]


def identity(row: Row, tracks: list[np.ndarray]) -> int | None:
    """Return the identity of the track that overlaps the true box most, if any does enough."""
    boxes = tracks[row.frame]
    if not len(boxes):
        return None
    shared = overlaps(np.array([row.box]), boxes[:, 1:])[0]
    best = int(shared.argmax())
    return int(boxes[best, 0]) if shared[best] >= UNDER else None


def report(path: Path, seed: int, truth: list[Row], tracks: list[np.ndarray]) -> None:
    """Print a line for every occlusion of one vehicle, total ones where there are any."""
    spells = [list(rows) for _, rows in groupby(truth, lambda row: row.hidden)]
    under = {row.frame: identity(row, tracks) for row in truth if not row.hidden}
    followed = sum(one is not None for one in under.values()) / len(under)
    identities = len({one for one in under.values() if one is not None})
    # Three spells in a row: visible, hidden, visible again.
    for before, hidden, after in zip(spells, spells[1:], spells[2:], strict=False):
        if before[0].hidden:
            continue
        # The last identity before, and the commonest soon after: single frames may have another.
        known = [one for row in before if (one := under[row.frame]) is not None]
        then = Counter(one for row in after[:WINDOW] if (one := under[row.frame]) is not None)
        first = known[-1] if known else None
        last = then.most_common(1)[0][0] if then else None
        kept = "yes" if first is not None and first == last else "no"
        span = f"{hidden[0].frame} to {hidden[-1].frame}"
        cells = (path.parent.name, seed, span, first or "–", last or "–", kept)
        print("|", " | ".join(map(str, cells)), f"| {followed:.0%} | {identities} |", flush=True)


if __name__ == "__main__":
    main()
