# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Weather, light and transmission in which a scene with many vehicles is seen.

Each condition alters images that are rendered already, so that the truth stays exact. All are
deterministic: the same scene, condition and seed give the same bits in any order of frames.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

import cv2
import numpy as np

from laboratory.scenes.traffic_scene import VehicleTruth
from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.scenes.random_streams import stream

Truths: TypeAlias = Sequence[VehicleTruth]
Condition: TypeAlias = Callable[[Frame, int, Truths, Truths], Frame]
"""Alters the image of a frame, by its index, the truth, and the truth of the next frame."""

_FLAKES, _FLAKE_FALL = 160, (3.0, 9.0)
"""Flakes in view, and their fall in px per frame: near ones are larger and faster."""
_STREAKS, _STREAK_LENGTH = 120, 14
"""Streaks of rain in view, new in each frame, and their length in px: a drop crosses the picture in
less than two exposures."""
_HAZE = 0.25
"""Share of the light that snow and rain scatter into the lens."""
_DUSK = np.array([0.24, 0.26, 0.34])
"""Brightness of dusk in red, green and blue, of the day's: blue light of the sky is left."""
_LAMP = 0.09
"""Radius of a lamp, of the vehicle's width; each has a glare of three times this radius."""
_BEAM = (0.9, 0.5)
"""Semi-axes of the light on the road, across and along, of the vehicle's width."""
_BEAM_LIGHT, _LAMP_LIGHT = 95.0, 215.0
"""Levels of 0 to 255 that the middle of a beam, and a lamp, add."""
_FACING = -0.2
"""Least share of a vehicle's motion that is down the image for its lamps to be seen: those of one
that drives away are not."""
_CROWN = (0.42, 0.28)
"""Width and height of the crown of leaves in the upper left corner, of the image's."""
_LEAF = 5.0
"""Correlation length of leaves, px."""
_SWAY, _GUST = 5.0, 70.0
"""Farthest displacement of leaves, px, and period of a gust, frames."""
_QUALITY = 10
"""Quality of the compression, of JPEG's 100: a stream of few bits, whose blocks flicker."""


def snow(size: tuple[int, int], seed: int) -> Condition:
    """Let flakes fall, which drift, before a hazy scene."""
    width, height = size
    rng = stream(seed, "snow")
    start = rng.uniform((0, 0), (width, height), (_FLAKES, 2))
    near = rng.random(_FLAKES)
    fall = _FLAKE_FALL[0] + near * (_FLAKE_FALL[1] - _FLAKE_FALL[0])
    # Faster flakes, which are nearer, drift faster, too.
    drift = rng.normal(0.6, 0.4, _FLAKES) * fall / 4

    def apply(frame: Frame, index: int, truth: Truths, after: Truths) -> Frame:
        picture = _hazy(frame)
        # Round the image, so that there are always as many flakes in it.
        xs = (start[:, 0] + drift * index) % width
        ys = (start[:, 1] + fall * index) % height
        for x, y, size_of in zip(xs.tolist(), ys.tolist(), (1 + 2 * near).tolist(), strict=True):
            cv2.circle(picture, (int(x), int(y)), int(size_of), (235, 238, 242), cv2.FILLED)
        return picture

    return apply


def rain(size: tuple[int, int], seed: int) -> Condition:
    """Let streaks of rain fall before a hazy scene."""
    width, height = size

    def apply(frame: Frame, index: int, truth: Truths, after: Truths) -> Frame:
        picture = _hazy(frame)
        rng = stream(seed, "rain", index)
        # From a streak's length above the image on, so that some are cut by its border.
        tops = rng.uniform((0, -_STREAK_LENGTH), (width, height), (_STREAKS, 2)).astype(int)
        streaks = np.zeros_like(picture)
        for x, y in tops.tolist():
            cv2.line(streaks, (x, y), (x + 2, y + _STREAK_LENGTH), (70, 72, 75))
        # Added and cut at 255: drops are lit by the sky, and never darken what is behind them.
        return np.asarray(cv2.add(picture, streaks), np.uint8)

    return apply


def dusk(size: tuple[int, int], seed: int) -> Condition:
    """Darken the scene; vehicles have head lights, which shine on the road before them."""

    def apply(frame: Frame, index: int, truth: Truths, after: Truths) -> Frame:
        light = np.zeros(frame.shape[:2])
        # The next frame says where each drives to; one that has no next frame shines straight on.
        later = {one.identity: one.box.centre for one in after}
        for one in truth:
            _shine(light, one, later.get(one.identity, one.box.centre))
        # 3 levels, against 2 by day: the camera's gain is higher in the dark.
        noise = stream(seed, "dusk", index).normal(0, 3.0, frame.shape)
        picture = frame * _DUSK + light[..., None] * (1.0, 0.96, 0.85) + noise
        return np.asarray(np.clip(np.rint(picture), 0, 255), np.uint8)

    return apply


def _shine(light: Array, vehicle: VehicleTruth, to: tuple[float, float]) -> None:
    """Add the light of a vehicle that drives to a centre: on the road, and its lamps in sight."""
    box = vehicle.box
    way = np.array(to) - box.centre
    # A vehicle that stands has no direction; its beam is on its own spot.
    across, down = (way / max(float(np.hypot(*way)), 1e-9)).tolist()
    # At the front bumper: the lower edge of the box of one that comes, higher up for one that goes.
    x, y = box.centre[0] + across * box.width / 2, box.y + box.height * (0.8 + 0.2 * down)
    beam = (x + across * box.width, y + down * box.width / 2)
    _add_spot(light, beam, (_BEAM[0] * box.width, _BEAM[1] * box.width), _BEAM_LIGHT)
    if down < _FACING:
        return
    radius = max(_LAMP * box.width, 1.0)
    # Seen from the side, both lamps are at one place.
    for side in (-0.3, 0.3):
        lamp = (x + side * box.width * abs(down), y - 0.25 * box.height)
        # Lamps are hidden in the same share as their vehicle.
        _add_spot(light, lamp, (radius, radius), _LAMP_LIGHT * vehicle.visible)
        _add_spot(light, lamp, (3 * radius, 3 * radius), _LAMP_LIGHT / 5 * vehicle.visible)


def _add_spot(
    light: Array, centre: tuple[float, float], axes: tuple[float, float], level: float
) -> None:
    """Add a Gaussian spot, as far as it can be seen."""
    # Beyond 2.5 axes it is below 0.2 % of its level: less than a grey level.
    low = [max(int(middle - 2.5 * axis), 0) for middle, axis in zip(centre, axes, strict=True)]
    high = [max(int(middle + 2.5 * axis), 0) for middle, axis in zip(centre, axes, strict=True)]
    part = light[low[1] : high[1], low[0] : high[0]]
    columns = (np.arange(part.shape[1]) + low[0] + 0.5 - centre[0]) / axes[0]
    rows = (np.arange(part.shape[0]) + low[1] + 0.5 - centre[1]) / axes[1]
    # A Gaussian is the product of one along the rows and one along the columns.
    part += level * np.exp(-(rows**2))[:, None] * np.exp(-(columns**2))


def foliage(size: tuple[int, int], seed: int) -> Condition:
    """Hang a crown of leaves into the upper left corner, which sways in gusts."""
    width = int(size[0] * _CROWN[0])
    height = int(size[1] * _CROWN[1])
    rng = stream(seed, "foliage")
    # Twice the sway, so that the displaced picture never reaches the end of the drawn leaves.
    margin = int(2 * _SWAY)
    leaves = rng.normal(size=(height + 2 * margin, width + 2 * margin)).astype(np.float32)
    # Blurred noise is correlated over about twice the blur's deviation.
    leaves = np.asarray(cv2.GaussianBlur(leaves, (0, 0), _LEAF / 2))
    # Of unit deviation, so that the limit below, -0.6, leaves leaves on 73 % of the crown.
    leaves /= leaves.std()
    columns, rows = np.meshgrid(np.arange(width), np.arange(height))
    # A quarter of an ellipse: the tree stands outside of the image.
    inside = (columns / width) ** 2 + (rows / height) ** 2 < 1
    phase = rng.uniform(0, 2 * np.pi, 2)

    def apply(frame: Frame, index: int, truth: Truths, after: Truths) -> Frame:
        gust = 0.5 + 0.5 * np.sin(2 * np.pi * index / _GUST)
        # Periods of 13 and 17 frames, which together repeat after 628.
        bend = (np.sin(0.5 * index + phase[0]), np.sin(0.37 * index + phase[1]))
        # Neighbouring twigs do not move alike.
        wave = np.sin(columns / 23.0 + rows / 31.0 + 0.4 * index)
        map_x = columns + margin + _SWAY * gust * (bend[0] + wave) / 2
        map_y = rows + margin + _SWAY * gust * (bend[1] + wave) / 2
        swaying = cv2.remap(
            leaves, map_x.astype(np.float32), map_y.astype(np.float32), cv2.INTER_LINEAR
        )
        shade = (swaying[..., None] * 26 + 80) * (0.7, 1.0, 0.5)
        covered = (inside & (swaying > -0.6))[..., None]
        picture = frame.copy()
        corner = picture[:height, :width]
        picture[:height, :width] = np.where(covered, np.clip(shade, 0, 255), corner)
        return np.asarray(picture, np.uint8)

    return apply


def compression(size: tuple[int, int], seed: int) -> Condition:
    """Send the images through a stream of few bits."""

    def apply(frame: Frame, index: int, truth: Truths, after: Truths) -> Frame:
        # OpenCV codes blue, green, red: JPEG keeps less of blue than of red.
        picture = cv2.cvtColor(frame, cv2.COLOR_RGB2BGR)
        _, code = cv2.imencode(".jpg", picture, (cv2.IMWRITE_JPEG_QUALITY, _QUALITY))
        received = np.asarray(cv2.imdecode(code, cv2.IMREAD_COLOR))
        return np.asarray(cv2.cvtColor(received, cv2.COLOR_BGR2RGB), np.uint8)

    return apply


def _hazy(frame: Frame) -> Frame:
    # Light that is scattered has the colour of the sky, wherever it comes from.
    grey = np.full_like(frame, 190)
    return np.asarray(cv2.addWeighted(frame, 1 - _HAZE, grey, _HAZE, 0), np.uint8)


CONDITIONS: Mapping[str, Callable[[tuple[int, int], int], Condition]] = {
    "snow": snow,
    "rain": rain,
    "dusk": dusk,
    "foliage": foliage,
    "compression": compression,
}
"""Makers of conditions by name: of the image's size in px, and a seed."""
