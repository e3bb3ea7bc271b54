# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Simulated detectors: truth with misses, false alarms, noise and merged boxes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.scenes.randomness import stream
from vehicle_pf_tracker.scenes.traffic_scene import VehicleTruth

_BLIND, _SURE = 0.25, 0.75
"""Visible shares below which a vehicle is never detected, and above which like a free one."""
_CONCENTRATION = 12.0
"""Concentration of the beta distribution of scores: a standard deviation of about 0.13."""
_FALSE_SCORE = 0.35
"""Mean score of false alarms: some are as high as those of vehicles."""


@dataclass(frozen=True, slots=True)
class SimulatedDetector:
    """A detector.

    Attributes
    ----------
    misses : float
        Share of free vehicles that are missed.
    miss_length : float
        Mean number of frames for which one is missed.
    false_alarms : float
        Mean number of false alarms per frame.
    noise : float
        Standard deviation of each edge, as a share of the side.
    merges : float
        Share of overlapping pairs that are detected as one.
    power, factor : float
        Scores are raised to `power` and multiplied by `factor`.
    """

    misses: float = 0.02
    miss_length: float = 2.0
    false_alarms: float = 0.05
    noise: float = 0.03
    merges: float = 0.0
    power: float = 1.0
    factor: float = 1.0


SIMULATED_DETECTORS: Mapping[str, SimulatedDetector] = MappingProxyType(
    {
        "good": SimulatedDetector(),
        "misses": SimulatedDetector(misses=0.25, miss_length=5.0),
        "false_alarms": SimulatedDetector(false_alarms=2.0),
        "noisy": SimulatedDetector(noise=0.1),
        "merged": SimulatedDetector(merges=0.7),
        "poor": SimulatedDetector(
            misses=0.15, miss_length=4.0, false_alarms=0.7, noise=0.07, merges=0.4
        ),
        "squared": SimulatedDetector(power=2.0),
        "halved": SimulatedDetector(factor=0.5),
    }
)
"""The simulated detectors by name; `squared` and `halved` are `good` with other scores."""


def detect(
    detector: SimulatedDetector,
    truths: Sequence[Sequence[VehicleTruth]],
    size: tuple[int, int],
    seed: int,
) -> Array:
    """Simulate a detector on all frames of a scene.

    Parameters
    ----------
    detector : SimulatedDetector
        What it does wrong.
    truths : sequence of sequence of VehicleTruth
        Truth of every frame.
    size : (int, int)
        Width and height of the image, px.
    seed : int
        Seed; two detectors that differ in scores alone find the same boxes.

    Returns
    -------
    array, shape (N, 6)
        Frame from 1, left, top, width, height (px), score.
    """
    missed: dict[int, bool] = {}
    rows: list[list[float]] = []
    for frame, now in enumerate(truths, start=1):
        rng = stream(seed, "detector", frame)
        seen = [one for one in now if _found(one, detector, missed, rng)]
        found = [(_noisy(boxes, detector.noise, rng), _score(share, rng))
                 for boxes, share in _merged(seen, detector.merges, rng)]  # fmt: skip
        found += [_false_alarm(size, rng) for _ in range(rng.poisson(detector.false_alarms))]
        for box, score in found:
            rows.append([frame, *box.tolist(), detector.factor * score**detector.power])
    return np.array(rows, dtype=np.float64).reshape(-1, 6)


def _found(
    one: VehicleTruth,
    detector: SimulatedDetector,
    missed: dict[int, bool],
    rng: np.random.Generator,
) -> bool:
    """Decide on one vehicle: misses come in runs, and more often where much of it is hidden."""
    draw = rng.uniform()
    end = 1 / detector.miss_length
    begin = end * detector.misses / (1 - detector.misses)
    was = missed.get(one.identity, False)
    missed[one.identity] = draw > end if was else draw < begin
    share = float(np.clip((one.visible - _BLIND) / (_SURE - _BLIND), 0.0, 1.0))
    inside = one.box.area / one.whole.area
    return not missed[one.identity] and rng.uniform() < share and inside > _BLIND


def _merged(
    seen: list[VehicleTruth], merges: float, rng: np.random.Generator
) -> list[tuple[Array, float]]:
    """Join pairs that overlap, by chance: boxes (left, top, right, bottom), visible shares."""
    groups = [(_corners(one), one.visible) for one in seen]
    if merges == 0:
        return groups
    index = 0
    while index < len(groups):
        box, visible = groups[index]
        others = [
            number
            for number in range(index + 1, len(groups))
            if (np.minimum(box[2:], groups[number][0][2:])
                > np.maximum(box[:2], groups[number][0][:2])).all()
        ]  # fmt: skip
        if others and rng.uniform() < merges:
            other, seen_of_it = groups.pop(others[0])
            low, high = np.minimum(box[:2], other[:2]), np.maximum(box[2:], other[2:])
            groups[index] = np.concatenate([low, high]), max(visible, seen_of_it)
        else:
            index += 1
    return groups


def _corners(one: VehicleTruth) -> Array:
    box = one.box
    return np.array([box.x, box.y, box.x + box.width, box.y + box.height])


def _noisy(corners: Array, noise: float, rng: np.random.Generator) -> Array:
    """Move each edge, and return left, top, width and height."""
    sides = np.tile(corners[2:] - corners[:2], 2)
    moved = corners + noise * sides * rng.standard_normal(4)
    low, high = np.minimum(moved[:2], moved[2:] - 1), np.maximum(moved[2:], moved[:2] + 1)
    return np.concatenate([low, high - low])


def _score(visible: float, rng: np.random.Generator) -> float:
    mean = 0.45 + 0.4 * visible  # a free vehicle's 0.85 is that of common detectors
    return float(rng.beta(_CONCENTRATION * mean, _CONCENTRATION * (1 - mean)))


def _false_alarm(size: tuple[int, int], rng: np.random.Generator) -> tuple[Array, float]:
    """Place a box of a vehicle's size anywhere."""
    width, height = rng.uniform(15, 60), rng.uniform(10, 30)
    left, top = rng.uniform(0, size[0] - width), rng.uniform(0, size[1] - height)
    mean = _FALSE_SCORE
    score = rng.beta(_CONCENTRATION * mean, _CONCENTRATION * (1 - mean))
    return np.array([left, top, width, height]), float(score)
