# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Association of detections with vehicles.

The cost of a pair is the squared distance of the four edges in standard deviations, or, where the
detection lies inside the predicted box because something hides a part, that of the edges that are
not drawn in, and a price of what it lacks. What is not yet known to be a vehicle takes a detection
only where that is rather its own than a false alarm.
"""

from __future__ import annotations

import importlib
import math
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.overlaps import are_alone, clipped, overlaps
from vehicle_pf_tracker.trackers.traffic.box_edges import (
    INWARD_SIGNS,
    MeasurementModel,
    both_ends,
    sides_of,
)
from vehicle_pf_tracker.trackers.traffic.candidates import SIZE_SPREAD, Candidates
from vehicle_pf_tracker.trackers.traffic.rows import Integers
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks
from vehicle_pf_tracker.trackers.traffic.vehicle_state import PIXEL_NOISE

GATE = 30.0
"""Largest cost of a pair: more than 23.5, the 0.9999 quantile of chi-squared with four degrees of
freedom, since the noise of edges is an estimate."""
_PARTIAL = 3.0
"""Cost of taking a detection for a part of the vehicle: if it were free, pieces of blobs would be
taken for whole vehicles."""
_MISSING = 12.0
"""Cost of all of the vehicle that a part lacks: with `_PARTIAL` half of the gate."""
_LEAST_PART = 0.15
"""Smallest share of a vehicle that is seen as a part of it: with a tenth vehicles behind a bridge
exchange their numbers."""
_OVERLAPPING = 0.5
"""Overlap with a likely vehicle above which a drive, however sure, may be wrong: no other is as
near. A choice: at a half evaluations, too, take two boxes for one vehicle's."""

_CLOSEST = 0.9 * GATE * _OVERLAPPING
"""Cost that no overlap lessens: a complete one costs a ninth more, so that rounding decides
nothing."""


class Pairs(NamedTuple):
    """Tracks and their detections.

    Attributes
    ----------
    rows, columns : (P,) arrays
        Indices of the tracks, and of the detections.
    fits : (P,) array
        Log odds that each detection is the track's rather than a false alarm, by position alone.
    """

    rows: Integers
    columns: Integers
    fits: Array


def check_library() -> None:
    """Load the library of `assigned` at the start: it takes a second, in which a node loses images.

    Raises
    ------
    InputError
        If it is not.
    """
    try:
        importlib.import_module("scipy.optimize")
    except ModuleNotFoundError:
        raise InputError(
            "traffic needs the Python module scipy: install the extra [video], "
            "pip install 'vehicle_pf_tracker[video]', or with apt python3-scipy"
        ) from None


def assigned(rows: Integers, columns: Integers, costs: Array, odds: Array) -> Pairs:
    """Pairs of least total cost, each below the gate."""
    # Not at the top: help and parameters of `traffic` are printed without this library.
    from scipy.optimize import linear_sum_assignment  # noqa: PLC0415

    # All pairs beyond the gate cost the same: the solver would else give up a good pair to make a
    # hopeless one cheaper. They are dropped below.
    bounded = np.minimum(costs, GATE)
    first, second = linear_sum_assignment(bounded)
    good = bounded[first, second] < GATE
    first = first[good]
    second = second[good]
    return Pairs(rows[first], columns[second], odds[first, second])


def edge_costs(predicted: Array, deviations: Array, detected: Array) -> Array:
    """Cost (P,) of each pair of a track and a detection by the edges.

    Parameters
    ----------
    predicted, deviations : (P, 4) arrays
        Edges of the tracks and their standard deviations, measurement included, px.
    detected : (P, 4) array
        Edges of the detections, px.
    """
    inward = (detected - predicted) * INWARD_SIGNS
    # Each edge in its own standard deviations, without covariances: a covered edge can then be left
    # out by itself.
    normal = inward / deviations
    whole = (normal**2).sum(axis=1)
    # An occluder can only draw edges in: what is outside the prediction costs in full.
    outward = (np.minimum(normal, 0.0) ** 2).sum(axis=1)
    lacking = np.maximum(inward, 0.0)
    shares = 1 - (lacking[:, :2] + lacking[:, 2:]) / sides_of(predicted)
    shares = np.minimum(np.maximum(shares, 0.0), 1.0)
    kept = shares[:, 0] * shares[:, 1]
    # The price keeps a part from being as good as a whole; the less is seen, the dearer it is.
    part = outward + _PARTIAL + _MISSING * (1 - kept)
    return np.asarray(np.where(kept > _LEAST_PART, np.minimum(whole, part), whole))


def pair_costs(
    tracks: Tracks, candidates: Candidates, columns: Integers, measurement: MeasurementModel
) -> tuple[Array, Array]:
    """Cost of each pair of a vehicle and one of the detections at `columns`, and its log odds.

    Both are (tracks, detections); of pairs beyond the gate they are `GATE` and none at all.
    """
    gaussians = tracks.drives.gaussians
    # 1. Innovation: prediction and measurement are independent.
    spread = np.sqrt(gaussians.edge_variances + measurement.deviations(gaussians.edges) ** 2)
    # A detector's box ends at the border, and so does what is compared with it.
    predicted = clipped(gaussians.edges, measurement.size)
    detected = candidates.edges[columns]
    # 2. Nearly all pairs are out of reach, and only the others cost time.
    rows, pairs = _within_reach(predicted, spread, detected)
    each = predicted.take(rows, 0)
    others = detected.take(pairs, 0)
    cost = edge_costs(each, spread.take(rows, 0), others)
    # 3. Log likelihood ratio: a Gaussian over the edges against the density of false alarms.
    peaks = -np.log(spread * math.sqrt(2 * math.pi)).sum(axis=1)
    odds = np.full((len(predicted), len(detected)), -np.inf)
    odds[rows, pairs] = peaks[rows] - cost / 2 - candidates.false_density[columns][pairs]
    # 4. However sure its drive is, it was wrong where a likely vehicle overlaps it by half.
    far = (cost > _CLOSEST) & (candidates.log_odds[columns] > 0)[pairs]
    if far.any():
        # In a crowd, or behind something, the likely vehicle may be another one.
        far &= (are_alone(predicted) & tracks.in_sight)[rows]
        # Below the gate from the overlap of `_OVERLAPPING` on, and the closer the cheaper.
        near = GATE * (1 + _OVERLAPPING - overlaps(each[far], others[far]))
        cost[far] = np.minimum(cost[far], near)
    costs = np.full(odds.shape, GATE)
    costs[rows, pairs] = cost
    return costs, odds


def _within_reach(predicted: Array, spread: Array, detected: Array) -> tuple[Integers, Integers]:
    """Find the pairs (P,), (P,) of predictions (T, 4) and detections (D, 4) not surely too dear.

    As a whole a pair is too dear if one edge alone is beyond the gate, and a part lies inside its
    prediction: whatever does not touch a prediction, widened by the gate, is neither.
    """
    widened = predicted - INWARD_SIGNS * (math.sqrt(GATE) * spread)
    left, top, right, bottom = widened.T[..., np.newaxis]
    near = (left < detected[:, 2]) & (detected[:, 0] < right)
    near &= (top < detected[:, 3]) & (detected[:, 1] < bottom)
    rows, pairs = near.nonzero()
    return rows, pairs


def birth_costs(
    tracks: Tracks, candidates: Candidates, columns: Integers, measurement: MeasurementModel
) -> tuple[Array, Array]:
    """Cost of each pair of a new track and one of the detections at `columns`, and its log odds.

    Both are (tracks, detections); see `birth_odds`.
    """
    odds = birth_odds(tracks, candidates, columns, measurement)
    # Below the gate exactly where the odds are above even.
    return GATE - odds, odds


def birth_odds(
    tracks: Tracks, candidates: Candidates, columns: Integers, measurement: MeasurementModel
) -> Array:
    """Log odds (tracks, detections) that a detection is a new track's and no false alarm.

    The density of the prediction against that of false alarms there, which have any size. An edge
    that is cut in both tells nothing. Only where it is says so, neither scores nor colours.

    Parameters
    ----------
    tracks : Tracks
        Tracks, predicted into this frame.
    candidates : Candidates
        Detections of the frame.
    columns : (D,) array
        Indices of those to compare with.
    measurement : MeasurementModel
        How a detector measures edges in this image.
    """
    # 1. Predictions and detections, with the deviations of both.
    gaussians = tracks.drives.gaussians
    predicted = gaussians.edges
    detected = candidates.edges[columns]
    spread = measurement.deviations(detected)
    reach = np.sqrt(gaussians.edge_variances)
    cut = measurement.cut_edges(predicted)
    also_cut = measurement.cut_edges(detected)
    # 2. Gate edge by edge: most pairs are far apart by the first one, only the others cost time.
    reachable = math.sqrt(GATE)
    apart = np.abs(detected[:, 0] - predicted[:, :1])
    # Deviations are added, not their squares: on the wide side, as the density decides.
    rows, pairs = np.nonzero(
        (apart < reachable * (reach[:, :1] + spread[:, 0])) | (cut[:, :1] & also_cut[:, 0])
    )
    for edge in range(1, 4):
        far = np.abs(detected[pairs, edge] - predicted[rows, edge])
        near = far < reachable * (reach[rows, edge] + spread[pairs, edge])
        near |= cut[rows, edge] & also_cut[pairs, edge]
        rows = rows[near]
        pairs = pairs[near]
    # 3. An edge that is cut in both: this variance gives it the density that false alarms have
    # there, so that both cancel and it tells nothing.
    sides = both_ends(sides_of(detected))
    unknown = (SIZE_SPREAD * sides[pairs]) ** 2 / (2 * np.pi)
    both_cut = cut[rows] & also_cut[pairs]
    # 4. With covariances here: while its speed is unknown, a new track's edges move far together.
    covariance = gaussians.edge_covariance[rows]
    covariance[:, range(4), range(4)] += spread[pairs] ** 2 + np.where(both_cut, unknown, 0.0)
    odds = np.full((len(predicted), len(detected)), -np.inf)
    odds[rows, pairs] = (
        _log_density(detected[pairs] - predicted[rows], covariance)
        - candidates.false_density[columns][pairs]
    )
    return odds


def _log_density(residuals: Array, covariances: Array) -> Array:
    """Logarithm of Gaussian densities (N,) at residuals (N, 4) of edges: one after the other."""
    # The chain rule: each edge's density given those before, which a Schur complement takes out.
    total = np.zeros(len(residuals))
    for _ in range(residuals.shape[1]):
        # Rounding leaves no edge less than its measurement's noise.
        variance = np.maximum(covariances[:, 0, 0], PIXEL_NOISE**2)
        total -= (residuals[:, 0] ** 2 / variance + np.log(2 * np.pi * variance)) / 2
        slope = covariances[:, 1:, 0] / variance[:, np.newaxis]
        residuals = residuals[:, 1:] - slope * residuals[:, :1]
        covariances = covariances[:, 1:, 1:] - slope[..., np.newaxis] * covariances[:, :1, 1:]
    return total
