"""What a frame costs `fusion` and OpenCV's CSRT on real video, in turns: a table of docs/fusion.md.

    python -m benchmarks.fusion_cost ../shared/sequences --baselines .venv-baselines/bin/python

Processor time of the one thread that tracks, of every frame from the second on, hidden ones
included. Let nothing else run.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import cv2

from benchmarks import fusion_tables as tables
from benchmarks.bench.turns import BLOCK, Follower, Own, Theirs
from benchmarks.fusion_runs import find_sequence, sequence
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.evaluation.baselines.client import Baseline

SMALL = ("car_a", "car_e", "cdnet_bridge_total", "cdnet_pole_partial", "white_van", "Suv")
"""Sequences of 320x240 px."""
COLUMNS = (
    "frames", "fusion, median ms", "mean", "slowest", "CSRT, median ms", "mean", "slowest",
    "ratio of medians", "of means",
)  # fmt: skip


def main() -> int:
    """Measure and print the table; 1 where a sequence or the baselines are missing."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--names", nargs="+", default=SMALL, metavar="SEQUENCE")
    parser.add_argument("--passes", type=int, default=2, help="each with a seed of its own")
    parser.add_argument(
        "--baselines", type=Path, help="Python with OpenCV's trackers (make baselines)"
    )
    args = parser.parse_args()
    cv2.setNumThreads(1)
    try:
        folders = [find_sequence(args.folder, name) for name in args.names]
        with Baseline("csrt", args.baselines) as csrt:
            print(tables.header("sequence", COLUMNS), flush=True)
            for folder in folders:
                frames, box = _readable(folder)
                followers: dict[str, Follower] = {
                    "fusion": Own("fusion", size=None),
                    "csrt": Theirs(csrt),
                }
                times = step_times(followers, frames, box, range(args.passes))
                print(row(folder.name, times["fusion"], times["csrt"]), flush=True)
    except InputError as error:
        print(f"fusion_cost: {error}", file=sys.stderr)
        return 1
    return 0


def _readable(folder: Path) -> tuple[list[Frame], Box]:
    """Frames from that of the first truth on, and the box in it."""
    stamped, truth = sequence(folder)
    first = truth[0]
    shown = [frame for stamp, frame in stamped if frame is not None and stamp >= first.stamp_ns]
    return shown, first.box


def step_times(
    followers: Mapping[str, Follower], frames: Sequence[Frame], box: Box, seeds: Sequence[int]
) -> dict[str, list[float]]:
    """Let all follow in turns of `BLOCK` frames; who begins changes from turn to turn.

    Parameters
    ----------
    followers : mapping of str to Follower
        By name.
    frames : sequence of (H, W, 3) arrays
        RGB.
    box : Box
        Of the target in the first of them, px.
    seeds : sequence of int
        One pass for each.

    Returns
    -------
    dict of str to list of float
        CPU seconds of each step of each pass.
    """
    names = list(followers)
    times: dict[str, list[float]] = {name: [] for name in names}
    for seed in seeds:
        for follower in followers.values():
            follower.start(frames[0], box, seed)
        for first in range(1, len(frames), BLOCK):
            turn = first // BLOCK % len(names)
            for name in names[turn:] + names[:turn]:
                times[name] += [followers[name].step(one) for one in frames[first : first + BLOCK]]
    return times


def row(name: str, ours: Sequence[float], baseline: Sequence[float]) -> str:
    """Sum up the seconds of all steps in a line of the table."""
    medians = statistics.median(ours), statistics.median(baseline)
    means = statistics.fmean(ours), statistics.fmean(baseline)
    cells = [
        str(len(ours)),
        *(f"{1e3 * one:.2f}" for one in (medians[0], means[0], max(ours))),
        *(f"{1e3 * one:.2f}" for one in (medians[1], means[1], max(baseline))),
        f"{medians[1] / medians[0]:.1f}",
        f"{means[1] / means[0]:.1f}",
    ]
    return tables.line([name, *cells])


if __name__ == "__main__":
    sys.exit(main())
