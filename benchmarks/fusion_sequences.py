"""`fusion` on the nine real sequences: the two tables of docs/fusion.md.

    python -m benchmarks.fusion_sequences ../shared/sequences

The folder holds recordings, or the sequences' own folders, which are imported on the way.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from benchmarks import fusion_tables as tables
from benchmarks.fusion_runs import HELD_OUT, TUNED_ON, Run, find_sequence, run, sequence
from vehicle_pf_tracker.core.errors import InputError

COLUMNS = (
    "on target", "error < 15 px", "RMSE visible, px", *tables.RECOVERIES, *tables.CLAIMS,
)  # fmt: skip


def main() -> int:
    """Run all sequences and print the tables; 1 where one is missing."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--names", nargs="+", default=HELD_OUT + TUNED_ON, metavar="SEQUENCE")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=2)
    args = parser.parse_args()
    measured = partial(runs_on, seeds=range(args.first_seed, args.first_seed + args.seeds))
    parts = {
        "Held out": [name for name in args.names if name in HELD_OUT],
        "Tuned on": [name for name in args.names if name in TUNED_ON],
        "Others": [name for name in args.names if name not in HELD_OUT + TUNED_ON],
    }
    try:
        for title, names in parts.items():
            if names:
                print_table(title, names, args.folder, measured, args.processes)
    except InputError as error:
        print(f"fusion_sequences: {error}", file=sys.stderr)
        return 1
    return 0


def print_table(
    title: str,
    names: Sequence[str],
    folder: Path,
    measured: Callable[[Path], list[Run]],
    processes: int,
) -> None:
    """Run some sequences and print their table."""
    folders = [find_sequence(folder, name) for name in names]
    print(f"{title}:\n\n{tables.header('sequence', COLUMNS)}", flush=True)
    with ProcessPoolExecutor(processes) as pool:
        all_runs = pool.map(measured, folders)
        for name, runs in zip(names, all_runs, strict=True):
            print(row(name, runs), flush=True)
    print(flush=True)


def runs_on(folder: Path, seeds: range) -> list[Run]:
    """Follow the vehicle of one sequence, once for each seed."""
    footage = sequence(folder)
    return [run(footage, seed) for seed in seeds]


def row(name: str, runs: list[Run]) -> str:
    """Sum up the runs of a sequence in a line of the table."""
    cells = [
        tables.spread((one.on_target for one in runs), 2),
        tables.spread((one.close for one in runs), 2),
        tables.spread((one.rmse_px for one in runs), 2),
        *tables.recoveries(runs),
        *tables.claims(runs),
    ]
    return tables.line([name, *cells])


if __name__ == "__main__":
    sys.exit(main())
