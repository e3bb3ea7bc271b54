# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pixels that hold a vehicle while no detection does: the flow of points in its box.

Points of all vehicles are followed in one call. Particles over place and size are weighted by how
well they explain where the points went; their mean and spread are the measurement.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import NO_BOXES, areas
from vehicle_pf_tracker.image.motion.point_flow import PointFlow
from vehicle_pf_tracker.trackers.traffic.box_edges import both_ends, sides_of
from vehicle_pf_tracker.trackers.traffic.colours import BACKGROUND_RIM, similarities
from vehicle_pf_tracker.trackers.traffic.edge_observation import V, X
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers, Objects
from vehicle_pf_tracker.trackers.traffic.state import Grey, State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks
from vehicle_pf_tracker.trackers.traffic.vehicle_state import PIXEL_NOISE

_GRID = 5
"""Points along each side of a box, a choice; the fewest that a motion is taken from, and as many as
count as independent: neighbours err together."""
_ASTRAY = 3.0
"""Standard deviations beyond which a point went elsewhere: one in 90 is as far, in two
directions."""
_OUTLIER = math.exp(-(_ASTRAY**2) / 2)
"""Likelihood of a point that went elsewhere, of that at the centre: as far as `_ASTRAY` both are
alike, and farther the distance no longer counts."""
_MOST_ALIVE = 0.5
"""Least share of the points found again that drive: most of them."""
_MOST_AGREE = 0.5
"""Least share of these that agree with a box: most of them."""
_STANDS = 0.5
"""Share of the predicted displacement below which a point does not drive: nearer to standing than
to driving."""
_SLIP = 0.02
"""Standard deviation, of its size, by which a box grows or slips on its vehicle in a frame. A
choice, less than the .05 of a detector's edge: what a hold knows it has from the frame before."""
_SLIP_PX = 0.3
"""That deviation's part in px, less than a point's noise, as many are averaged."""
_CAUTION = 1.5
"""Factor on these deviations: errors of successive frames go the same way and add up."""
_HELD_SHARE = 0.3
"""Least visible share of a vehicle, and share in the image, for pixels to hold it. Chosen by
motion, with the caution."""
_HELD_FOR = 4.0
"""Nominal periods since a vehicle was seen from which its points lie on what hides it. A choice:
each hold begins them anew, so that holding ends only where it failed all the time."""
_HELD_FALL = 0.15
"""Fall of the colours' similarity below its usual value above which pixels do not hold it: less
than for vehicles that come back, as the light is the same from frame to frame."""
_PARTICLES_AT_ONCE = 1000
"""Particles of several vehicles that are weighed at once: with 25 points each they fill a cache of
half a MB, and more would only need more memory."""
_AXIS = ((np.arange(_GRID) + 0.5) / _GRID - 0.5) * (1 - 2 * BACKGROUND_RIM)
"""Places of the points along one axis, of the side from its centre: none on the rim, which may be
background."""
_PLACES = np.column_stack([np.tile(_AXIS, _GRID), np.repeat(_AXIS, _GRID)])
"""Places of the points in a box, of its sides from its centre, (G², 2)."""
# A small window and one halving: the prediction is the guess, and distant vehicles are small.
_FLOW = PointFlow(window=9, levels=2, steps=10, precision=0.03)


def hold_by_pixels(state: State, step: Step) -> State:
    """Measure vehicles that were not detected by their pixels; and keep the frame for the next."""
    tracks = state.tracks
    absences = state.tracks.absences
    part = np.minimum(tracks.visibility.uncovered, tracks.visibility.inside)
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
    unseen = tracks.absences.unseen.copy()
    # Seen, but not detected: `misses` still counts it.
    unseen[rows] = 0.0
    return replace(tracks, drives=drives, absences=replace(tracks.absences, unseen=unseen))


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
    # 1. Points on a grid in each old box, where no nearer vehicle covers them. After a change of
    # size there are none.
    if before.shape != step.grey.shape:
        return np.zeros(0, np.intp), NO_BOXES, NO_BOXES
    old = tracks.drives.before
    new = tracks.edges
    starts = _points(old)
    in_sight = _uncovered(starts, tracks.visibility.covers)
    # 2. Followed in one call for all vehicles, from where the drive predicts them.
    guesses = _carried(starts, old, new)
    ends = np.full_like(starts, np.nan)
    ends[in_sight] = _follow(before, step.grey, starts[in_sight], guesses[in_sight])
    # 3. Each vehicle by its own points, of which there have to be enough without those that stand
    # on an occluder.
    found = np.isfinite(ends[..., 0])
    alive = found & ~_standing(starts, ends, old, new)
    counts = alive.sum(axis=1)
    enough = counts >= np.maximum(_GRID, _MOST_ALIVE * found.sum(axis=1))
    gaussians = tracks.drives.gaussians
    places = np.sqrt(gaussians.covariance[:, [X, V], [X, V]]) + PIXEL_NOISE
    edges = np.empty_like(new)
    spreads = np.empty_like(new)
    agree = np.zeros(len(new), np.bool_)
    for rows in _together(counts, enough, len(step.normals)):
        at_first, now = (every[rows][alive[rows]] for every in (starts, ends))
        as_many = (len(rows), -1, 2)
        edges[rows], spreads[rows], agree[rows] = _shown(
            at_first.reshape(as_many),
            now.reshape(as_many),
            old[rows],
            new[rows],
            places[rows],
            step.normals,
        )
    # 4. Flow follows whatever is there: the colours show whether it is still the vehicle.
    kept = np.flatnonzero(agree)
    alike = _alike(tracks.take(kept), edges[kept], step)
    kept = kept[alike]
    return kept, edges[kept], spreads[kept]


def _together(counts: Integers, enough: Bools, particles: int) -> Iterator[Integers]:
    """Rows of vehicles that have `enough` points (K,), those with equal counts (K,) together."""
    most = max(_PARTICLES_AT_ONCE // particles, 1)
    for count in np.unique(counts[enough]).tolist():
        rows = np.flatnonzero(enough & (counts == count))
        for first in range(0, len(rows), most):
            yield rows[first : first + most]


def _alike(tracks: Tracks, boxes: Array, step: Step) -> Bools:
    """Find boxes (K, 4) that have the colours of their vehicles."""
    colours = step.colours.histograms(boxes, list(tracks.visibility.covers))
    appearance = tracks.appearance
    fall = appearance.usual_similarity - similarities(appearance.colours, colours)
    return np.asarray(fall <= _HELD_FALL)


def _shown(
    old: Array, new: Array, before: Array, predicted: Array, place: Array, normals: Array
) -> tuple[Array, Array, Bools]:
    """Edges (K, 4) and their standard deviations, px, by the points of each vehicle.

    Parameters
    ----------
    old, new : (K, N, 2) arrays
        Points in the frame before, and where they are now.
    before, predicted : (K, 4) arrays
        Boxes in the frame before, and as they are predicted.
    place : (K, 2) array
        Standard deviations of the predicted places, px.
    normals : (P, 3) array
        Standard normal numbers that make the particles.

    Returns
    -------
    (K, 4), (K, 4), (K,) arrays
        Edges, their standard deviations, and True where enough points agree with them.
    """
    # 1. Residual motion of each point, beside the growth that is predicted.
    centre = _middles(predicted)
    size = sides_of(predicted)
    growth = _growth(before, predicted)
    relative = (old - _middles(before)[:, np.newaxis]) * growth[:, np.newaxis, np.newaxis]
    observed = new - centre[:, np.newaxis]
    particles = _particles(place, observed - relative, normals)
    # 2. Weigh particles: where each would have carried the points.
    expected = (1 + particles[:, :, 2, np.newaxis, np.newaxis]) * relative[:, np.newaxis]
    expected += particles[:, :, np.newaxis, :2]
    away = observed[:, np.newaxis] - expected
    away *= away
    squared = (away[..., 0] + away[..., 1]) / PIXEL_NOISE**2
    # A Gaussian on a floor, so that points astray cannot veto. A mean times `_GRID`, not a sum: 25
    # points of one texture are not 25 measurements, and the weights would collapse.
    logs = np.log(np.exp(-squared / 2) + _OUTLIER).mean(axis=2)
    logs *= _GRID
    # 3. The best of all bad ones is no measurement.
    best = squared[np.arange(len(logs)), logs.argmax(axis=1)]
    agree = (best < _ASTRAY**2).mean(axis=1) >= _MOST_AGREE
    # 4. Mean and spread of the boxes are the measurement, its errors larger than the particles say.
    middles = centre[:, np.newaxis] + particles[..., :2]
    halves = size[:, np.newaxis] * (1 + particles[..., 2:]) / 2
    boxes = np.concatenate([middles - halves, middles + halves], axis=2)
    # Less the largest, so that not all underflow.
    weights = np.exp(logs - logs.max(axis=1, keepdims=True))
    weights /= weights.sum(axis=1, keepdims=True)
    edges = weights[:, np.newaxis] @ boxes
    spread = np.sqrt(weights[:, np.newaxis] @ (boxes - edges) ** 2)[:, 0]
    edges = edges[:, 0]
    sides = both_ends(sides_of(edges))
    return edges, _CAUTION * (np.hypot(spread, _SLIP * sides) + _SLIP_PX), agree


def _standing(old: Array, new: Array, before: Array, predicted: Array) -> Bools:
    """Points (K, N) that stand while the vehicle drives: they lie on what hides it."""
    drive = (predicted[:, :2] + predicted[:, 2:] - before[:, :2] - before[:, 2:]) / 2
    length = np.hypot(*drive.T)[:, np.newaxis]
    moves = new - old
    stands = np.hypot(moves[..., 0], moves[..., 1]) < _STANDS * length
    # Else standing and driving cannot be distinguished yet.
    return np.asarray(stands & (length >= PIXEL_NOISE))


def _particles(place: Array, motions: Array, normals: Array) -> Array:
    """Particles (K, P, 3): displacement of the centre in px and relative growth.

    Half of them are drawn around the prediction, half around the points' median motion: a
    prediction may be far off.
    """
    count = motions.shape[1]
    ordered = np.sort(motions, axis=1)
    median = (ordered[:, (count - 1) // 2] + ordered[:, count // 2]) / 2
    spread = np.concatenate([place, np.full((len(place), 1), _SLIP)], axis=1)
    particles = normals * spread[:, np.newaxis]
    particles[:, ::2, :2] = median[:, np.newaxis] + normals[::2, :2] * PIXEL_NOISE
    return np.asarray(particles)


def _follow(before: Grey, present: Grey, old: Array, guess: Array) -> Array:
    """Places (N, 2) of points in the present frame, NaN where they are not found again."""
    if not len(old):
        return np.empty((0, 2))
    # Pixel 0 is centred at 0.5 here and at 0 in OpenCV.
    start = (old - 0.5).astype(np.float32)
    first = (guess - 0.5).astype(np.float32)
    new, found, error = _FLOW.follow_and_return(before, present, start, first)
    moved = new.astype(np.float64) + 0.5
    # Followed back it has to end where it began, within the noise of both paths.
    moved[~found | (np.abs(error).max(axis=1) > PIXEL_NOISE)] = np.nan
    return moved


def _points(edges: Array) -> Array:
    """Points (K, G², 2) on a grid inside of boxes (K, 4)."""
    return np.asarray(_PLACES * sides_of(edges)[:, np.newaxis] + _middles(edges)[:, np.newaxis])


def _middles(edges: Array) -> Array:
    return np.asarray((edges[:, :2] + edges[:, 2:]) / 2)


def _uncovered(points: Array, covers: Objects) -> Bools:
    """Find points (K, N, 2) that no nearer box covers: True (K, N)."""
    shown = np.ones(points.shape[:2], np.bool_)
    for row, boxes in enumerate(covers.tolist()):
        if len(boxes):
            x = points[row, :, :1]
            y = points[row, :, 1:]
            inside = (x > boxes[:, 0]) & (x < boxes[:, 2]) & (y > boxes[:, 1]) & (y < boxes[:, 3])
            shown[row] = ~inside.any(axis=1)
    return shown


def _carried(points: Array, before: Array, after: Array) -> Array:
    """Places of points (K, N, 2) as the prediction has them."""
    growth = _growth(before, after)[:, np.newaxis, np.newaxis]
    relative = (points - _middles(before)[:, np.newaxis]) * growth
    return np.asarray(relative + _middles(after)[:, np.newaxis])


def _growth(before: Array, after: Array) -> Array:
    """Growth (K,) of the boxes' sides."""
    return np.asarray(np.sqrt(areas(after) / areas(before)))
