"""Maps of how alike a frame is to the target, around a place and at several sizes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.features.region import Region
from vehicle_pf_tracker.features.template import Map
from vehicle_pf_tracker.trackers.estimate import Array

CUES = ("anchor", "following", "colour")


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """What one size looks like.

    Attributes
    ----------
    scale : float
        Size relative to the first box.
    cues : tuple of (h, w) arrays
        Similarity of each window by each cue of `CUES`, at most 1.
    fused : (h, w) array
        Their weighted sum.
    offset : (float, float)
        Centre of the first window in px of the region.
    """

    scale: float
    cues: tuple[Map, ...]
    fused: Map
    offset: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Peak:
    """A place in px of the frame and a size, where the fused similarity is largest."""

    place: tuple[float, float]
    scale: float
    height: float


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """One frame around a place, levels in order of their sizes."""

    region: Region
    levels: tuple[Level, ...]

    def fused(self, positions: Array, scales: Array) -> Array:
        """Fused similarity of particles at `positions` (N, 2) in px, of `scales` (N,)."""
        return self._read(positions, scales, [level.fused for level in self.levels])

    def cue(self, index: int, positions: Array, scales: Array) -> Array:
        """Similarity by one cue, for the same."""
        return self._read(positions, scales, [level.cues[index] for level in self.levels])

    def _read(self, positions: Array, scales: Array, maps: list[Map]) -> Array:
        places = self.region.to_canonical(positions)
        if len(maps) == 1:
            return _interpolate(maps[0], places - np.array(self.levels[0].offset))
        first, step = self.levels[0].scale, self.levels[1].scale / self.levels[0].scale
        index = np.clip(np.log(scales / first) / math.log(step), 0.0, len(maps) - 1.0)
        total = np.zeros(len(places))
        for number, (level, values) in enumerate(zip(self.levels, maps, strict=True)):
            share = np.maximum(1.0 - np.abs(index - number), 0.0)
            total += share * _interpolate(values, places - np.array(level.offset))
        return total

    def peaks(
        self, count: int, around: tuple[float, float], reach: float, apart: float
    ) -> list[Peak]:
        """Find the most alike places, best first.

        Parameters
        ----------
        count : int
            How many at most.
        around : (float, float)
            Where the target is expected, in px.
        reach : float
            Distance from there in px at which a peak counts for `_FAR` less.
        apart : float
            Least distance between two of them, in px of the region.
        """
        found = [
            peak
            for level in self.levels
            for peak in self._peaks(level, count, around, reach, apart)
        ]
        found.sort(key=lambda peak: -peak.height)
        kept: list[Peak] = []
        for peak in found:
            if all(math.dist(peak.place, one.place) * self.region.zoom[0] > apart for one in kept):
                kept.append(peak)
        return kept[:count]

    def _peaks(
        self, level: Level, count: int, around: tuple[float, float], reach: float, apart: float
    ) -> list[Peak]:
        height, width = level.fused.shape
        x, y = self.region.to_canonical(np.asarray(around)) - np.array(level.offset)
        far = ((np.arange(width) - x) ** 2)[np.newaxis] + ((np.arange(height) - y) ** 2)[
            :, np.newaxis
        ]
        heights = level.fused - _FAR * far / (reach * self.region.zoom[0]) ** 2
        side = int(apart) + 1
        found = []
        for _ in range(count):
            row, column = divmod(int(heights.argmax()), width)
            place = self.region.to_frame(np.array([column, row]) + np.array(level.offset))
            top = float(heights[row, column])
            found.append(Peak((float(place[0]), float(place[1])), level.scale, top))
            heights[
                max(row - side, 0) : row + side + 1, max(column - side, 0) : column + side + 1
            ] = -np.inf
        return found


_FAR = 0.1


def _interpolate(values: Map, places: Array) -> Array:
    """Read a map between its entries, at (N, 2) places; beyond them the nearest."""
    height, width = values.shape
    x = np.minimum(np.maximum(places[:, 0], 0.0), width - 1.0)
    y = np.minimum(np.maximum(places[:, 1], 0.0), height - 1.0)
    left, top = (
        np.minimum(x.astype(np.intp), max(width - 2, 0)),
        np.minimum(y.astype(np.intp), max(height - 2, 0)),
    )
    across, down = min(1, width - 1), width * min(1, height - 1)
    u, v = x - left, y - top
    flat, first = values.ravel(), top * width + left
    upper = flat[first] * (1 - u) + flat[first + across] * u
    lower = flat[first + down] * (1 - u) + flat[first + down + across] * u
    return np.asarray(upper * (1 - v) + lower * v, np.float64)
