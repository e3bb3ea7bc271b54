# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fit what a count is worth, and judge its intervals on cameras left out.

    python -m laboratory.count_trust CAMERA=FOLDER=BOXES[,BOXES]... -o results/count_trust

Folders are in MOTChallenge's layout; clips of one camera have the same name before the first
equals sign. BOXES is ``motion``, or a file of ``det/``: ``yolox_nano@.1`` has scores from .1.
A clip is followed once, and counted at 16 lines. ``calibration.md`` has the numbers that are fitted
to all cameras, which `counting.trust` ships; ``left_out.md`` judges each camera by the fit to the
others. Runs are kept in ``runs.jsonl``: delete it when the code has changed.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize
from scipy.special import gammaln

from laboratory.result_store import ResultStore
from laboratory.traffic.camera_clips import cut
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.counting.count_signs import Sign
from vehicle_pf_tracker.counting.trust import Trust
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.evaluation.traffic.case_run import MOTION_SOURCE, follow
from vehicle_pf_tracker.evaluation.traffic.line_counts import LineCount, LineCounts
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence, read_sequence
from vehicle_pf_tracker.results.output_files import write_text
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters

_TRUE = (Sign.SEEN, Sign.VAGUE, Sign.DOUBTED)
_MISSED = (Sign.PASSED, Sign.BROKEN, Sign.UNCONFIRMED, Sign.SEEN, Sign.JOINED)
_START = np.array([4.0, 3.0, 0.0, -1.0, -1.5, -1.5, -4.0, -2.0, -2.5, 0.0])
"""Start of the fit: log odds that crossings are true, logarithms of what is missed for each sign
and without any, and of the spread."""
# Of the log odds: from 73 % to 99.8 % true for two signs, 5 % to 88 % for the third. Of the
# logarithms: from a missed one in 3000 signs to nearly three for each.
_BOUNDS = [(1, 6), (1, 6), (-3, 2), *[(-8, 1)] * 5, (-6, 0), (-2, 2)]
_PRIOR = 1e-3
"""Weight of the squared distance from the start: it decides only what no line tells."""
_ITERATIONS = 25
"""Steps of the fit, after which its likelihood changes by less than a thousandth."""
_IMPOSSIBLE = 1e-9
"""Least likelihood of a line: no single one decides the fit."""


@dataclass(frozen=True, slots=True)
class Clip:
    """A clip of a camera, with the boxes that the tracker is given, and its counts."""

    camera: str
    name: str
    boxes: str
    lines: Sequence[LineCount]


def main() -> int:
    """Follow, fit, judge, and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("clips", nargs="+", metavar="CAMERA=FOLDER=BOXES")
    parser.add_argument("-o", "--out", type=Path, required=True)
    args = parser.parse_args()
    store = ResultStore(args.out / "runs.jsonl")
    clips = [clip for text in args.clips for clip in followed(text, store)]
    fits = []
    judged = []
    # Apart: what a box of a network is worth and what a moving blob is are two things.
    for kind in ("boxes", MOTION_SOURCE):
        own = [clip for clip in clips if (clip.boxes == MOTION_SOURCE) == (kind == MOTION_SOURCE)]
        if own:
            fits.append([kind, *cells(fitted(own))])
            judged += judge(own)
    write_text(args.out / "calibration.md", markdown(CALIBRATION, fits))
    write_text(args.out / "left_out.md", markdown(JUDGED, [*judged_rows(judged)]))
    return 0


def followed(text: str, store: ResultStore) -> list[Clip]:
    """Follow all vehicles of the clips that an argument names.

    Raises
    ------
    InputError
        If it names no camera, or no such boxes.
    """
    camera, _, rest = text.partition("=")
    folder, _, sources = rest.rpartition("=")
    if not folder:
        raise InputError(f"{text} is not CAMERA=FOLDER=BOXES")
    sequence = read_sequence(Path(folder))
    return [
        Clip(camera, sequence.name, boxes, lines_of(sequence, boxes, store))
        for boxes in sources.split(",")
    ]


def lines_of(sequence: TrafficSequence, boxes: str, store: ResultStore) -> list[LineCount]:
    """Return the counts at all lines, of a run now or before."""
    # The tracker's code is not in the key, so that `runs.jsonl` has to be deleted by hand.
    key = f"{sequence.folder.resolve()} {boxes}"
    if key not in store:
        lines = LineCounts(sequence)
        follow(cut(sequence, boxes), TrafficParameters(), lines=lines)
        store.add(key, key, {"lines": [packed(result) for result in lines.results()]})
    return [unpacked(one) for one in store[key]["lines"]]


def packed(one: LineCount) -> list[object]:
    """Return a count as plain values."""
    signs = {sign.value: number for sign, number in one.signs.items()}
    return [one.true, one.counted, list(one.interval), signs]


def unpacked(values: list[Any]) -> LineCount:
    """Return a count that was `packed`."""
    true, counted, (low, high), signs = values
    return LineCount(true, counted, (low, high), {Sign(name): n for name, n in signs.items()})


def trust_of(numbers: Array) -> Trust:
    """Make a calibration of numbers as the fit has them."""
    shares = 1 / (1 + np.exp(-numbers[:3]))
    *missed, unseen, spread = np.exp(numbers[3:]).tolist()
    return Trust(
        dict(zip(_TRUE, shares.tolist(), strict=True)),
        dict(zip(_MISSED, missed, strict=True)),
        unseen,
        spread,
    )


class Likelihood:
    """Likelihood of the true counts at the lines of clips, as arrays, for it is taken often.

    Parameters
    ----------
    clips : sequence of Clip
        The clips.
    """

    def __init__(self, clips: Sequence[Clip]) -> None:
        # Lines of equal counts are one row with their summed weight: the sums below are long.
        weights: dict[tuple[int, tuple[int, ...]], float] = {}
        for clip in clips:
            # Lines of a camera see the same vehicles: as many of other cameras tell more.
            same = sum(len(other.lines) for other in clips if other.camera == clip.camera)
            for line in clip.lines:
                key = line.true, tuple(line.signs.get(sign, 0) for sign in (*_TRUE, *_MISSED))
                # The square root: between lines that are all alike and lines that share nothing.
                weights[key] = weights.get(key, 0.0) + same**-0.5
        counts = np.array([signs for _, signs in weights], dtype=np.float64)
        self._crossings = counts[:, : len(_TRUE)]
        self._signs = counts[:, len(_TRUE) :]
        self._true = np.array([true for true, _ in weights])
        # Means of logarithms, so that `_PRIOR` weighs the same for few and for many clips.
        self._weights = np.array(list(weights.values())) / sum(weights.values())

    def shares(self, numbers: Array) -> Array:
        """Return the probability of each true count."""
        # 1. How many of the counted crossings are true: a sum of one binomial for each sign.
        likely = np.ones((len(self._true), 1))
        for count, odds in zip(self._crossings.T, numbers[:3], strict=True):
            likely = _convolved(likely, _binomials(count[:, np.newaxis], odds))
        # 2. What is left of the true count was missed.
        missed = self._true[:, np.newaxis] - np.arange(likely.shape[1])
        means = self._signs @ np.exp(numbers[3:-2]) + np.exp(numbers[-2])
        # 3. Missed ones as a negative binomial: they may be more scattered than a Poisson number.
        rates = _negative_binomials(np.maximum(missed, 0), means[:, np.newaxis], numbers[-1])
        # 4. Every way to split the true count into counted and missed.
        return np.asarray((likely * rates * (missed >= 0)).sum(axis=1))

    def cost(self, numbers: Array) -> float:
        """Return what the fit makes least."""
        fit = -float(self._weights @ np.log(self.shares(numbers) + _IMPOSSIBLE))
        return fit + _PRIOR * float(((numbers - _START) ** 2).sum())


def _binomials(count: Array, odds: float) -> Array:
    number = np.arange(count.max() + 1)
    # Of numbers beyond the count, which `where` takes out, no logarithm of a negative one.
    rest = np.maximum(count - number, 0)
    ways = gammaln(count + 1) - gammaln(number + 1) - gammaln(rest + 1)
    # In logarithms, where factorials of hundreds do not overflow.
    shares = np.exp(ways + number * odds - count * np.logaddexp(0, odds))
    return np.where(number <= count, shares, 0.0)


def _convolved(first: Array, second: Array) -> Array:
    """Return the distributions of the sums of two numbers, row by row."""
    found = np.zeros((len(first), first.shape[1] + second.shape[1] - 1))
    for number in range(second.shape[1]):
        found[:, number : number + first.shape[1]] += first * second[:, number, np.newaxis]
    return found


def _negative_binomials(number: Array, mean: Array, log_spread: float) -> Array:
    # By mean and size: the variance is mean + mean² / size, so that a spread of 0 is Poisson's.
    size = np.exp(-log_spread)
    ways = gammaln(number + size) - gammaln(size) - gammaln(number + 1)
    logs = ways + size * np.log(size / (size + mean)) + number * np.log(mean / (size + mean))
    return np.asarray(np.exp(logs))


def fitted(clips: Sequence[Clip]) -> Trust:
    """Return the calibration under which the true counts are most likely."""
    options = {"maxiter": _ITERATIONS}
    cost = Likelihood(clips).cost
    found = minimize(cost, _START, method="L-BFGS-B", bounds=_BOUNDS, options=options)
    return trust_of(found.x)


def judge(clips: Sequence[Clip]) -> list[Clip]:
    """Return the clips with the intervals that the fit to the other cameras gives."""
    judged = []
    for camera in dict.fromkeys(clip.camera for clip in clips):
        others = [clip for clip in clips if clip.camera != camera]
        # A single camera is judged by its own fit: better than no table.
        trust = fitted(others or clips)
        for clip in clips:
            if clip.camera == camera:
                lines = [replace(line, interval=trust.interval(line.signs)) for line in clip.lines]
                judged.append(replace(clip, lines=lines))
    return judged


CALIBRATION = ["detector", *(f"true, {one.value}" for one in _TRUE)]
CALIBRATION += [*(f"missed, {one.value}" for one in _MISSED), "unseen", "spread"]
JUDGED = [
    "camera",
    "clip",
    "boxes",
    "lines",
    "true",
    "counted",
    "count exact, %",
    "held, %",
    "width",
]
"""Headings: means over the lines that anything crossed."""


def cells(trust: Trust) -> list[str]:
    """Return a calibration as a row."""
    numbers = [*trust.true.values(), *trust.missed.values(), trust.unseen, trust.spread]
    return [f"{number:.3f}" for number in numbers]


def judged_rows(clips: Sequence[Clip]) -> Iterable[list[str]]:
    """Summarise each clip, motion, boxes, and all."""
    for clip in clips:
        if any(line.is_judged for line in clip.lines):
            yield [clip.camera, clip.name, clip.boxes, *means(clip.lines)]
    for name, own in (
        ("boxes", [clip for clip in clips if clip.boxes != MOTION_SOURCE]),
        ("motion", [clip for clip in clips if clip.boxes == MOTION_SOURCE]),
        ("all", clips),
    ):
        # Over all lines, not over the clips' means: a clip with many vehicles has no more lines.
        lines = [line for clip in own for line in clip.lines]
        if any(line.is_judged for line in lines):
            yield [name, "", "", *means(lines)]


def means(lines: Sequence[LineCount]) -> list[str]:
    """Return the number of lines judged, and their means."""
    judged = [line for line in lines if line.is_judged]
    exact = 100 * np.mean([one.true == one.counted for one in judged])
    held = 100 * np.mean([one.is_held for one in judged])
    width = np.mean([one.interval[1] - one.interval[0] for one in judged])
    true = np.mean([one.true for one in judged])
    counted = np.mean([one.counted for one in judged])
    return [
        str(len(judged)),
        f"{true:.1f}",
        f"{counted:.1f}",
        f"{exact:.0f}",
        f"{held:.0f}",
        f"{width:.1f}",
    ]


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.count_trust"))
