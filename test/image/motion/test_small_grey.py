# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Frames made small and grey."""

import numpy as np
import pytest

from vehicle_pf_tracker.image.motion.small_grey import small_grey


def test_small_frames_keep_their_size():
    frame = np.random.default_rng(0).integers(0, 256, (24, 32, 3), dtype=np.uint8)
    small = small_grey(frame)
    assert small.zoom == 1
    assert small.image.shape == (24, 32)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [((480, 640), (240, 320)), ((900, 30), (320, 11)), ((2160, 3840), (180, 320))],
)
def test_larger_ones_shrink_to_320_px(shape, expected):
    small = small_grey(np.full((*shape, 3), 77, np.uint8))
    assert small.image.shape == expected
    assert small.zoom == pytest.approx(320 / max(shape))
    assert (small.image == 77).all()


@pytest.mark.parametrize("shape", [(480, 640), (1080, 1920), (1000, 1600)])
def test_a_ramp_stays_where_it_is(shape):
    """Also where rows are left out."""
    ramp = np.linspace(0, 250, shape[0])[:, np.newaxis, np.newaxis]
    small = small_grey(np.broadcast_to(ramp, (*shape, 3)).astype(np.uint8))
    expected = np.linspace(0, 250, len(small.image))
    assert small.image.mean(axis=1) == pytest.approx(expected, abs=1.5)
