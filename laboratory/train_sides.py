# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Train the network that tells `fusion` where a vehicle ends (`side_network.py`).

    python -m laboratory.train_sides SEQUENCES... -o side_network.npz [--parts FOLDER]

Around each true box of a vehicle that is wholly in view, boxes are drawn at random, as far off as a
followed one may be; their cells are the network's input, and how far the vehicle's sides are beyond
theirs what it has to tell. Each image counts as seen in a mirror, too. All sequences of one folder
are taken to be of one camera. The package's drawn scenes are learnt from besides, each as a camera.

The cameras are dealt into four parts; of each part the errors of a network that was trained on the
other three are measured, which is how far the one that is written, trained on all of them, is
believed. `--parts` keeps these four, and which cameras each has not seen: `python -m laboratory
stress --side-network` judges `fusion` with them. The same sequences give the same files.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from laboratory.stress.footage import find_sequences, open_footage
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.image.kernels.interface import Kernels
from vehicle_pf_tracker.image.patches.side_network import (
    CELLS,
    CHANNELS,
    SideNetwork,
    mirrored,
    side_cells,
)
from vehicle_pf_tracker.results.output_files import make_folder
from vehicle_pf_tracker.scenes.catalogue import SCENES, make_scene

PROGRAM = "python -m laboratory.train_sides"
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
PARTS = 4
"""Parts that cameras are dealt into."""
HIDDEN = 14
"""Hidden units. With 48 the errors on cameras left out are .003 smaller, with four times the file.
"""
ROUNDS = 12
"""Passes over all boxes."""
BATCH = 256
"""Boxes in each step of the descent."""
RATE = 1e-3
"""Rate of the descent (Adam) at its beginning; it falls to zero as a cosine."""
DECAY = 0.03
"""Decay of the weights, of each rate's step."""
CELLS_KEPT = 0.7
"""Share of the cells' channels that a step sees, so that no single one is relied on."""
UNITS_KEPT = 0.8
"""Share of the hidden units that a step sees."""
SMALL = 0.05
"""Error beyond which the loss grows in proportion and no more as the square: a wrong true box."""
OUTPUTS = ("left or right", "top", "bottom")

_Shot = tuple[Frame, Box]
Weights = tuple[npt.NDArray[np.float32], ...]


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


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog=PROGRAM, description="Train the network for the sides.")
    parser.add_argument("sequences", nargs="+", type=Path, help="sequences with truth, or folders")
    parser.add_argument("-o", "--output", type=Path, required=True, help="file of the network")
    parser.add_argument(
        "--parts", type=Path, metavar="FOLDER", help="where to keep the networks of the four parts"
    )
    args = parser.parse_args(argv)
    return exit_status(lambda: _run(args.sequences, args.output, args.parts), PROGRAM)


def _run(locations: Sequence[Path], output: Path, kept: Path | None) -> int:
    examples = collected(locations)
    part = parts_of(examples.camera)
    networks = [trained(examples.taken(part != number)) for number in range(PARTS)]
    errors = left_out_errors(examples, part, networks)
    bias, noise = deviations(errors, examples.vehicle)
    make_folder(output.parent)
    trained(examples)._replace(noise=noise).write(output)
    if kept is not None:
        make_folder(kept)
        for number, network in enumerate(networks):
            network._replace(noise=noise).write(kept / f"{number}.npz")
        pairs = sorted({*zip(part.tolist(), examples.camera.tolist(), strict=True)})
        lines = [f"{number},{examples.names[camera]}\n" for number, camera in pairs]
        table = "".join(["part,camera\n", *lines])
        (kept / "cameras.csv").write_text(table, encoding="utf-8")
    spread = by_output(examples.beyond).std(axis=0)
    rows = [
        [name, *(f"{value:.3f}" for value in values)]
        for name, *values in zip(OUTPUTS, spread, bias, noise, strict=True)
    ]
    cameras = len(np.unique(examples.camera))
    print(f"{len(examples.camera)} boxes of {cameras} cameras, which are left out in turns.\n")
    print(markdown(["side", "off by", "error's mean by vehicle", "around it"], rows))
    return 0


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
    if len(near) < BATCH:
        raise InputError(
            f"there are {len(near)} boxes of vehicles in full view; {BATCH} are needed"
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
    """Distances (N, 4) of the sides as what the network has to tell, (2 N, 3)."""
    # Of the image, and of the mirrored one.
    return np.concatenate([beyond[:, [0, 1, 3]], beyond[:, [2, 1, 3]]])


def left_out_errors(
    examples: Examples, part: npt.NDArray[np.intp], networks: Sequence[SideNetwork]
) -> npt.NDArray[np.float32]:
    """Errors (N, 4) of networks that the camera of each box had no part in.

    `part` (N,) is the number of the one of `networks` that has not seen it.
    """
    errors = np.zeros_like(examples.beyond)
    for index, number in enumerate(part):
        told = networks[number].beyond(examples.cells[index].astype(np.float32)).ravel()
        errors[index] = examples.beyond[index] - told
    return errors


def parts_of(camera: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Deal cameras into parts, (N,): those with most boxes first, to the part that has fewest."""
    counts = np.bincount(camera)
    parts = np.zeros(len(counts), np.intp)
    total = np.zeros(PARTS)
    for number in np.argsort(-counts, kind="stable"):
        parts[number] = total.argmin()
        total[parts[number]] += counts[number]
    return parts[camera]


def deviations(
    errors: npt.NDArray[np.float32], vehicle: npt.NDArray[np.intp]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Compute the standard deviations of a vehicle's mean error, and of errors around it.

    Each (3,): those of the left and the right side are one.
    """
    groups = [errors[vehicle == number] for number in np.unique(vehicle)]
    means = np.array([(group.mean(axis=0) ** 2) for group in groups]).mean(axis=0)
    around = np.array([group.var(axis=0) for group in groups]).mean(axis=0)
    return _three(means), _three(around)


def _three(variances: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    left, top, right, bottom = variances
    return np.sqrt(np.array([(left + right) / 2, top, bottom], np.float32))


def trained(examples: Examples) -> SideNetwork:
    """Train a network."""
    rng = np.random.default_rng(0)
    mean, spread = _standard(examples.cells)
    # Cameras with many boxes count more, but not in proportion.
    counts = np.bincount(examples.camera)
    weights = 1 / np.sqrt(counts[examples.camera])
    weights /= weights.mean()
    layers = _first_layers(CHANNELS * CELLS**2, rng)
    steps = max(len(weights) // BATCH, 1)
    descent = _descent(layers, ROUNDS * steps)
    for _ in range(ROUNDS):
        order = rng.permutation(len(weights))
        for start in range(0, steps * BATCH, BATCH):
            chosen = np.sort(order[start : start + BATCH])
            cells = (examples.cells[chosen].astype(np.float32) - mean) / spread
            told = examples.beyond[chosen]
            turned = rng.random(len(chosen)) < 0.5
            cells[turned] = mirrored(cells[turned])
            told = np.where(turned[:, np.newaxis], told[:, [2, 1, 3]], told[:, [0, 1, 3]])
            descent(_gradients(layers, cells, told, weights[chosen], rng))
    first, hidden, second, last = layers
    # As weights of the cells themselves, which need no standard then.
    first = first / np.broadcast_to(spread, (CHANNELS, CELLS, CELLS)).reshape(-1, 1)
    middle = np.broadcast_to(mean, (CHANNELS, CELLS, CELLS)).ravel()
    return SideNetwork(first, hidden - middle @ first, second, last, np.zeros(3, np.float32))


def _standard(
    cells: npt.NDArray[np.float16],
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Mean and standard deviation of each channel, (channels, 1, 1)."""
    some = cells[::5].astype(np.float32)
    mean = some.mean(axis=(0, 2, 3), keepdims=True)[0]
    spread = some.std(axis=(0, 2, 3), keepdims=True)[0]
    return mean, spread + np.float32(1e-3)  # a channel may have no spread: footage without colour


def _first_layers(inputs: int, rng: np.random.Generator) -> Weights:
    first = rng.normal(0, 1 / np.sqrt(inputs), (inputs, HIDDEN))
    second = rng.normal(0, 0.1 / np.sqrt(HIDDEN), (HIDDEN, len(OUTPUTS)))
    layers = first, np.zeros(HIDDEN), second, np.zeros(len(OUTPUTS))
    return tuple(layer.astype(np.float32) for layer in layers)


def _gradients(
    layers: Weights,
    cells: npt.NDArray[np.float32],
    told: npt.NDArray[np.float32],
    weights: npt.NDArray[np.float64],
    rng: np.random.Generator,
) -> Weights:
    """Gradients of the loss by all layers, of cells and units of which some are left out."""
    first, hidden, second, last = layers
    flat = cells.reshape(len(cells), -1)
    seen = flat * ((rng.random(flat.shape, np.float32) < CELLS_KEPT) / np.float32(CELLS_KEPT))
    inner = seen @ first + hidden
    kept = (rng.random(inner.shape, np.float32) < UNITS_KEPT) / np.float32(UNITS_KEPT)
    units = np.maximum(inner, 0) * kept
    error = units @ second + last - told
    slope = np.clip(error / SMALL, -1, 1) * (weights[:, np.newaxis] / len(cells))
    slope = slope.astype(np.float32)
    back = (slope @ second.T) * kept * (inner > 0)
    return seen.T @ back, back.sum(axis=0), units.T @ slope, slope.sum(axis=0)


def _descent(layers: Weights, steps: int) -> Callable[[Weights], None]:
    """Return a function that moves the layers, in place, down their gradients.

    Kingma, Ba, "Adam: a method for stochastic optimization" (2015), with its usual constants, and
    weights that decay (Loshchilov, Hutter, 2019).
    """
    means = [np.zeros_like(layer) for layer in layers]
    squares = [np.zeros_like(layer) for layer in layers]
    done = 0

    def step(gradients: Weights) -> None:
        nonlocal done
        done += 1
        rate = RATE * 0.5 * (1 + np.cos(np.pi * done / steps)) * min(1.0, done / 50)
        for index, gradient in enumerate(gradients):
            means[index] += 0.1 * (gradient - means[index])
            squares[index] += 0.001 * (gradient**2 - squares[index])
            height = np.sqrt(squares[index] / (1 - 0.999**done)) + 1e-8
            layers[index][:] -= rate * (means[index] / (1 - 0.9**done)) / height
            if layers[index].ndim == 2:
                layers[index][:] *= np.float32(1 - rate * DECAY)

    return step


if __name__ == "__main__":
    sys.exit(main())
