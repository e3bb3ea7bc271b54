# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images of the benchmarks: a drawn 40x30 px vehicle that drives through 640x480 images."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.windows.window import Positions
from vehicle_pf_tracker.scenes.catalogue import make_scene

FRAME_RATE = 15.0
"""Images per second of the drive, that of the APF paper's video."""
FRAME_SIZES = {"vga": (640, 480), "720p": (1280, 720), "1080p": (1920, 1080)}
"""Width and height in px of the images that traffic cameras send."""
CLOUD_SIGMA = 8.0
"""Spread in px of the particles, that of `pf`'s motion."""


class Drive(NamedTuple):
    """Frames and the vehicle's box in each."""

    frames: tuple[Frame, ...]
    boxes: tuple[Box, ...]


@functools.cache
def drive() -> Drive:
    """Draw the artificial video of the APF paper without its bar: 5 px a frame, a little noise."""
    # Without the bar: a tracker that loses its vehicle would be timed at other work.
    scene = make_scene("bar", seed=1, settings={"width": 0.0})
    shown = list(scene.frames())
    return Drive(tuple(one.frame for one in shown), tuple(one.truth.box for one in shown))


def enlarged(frame: Frame, size: str) -> Frame:
    """Enlarge a frame to one of `FRAME_SIZES`: it is in the top-left corner, mirrored beyond."""
    width, height = FRAME_SIZES[size]
    below = max(height - frame.shape[0], 0)
    beside = max(width - frame.shape[1], 0)
    # In steps, as a mirror image is no larger than what it mirrors.
    while below or beside:
        more = min(below, frame.shape[0]), min(beside, frame.shape[1])
        # Mirrored, and not black: border windows then have as many colours to count.
        frame = np.pad(frame, ((0, more[0]), (0, more[1]), (0, 0)), mode="symmetric")
        below, beside = below - more[0], beside - more[1]
    return frame


def clouds(centre: tuple[float, float], count: int, variety: int = 16) -> list[Positions]:
    """Draw several clouds of `count` particles around `centre`, px."""
    # The same clouds in every run.
    rng = np.random.default_rng(0)
    return [rng.normal(centre, CLOUD_SIGMA, (count, 2)) for _ in range(variety)]
