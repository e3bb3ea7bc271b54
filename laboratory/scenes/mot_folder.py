# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Scenes with many vehicles as folders in MOTChallenge's layout, with simulated detectors.

A simulated detector gives the truth with misses, false alarms, noise and merged boxes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from laboratory.scenes.conditions import Condition
from laboratory.scenes.traffic_scene import TrafficScene, VehicleTruth
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import whole_folder
from vehicle_pf_tracker.image.compressed_image import jpeg
from vehicle_pf_tracker.scenes.random_streams import stream

_BLIND, _SURE = 0.25, 0.75
"""Visible shares below which a vehicle is never detected, and above which like a free one."""
_CONCENTRATION = 12.0
"""Concentration of the beta distribution of scores: a standard deviation of about 0.13."""
_FALSE_SCORE = 0.35
"""Mean score of false alarms: some are as high as those of vehicles."""


LEAST_SIDE = 8.0
"""Sides of a box inside the image, px, below which a vehicle has no truth but is ignored."""


# By whom each vehicle is hidden: `hidden_by` is an id, `scene` or empty; `share` is its part.
OCCLUDERS_HEADER = "frame,id,depth,hidden_by,share"


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
            seen = [one for one in now if _found(one, self, missed, rng)]
            found = [(_noisy(boxes, self.noise, rng), _score(share, rng))
                     for boxes, share in _merged(seen, self.merges, rng)]  # fmt: skip
            found += [false_alarm(size, rng) for _ in range(rng.poisson(self.false_alarms))]
            rows += [[frame, *box.tolist(), score] for box, score in found]
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


def _found(
    one: VehicleTruth,
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
    was = missed.get(one.identity, False)
    missed[one.identity] = draw > end if was else draw < begin
    share = float(np.clip((one.visible - _BLIND) / (_SURE - _BLIND), 0.0, 1.0))
    inside = one.box.area / one.whole.area
    # Vehicles that the border cuts to less than a quarter are not detected either.
    return not missed[one.identity] and rng.uniform() < share and inside > _BLIND


def _merged(
    seen: list[VehicleTruth], merges: float, rng: np.random.Generator
) -> list[tuple[Array, float]]:
    """Join pairs that overlap, by chance: boxes (left, top, right, bottom), visible shares."""
    groups = [(_corners(one), one.visible) for one in seen]
    if merges == 0:
        return groups
    # A merged box stays at its index: it may overlap a third vehicle.
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
            low = np.minimum(box[:2], other[:2])
            high = np.maximum(box[2:], other[2:])
            # As visible as the more visible one: it is what the detector finds.
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


def write_mot_folder(
    scene: TrafficScene,
    folder: Path,
    seed: int,
    progress: Callable[[int, int], None] = lambda number, total: None,
    detectors: Mapping[str, SimulatedDetector] = SIMULATED_DETECTORS,
    condition: Condition | None = None,
    every: int = 1,
) -> None:
    """Render `scene` with its truth and simulated detectors into `folder`.

    The folder appears when it is whole.

    Parameters
    ----------
    scene : TrafficScene
        Scene to render.
    folder : Path
        New or empty folder.
    seed : int
        Seed of the detectors.
    progress : callable
        Called with the number of frames done and of all.
    detectors : mapping of str to SimulatedDetector
        Detectors by name.
    condition : Condition or None
        Weather or light in which the scene is seen.
    every : int
        Only each of so many frames is kept, at as much lower a rate.

    Raises
    ------
    InputError
        If the folder is not empty, or cannot be written.
    """
    try:
        if folder.exists() and any(folder.iterdir()):
            raise InputError(f"{folder} is not empty; choose another folder")
        with whole_folder(folder) as partial:
            for name in ("img1", "gt", "det"):
                (partial / name).mkdir()
            truths = []
            for index, (frame, truth) in enumerate(scene.frames()):
                progress(index + 1, scene.frame_count)
                # All frames are rendered: the scene's random streams go by their number.
                if index % every:
                    continue
                truths.append(truth)
                picture = frame
                if condition is not None:
                    # Lamps shine where a vehicle drives to, which the next frame says.
                    after = scene.truth(min(index + 1, scene.frame_count - 1))
                    picture = condition(frame, index, truth, after)
                (partial / "img1" / f"{len(truths):06d}.jpg").write_bytes(jpeg(picture))
            name = folder.resolve().name
            (partial / "seqinfo.ini").write_text(_information(scene, name, every))
            _write_tables(scene, truths, partial, seed, detectors)
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror}") from error


def _information(scene: TrafficScene, name: str, every: int) -> str:
    count = -(-scene.frame_count // every)  # rounded up: the first frame is always kept
    return (
        f"[Sequence]\nname={name}\nimDir=img1\nframeRate={scene.frame_rate / every:g}\n"
        f"seqLength={count}\nimWidth={scene.width}\nimHeight={scene.height}\n"
        "imExt=.jpg\n"
    )


def _write_tables(
    scene: TrafficScene,
    truths: Sequence[Sequence[VehicleTruth]],
    folder: Path,
    seed: int,
    detectors: Mapping[str, SimulatedDetector],
) -> None:
    boxes = [(frame, one) for frame, now in enumerate(truths, start=1) for one in now]
    judged = [pair for pair in boxes if _is_judged(pair[1])]
    ignored = (_ignored(*pair) for pair in boxes if not _is_judged(pair[1]))
    occluders = (_occluder(*pair) for pair in judged)
    _write(folder / "gt" / "gt.txt", (_truth(*pair) for pair in judged))
    _write(folder / "gt" / "occluders.csv", (OCCLUDERS_HEADER, *occluders))
    _write(folder / "ignore.txt", ignored)
    for name, detector in detectors.items():
        found = detector.detect(truths, (scene.width, scene.height), seed)
        _write(folder / "det" / f"{name}.txt", map(_detection, found))


def _truth(frame: int, one: VehicleTruth) -> str:
    """Return the row of `gt.txt`: a vehicle of class 1, and how much of it is visible."""
    box = one.box
    place = f"{box.x:.2f},{box.y:.2f},{box.width:.2f},{box.height:.2f}"
    return f"{frame},{one.identity},{place},1,1,{one.visible:.3f}"


def _occluder(frame: int, one: VehicleTruth) -> str:
    """Return the row of `occluders.csv`."""
    hidden_by = "" if one.hidden_by is None else one.hidden_by
    return f"{frame},{one.identity},{one.depth},{hidden_by},{one.hidden_share:.3f}"


def _is_judged(one: VehicleTruth) -> bool:
    return min(one.box.width, one.box.height) >= LEAST_SIDE


def _ignored(frame: int, one: VehicleTruth) -> str:
    # A margin for boxes that are not tight: a strip of 2 px is not to be hit exactly.
    box = one.box
    margin = LEAST_SIDE
    sides = box.width + 2 * margin, box.height + 2 * margin
    place = f"{box.x - margin:.2f},{box.y - margin:.2f},{sides[0]:.2f},{sides[1]:.2f}"
    return f"{frame},{place},vehicle {one.identity} at the border"


def _detection(row: Array) -> str:
    frame, *box, score = row.tolist()
    return f"{frame:.0f},-1,{','.join(f'{side:.2f}' for side in box)},{score:.4f},-1,-1,-1"


def _write(path: Path, rows: Iterable[str]) -> None:
    path.write_text("".join(f"{row}\n" for row in rows))
