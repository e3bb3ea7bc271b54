# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fit the decisions of `traffic` and of its detectors, and judge each on cameras left out.

    python -m laboratory.traffic.fit CAMERA=FOLDER... --boxes motion -o results/traffic_fit

runs every decision of `decisions` (or those of ``--only``) at each of its values over all
clips, which are folders in MOTChallenge's layout; clips of one camera have the same name before the
equals sign. The score of a run is the mean of HOTA and IDF1. ``leave_one_camera_out.md`` has for
each decision the value that is best for the other cameras, what it scores on the one left out, and
what the decision is worth: the shipped value's score less that without it. Runs are kept in
``runs.jsonl``: delete it when the code has changed.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from laboratory.result_store import ResultStore
from laboratory.traffic.decisions import FITTED_DECISIONS, Decision
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.tables import NO_SCORE, markdown
from vehicle_pf_tracker.evaluation.traffic.baselines import TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.case_run import follow
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence
from vehicle_pf_tracker.results.output_files import write_text
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters

HEADER = ["decision", "shipped", "by the other cameras", "shipped scores", "left out", "worth"]
"""Headings; *by the other cameras* has the values that are best for them, in the order of the
cameras, *left out* the mean of what each scores on the camera that it has not seen."""


class Clip(NamedTuple):
    """A clip of a camera, with the boxes that the tracker is given."""

    camera: str
    sequence: TrafficSequence
    boxes: str


def main() -> int:
    """Fit, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("clips", nargs="+", metavar="CAMERA=FOLDER")
    parser.add_argument("--boxes", default="motion", help="motion, or a file of det/")
    parser.add_argument("--only", action="append", default=[], metavar="PLACE")
    parser.add_argument("-o", "--out", type=Path, required=True)
    args = parser.parse_args()
    clips = [read_clip(text, args.boxes) for text in args.clips]
    decisions = [each for each in FITTED_DECISIONS if not args.only or each.place in args.only]
    if not decisions:
        raise InputError(f"--only names no decision: {', '.join(args.only)}")
    store = ResultStore(args.out / "runs.jsonl")
    with TrafficWorker() as worker:
        rows = [row(decision, scores_of(decision, clips, store, worker)) for decision in decisions]
    write_text(args.out / "leave_one_camera_out.md", markdown(HEADER, rows))
    return 0


def read_clip(text: str, boxes: str) -> Clip:
    """Read a clip as the command line names it.

    Raises
    ------
    InputError
        If it has no camera's name, or no such boxes.
    """
    camera, equals, folder = text.partition("=")
    if not equals:
        raise InputError(f"{text} does not name a camera; give CAMERA=FOLDER")
    sequence = read_sequence(Path(folder))
    if boxes != "motion" and boxes not in sequence.detections:
        raise InputError(f"{folder} has no det/{boxes}.txt")
    return Clip(camera, sequence, boxes)


def scores_of(
    decision: Decision, clips: Sequence[Clip], store: ResultStore, worker: TrafficWorker
) -> dict[float, dict[str, float]]:
    """Run all clips at every value: mean scores of each camera, by value; the shipped one first."""
    shipped = decision.get()
    without = () if decision.without is None else (decision.without,)
    by_value: dict[float, dict[str, float]] = {}
    # Shipped first: `row` takes the first value for it.
    for value in dict.fromkeys((shipped, *decision.values, *without)):
        cameras: dict[str, list[float]] = {}
        for clip in clips:
            # All decisions share the run in which all are as shipped.
            name = "shipped" if value == shipped else f"{decision.place}={value:g}"
            key = f"{name} {clip.sequence.folder.resolve()} {clip.boxes}"
            # Scored once for all decisions, and kept as soon as it is there.
            if key not in store:
                with decision.at(value):
                    tracks, _, _ = follow((clip.sequence, clip.boxes), TrafficParameters())
                scores = worker.score(clip.sequence, tracks)
                store.add(key, key, {"HOTA": scores["HOTA"], "IDF1": scores["IDF1"]})
            result = store[key]
            # HOTA weighs detection and association alike, IDF1 how long identities are kept.
            cameras.setdefault(clip.camera, []).append((result["HOTA"] + result["IDF1"]) / 2)
        by_value[value] = {camera: statistics.fmean(each) for camera, each in cameras.items()}
    return by_value


def row(decision: Decision, scores: Mapping[float, Mapping[str, float]]) -> list[str]:
    """Summarise one decision."""
    shipped = next(iter(scores))
    # Without the decision is no candidate: it shows what the decision is worth.
    candidates = [value for value in scores if value != decision.without or value == shipped]
    cameras = list(scores[shipped])
    chosen = {camera: best_for_others(scores, candidates, camera) for camera in cameras}
    seen = statistics.fmean(scores[shipped].values())
    left_out = statistics.fmean(scores[value][camera] for camera, value in chosen.items())
    worth = NO_SCORE
    if decision.without is not None:
        worth = f"{seen - statistics.fmean(scores[decision.without].values()):+.1f}"
    values = ", ".join(f"{value:g}" for value in chosen.values())
    return [decision.place, f"{shipped:g}", values, f"{seen:.1f}", f"{left_out:.1f}", worth]


def best_for_others(
    scores: Mapping[float, Mapping[str, float]], values: Sequence[float], camera: str
) -> float:
    """Return the value with the best mean over all other cameras; the first of equal ones."""

    def others(value: float) -> float:
        # With a single camera nothing is left to decide by: the shipped value, which is first.
        each = [score for name, score in scores[value].items() if name != camera]
        return statistics.fmean(each) if each else 0.0

    return max(values, key=others)


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.traffic.fit"))
