"""`fusion` on synthetic scenes: the table of docs/fusion.md.

    python -m benchmarks.fusion_scenes

A scene and the tracker on it have the same seed. Seeds from 100 on are for tuning.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial

from benchmarks import fusion_tables as tables
from benchmarks.fusion_runs import Run, run, scene
from vehicle_pf_tracker.core.errors import InputError

SCENES = (
    "bar", "bars", "bus", "cross", "bridge", "shadows", "braking", "turn", "turn_occluded",
    "clear", "illumination", "acceleration", "scale",
)  # fmt: skip
COLUMNS = (
    "RMSE visible, median, px", "on target", *tables.RECOVERIES, *tables.CLAIMS,
)  # fmt: skip


def main() -> int:
    """Run all scenes and print the table; 1 where one is not known."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", nargs="+", default=SCENES, metavar="SCENE")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=2)
    args = parser.parse_args()
    measured = partial(runs_on, seeds=range(args.first_seed, args.first_seed + args.seeds))
    print(tables.header("scene", COLUMNS), flush=True)
    try:
        with ProcessPoolExecutor(args.processes) as pool:
            for name, runs in zip(args.scenes, pool.map(measured, args.scenes), strict=True):
                print(row(name, runs), flush=True)
    except InputError as error:
        print(f"fusion_scenes: {error}", file=sys.stderr)
        return 1
    return 0


def runs_on(name: str, seeds: range) -> list[Run]:
    """Follow the vehicle of one scene, once for each seed."""
    return [run(scene(name, seed), seed) for seed in seeds]


def row(name: str, runs: list[Run]) -> str:
    """Sum up the runs of a scene in a line of the table."""
    cells = [
        tables.spread((one.rmse_px for one in runs), 2, statistics.median),
        tables.spread((one.on_target for one in runs), 2),
        *tables.recoveries(runs),
        *tables.claims(runs),
    ]
    return tables.line([name, *cells])


if __name__ == "__main__":
    sys.exit(main())
