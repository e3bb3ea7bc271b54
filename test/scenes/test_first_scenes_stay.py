# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The first two scenes look as they were fixed before any tuning: mean levels of twelve tiles."""

import numpy as np
import pytest

from vehicle_pf_tracker.scenes.catalogue import make_scene


@pytest.mark.parametrize(
    ("name", "index", "levels"),
    [
        ("bar", 60, [[167.34, 156.5, 155.36, 168.7], [169.44, 156.36, 153.51, 167.49],
                     [167.09, 154.68, 156.16, 168.8]]),
        ("highway", 100, [[88.24, 93.79, 89.48, 96.42], [107.8, 105.04, 101.96, 111.55],
                          [88.49, 96.25, 89.49, 89.62]]),
    ],
)  # fmt: skip
def test_mean_levels_of_tiles(name, index, levels):
    frame = next(make_scene(name).frames([index])).frame.astype(float)
    tiles = frame.reshape(3, 160, 4, 160, 3).mean(axis=(1, 3, 4))
    np.testing.assert_allclose(tiles, levels, atol=0.01)
