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
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from laboratory.covariance_coverage import fitted_table, report, runs_of
from laboratory.coverage_picture import draw
from laboratory.scenes import LABORATORY_SCENES, make_scene
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import SessionParameters, TargetParameters
from vehicle_pf_tracker.parameters.table import from_mapping, specs
from vehicle_pf_tracker.results.output_files import write_text
from vehicle_pf_tracker.scenes.scene import SceneFrame
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant
from vehicle_pf_tracker.trackers.session import Session
from vehicle_pf_tracker.trackers.uncertainty import cloud_covariance

TABLE = Path(__file__).parents[1] / "vehicle_pf_tracker" / "trackers" / "uncertainty_table.py"
CAMERAS: dict[str, dict[str, object]] = {
    "": {},
    "_rough": {"disturbance": "rough"},
    "_going": {"heading": "going", "lens": "barrel"},
    "_mast": {"mount": "mast", "lens": "barrel"},
    "_mast_going": {"mount": "mast", "heading": "going"},
}
"""Settings of a scene, by what they add to its name; the last three are those of `road`."""


def main() -> int:
    """Do what the arguments say; 1 where a file cannot be read or written."""
    args = _arguments()
    cv2.setNumThreads(1)
    try:
        if args.action == "run":
            _run(args)
        elif args.action == "fit":
            write_text(args.table, fitted_table(args.folder, _licence()))
        else:
            print(report(args.folder), end="")
            if args.docs is not None:
                draw(args.docs / "images" / "uncertainty.png", runs_of(args.folder))
    except InputError as error:
        print(f"uncertainty: {error}", file=sys.stderr)
        return 1
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
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


def _licence() -> str:
    lines = TABLE.with_name("estimate.py").read_text(encoding="utf-8").splitlines(keepends=True)
    return "".join(line for line in lines[:14] if line.startswith("#"))


def _run(args: argparse.Namespace) -> None:
    args.folder.mkdir(parents=True, exist_ok=True)
    for seed in range(args.first_seed, args.first_seed + args.seeds):
        for name, addition, settings in _scenes(args.scenes):
            # Asked before the scene is made: one that no run needs is not rendered.
            left = [
                (VARIANTS[one], args.folder / f"{one}.{name}{addition}.{seed}.npy")
                for one in args.variants
                if not (args.folder / f"{one}.{name}{addition}.{seed}.npy").exists()
            ]
            if left:
                # Once for all variants, which so see the very same images.
                frames = list(make_scene(name, seed=seed, settings=settings).frames())
                for variant, path in left:
                    np.save(path, np.array(list(rows_of(variant, frames, seed))))
                print(f"{name}{addition}, seed {seed}", file=sys.stderr, flush=True)


def _scenes(names: Sequence[str]) -> Iterator[tuple[str, str, dict[str, object]]]:
    for name in names:
        known = specs(LABORATORY_SCENES[name].parameters)
        for addition, settings in CAMERAS.items():
            # A scene that does not know a setting has no such view.
            if not settings or all(
                key in known and value in known[key].choices for key, value in settings.items()
            ):
                yield name, addition, settings


def rows_of(variant: Variant, frames: Sequence[SceneFrame], seed: int) -> Iterator[Any]:
    """Track a scene, and give for each frame the numbers of `COVERAGE_COLUMNS`."""
    box = frames[0].truth.box
    target = TargetParameters(box.x, box.y, box.width, box.height)
    session = Session(
        variant,
        from_mapping(variant.parameters, {"seed": seed}),
        SessionParameters(target=target),
    )
    for each in frames:
        estimate = session.feed(each.frame, each.truth.stamp_ns)
        # A target was given, and so there is an estimate from the first frame on.
        assert estimate is not None
        yield _row(estimate, each, session.tracker.frame_period)


def _row(estimate: Estimate, each: SceneFrame, period: float) -> tuple[float, ...]:
    truth = each.truth
    x, y = estimate.position
    true_x, true_y = truth.box.centre
    # Symmetric: the element below the diagonal is left out.
    (xx, xy), (_, yy) = cloud_covariance(estimate)
    return (
        truth.stamp_ns * 1e-9,
        x - true_x,
        y - true_y,
        xx,
        xy,
        yy,
        estimate.box.width,
        estimate.box.height,
        *estimate.velocity,
        period,
        list(Mode).index(estimate.mode),
        estimate.confidence,
        int(truth.occlusion),
    )


if __name__ == "__main__":
    sys.exit(main())
