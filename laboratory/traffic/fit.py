# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fit the decisions of `traffic` and of its detectors, and judge each on cameras left out.

    python -m laboratory.traffic.fit CAMERA=FOLDER... --boxes motion -o results/traffic_fit

runs every decision of `decisions` (or those of ``--only``) at each of its values over all
clips that it matters to: folders in MOTChallenge's layout; clips of one camera have the same name
before the equals sign. CAMERA=FOLDER=BOXES gives a clip boxes of its own, ``yolox_nano@.1`` those
of a file of ``det/`` from a score on. The score of a run is the mean of HOTA and IDF1.
``leave_one_camera_out.md`` has for each decision the value that is best for the other cameras, what
it scores on the one left out, the shipped value's score, that without the decision, and what it is
worth: the difference of the last two, with its standard error over the cameras. Runs are kept in
``runs.jsonl``: delete it when the code has changed.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from laboratory.result_store import ResultStore
from laboratory.traffic.camera_clips import read_clip
from laboratory.traffic.decision_table import HEADER, row
from laboratory.traffic.decisions import FITTED_DECISIONS
from laboratory.traffic.trials import scores_of
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.evaluation.traffic.baselines import TrafficWorker
from vehicle_pf_tracker.results.output_files import write_text


def main() -> int:
    """Fit, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("clips", nargs="+", metavar="CAMERA=FOLDER[=BOXES]")
    parser.add_argument("--boxes", default="motion", help="of clips without: motion, or of det/")
    parser.add_argument("--only", action="append", default=[], metavar="PLACE")
    parser.add_argument("-o", "--out", type=Path, required=True)
    args = parser.parse_args()
    clips = [read_clip(text, args.boxes) for text in args.clips]
    decisions = [each for each in FITTED_DECISIONS if not args.only or each.place in args.only]
    if not decisions:
        raise InputError(f"--only names no decision: {', '.join(args.only)}")
    # The others would be as many runs, all as shipped.
    decisions = [each for each in decisions if any(each.matters(clip.boxes) for clip in clips)]
    if not decisions:
        raise InputError("none of these decisions matters with these boxes")
    store = ResultStore(args.out / "runs.jsonl")
    with TrafficWorker() as worker:
        rows = [row(decision, scores_of(decision, clips, store, worker)) for decision in decisions]
    write_text(args.out / "leave_one_camera_out.md", markdown(HEADER, rows))
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.traffic.fit"))
