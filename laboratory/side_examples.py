# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Examples for the network that finds the sides of vehicles: boxes drawn around true ones.

Around each true box of a vehicle that is wholly in view, boxes are drawn at random, as far off as a
followed one may be. Their cells are the network's input, and the distances of the vehicle's sides
beyond theirs its target values. The synthetic scenes of the package are examples too, each as a
camera.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from laboratory.stress.footage import find_sequences, open_footage
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.patches.side_network import side_cells
from vehicle_pf_tracker.scenes.catalogue import SCENES, make_scene

DRAWN = 1000
"""Seed of the drawn scenes: none that tests or tables use."""
FRAMES = 40
"""Frames of a sequence that are used, evenly spaced."""
BOXES = 6
"""Boxes that are drawn around the vehicle in each of them."""
SHIFT = 0.2
"""Largest shift of such a box, fraction of its size: what a followed box may be off."""
SCALE = 0.12
"""Standard deviation of the logarithm of its scale: of both axes together, and of each."""
LARGEST = 0.34
"""Bound of that logarithm: within 1.4 times the size."""
FARTHEST = 0.4
"""Distance of a side beyond which a box is not learnt from: it is out of what the network sees."""
INSIDE = 1.0
"""Least distance of a true box from the image's border, px: the border may have cut another one."""
FEWEST = 256
"""Fewest boxes that a network is trained on: one step of the descent."""

_Shot = tuple[Frame, Box]


class Examples(NamedTuple):
    """Boxes that were drawn.

    Attributes
    ----------
    cells : (N, channels, rows, columns) array of float16
        Cells of each box.
    beyond : (N, 4) array
        Distances of the true sides, left, top, right, bottom, fractions of the box's size.
    camera, vehicle : (N,) arrays
        Numbers of the camera and of the sequence.
    names : tuple of str
        Names of the cameras by their numbers.
    """

    cells: npt.NDArray[np.float16]
    beyond: npt.NDArray[np.float32]
    camera: npt.NDArray[np.intp]
    vehicle: npt.NDArray[np.intp]
    names: tuple[str, ...]

    def taken(self, chosen: npt.NDArray[np.bool_]) -> Examples:
        """Take those that are chosen."""
        return self._replace(
            cells=self.cells[chosen],
            beyond=self.beyond[chosen],
            camera=self.camera[chosen],
            vehicle=self.vehicle[chosen],
        )


def collected(locations: Sequence[Path]) -> Examples:
    """Draw boxes around the vehicles of sequences."""
    rng = np.random.default_rng(0)
    kernels = Kernels()
    cameras: dict[str, int] = {}
    drawn: list[tuple[npt.NDArray[np.float16], npt.NDArray[np.float32], int, int]] = []
    for vehicle, (folder, shots) in enumerate(_vehicles(locations)):
        camera = cameras.setdefault(folder, len(cameras))
        for frame, box in shots:
            for centre, size in _drawn(box, rng):
                cells = side_cells(frame, centre, size, kernels).astype(np.float16)
                drawn.append((cells, _beyond(box, centre, size), camera, vehicle))
    near = [one for one in drawn if np.abs(one[1]).max() < FARTHEST]
    if len(near) < FEWEST:
        raise InputError(
            f"there are {len(near)} boxes of vehicles in full view; {FEWEST} are needed"
        )
    cells, beyond, camera_of, vehicle_of = map(np.array, zip(*near, strict=True))
    return Examples(cells, beyond, camera_of, vehicle_of, tuple(cameras))


def _vehicles(locations: Sequence[Path]) -> Iterator[tuple[str, Iterator[_Shot]]]:
    """Camera and shots of each vehicle: of the sequences, and of the scenes that are drawn."""
    for sequence in find_sequences(locations):
        footage = open_footage(sequence.source)
        every = max(len(footage.truth) // FRAMES, 1)
        some = ((footage.truth[at], at) for at in range(0, len(footage.truth), every))
        shots = ((footage.frame(at), truth) for truth, at in some if truth is not None)
        yield sequence.name.rpartition("/")[0] or sequence.name, _in_view(shots)
    for name in SCENES:
        scene = list(make_scene(name, seed=DRAWN).frames())
        every = max(len(scene) // FRAMES, 1)
        yield f"drawn {name}", _in_view((one.frame, one.truth) for one in scene[::every])


def _in_view(shots: Iterable[tuple[Frame, Truth]]) -> Iterator[_Shot]:
    """Frames that show a vehicle whole, and its true box."""
    for frame, truth in shots:
        if truth.occlusion is not Occlusion.NONE:
            continue
        width, height = frame_size(frame)
        box = truth.box
        left, top = box.x - INSIDE, box.y - INSIDE
        right, bottom = box.x + box.width + INSIDE, box.y + box.height + INSIDE
        if left > 0 and top > 0 and right < width and bottom < height:
            yield frame, box


def _drawn(box: Box, rng: np.random.Generator) -> Iterator[tuple[Array, Array]]:
    """Centres and sizes, px, of boxes around a true one."""
    centre = np.array(box.centre)
    size = np.array([box.width, box.height])
    for _ in range(BOXES):
        scale = rng.normal(0, SCALE, 2) + rng.normal(0, SCALE)
        drawn = size * np.exp(np.clip(scale, -LARGEST, LARGEST))
        yield centre + rng.uniform(-SHIFT, SHIFT, 2) * drawn, drawn


def _beyond(box: Box, centre: Array, size: Array) -> npt.NDArray[np.float32]:
    low = np.array([box.x, box.y])
    high = low + np.array([box.width, box.height])
    below = (centre - size / 2 - low) / size
    above = (high - centre - size / 2) / size
    return np.concatenate([below, above]).astype(np.float32)


def by_output(beyond: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Distances (N, 4) of the sides as targets of the network, (2 N, 3)."""
    # Of the image, and of the mirrored one.
    return np.concatenate([beyond[:, [0, 1, 3]], beyond[:, [2, 1, 3]]])
