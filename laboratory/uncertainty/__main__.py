# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Calibration of `~/pose_with_covariance` on synthetic scenes: runs, fit, and coverage.

    python -m laboratory.uncertainty run runs/fit --first-seed 1000 --seeds 5
    python -m laboratory.uncertainty fit runs/fit
    python -m laboratory.uncertainty run runs/report --seeds 5
    python -m laboratory.uncertainty report runs/report --docs docs

`fit` writes `vehicle_pf_tracker/trackers/uncertainty_table.py`; `report` the tables and the picture
of docs/road.md. Every scene is run as it is, and with a rough camera or from other views; runs that
are there are kept.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import cv2

from laboratory.scenes import LABORATORY_SCENES
from laboratory.uncertainty.coverage import report
from laboratory.uncertainty.picture import draw
from laboratory.uncertainty.runs import runs_of
from laboratory.uncertainty.table_module import TABLE, fitted_table, licence_comment
from laboratory.uncertainty.tracking import keep_runs
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.results.output_files import write_text
from vehicle_pf_tracker.trackers.registry import VARIANTS


def main() -> int:
    """Do what the arguments say; 1 where a file cannot be read or written."""
    args = _arguments()
    cv2.setNumThreads(1)
    try:
        if args.action == "run":
            seeds = range(args.first_seed, args.first_seed + args.seeds)
            keep_runs(args.folder, args.variants, args.scenes, seeds)
        elif args.action == "fit":
            write_text(args.table, fitted_table(args.folder, licence_comment()))
        else:
            print(report(args.folder), end="")
            if args.docs is not None:
                draw(args.docs / "images" / "uncertainty.png", runs_of(args.folder))
    except InputError as error:
        print(f"uncertainty: {error}", file=sys.stderr)
        return 1
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m laboratory.uncertainty", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("action", choices=("run", "fit", "report"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--variants", nargs="+", default=list(VARIANTS), metavar="VARIANT")
    parser.add_argument(
        "--scenes", nargs="+", default=list(LABORATORY_SCENES), choices=list(LABORATORY_SCENES)
    )
    parser.add_argument("--table", type=Path, default=TABLE, help="file that `fit` writes")
    parser.add_argument("--docs", type=Path, help="folder for images/uncertainty.png")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
