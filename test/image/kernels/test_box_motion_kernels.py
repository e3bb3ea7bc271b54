# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Compiled, points of a box move with its vehicle as they do by numpy."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.kernels.interface import load_kernels
from vehicle_pf_tracker.image.motion.box_motion import carried_share, staying

TO_BOX = np.array([[0.02, 0.03], [-1.0, -1.2]])
DRIVEN = np.array([[1.01, 0.99], [0.5, -0.4]])
ROLLED = np.array([[1.0, 0.01], [-0.01, 1.0], [2.0, 1.0]])
NOT_TOLD = np.empty((0, 2))


@pytest.fixture(name="compiled")
def _compiled():
    pytest.importorskip("numba", reason="numba is not installed")
    return load_kernels("numba")


@pytest.mark.parametrize("background", [ROLLED, NOT_TOLD], ids=["a background", "none"])
@pytest.mark.parametrize("spread", [0.3, 1.0, 3.0])
@pytest.mark.parametrize("box", [[[3, 5], [9, 12]], [[0, 0], [24, 24]], [[23, 2], [1, 1]]])
def test_the_carried_share_is_the_same(compiled, background, spread, box):
    """Shares are counts, so that rounding does not show."""
    rng = np.random.default_rng(7)
    cells = np.array(box, np.intp)
    for _ in range(20):
        flow = (rng.normal(size=(96, 96, 2)) * spread + rng.normal(size=2)).astype(np.float32)
        maps = TO_BOX, DRIVEN, background
        assert compiled.carried_share(flow, cells, *maps) == carried_share(flow, cells, *maps)


@pytest.mark.parametrize("spread", [0.02, 0.2])
@pytest.mark.parametrize("living", [0.0, 0.2, 0.9])
def test_the_same_points_stay(compiled, spread, living):
    rng = np.random.default_rng(8)
    for _ in range(20):
        before = rng.uniform(-0.4, 0.4, (64, 2))
        turn = np.eye(2) + 0.1 * rng.normal(size=(2, 2))
        after = before @ turn + rng.normal(size=before.shape) * spread
        alive = rng.random(64) < living
        expected = staying(before, after, alive, 0.2)
        assert np.array_equal(compiled.staying(before, after, alive, 0.2), expected)
