# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The correlation filter: its peak, its limits in space, and its memory."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.correlation.correlation_filter import (
    FIRST_IMAGE,
    CorrelationFilter,
    Schedule,
)
from vehicle_pf_tracker.image.correlation.spectra import PartialFourier, shifted

SIDE = 32
TARGET = np.array([8.0, 6.0])
INSIDE = (slice(None), slice(13, 19), slice(12, 20))
"""The target's cells: eight by six around the middle, which lies between cells 15 and 16."""
WHOLE = PartialFourier(SIDE, slice(SIDE), slice(SIDE))


def features(seed=0, side=SIDE):
    return np.random.default_rng(seed).normal(size=(5, side, side)).astype(np.float32)


def cells_of(made, seed=0):
    """Cells as the filter sees them, faded out."""
    return WHOLE.cells_of(made.spectrum(features(seed)))


def trained(seed=0, first=FIRST_IMAGE):
    made = CorrelationFilter(SIDE, TARGET, 0.1, first)
    made.train(made.spectrum(features(seed)), 0.0)
    return made


def peak(response):
    y, x = np.unravel_index(int(response.argmax()), response.shape)
    return x - response.shape[1] // 2, y - response.shape[0] // 2


def test_the_peak_on_the_training_patch_is_in_its_middle():
    made = trained()
    response = made.respond(made.spectrum(features()))
    assert response.shape == (2 * SIDE, 2 * SIDE)
    assert peak(response) == (0, 0)
    apart = np.abs(np.arange(2 * SIDE) - SIDE) > 4
    assert np.abs(response[apart][:, apart]).max() < 0.4 * response.max()


def test_more_steps_reach_the_least_squares_solution():
    """The system sum_k x_k * g_k = y with 5 x 48 unknowns is solved here directly.

    The usual eight steps with a growing penalty end on the way there: the filter is smoother.
    """
    eight = trained()
    made = trained(first=Schedule(steps=40, growth=1.0))
    cells = cells_of(made)
    columns = [
        np.roll(channel, (SIDE // 2 - row, SIDE // 2 - column), (0, 1)).ravel()
        for channel in cells for row in range(13, 19) for column in range(12, 20)
    ]  # fmt: skip
    offsets = np.arange(SIDE) - SIDE // 2
    sigma = np.sqrt(48) / 16
    label = np.exp(-0.5 * (offsets[:, np.newaxis] ** 2 + offsets**2) / sigma**2)
    matrix = np.column_stack(columns).astype(float)
    solution = np.linalg.lstsq(matrix, label.ravel(), rcond=None)[0]
    least = np.linalg.norm(matrix @ solution - label.ravel())

    def residual(trained_filter):
        weights = trained_filter.weights.target.ravel()
        return np.linalg.norm(matrix @ weights - label.ravel())

    assert residual(made) == pytest.approx(least, rel=1e-3)
    assert least < residual(eight) < 0.7 * np.linalg.norm(label)
    # The upsampled response leaves out the highest frequency, which noise has.
    response = made.respond(made.spectrum(features()))[::2, ::2]
    expected = matrix @ made.weights.target.ravel()
    assert response.ravel() == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize(("x", "y"), [(1, 0), (-3, 2), (0.5, 0), (0, -0.5), (2.5, -1.5)])
def test_the_peak_follows_a_shift_to_half_a_cell(x, y):
    made = trained()
    response = made.respond(shifted(made.spectrum(features()), x, y))
    assert peak(response) == (2 * x, 2 * y)


def test_shifting_a_spectrum_moves_its_cells():
    made = trained()
    spectrum = made.spectrum(features())
    moved = WHOLE.cells_of(shifted(spectrum, 3, -2))
    assert moved == pytest.approx(np.roll(cells_of(made), (-2, 3), (1, 2)), abs=1e-5)


def test_weights_are_zero_outside_the_target():
    """The spectrum that responses are made with is that of the target's cells and zeros."""
    weights = trained().weights
    cells = WHOLE.cells_of(weights.spectrum)
    assert cells[INSIDE] == pytest.approx(weights.target, abs=1e-6)
    assert (np.abs(weights.target).sum(axis=0) > 0).all()
    cells[INSIDE] = 0
    assert np.abs(cells).max() < 1e-6


def test_the_response_in_the_middle_of_a_small_patch_is_that_of_the_large_one():
    """The response leaves out the highest frequency along x."""
    made = trained()
    small = features()[:, 10:22, 10:22]
    whole = float(np.vdot(cells_of(made)[INSIDE], made.weights.target))
    assert made.respond_in_middle(small) == pytest.approx(whole, rel=1e-5)
    assert made.respond_in_middle(small) == pytest.approx(
        float(made.respond(made.spectrum(features()))[SIDE, SIDE]), abs=0.03
    )


def test_great_stiffness_keeps_the_filter_and_none_learns_the_new_patch():
    strangers = {}
    for stiffness in (1e9, 1.0, 0.0):
        made = trained()
        before = made.weights.target.copy()
        made.train(made.spectrum(features(9)), stiffness)
        strangers[stiffness] = np.linalg.norm(made.weights.target - before) / np.linalg.norm(before)
    assert strangers[1e9] < 1e-3
    assert strangers[1e9] < strangers[1.0] < strangers[0.0]


@pytest.mark.parametrize(("x", "y"), [(0, 0), (10, -6), (-14, 15)])
def test_a_wide_patch_shows_the_target_wherever_it_is(x, y):
    made = trained()
    wide = 0.3 * features(4, 64)
    row, column = 16 + y, 16 + x
    wide[:, row : row + SIDE, column : column + SIDE] = cells_of(made)
    response = made.respond_wide(made.wide_spectrum(wide))
    assert response.shape == (128, 128)
    assert peak(response) == (2 * x, 2 * y)


def test_empty_cells_give_a_finite_filter():
    made = CorrelationFilter(SIDE, TARGET, 0.1)
    nothing = made.spectrum(np.zeros((5, SIDE, SIDE), np.float32))
    for stiffness in (0.0, 5.0):
        made.train(nothing, stiffness)
        assert np.array_equal(made.respond(nothing), np.zeros((64, 64)))
