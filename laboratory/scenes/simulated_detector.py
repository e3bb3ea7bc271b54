# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Detectors that are simulated: the truth with misses, false alarms, noise and merged boxes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from laboratory.scenes.traffic_scene import VehicleTruth
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.scenes.random_streams import stream

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
    misses, miss_length : float
        Share of free vehicles that are missed, and mean number of frames for which one is.
    false_alarms : float
        Mean number of false alarms per frame.
    noise : float
        Standard deviation of each edge, as a share of the side.
    merges : float
        Share of overlapping pairs that are detected as one.
    """

    misses: float = 0.02
    miss_length: float = 2.0
    false_alarms: float = 0.05
    noise: float = 0.03
    merges: float = 0.0

    def detect(
        self, truths: Sequence[Sequence[VehicleTruth]], size: tuple[int, int], seed: int
    ) -> Array:
        """Simulate the detector on all frames of a scene.

        Parameters
        ----------
        truths : sequence of sequence of VehicleTruth
            Truth of every frame.
        size : (int, int)
            Width and height of the image, px.
        seed : int
            Seed of the detector.

        Returns
        -------
        array, shape (N, 6)
            Frame from 1, left, top, width, height (px), score.
        """
        # By identity, from frame to frame: a miss is a run of frames.
        missed: dict[int, bool] = {}
        rows: list[list[float]] = []
        for frame, now in enumerate(truths, start=1):
            # A stream for each frame: what is drawn in one shifts nothing in the others.
            rng = stream(seed, "detector", frame)
            seen = [vehicle for vehicle in now if _is_detected(vehicle, self, missed, rng)]
            detections = [
                (_noisy(boxes, self.noise, rng), _score(share, rng))
                for boxes, share in _merged(seen, self.merges, rng)
            ]
            detections += [false_alarm(size, rng) for _ in range(rng.poisson(self.false_alarms))]
            rows += [[frame, *box.tolist(), score] for box, score in detections]
        return np.array(rows, dtype=np.float64).reshape(-1, 6)


SIMULATED_DETECTORS: Mapping[str, SimulatedDetector] = {
    "good": SimulatedDetector(),
    "misses": SimulatedDetector(misses=0.25, miss_length=5.0),
    "false_alarms": SimulatedDetector(false_alarms=2.0),
    "noisy": SimulatedDetector(noise=0.1),
    "merged": SimulatedDetector(merges=0.7),
    "poor": SimulatedDetector(
        misses=0.15, miss_length=4.0, false_alarms=0.7, noise=0.07, merges=0.4
    ),
}
"""The simulated detectors by name."""


def _is_detected(
    vehicle: VehicleTruth,
    detector: SimulatedDetector,
    missed: dict[int, bool],
    rng: np.random.Generator,
) -> bool:
    """Decide on one vehicle: misses come in runs, and more often where much of it is hidden."""
    draw = rng.uniform()
    # Two states with chances to change, begin and end. The share of time in the missed one is
    # begin / (begin + end) = misses, and its mean length 1 / end.
    end = 1 / detector.miss_length
    begin = end * detector.misses / (1 - detector.misses)
    was = missed.get(vehicle.identity, False)
    missed[vehicle.identity] = draw > end if was else draw < begin
    share = float(np.clip((vehicle.visible - _BLIND) / (_SURE - _BLIND), 0.0, 1.0))
    inside = vehicle.box.area / vehicle.whole.area
    # Vehicles that the border cuts to less than a quarter are not detected either.
    return not missed[vehicle.identity] and rng.uniform() < share and inside > _BLIND


def _merged(
    seen: list[VehicleTruth], merges: float, rng: np.random.Generator
) -> list[tuple[Array, float]]:
    """Join pairs that overlap, by chance: boxes (left, top, right, bottom), visible shares."""
    groups = [(_corners(vehicle), vehicle.visible) for vehicle in seen]
    if merges == 0:
        return groups
    # A merged box stays at its index: it may overlap a third vehicle.
    index = 0
    while index < len(groups):
        box, visible = groups[index]
        others = [
            number
            for number in range(index + 1, len(groups))
            if (
                np.minimum(box[2:], groups[number][0][2:])
                > np.maximum(box[:2], groups[number][0][:2])
            ).all()
        ]
        if others and rng.uniform() < merges:
            other, seen_of_it = groups.pop(others[0])
            low = np.minimum(box[:2], other[:2])
            high = np.maximum(box[2:], other[2:])
            # As visible as the more visible one: it is what the detector finds.
            groups[index] = np.concatenate([low, high]), max(visible, seen_of_it)
        else:
            index += 1
    return groups


def _corners(vehicle: VehicleTruth) -> Array:
    box = vehicle.box
    return np.array([box.x, box.y, box.x + box.width, box.y + box.height])


def _noisy(corners: Array, noise: float, rng: np.random.Generator) -> Array:
    """Move each edge, and return left, top, width and height."""
    sides = np.tile(corners[2:] - corners[:2], 2)
    moved = corners + noise * sides * rng.standard_normal(4)
    # A box keeps a side of 1 px at least, also where the noise swaps its edges.
    low = np.minimum(moved[:2], moved[2:] - 1)
    high = np.maximum(moved[2:], moved[:2] + 1)
    return np.concatenate([low, high - low])


def _score(visible: float, rng: np.random.Generator) -> float:
    mean = 0.45 + 0.4 * visible  # a free vehicle's 0.85 is that of common detectors
    return float(rng.beta(_CONCENTRATION * mean, _CONCENTRATION * (1 - mean)))


def false_alarm(size: tuple[int, int], rng: np.random.Generator) -> tuple[Array, float]:
    """Place a box of a vehicle's size anywhere."""
    # Around the size of cars in these scenes, which are about 30 px long.
    width = rng.uniform(15, 60)
    height = rng.uniform(10, 30)
    left = rng.uniform(0, size[0] - width)
    top = rng.uniform(0, size[1] - height)
    mean = _FALSE_SCORE
    score = rng.beta(_CONCENTRATION * mean, _CONCENTRATION * (1 - mean))
    return np.array([left, top, width, height]), float(score)
