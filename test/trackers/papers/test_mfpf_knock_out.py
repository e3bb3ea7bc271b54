# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""P2's point: a feature that is knocked out loses its weight, and the others hold the track.

The vehicle is made so that each spoiling takes one feature and leaves another: its stripes differ
in colour but hardly in grey, and its texture is a dither of two levels, too small to make edges or
another colour.
"""

import cv2
import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.trackers.papers.mfpf import MfpfTracker
from vehicle_pf_tracker.trackers.papers.mfpf_parameters import MfpfParameters

SIDE, LEFT, TOP, SPEED = 36, 20, 40, 3
START, FRAMES = 20, 50
ROAD = np.random.default_rng(0).normal(176, 6, (120, 260, 1)).clip(0, 255).astype(np.uint8)


def box(time):
    return Box(LEFT + SPEED * time, TOP, SIDE, SIDE)


def frame(time, dither=2):
    vehicle = np.empty((SIDE, SIDE, 3), np.uint8)
    vehicle[:, :12] = (160, 22, 22)
    vehicle[:, 12:24] = (20, 60, 150)
    vehicle[:, 24:] = (30, 86, 30)
    rows, columns = np.indices((SIDE, SIDE))
    vehicle += ((rows + columns) % 2 * dither).astype(np.uint8)[..., np.newaxis]
    picture = ROAD.repeat(3, axis=2)
    x = LEFT + SPEED * time
    picture[TOP : TOP + SIDE, x : x + SIDE] = vehicle
    return picture


def grey(time):
    return cv2.cvtColor(frame(time), cv2.COLOR_RGB2GRAY)[..., np.newaxis].repeat(3, axis=2)


def shaken(time):
    """Blur along y: level edges fade. (Even blur fades all edges alike, which changes nothing.)"""
    return cv2.blur(frame(time), (1, 9))


def flat(time):
    return frame(time, dither=0)


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize(("spoilt", "name"), [(grey, "color"), (shaken, "edge"), (flat, "texture")])
def test_a_feature_knocked_out_loses_its_weight_and_the_track_survives(spoilt, name, seed):
    tracker = MfpfTracker(MfpfParameters(seed=seed))
    estimates = [tracker.start(frame(0), box(0))]
    estimates += [
        tracker.step(spoilt(time) if time >= START else frame(time)) for time in range(1, FRAMES)
    ]
    factors = np.array([e.similarities[f"wf_{name}"] for e in estimates[1:]])
    assert factors[: START - 1].min() > 0.25
    assert factors[START + 5 :].max() == 0.0
    errors = [np.hypot(*np.subtract(e.position, box(t).centre)) for t, e in enumerate(estimates)]
    assert max(errors) < 10
    assert {e.regime for e in estimates[1:]} == {"estimation"}
