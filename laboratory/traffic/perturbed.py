# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`traffic` and the baselines on detections made worse, as `evaluate --traffic` compares them.

``python -m laboratory.traffic.perturbed FOLDER… -o DIR`` with folders in MOTChallenge's layout.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import MappingProxyType

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.evaluation.traffic.baselines import TrafficWorker
from vehicle_pf_tracker.evaluation.traffic.comparison import compare
from vehicle_pf_tracker.evaluation.traffic.comparison_report import write_traffic_report
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters

DROPPED = 0.2
"""Share of detections that `dropped` leaves out: a fifth, which tracks have to bridge. A choice."""
_SEED = 20
"""Seed of what is left out: the same for every system."""
_PERIOD, _FIRST = 200, 100
"""Frames from one gap to the next, and the first gap's first frame: the tracks before it are old
enough, and a clip of 820 frames has four gaps."""


def _dropped(rows: Array) -> Array:
    # By its own generator: every detector and scene loses rows of the same numbers.
    kept: Array = rows[np.random.default_rng(_SEED).uniform(size=len(rows)) >= DROPPED]
    return kept


def _with_gaps(length: int, rows: Array) -> Array:
    # Nothing is missing before the first gap.
    late = rows[:, 0] - _FIRST
    kept: Array = rows[(late < 0) | (late % _PERIOD >= length)]
    return kept


PERTURBATIONS: Mapping[str, Callable[[Array], Array]] = MappingProxyType(
    {
        "dropped": _dropped,
        "gap20": partial(_with_gaps, 20),
        "gap40": partial(_with_gaps, 40),
        # Other scores in the same order: what a threshold that is fixed makes of them.
        "squared": lambda rows: np.column_stack([rows[:, :5], rows[:, 5] ** 2]),
        "halved": lambda rows: np.column_stack([rows[:, :5], rows[:, 5] / 2]),
    }
)
"""A fifth of the detections dropped; 20 and 40 of every 200 frames without any; other scores.

Each takes rows (frame, left, top, width, height, score) and returns others."""


def perturbed(sequence: TrafficSequence) -> TrafficSequence:
    """Add every detector's boxes made worse, as ``detector, perturbation``."""
    worse = {
        f"{source}, {name}": change(rows)
        for source, rows in sequence.detections.items()
        for name, change in PERTURBATIONS.items()
    }
    return replace(sequence, detections={**sequence.detections, **worse})


def main() -> int:
    """Compare all systems, and write the report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=Path, help="scenes in MOTChallenge's layout")
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--seeds", type=int, default=1, help="runs of `traffic`")
    args = parser.parse_args()
    scenes = [perturbed(read_sequence(folder)) for folder in args.folders]
    cases = [(scene, source) for scene in scenes for source in scene.detections]
    with TrafficWorker() as worker:
        results = list(compare(cases, worker, TrafficParameters(), range(args.seeds)))
        write_traffic_report(results, args.output, {"command": sys.argv, **worker.versions})
    print(f"the report is {args.output / 'traffic.md'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
