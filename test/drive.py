# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A red vehicle that drives over grey noise: quick to make, easy to track."""

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth

PERIOD_NS = 40_000_000
WIDTH, HEIGHT = 96, 64


def stamp_of(index):
    return 1_000_000_000 + index * PERIOD_NS


def box_of(index):
    return Box(8 + 2.0 * index, 24, 16, 12)


def truth_of(index):
    return Truth(stamp_of(index), box_of(index), Occlusion.NONE, 1.0)


def frame_of(index):
    frame = np.random.default_rng(index).integers(90, 120, (HEIGHT, WIDTH, 3), np.uint8)
    left = int(box_of(index).x)
    frame[24:36, left : left + 16] = (200, 30, 30)
    return frame


def drive(count=20):
    return [(stamp_of(index), frame_of(index)) for index in range(count)]
