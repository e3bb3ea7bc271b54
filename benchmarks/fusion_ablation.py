"""What each part of `fusion` buys: every part switched off in turn, on what it was not tuned on.

    python -m benchmarks.fusion_ablation ../shared/sequences

Every row runs `fusion` with one switch turned, on three real sequences that took no part in its
making and on synthetic scenes of seeds that did not either.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from pathlib import Path

from benchmarks import fusion_tables as tables
from benchmarks.fusion_runs import HELD_OUT, Footage, Run, find_sequence, run, scene, sequence
from vehicle_pf_tracker.core.errors import InputError

SCENES = ("bridge", "bus")
OFF: dict[str, dict[str, object]] = {
    "all parts": {},
    "no anchor template": {"cues.anchor": False},
    "no following template": {"cues.following": False},
    "no templates": {"cues.anchor": False, "cues.following": False},
    "no colour": {"cues.colour": False},
    "no parts": {"cues.parts": False},
    "no fine alignment": {"cues.alignment": False},
    "fixed weights of cues": {"cues.adaptive": False},
    "no scale": {"motion.scale": False},
    "no camera motion": {"motion.camera": False},
    "no retrospect": {"hiding.retrospect": False},
    "no perspective": {"hiding.projective": False},
    "no drift": {"hiding.drift": False},
    "no gate on the path": {"hiding.gate": False},
    "no background": {"hiding.background": False},
    "no handling of turns": {"hiding.turns": False},
    "no search": {"hiding.search": False},
    "no resampling in a frame": {"resampling_passes": 0},
}
COLUMNS = (
    "on target, real", "RMSE real, px", "clear, real",
    "on target, scenes", "RMSE scenes, px", "recovered", "hidden, scenes",
)  # fmt: skip


def main() -> int:
    """Run all rows and print the table; 1 where a sequence or a scene is missing."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--names", nargs="*", default=HELD_OUT, metavar="SEQUENCE")
    parser.add_argument("--scenes", nargs="*", default=SCENES, metavar="SCENE")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=2)
    args = parser.parse_args()
    seeds = range(args.first_seed, args.first_seed + args.seeds)
    try:
        folders = [find_sequence(args.folder, name) for name in args.names]
        measured = partial(table_row, folders=folders, scenes=args.scenes, seeds=seeds)
        print(tables.header("part", COLUMNS), flush=True)
        with ProcessPoolExecutor(args.processes) as pool:
            for line in pool.map(measured, OFF):
                print(line, flush=True)
    except InputError as error:
        print(f"fusion_ablation: {error}", file=sys.stderr)
        return 1
    return 0


def table_row(part: str, folders: Sequence[Path], scenes: Sequence[str], seeds: range) -> str:
    """Measure with `part` off and return a line of the table."""
    real = [run(_sequence(one), seed, OFF[part]) for one in folders for seed in seeds]
    made = [run(_scene(name, seed), seed, OFF[part]) for name in scenes for seed in seeds]
    return tables.line([part, *cells(real, made)])


def cells(real: Sequence[Run], made: Sequence[Run]) -> list[str]:
    """Sum up the runs on real video and on scenes; either may be empty."""
    return [
        tables.spread((one.on_target for one in real), 3),
        tables.spread((one.rmse_px for one in real), 2),
        tables.spread((one.clear for one in real), 2),
        tables.spread((one.on_target for one in made), 3),
        tables.spread((one.rmse_px for one in made), 2),
        tables.recoveries(made)[0],
        tables.spread((one.hidden for one in made), 2),
    ]


@cache
def _sequence(folder: Path) -> Footage:
    return sequence(folder)


@cache
def _scene(name: str, seed: int) -> Footage:
    return scene(name, seed)


if __name__ == "__main__":
    sys.exit(main())
