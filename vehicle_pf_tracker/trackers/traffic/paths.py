# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Paths of vehicles through the image: how far, and how straight at constant speed.

A regression of the places of detections on their times, of which only the sums are kept. A time of
standing is one place: what has stood drives off as if it had just come.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel, opposites
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers, Rows, columns

_STANDS_WITHIN = 0.1
"""Distance, of its width, within which a vehicle that stands is detected: boxes of networks shake
by half of it."""
_STANDS_FROM = 15
"""Detections in a row within this distance, half a second of 30 Hz, by which a vehicle stands: one
that is slower than a fifth of its width per second is taken for one that does."""
_BLOCK = 15
"""Detections of a block: the latest one to two tell a drive apart from a stand before it that shook
by more. A choice: as many as tell a stand."""
_STRAIGHT = 0.8
"""Straightness of a drive, above the .75 that a leap between two places that flicker reaches at
most."""


@dataclass(frozen=True, slots=True, eq=False)
class Paths(Rows):
    """Paths of N vehicles.

    Attributes
    ----------
    age : (N,) array
        Nominal periods since each was first seen.
    first : (N, 4) array
        Edges of the first detection, px.
    sums : (N, 8) array
        Sums over the detections since it stood: one, time, its square, x, y, time x, time y, x² +
        y².
    blocks : (N, 16) array
        The same over the latest detections, at most `_BLOCK`, and over as many before these.
    matches : (N,) array
        Number of its detections.
    halt : (N, 2) array
        Place around which the latest detections are, px.
    stood : (N,) array
        Number of these.
    """

    age: Array
    first: Array
    sums: Array
    blocks: Array
    matches: Integers
    halt: Array
    stood: Integers

    @classmethod
    def unknown(cls, count: int) -> Paths:
        """Paths before the first detection."""
        number = np.zeros(count, np.intp)
        edges = np.zeros((count, 4))
        halt = np.zeros((count, 2))
        sums = np.zeros((count, 8))
        blocks = np.zeros((count, 16))
        return cls(np.zeros(count), edges, sums, blocks, number, halt, number)

    @property
    def stands(self) -> Bools:
        """True (N,) where it has stood for a while, up to the latest detection."""
        return np.asarray(self.stood >= _STANDS_FROM)

    def older(self, elapsed: float) -> Paths:
        """Go on by `elapsed` nominal periods."""
        return replace(self, age=self.age + elapsed)

    def added(self, edges: Array) -> Paths:
        """Add a detection of each now, by its edges (N, 4) in px."""
        x, y = _centres(edges).T
        time = self.age
        once = np.ones(len(self))
        terms = columns(once, time, time * time, x, y, time * x, time * y, x * x + y * y)
        here = columns(x, y)
        # Lengths are measured from the first detection, also after a stand: a vehicle that stood
        # and drives on has come as far.
        is_first = self.matches == 0
        first = np.where(is_first[:, np.newaxis], edges, self.first)
        away = np.hypot(*(here - self.halt).T)
        # From the first detection of the stand, not from the latest: a slow drive would creep away.
        stays = (away < _STANDS_WITHIN * (edges[:, 2] - edges[:, 0])) & ~is_first
        stood = np.where(stays, self.stood + 1, 1)
        halt = np.where(stays[:, np.newaxis], self.halt, here)
        # Detections of one place say nothing about the drive that follows, however many they are.
        sums = np.where((stood >= _STANDS_FROM)[:, np.newaxis], 0.0, self.sums) + terms
        is_full = (self.matches % _BLOCK == 0)[:, np.newaxis]
        before = np.where(is_full, self.blocks[:, :8], self.blocks[:, 8:])
        latest = np.where(is_full, 0.0, self.blocks[:, :8]) + terms
        blocks = np.concatenate([latest, before], axis=1)
        return Paths(self.age, first, sums, blocks, self.matches + 1, halt, stood)

    def lengths(self, edges: Array) -> Array:
        """Distance (N,) of boxes (N, 4) from the first detection, in their widths; 0 before it."""
        x, y = (_centres(edges) - _centres(self.first)).T
        width = np.maximum(edges[:, 2] - edges[:, 0], 1.0)
        return np.asarray(np.where(self.matches > 0, np.hypot(x, y) / width, 0.0))

    def shared_lengths(self, edges: Array, measurement: MeasurementModel) -> Array:
        """Distance (N,) that two edges of boxes (N, 4) or more have moved, in widths of the boxes.

        A vehicle takes two with it at least: those of one axis, or the lower one and both sides as
        it grows. Of what stands, and is learnt by and by or changes its form, one edge moves. One
        that the image's border cuts tells nothing, and counts as the opposite one does.
        """
        moved = np.abs(edges - self.first)
        opposite = opposites(moved)
        cut = measurement.cut_edges(edges) | measurement.cut_edges(self.first)
        second = np.sort(np.where(cut, opposite, moved), axis=1)[:, -2]
        width = np.maximum(edges[:, 2] - edges[:, 0], 1.0)
        return np.asarray(np.where(self.matches > 0, second / width, 0.0))

    def evidence(self) -> Array:
        """Logarithm (N,) of how rarely detections that shake in one place are as straight.

        They shake independently, and a drive has constant speed; 0 where they are not straight.
        """
        return _straight(self.sums)

    def latest_evidence(self) -> Array:
        """Evidence (N,) of the latest detections alone: a stand before them is no debt."""
        return _straight(self.blocks[:, :8] + self.blocks[:, 8:])


def _straight(sums: Array) -> Array:
    """Evidence (N,) of `Paths.evidence`, of such sums (N, 8)."""
    count, time, squared, x, y, time_x, time_y, places = sums.T
    # Centred sums: scatter of places, and of times, and what both share.
    known = np.maximum(count, 1.0)
    scatter = places - (x * x + y * y) / known
    duration = squared - time * time / known
    along_x = time_x - time * x / known
    along_y = time_y - time * y / known
    # One place, or one moment, has no line.
    is_told = (scatter > 0) & (duration > 0)
    # Share of their scatter that the drive explains.
    explained = (along_x**2 + along_y**2) / np.where(is_told, duration, 1.0)
    straightness = explained / np.where(is_told, scatter, 1.0)
    is_told &= straightness >= _STRAIGHT
    # The share is distributed as Beta(1, count - 2): two slopes, of twice as many coordinates.
    rest = np.maximum(1 - np.where(is_told, straightness, 0.0), math.ulp(1.0))
    # Its tail is (1 - share)^(count - 2): more detections make the same straightness rarer.
    return np.asarray(np.where(is_told, (2 - count) * np.log(rest), 0.0))


def _centres(edges: Array) -> Array:
    return np.asarray((edges[:, :2] + edges[:, 2:]) / 2)
