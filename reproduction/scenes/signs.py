# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Road signs and lamp posts, which hide the vehicles of the papers' videos."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.scenes.compositing import Colour
from vehicle_pf_tracker.scenes.drive import Drive
from vehicle_pf_tracker.scenes.drive_scenes import hiding_width
from vehicle_pf_tracker.scenes.obstacles import opaque, post
from vehicle_pf_tracker.scenes.random_streams import stream
from vehicle_pf_tracker.scenes.scene import Actor

SIGN_COLOURS: tuple[Colour, ...] = ((28, 92, 60), (30, 66, 130), (196, 160, 40))
"""Green, blue and yellow of motorways, main roads and works."""


def sign_at(drive: Drive, share: float, frames: float) -> list[Actor]:
    """Put up a road sign that hides the target for `frames` frames."""
    middle = drive.x(drive.along(share))
    width = hiding_width(drive, frames)
    height = drive.target.size[1]
    board = width, drive.row - height - 12, drive.row + 0.4 * height + 8
    foot = drive.opposite.rows.stop + 22
    return sign(middle, board, foot, stream(drive.seed, "sign"))


def posts_at(drive: Drive, shares: tuple[float, ...], width: float = 9.0) -> list[Actor]:
    """Put up lamp posts, which hide a part of the target for a moment."""
    foot = drive.opposite.rows.stop + 14
    return [
        actor for share in shares for actor in post(drive.x(drive.along(share)), width, -5, foot)
    ]


def sign(
    middle: float, board: tuple[float, float, float], foot: float, rng: np.random.Generator
) -> list[Actor]:
    """Make a large road sign on two posts.

    Parameters
    ----------
    middle : float
        Middle of the sign on the stage, px.
    board : tuple of float
        Width, top and bottom of its board, px.
    foot : float
        Row of the ground it stands on, px.
    rng : numpy.random.Generator
        Source of its colour and lettering.
    """
    width, top, bottom = board
    posts = [
        actor
        for side in (-0.32, 0.32)
        for actor in post(middle + side * width, 5.0, bottom - 4, foot)
    ]
    rows, columns = round(2 * (bottom - top)), round(2 * width)
    colour = np.tile(np.asarray(SIGN_COLOURS[rng.integers(3)]), (rows, columns, 1))
    colour[3:6, 3:-3] = colour[-6:-3, 3:-3] = 226
    colour[3:-3, 3:6] = colour[3:-3, -6:-3] = 226
    for line in range(14, rows - 18, 22):
        _lettering(colour[line : line + 11, 14 : 14 + int(columns * rng.uniform(0.4, 0.8))], rng)
    return [*posts, opaque(colour, Box(middle - width / 2, top, width, bottom - top))]


def _lettering(area: Array, rng: np.random.Generator) -> None:
    """Write a line of white blocks that look like letters from afar."""
    left = 0
    while left < area.shape[1] - 6:
        width = int(rng.integers(3, 7))
        area[:, left : left + width] = 230
        area[4:7, left + 1 : left + width - 1] = area[0, 0] * 0.5 + 90
        left += width + int(rng.choice((2, 2, 2, 7)))
