"""Maps of how alike a frame is to the target, around a place and at several sizes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.image.region import Region
from vehicle_pf_tracker.image.template import Map

Indices = npt.NDArray[np.intp]

CUES = ("anchor", "following", "colour")

_FAR = 0.1
"""What a place at the distance `reach` of the expected one counts less."""
_CLIMB = 3
"""Half side of the windows that the refinement climbs by, px of the region; and their number."""
_CLIMB_SHARPNESS = 40.0
_INSIDE = 1.001
"""Keeps the right and the lower neighbour of every place that is read within the map."""


@dataclass(frozen=True, slots=True)
class Peak:
    """A place in px of the frame and a scale, with the fused similarity there."""

    place: Position
    scale: float
    height: float


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """One frame around a place.

    Attributes
    ----------
    region : Region
        What was looked at.
    scales : (S,) array
        Sizes that were looked for, ascending by a constant factor, relative to the first box.
    cues : (3, S, h, w) array
        Similarity of the window around each pixel of the region by each cue of `CUES`, 0 to 1.
    fused : (S, h, w) array
        Their weighted sum.
    """

    region: Region
    scales: Array
    cues: Map
    fused: Map

    def read(self, maps: Map, positions: Array, scales: Array) -> Array:
        """Read between the entries of maps (..., S, h, w).

        Parameters
        ----------
        positions : (N, 2) array
            In px of the frame; beyond the region nothing is alike.
        scales : (N,) array
            Relative to the first box.

        Returns
        -------
        (..., N) array
        """
        height, width = maps.shape[-2:]
        places = self.region.to_canonical(positions) - 0.5
        if len(self.scales) == 1:
            values = _bilinear(maps, np.zeros(len(places), np.intp), places)
        else:
            steps = len(self.scales) - 1
            index = np.log(scales / self.scales[0]) * (steps / self._range)
            index = np.minimum(np.maximum(index, 0.0), steps)
            below = np.minimum(index.astype(np.intp), steps - 1)
            part = index - below
            values = _bilinear(maps, below, places) * (1 - part)
            values += _bilinear(maps, below + 1, places) * part
        middle = np.array([width / 2, height / 2])
        beyond = (np.abs(places - (middle - 0.5)) > middle).any(axis=1)
        return np.where(beyond, 0.0, values)

    @property
    def _range(self) -> float:
        """Logarithm of the largest scale over the smallest."""
        return math.log(self.scales[-1] / self.scales[0])

    def refine(self, place: Position, scale: float) -> Position:
        """Climb from `place` (px) to the nearest peak of the map for `scale` by mean shift."""
        fused = self.fused[int(np.argmin(np.abs(np.log(self.scales / scale))))]
        u, v = self.region.to_canonical(np.asarray(place)).tolist()
        for _ in range(_CLIMB):
            left, top = max(int(u) - _CLIMB, 0), max(int(v) - _CLIMB, 0)
            around = fused[top : int(v) + _CLIMB + 1, left : int(u) + _CLIMB + 1]
            if min(around.shape) < _CLIMB:
                break
            weights = np.exp(_CLIMB_SHARPNESS * (around - around.max()))
            columns, rows = weights.sum(axis=0), weights.sum(axis=1)
            total = float(rows.sum())
            u = left + 0.5 + float(columns @ np.arange(len(columns))) / total
            v = top + 0.5 + float(rows @ np.arange(len(rows))) / total
        x, y = self.region.to_frame(np.array([u, v])).tolist()
        return x, y

    def best(self, expected: Position, reach: float, frame_size: tuple[int, int]) -> Peak:
        """Find the most alike place in the image.

        Parameters
        ----------
        expected : (float, float)
            Where the target should be, px.
        reach : float
            Distance from there at which a place counts for `_FAR` less, px.
        frame_size : (int, int)
            Width and height of the image, px.
        """
        _, height, width = self.fused.shape
        x = self.region.origin[0] + (np.arange(width) + 0.5) / self.region.zoom[0]
        y = self.region.origin[1] + (np.arange(height) + 0.5) / self.region.zoom[1]
        away_x = np.where((x < 0) | (x >= frame_size[0]), np.inf, (x - expected[0]) ** 2)
        away_y = np.where((y < 0) | (y >= frame_size[1]), np.inf, (y - expected[1]) ** 2)
        away = away_x[np.newaxis] + away_y[:, np.newaxis]
        heights = self.fused - _FAR * away / max(reach, 1.0) ** 2
        level, row, column = np.unravel_index(int(heights.argmax()), heights.shape)
        place = float(x[column]), float(y[row])
        return Peak(place, float(self.scales[level]), float(heights[level, row, column]))


def _bilinear(maps: Map, levels: Indices, places: Array) -> Array:
    """Read maps (..., S, h, w) at `levels` (N,) and places (N, 2); beyond them the nearest."""
    height, width = maps.shape[-2:]
    x = np.minimum(np.maximum(places[:, 0], 0.0), width - _INSIDE)
    y = np.minimum(np.maximum(places[:, 1], 0.0), height - _INSIDE)
    left, top = x.astype(np.intp), y.astype(np.intp)
    u, v = x - left, y - top
    flat = maps.reshape(*maps.shape[:-3], -1)
    first = (levels * height + top) * width + left
    upper = flat[..., first] * (1 - u) + flat[..., first + 1] * u
    lower = flat[..., first + width] * (1 - u) + flat[..., first + width + 1] * u
    return np.asarray(upper * (1 - v) + lower * v)
