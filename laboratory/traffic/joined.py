# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""What `traffic` says by motion of vehicles in joined blobs, against those without a number.

    python -m laboratory.traffic.joined CAMERA=FOLDER... --set detection.usual_size:_PER_AREA=0.8

Folders are in MOTChallenge's layout. *Said* is the mean number of vehicles in blobs with others
that no number stands for, by the blobs' size; *true* that of visible vehicles whose true box none
that is followed overlaps by .3, both in the images in which sizes were known. *Holds* is the share
of these images whose true number is between half of what is said and twice that, rounded outwards.

The last line is the error by which the numbers of ``--set`` are chosen: the mean over cameras of
the distance of the logarithms of what is said and of the truth.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from contextlib import ExitStack
from statistics import fmean
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from laboratory.traffic.camera_clips import read_clip
from laboratory.traffic.decisions import Decision
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.evaluation.traffic.box_matches import overlaps
from vehicle_pf_tracker.evaluation.traffic.case_run import MOTION_SOURCE
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

HEADER = ["clip", "images", "sizes known, %", "true, all images", "said", "true", "holds, %"]
"""Headings of the table."""
UNDER = 0.3
"""Least overlap of a vehicle that is followed with the true box: blobs are wider than vehicles."""
FACTOR = 2.0
"""Factor, either way, within which a number holds: vehicles hide a half of each other in a jam."""
EMPTY_ROAD = 0.3
"""Number that is added to both before their ratio is taken: a tenth of a vehicle beside none is no
error."""
FEWEST_IMAGES = 20
"""Least images of a clip with known sizes that it has a vote with."""


class Image(NamedTuple):
    """Vehicles without a number in one image: what is said, None where unknown, and the truth."""

    said: float | None
    true: int


def main() -> None:
    """Print a row for each folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("clips", nargs="+", metavar="CAMERA=FOLDER")
    parser.add_argument("--set", action="append", default=[], metavar="PLACE=VALUE", dest="values")
    args = parser.parse_args()
    rows = []
    errors: dict[str, list[float]] = {}
    with ExitStack() as stack:
        for text in args.values:
            place, _, value = text.partition("=")
            stack.enter_context(Decision(place, ()).at(float(value)))
        for clip in (read_clip(text, MOTION_SOURCE) for text in args.clips):
            images = images_of(clip.sequence)
            rows.append(row(clip.sequence.name, images))
            known = [one for one in images if one.said is not None]
            if len(known) >= FEWEST_IMAGES:
                errors.setdefault(clip.camera, []).append(error(known))
    print(markdown(HEADER, rows))
    if errors:
        print(f"error {fmean(map(fmean, errors.values())):.3f}")


def images_of(sequence: TrafficSequence) -> list[Image]:
    """Follow all vehicles by motion; images in which the detector was not blind."""
    session = TrafficSession(
        MultiVehicleTracker(TrafficParameters()), MotionDetector, frame_rate=sequence.frame_rate
    )
    visible = sequence.truth[~sequence.hidden]
    images = []
    for number, frame in enumerate(sequence.frames(), start=1):
        before = session.detected.images
        estimates = session.feed(frame, round(number * 1e9 / sequence.frame_rate))
        if session.detected.images > before:
            true = without_number(visible[visible[:, 0] == number, 2:6], estimates)
            images.append(Image(session.detected.latest_unresolved, true))
    return images


def without_number(boxes: Array, estimates: Sequence[TrackEstimate]) -> int:
    """Count true boxes (N, 4) that no vehicle which is followed overlaps enough, one for each."""
    followed = [
        (one.box.x, one.box.y, one.box.width, one.box.height)
        for one in estimates
        if one.is_followed
    ]
    shared = overlaps(boxes, np.array(followed).reshape(-1, 4))
    rows, columns = linear_sum_assignment(shared, maximize=True)
    return len(boxes) - int(np.count_nonzero(shared[rows, columns] >= UNDER))


def holds(said: float, true: int) -> bool:
    """Tell whether a number is within the factor of the truth."""
    return math.floor(said / FACTOR) <= true <= math.ceil(FACTOR * said)


def error(known: Sequence[Image]) -> float:
    """Return the distance of the logarithms of the mean numbers."""
    said = fmean(one.said or 0.0 for one in known)
    true = fmean(one.true for one in known)
    return abs(math.log((said + EMPTY_ROAD) / (true + EMPTY_ROAD)))


def row(name: str, images: Sequence[Image]) -> list[str]:
    """Summarise a clip."""
    known = [(one.said, one.true) for one in images if one.said is not None]
    overall = f"{fmean(one.true for one in images):.1f}" if images else "–"
    share = f"{100 * len(known) / max(len(images), 1):.0f}"
    if not known:
        return [name, str(len(images)), share, overall, "–", "–", "–"]
    cells = (
        f"{fmean(said for said, _ in known):.1f}",
        f"{fmean(true for _, true in known):.1f}",
        f"{100 * fmean(holds(said, true) for said, true in known):.0f}",
    )
    return [name, str(len(images)), share, overall, *cells]


if __name__ == "__main__":
    main()
