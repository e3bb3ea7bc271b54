# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pixels that hold a vehicle while no detection does: the flow of points in its box.

Points of all vehicles are followed in one call. Particles over place and size are weighted by how
well they explain where the points went; their mean and spread are the measurement.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import NO_BOXES, areas
from vehicle_pf_tracker.image.motion.point_flow import PointFlow
from vehicle_pf_tracker.trackers.traffic.colours import BACKGROUND_RIM, similarities
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers
from vehicle_pf_tracker.trackers.traffic.state import Grey, State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Sights, Tracks
from vehicle_pf_tracker.trackers.traffic.vehicle_state import PIXEL_NOISE, V, X

_GRID = 5
"""Points along each side of a box, a choice; the fewest that a motion is taken from, and as many as
count as independent: neighbours err together."""
_ASTRAY = 3.0
"""Standard deviations beyond which a point went elsewhere: one in 90 is as far, in two
directions."""
_OUTLIER = math.exp(-(_ASTRAY**2) / 2)
"""Likelihood of a point that went elsewhere, of that at the centre: as far as `_ASTRAY` both are
alike, and farther the distance no longer counts."""
_MOST_ALIVE, _MOST_AGREE = 0.5, 0.5
"""Least share of the points found again that drive, and of these that agree with a box: most of
them."""
_STANDS = 0.5
"""Share of the predicted way below which a point does not drive: nearer to standing than to
driving."""
_SLIP = 0.02
"""Standard deviation, of its size, by which a box grows or slips on its vehicle in a frame. A
choice, less than the .05 of a detector's edge: what a hold knows it has from the frame before."""
_SLIP_PX = 0.3
"""That deviation's part in px, less than a point's noise, as many are averaged. At half of slip and
caution HOTA / IDF1 of `brief` fall by 1.6 / 4.2."""
_CAUTION = 1.5
"""Factor on these deviations: errors of successive frames go the same way and add up."""
_HELD_SHARE = 0.3
"""Least visible share of a vehicle, and share in the image, for pixels to hold it. At a half, and
without the caution, IDF1 by motion falls by three."""
_HELD_FOR = 4.0
"""Nominal periods since a vehicle was seen from which its points lie on what hides it. A choice:
each hold begins them anew, so that holding ends only where it failed all the time."""
_HELD_FALL = 0.15
"""Fall of the colours' similarity below its usual value above which pixels do not hold it. At .2,
as for vehicles that come back, IDF1 by motion behind the bridge falls by five."""
# A small window and one halving: the prediction is the guess, and distant vehicles are small.
_FLOW = PointFlow(window=9, levels=2, steps=10, precision=0.03)


def hold(state: State, step: Step) -> State:
    """Measure vehicles that were not detected by their pixels; and keep the frame for the next."""
    tracks = state.tracks
    absences = state.tracks.sights.absences
    part = np.minimum(tracks.sights.visible, tracks.sights.inside)
    held = tracks.confirmed & ~tracks.detected & (absences.unseen < _HELD_FOR)
    # Either bound alone: what covers it and what the border cuts may be the same pixels.
    held &= part > _HELD_SHARE
    if step.parameters.pixels and state.grey is not None and held.any():
        tracks = _held(tracks, np.flatnonzero(held), state.grey, step)
    # Held or not: the next frame's points start in this one.
    return state._replace(tracks=tracks, grey=step.grey)


def _held(tracks: Tracks, rows: Integers, before: Grey, step: Step) -> Tracks:
    """Correct the vehicles at `rows` by what their pixels show."""
    kept, edges, spreads = measure(tracks.take(rows), before, step)
    rows = rows[kept]
    if not len(rows):
        return tracks
    gaussians = tracks.drives.gaussians
    measured = gaussians.take(rows).measured(edges, spreads)
    drives = replace(tracks.drives, gaussians=gaussians.put(rows, measured))
    unseen = tracks.sights.absences.unseen.copy()
    # Seen, but not detected: existence still counts the missed detection.
    unseen[rows] = 0.0
    absences = replace(tracks.sights.absences, unseen=unseen)
    return replace(tracks, drives=drives, sights=replace(tracks.sights, absences=absences))


def measure(tracks: Tracks, before: Grey, step: Step) -> tuple[Integers, Array, Array]:
    """Measure vehicles by the flow of their pixels.

    Parameters
    ----------
    tracks : Tracks
        Vehicles, predicted into this frame.
    before : (H, W) array
        The frame before, in grey.
    step : Step
        The frame, and inputs that all parts of a step share.

    Returns
    -------
    (K,), (K, 4), (K, 4) arrays
        Rows of those that their pixels show, edges and their standard deviations, px.
    """
    # 1. Points on a grid in the old box, where no nearer vehicle covers them. After a change of
    # size there are none.
    if before.shape != step.grey.shape:
        return np.zeros(0, np.intp), NO_BOXES, NO_BOXES
    old = tracks.drives.before
    new = tracks.edges
    covers = tracks.sights.covers
    starts = [_uncovered(_points(edges), cover) for edges, cover in zip(old, covers, strict=True)]
    # 2. Followed in one call for all vehicles, from where the drive predicts them.
    guesses = [_carried(*each) for each in zip(starts, old, new, strict=True)]
    moved = _follow(before, step.grey, np.concatenate(starts), np.concatenate(guesses))
    ends = np.split(moved, np.cumsum([len(one) for one in starts])[:-1])
    # 3. Each vehicle by its own points.
    gaussians = tracks.drives.gaussians
    places = np.sqrt(gaussians.covariance[:, [X, V], [X, V]]) + PIXEL_NOISE
    rows = []
    edges = []
    spreads = []
    for row, (start, end) in enumerate(zip(starts, ends, strict=True)):
        shown = _shown(start, end, old[row], new[row], places[row], step.normals)
        if shown is not None:
            rows.append(row)
            edges.append(shown[0])
            spreads.append(shown[1])
    # 4. Flow follows whatever is there: the colours tell that it is still the vehicle.
    kept = np.array(rows, np.intp)
    boxes = np.array(edges).reshape(-1, 4)
    alike = _alike(tracks.sights.take(kept), boxes, step)
    return kept[alike], boxes[alike], np.array(spreads).reshape(-1, 4)[alike]


def _alike(sights: Sights, boxes: Array, step: Step) -> Bools:
    """Find boxes (K, 4) that have the colours of their vehicles."""
    colours = step.colours.histograms(boxes, list(sights.covers))
    fall = sights.looks.usual_similarity - similarities(sights.looks.colours, colours)
    return np.asarray(fall <= _HELD_FALL)


def _shown(
    old: Array, new: Array, before: Array, predicted: Array, place: Array, normals: Array
) -> tuple[Array, Array] | None:
    """Edges (4,) and their standard deviations, px, by one vehicle's points; None if too few agree.

    Parameters
    ----------
    old, new : (N, 2) arrays
        Points in the frame before, and where they are now; NaN where they are not found again.
    before, predicted : (4,) arrays
        Box in the frame before, and as it is predicted.
    place : (2,) array
        Standard deviations of the predicted place, px.
    normals : (P, 3) array
        Standard normal numbers that make the particles.
    """
    # 1. Without the points that stand on an occluder there have to be enough.
    found = np.isfinite(new[:, 0])
    alive = found & ~_standing(old, new, before, predicted)
    if alive.sum() < max(_GRID, _MOST_ALIVE * found.sum()):
        return None
    # 2. Residual motion of each point, beside the growth that is predicted.
    centre = (predicted[:2] + predicted[2:]) / 2
    size = predicted[2:] - predicted[:2]
    relative = (old[alive] - (before[:2] + before[2:]) / 2) * _growth(before, predicted)
    observed = new[alive] - centre
    particles = _particles(place, observed - relative, normals)
    # 3. Weigh particles: where each would have carried the points.
    expected = (1 + particles[:, 2])[:, np.newaxis, np.newaxis] * relative
    expected += particles[:, np.newaxis, :2]
    squared = ((observed - expected) ** 2).sum(axis=2) / PIXEL_NOISE**2
    # A Gaussian on a floor, so that points astray cannot veto. A mean times `_GRID`, not a sum: 25
    # points of one texture are not 25 measurements, and the weights would collapse.
    logs = np.log(np.exp(-squared / 2) + _OUTLIER).mean(axis=1)
    logs *= _GRID
    # 4. The best of all bad ones is no measurement.
    if (squared[int(np.argmax(logs))] < _ASTRAY**2).mean() < _MOST_AGREE:
        return None
    # 5. Mean and spread of the boxes are the measurement, its errors larger than the particles say.
    middles = centre + particles[:, :2]
    halves = size * (1 + particles[:, 2:]) / 2
    boxes = np.hstack([middles - halves, middles + halves])
    # Less the largest, so that not all underflow.
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    edges = weights @ boxes
    spread = np.sqrt(weights @ (boxes - edges) ** 2)
    sides = np.tile(edges[2:] - edges[:2], 2)
    return edges, _CAUTION * (np.hypot(spread, _SLIP * sides) + _SLIP_PX)


def _standing(old: Array, new: Array, before: Array, predicted: Array) -> Bools:
    """Points that stand while the vehicle drives: they lie on what hides it."""
    drive = (predicted[:2] + predicted[2:] - before[:2] - before[2:]) / 2
    length = float(np.hypot(*drive))
    # Standing and driving are not to be told apart yet.
    if length < PIXEL_NOISE:
        return np.zeros(len(old), dtype=np.bool_)
    return np.asarray(np.hypot(*(new - old).T) < _STANDS * length)


def _particles(place: Array, motions: Array, normals: Array) -> Array:
    """Particles (P, 3): displacement of the centre in px and relative growth.

    Half of them are drawn around the prediction, half around the points' median motion: a
    prediction may be far off.
    """
    particles = np.asarray(normals * np.append(place, _SLIP))
    particles[::2, :2] = np.median(motions, axis=0) + normals[::2, :2] * PIXEL_NOISE
    return particles


def _follow(before: Grey, present: Grey, old: Array, guess: Array) -> Array:
    """Places (N, 2) of points in the present frame, NaN where they are not found again."""
    if not len(old):
        return np.empty((0, 2))
    # Pixel 0 is centred at 0.5 here and at 0 in OpenCV.
    start = (old - 0.5).astype(np.float32)
    first = (guess - 0.5).astype(np.float32)
    new, found, error = _FLOW.follow_and_return(before, present, start, first)
    moved = new.astype(np.float64) + 0.5
    # Followed back it has to end where it began, within the noise of both ways.
    moved[~found | (np.abs(error).max(axis=1) > PIXEL_NOISE)] = np.nan
    return moved


def _points(edges: Array) -> Array:
    places = ((np.arange(_GRID) + 0.5) / _GRID - 0.5) * (1 - 2 * BACKGROUND_RIM)
    x, y = np.meshgrid(places, places)
    middle = (edges[:2] + edges[2:]) / 2
    size = edges[2:] - edges[:2]
    return np.asarray(np.column_stack([x.ravel(), y.ravel()]) * size + middle)


def _uncovered(points: Array, covers: Array) -> Array:
    """Points that no nearer box covers."""
    if not len(covers):
        return points
    x, y = points[:, :1], points[:, 1:]
    inside = (x > covers[:, 0]) & (x < covers[:, 2]) & (y > covers[:, 1]) & (y < covers[:, 3])
    return np.asarray(points[~inside.any(axis=1)])


def _carried(points: Array, before: Array, after: Array) -> Array:
    """Places of points as the prediction has them."""
    relative = (points - (before[:2] + before[2:]) / 2) * _growth(before, after)
    return np.asarray(relative + (after[:2] + after[2:]) / 2)


def _growth(before: Array, after: Array) -> float:
    """Growth of a box's sides."""
    return float(np.sqrt(areas(after) / areas(before)))
