# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pixels that hold a vehicle while no detection does: the flow of points in its box.

Points of all vehicles are followed in one call. Particles over place and size are weighted by how
well they explain where the points went; their mean and spread are the measurement.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import areas
from vehicle_pf_tracker.image.shared_motion import PointFlow
from vehicle_pf_tracker.trackers.traffic.colours import RIM, ColourBins, similarity
from vehicle_pf_tracker.trackers.traffic.detection_evidence import HALF
from vehicle_pf_tracker.trackers.traffic.track import FEW, Track
from vehicle_pf_tracker.trackers.traffic.vehicle_state import FAR, PIXEL_NOISE, V, X

Grey: TypeAlias = npt.NDArray[np.uint8]

_GRID = 5
"""Points along each side of a box; the fewest that a motion is taken from, and as many as count as
independent: neighbours err together."""
_OUTLIER = math.exp(-(FAR**2) / 2)
"""Likelihood of a point that went elsewhere."""
_SLIP = 0.02
"""Standard deviation, of its size, by which a box grows or slips on its vehicle in a frame."""
_SLIP_PX = 0.3
"""The same in px."""
_CAUTION = 1.5
"""Factor on these deviations: errors of successive frames go the same way and add up."""
_HELD_SHARE = 0.3
"""Least visible share of a vehicle, and share in the image, for pixels to hold it. At a half, and
without the caution, IDF1 by motion falls by three."""
_HELD_FALL = 0.15
"""Fall of the colours' similarity below its usual value above which pixels do not hold it. At .2,
as for vehicles that come back, IDF1 by motion behind the bridge falls by five."""
_FLOW = PointFlow(window=9, levels=2, steps=10, precision=0.03)


@dataclass(frozen=True, slots=True)
class Hold:
    """Measurement of a box by its pixels: edges and their standard deviations (4,), px."""

    edges: Array
    deviations: Array


class PixelHold:
    """Flow between two frames, of points in boxes."""

    def __init__(self) -> None:
        self._before: Grey | None = None
        self._present: Grey | None = None

    def show(self, grey: Grey) -> None:
        """Take the next frame."""
        self._before, self._present = self._present, grey

    def hold(self, tracks: Sequence[Track], colours: ColourBins, normals: Array) -> None:
        """Measure the vehicles among `tracks` that were not detected; see `measure`."""
        held = [
            track
            for track in tracks
            if track.confirmed
            and track.undetected > 0
            and track.unseen < FEW  # later the points lie on what hides it
            and min(track.visible, track.inside) > _HELD_SHARE
        ]
        for track, hold in zip(held, self.measure(held, colours, normals), strict=True):
            if hold is not None:
                track.hold(hold.edges, hold.deviations)

    def measure(
        self, tracks: Sequence[Track], colours: ColourBins, normals: Array
    ) -> list[Hold | None]:
        """Measure vehicles; None for those that their pixels do not show.

        Parameters
        ----------
        tracks : sequence of Track
            Track predicted into this frame.
        colours : ColourBins
            Colours of this frame.
        normals : (P, 3) array
            Standard normal numbers that make the particles.
        """
        before, present = self._before, self._present
        if before is None or present is None or before.shape != present.shape or not tracks:
            return [None] * len(tracks)
        starts = [_uncovered(_points(track.before), track.covers) for track in tracks]
        guesses = [_carried(*pair) for pair in zip(starts, tracks, strict=True)]
        moved = _follow(before, present, np.concatenate(starts), np.concatenate(guesses))
        parts = np.split(moved, np.cumsum([len(one) for one in starts])[:-1])
        return [
            _hold(track, old, new, normals, colours)
            for track, old, new in zip(tracks, starts, parts, strict=True)
        ]


def _hold(track: Track, old: Array, new: Array, normals: Array, colours: ColourBins) -> Hold | None:
    """Weight particles by the flow of one vehicle's points."""
    before, predicted = track.before, track.state.edges
    found = np.isfinite(new[:, 0])
    alive = found & ~_standing(old, new, before, predicted)
    if alive.sum() < max(_GRID, HALF * found.sum()):
        return None
    centre, size = (predicted[:2] + predicted[2:]) / 2, predicted[2:] - predicted[:2]
    relative = (old[alive] - (before[:2] + before[2:]) / 2) * _growth(before, predicted)
    observed = new[alive] - centre
    particles = _particles(track, observed - relative, normals)
    expected = (1 + particles[:, 2])[:, np.newaxis, np.newaxis] * relative
    expected += particles[:, np.newaxis, :2]
    squared = ((observed - expected) ** 2).sum(axis=2) / PIXEL_NOISE**2
    logs = np.log(np.exp(-squared / 2) + _OUTLIER).mean(axis=1)
    logs *= _GRID
    middles = centre + particles[:, :2]
    halves = size * (1 + particles[:, 2:]) / 2
    boxes = np.hstack([middles - halves, middles + halves])
    if (squared[int(np.argmax(logs))] < FAR**2).mean() < HALF:
        return None
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    edges = weights @ boxes
    fall = track.usual_similarity - similarity(
        track.colours, colours.histogram(edges, track.covers)
    )
    if fall > _HELD_FALL:
        return None
    spread = np.sqrt(weights @ (boxes - edges) ** 2)
    sides = np.tile(edges[2:] - edges[:2], 2)
    return Hold(edges, _CAUTION * (np.hypot(spread, _SLIP * sides) + _SLIP_PX))


def _standing(old: Array, new: Array, before: Array, predicted: Array) -> npt.NDArray[np.bool_]:
    """Points that stand while the vehicle drives: they lie on what hides it."""
    drive = (predicted[:2] + predicted[2:] - before[:2] - before[2:]) / 2
    length = float(np.hypot(*drive))
    if length < PIXEL_NOISE:
        return np.zeros(len(old), dtype=np.bool_)
    return np.asarray(np.hypot(*(new - old).T) < HALF * length)


def _particles(track: Track, motions: Array, normals: Array) -> Array:
    """Particles (P, 3): displacement of the centre in px and relative growth.

    Half of them are drawn around the prediction, half around the points' median motion: a
    prediction may be far off.
    """
    covariance = track.state.covariance
    place = np.sqrt([covariance[X, X], covariance[V, V]]) + PIXEL_NOISE
    spread = np.append(place, _SLIP)
    particles = np.asarray(normals * spread)
    particles[::2, :2] = np.median(motions, axis=0) + normals[::2, :2] * PIXEL_NOISE
    return particles


def _follow(before: Grey, present: Grey, old: Array, guess: Array) -> Array:
    """Places (N, 2) of points in the present frame, NaN where they are not found again."""
    if not len(old):
        return np.empty((0, 2))
    # Pixel 0 is centred at 0.5 here and at 0 in OpenCV.
    start, first = (old - 0.5).astype(np.float32), (guess - 0.5).astype(np.float32)
    new, found, error = _FLOW.follow_and_return(before, present, start, first)
    moved = new.astype(np.float64) + 0.5
    moved[~found | (np.abs(error).max(axis=1) > PIXEL_NOISE)] = np.nan
    return moved


def _points(edges: Array) -> Array:
    places = ((np.arange(_GRID) + 0.5) / _GRID - 0.5) * (1 - 2 * RIM)
    x, y = np.meshgrid(places, places)
    middle, size = (edges[:2] + edges[2:]) / 2, edges[2:] - edges[:2]
    return np.asarray(np.column_stack([x.ravel(), y.ravel()]) * size + middle)


def _uncovered(points: Array, covers: Array) -> Array:
    """Points that no nearer box covers."""
    if not len(covers):
        return points
    x, y = points[:, :1], points[:, 1:]
    inside = (x > covers[:, 0]) & (x < covers[:, 2]) & (y > covers[:, 1]) & (y < covers[:, 3])
    return np.asarray(points[~inside.any(axis=1)])


def _carried(points: Array, track: Track) -> Array:
    """Places of points as the prediction has them."""
    before, after = track.before, track.state.edges
    relative = (points - (before[:2] + before[2:]) / 2) * _growth(before, after)
    return np.asarray(relative + (after[:2] + after[2:]) / 2)


def _growth(before: Array, after: Array) -> float:
    """Growth of a box's sides."""
    return float(np.sqrt(areas(after) / areas(before)))
