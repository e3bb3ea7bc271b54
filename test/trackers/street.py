# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A street small enough for hundreds of runs: a vehicle drives to the right over noisy asphalt."""

from __future__ import annotations

import itertools

import numpy as np

from vehicle_pf_tracker.core.box import Box

WIDTH, HEIGHT = 200, 120
SPEED = 3.0
START = (20.0, 50.0)
SIZE = (24, 16)


def vehicle():
    """Patch of four colours, so that a histogram tells where its halves are."""
    patch = np.empty((SIZE[1], SIZE[0], 3), np.uint8)
    patch[:8, :12] = (90, 0, 0)
    patch[:8, 12:] = (230, 200, 60)
    patch[8:, :12] = (0, 0, 130)
    patch[8:, 12:] = (240, 240, 240)
    return patch


class Street:
    """Frame `i` is at time `i`; `hidden` is an interval of times without a vehicle in sight."""

    def __init__(self, speed=SPEED, hidden=(10**9, 10**9), seed=0, grey=False):
        self.speed, self.hidden, self.grey = speed, hidden, grey
        asphalt = np.random.default_rng(seed).normal(100, 8, (HEIGHT, WIDTH, 1))
        self._road = np.clip(asphalt, 0, 255).astype(np.uint8).repeat(3, axis=2)

    def box(self, time):
        return Box(START[0] + round(self.speed * time), START[1], *SIZE)

    def frame(self, time):
        frame = self._road.copy()
        box = self.box(time)
        left = int(box.x)
        if not self.hidden[0] <= time < self.hidden[1] and left < WIDTH:
            part = vehicle()[:, : WIDTH - left]
            frame[int(box.y) : int(box.y) + SIZE[1], left : left + part.shape[1]] = part
        if self.grey:
            frame[:] = frame.mean(axis=2, keepdims=True).astype(np.uint8)
        frame.flags.writeable = False
        return frame


def follow(tracker, street, times):
    """Start on the first time, step through the rest; returns the estimates."""
    estimates = [tracker.start(street.frame(times[0]), street.box(times[0]))]
    for before, now in itertools.pairwise(times):
        estimates.append(tracker.step(street.frame(now), float(now - before)))
    return estimates


def error(estimate, street, time):
    """Distance from the true centre in px."""
    x, y = street.box(time).centre
    return float(np.hypot(estimate.position[0] - x, estimate.position[1] - y))
