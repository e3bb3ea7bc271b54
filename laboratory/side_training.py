# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Training of the network that finds the sides of vehicles: a descent on examples.

Each image also counts as seen in a mirror, so that the right side is the left one of the mirrored
cells. The same examples give the same weights.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from laboratory.side_examples import Examples
from vehicle_pf_tracker.image.patches.side_network import CELLS, CHANNELS, SideNetwork, mirrored

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
"""Sides that the network's outputs are about."""

Weights = tuple[npt.NDArray[np.float32], ...]


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
            targets = examples.beyond[chosen]
            turned = rng.random(len(chosen)) < 0.5
            cells[turned] = mirrored(cells[turned])
            targets = np.where(turned[:, np.newaxis], targets[:, [2, 1, 3]], targets[:, [0, 1, 3]])
            descent(_gradients(layers, cells, targets, weights[chosen], rng))
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
    targets: npt.NDArray[np.float32],
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
    error = units @ second + last - targets
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
