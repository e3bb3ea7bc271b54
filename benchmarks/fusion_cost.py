# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Time per step of `fusion` on recordings with truth, beside OpenCV's CSRT, and by image size.

    python -m benchmarks.fusion_cost SEQUENCES -o results/fusion_cost

Both follow each whole sequence from its first true box, in turns of 10 frames; frames in which the
vehicle is hidden or the camera moves count. Times are processor times of the one thread that works.
With ``--resampled``, the first frames of some sequences are resampled to VGA, 1080p and 4K, and
three trackers follow them in turns, frame by frame. ``cost.md`` has both tables, ``cost.json`` the
times of all steps.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import cv2
import numpy as np

from benchmarks.bench.environment import describe
from benchmarks.bench.turns import TURN_FRAMES, Follower, Own, Theirs
from laboratory.stress import find_sequences
from laboratory.stress.footage import StressFootage, open_footage
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.evaluation.baselines import Baseline
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.results.output_files import write_text

SIZES: Mapping[str, tuple[int, int]] = {
    "VGA": (640, 480),
    "1080p": (1920, 1080),
    "4K": (3840, 2160),
}
"""Width and height in px that a sequence is resampled to."""
RESAMPLED_FRAMES = 60
"""Frames of a resampled sequence: two seconds, as the cost of a size does not change with time."""
OURS = "fusion"
"""Name of the variant that is measured."""
CSRT = "csrt"
"""Name of the baseline."""


@dataclass
class Costs:
    """Times of the steps of several trackers on the same frames.

    Attributes
    ----------
    sequence : str
        Name of the sequence.
    size : str
        Width and height of its images, px.
    ms : dict of str to list of float
        Times of the steps of each tracker, ms.
    """

    sequence: str
    size: str
    ms: dict[str, list[float]] = field(default_factory=dict)

    def ratios(self, ours: str, other: str) -> list[float]:
        """Return how many times as long `other` takes: by means, medians, and least times."""
        return [
            theirs / own
            for own, theirs in zip(summary(self.ms[ours]), summary(self.ms[other]), strict=True)
        ]


def summary(times: Sequence[float]) -> tuple[float, float, float]:
    """Mean, median, and the least of some times: other work on the machine adds to the first."""
    return statistics.fmean(times), statistics.median(times), min(times)


def beside_csrt(footage: StressFootage, baseline: Baseline, most_frames: int | None) -> Costs:
    """Follow a sequence with both, in turns."""
    followers: dict[str, Follower] = {OURS: Own(OURS, size=None), CSRT: Theirs(baseline)}
    first = footage.frame(0)
    box = _first_box(footage)
    costs = Costs(footage.source.name, f"{first.shape[1]}x{first.shape[0]}")
    for name, follower in followers.items():
        follower.start(first, box, 0)
        costs.ms[name] = []
    count = min(len(footage.truth), most_frames or len(footage.truth))
    for begin in range(1, count, TURN_FRAMES):
        frames = [footage.frame(index) for index in range(begin, min(begin + TURN_FRAMES, count))]
        turn = begin // TURN_FRAMES % 2
        for name in (OURS, CSRT)[:: -1 if turn else 1]:
            costs.ms[name] += [1e3 * followers[name].step(frame) for frame in frames]
    return costs


def by_image_size(footage: StressFootage) -> Costs:
    """Follow a sequence resampled to each size; each frame is made just before it is shown."""
    box = _first_box(footage)
    followers = {name: Own(OURS, size=None) for name in SIZES}
    costs = Costs(footage.source.name, "", {name: [] for name in SIZES})
    for index in range(min(len(footage.truth), RESAMPLED_FRAMES)):
        frame = footage.frame(index)
        for name, size in SIZES.items():
            shown = _resampled(frame, size)
            if index:
                costs.ms[name].append(1e3 * followers[name].step(shown))
            else:
                across = size[0] / frame.shape[1]
                down = size[1] / frame.shape[0]
                scaled = Box(box.x * across, box.y * down, box.width * across, box.height * down)
                followers[name].start(shown, scaled, 0)
    return costs


def _resampled(frame: Frame, size: tuple[int, int]) -> Frame:
    return np.asarray(cv2.resize(frame, size, interpolation=cv2.INTER_CUBIC), np.uint8)


def _first_box(footage: StressFootage) -> Box:
    truth = footage.truth[0]
    if truth is None:
        raise InputError(f"the first frame of {footage.source.name} has no truth to start on")
    return truth.box


def csrt_table(costs: Sequence[Costs]) -> str:
    """Markdown table of sequences: ours, CSRT's, and how many times as fast."""
    least = ("median", "least")
    ours = ("ours: mean, ms", *least, "slowest")
    header = ("sequence", "image, px", "steps", *ours, "CSRT: mean, ms", *least)
    header += ("times as fast: mean", *least)
    rows = []
    for cost in costs:
        own = cost.ms[OURS]
        cells = [cost.sequence, cost.size, f"{len(own)}"]
        cells += [f"{value:.2f}" for value in summary(own)]
        cells += [f"{max(own):.1f}"]
        cells += [f"{value:.1f}" for value in summary(cost.ms[CSRT])]
        cells += [f"{ratio:.1f}" for ratio in cost.ratios(OURS, CSRT)]
        rows.append(cells)
    return markdown(header, rows)


def size_table(costs: Sequence[Costs]) -> str:
    """Markdown table of image sizes: medians and least, and the ratios to VGA."""
    larger = [name for name in SIZES if name != "VGA"]
    header = ["resampled"]
    header += [f"{name}: median, least, ms" for name in SIZES]
    header += [f"{name} / VGA: median, least" for name in larger]
    rows = []
    for cost in costs:
        medians = {name: statistics.median(times) for name, times in cost.ms.items()}
        least = {name: min(times) for name, times in cost.ms.items()}
        cells = [cost.sequence]
        cells += [f"{medians[name]:.2f}, {least[name]:.2f}" for name in SIZES]
        cells += [
            f"{medians[name] / medians['VGA']:.2f}, {least[name] / least['VGA']:.2f}"
            for name in larger
        ]
        rows.append(cells)
    return markdown(header, rows)


def _chosen(options: argparse.Namespace, names: Sequence[str]) -> Iterator[StressFootage]:
    """Sequences by the ends of their names."""
    for source in find_sequences(options.sequences):
        if any(source.name.endswith(name) for name in names):
            yield open_footage(source.source)


def _measure(options: argparse.Namespace) -> tuple[list[Costs], list[Costs]]:
    beside = []
    sizes = []
    with Baseline(CSRT, options.baselines) as baseline:
        for footage in _chosen(options, options.only):
            beside.append(beside_csrt(footage, baseline, options.frames))
            print(csrt_table(beside[-1:]).splitlines()[-1], flush=True)
    if options.resampled:
        for footage in _chosen(options, options.resampled):
            sizes.append(by_image_size(footage))
            print(size_table(sizes[-1:]).splitlines()[-1], flush=True)
    return beside, sizes


def main() -> int:
    """Measure, and write both tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("sequences", type=Path, help="folder of recordings or frame folders")
    parser.add_argument("--baselines", type=Path, help="interpreter with OpenCV's contrib trackers")
    parser.add_argument("--only", nargs="+", default=[""], metavar="NAME", help="ends of names")
    parser.add_argument("--resampled", nargs="*", default=[], metavar="NAME", help="ends of names")
    parser.add_argument("--frames", type=int, help="most frames of each sequence")
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    cv2.setNumThreads(1)
    environment = describe()
    try:
        beside, sizes = _measure(options)
    except InputError as error:
        print(error, file=sys.stderr)
        return 1
    environment["load_average_at_end"] = round(os.getloadavg()[0], 2)
    options.output.mkdir(parents=True, exist_ok=True)
    text = csrt_table(beside) + ("\n" + size_table(sizes) if sizes else "")
    write_text(options.output / "cost.md", text)
    document = {
        "environment": environment,
        "sequences": [asdict(one) for one in beside],
        "sizes": [asdict(size) for size in sizes],
    }
    write_text(options.output / "cost.json", json.dumps(document, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
