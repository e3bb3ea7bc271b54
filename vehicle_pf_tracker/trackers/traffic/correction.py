# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Correction of vehicles by their detections, edge by edge.

An edge that the border of the image cuts, or that something covers, does not tell where the vehicle
ends: measured, it would brake the vehicle at an occluder and shrink it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import are_alone
from vehicle_pf_tracker.trackers.traffic.box_edges import (
    INWARD_SIGNS,
    MeasurementModel,
    both_ends,
    opposites,
    sides_of,
)
from vehicle_pf_tracker.trackers.traffic.edge_observation import ACROSS, Edge, W
from vehicle_pf_tracker.trackers.traffic.rows import Bools
from vehicle_pf_tracker.trackers.traffic.tracks import Drives, Tracks

_WHOLE = 0.85
"""Share of the width or height, of the predicted and of the latest detections, below which one of
the two edges is covered: at the rim of an occluder the edge does not jump, it creeps, and would
brake the vehicle. At the usual edge noise a side is as short by chance at two standard
deviations."""
_JUMP = 3.0
"""Standard deviations by which an edge that is drawn in has jumped: one in 400 is as far."""
_KNOWN_FROM = 4
"""Detections of a vehicle from which its size is known, so that an edge can be said to lack: with a
rate of `_FOLLOWED`, the latest four count for two thirds."""
_COVERED_FOR = 30
"""Detections in a row, one second of 30 Hz, after which a smaller box is all there is: a bridge
covers a vehicle that is far away for as long."""
_FOLLOWED = 0.25
"""Rate per detection at which residuals are learnt, and at which boxes follow them: the latest four
count for two thirds."""
_ENDS = slice(Edge.LEFT, Edge.BOTTOM, Edge.RIGHT - Edge.LEFT)
"""Left and right edge."""


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """Detections of N vehicles beside their predictions, once for all that a correction asks.

    Attributes
    ----------
    predicted, detected : (N, 4) arrays
        Edges of the predictions and of the detections, px.
    unknown : (N, 4) array
        Edges that the border of the image cuts in both.
    bounds : (N, 4) array
        Left and right edges that it cuts in the detection only: the vehicle ends there or beyond.
    own, sides : (N, 2) arrays
        Width and height of the predictions and of the detections, px.
    latest : (N, 2) array
        Largest width and height of the latest detections, these ones included, px.
    inward : (N, 4) array
        Detection less prediction, inward positive, px.
    variances, spread, expected : (N, 4) arrays
        Variances of the predictions; standard deviations of the measurements, and of the residuals
        that both let expect, px.
    noise : float
        Standard deviation of a detected edge, fraction of the box's side.
    """

    predicted: Array
    detected: Array
    unknown: Bools
    bounds: Bools
    own: Array
    sides: Array
    latest: Array
    inward: Array
    variances: Array
    spread: Array
    expected: Array
    noise: float

    @classmethod
    def of(cls, drives: Drives, edges: Array, measurement: MeasurementModel) -> Comparison:
        """Compare with detections (N, 4) in px; see `correct`."""
        predicted = drives.gaussians.edges
        # Cut in both, an edge is unknown. Where only one is cut, the vehicle comes in or leaves,
        # and the edge is measured, at a side as a bound.
        cut = measurement.cut_edges(edges)
        also_cut = measurement.cut_edges(predicted)
        bounds = cut & ~also_cut
        # At the upper border vehicles come in small, where a row is a long way of the road.
        bounds[:, Edge.TOP :: 2] = False
        own = sides_of(predicted)
        sides = sides_of(edges)
        variances = drives.gaussians.edge_variances
        spread = measurement.deviations(predicted)
        return cls(
            predicted=predicted,
            detected=edges,
            unknown=cut & also_cut,
            bounds=bounds,
            own=own,
            sides=sides,
            latest=np.maximum(sides, own * drives.extents.shown),
            inward=(edges - predicted) * INWARD_SIGNS,
            variances=variances,
            spread=spread,
            expected=np.sqrt(variances + spread**2),
            noise=measurement.noise,
        )


@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """Verdict on the edges of N detections: which are where their vehicles end.

    Attributes
    ----------
    left_out : (N, 4) array
        Edges that are not measured.
    covered : (N, 4) array
        Edges that something seems to cover.
    recede : (N,) array
        Vehicles that became smaller as a whole: they drive away.
    """

    left_out: Bools
    covered: Bools
    recede: Bools

    @property
    def whole(self) -> Bools:
        """True (N,) where all of the vehicle is seen."""
        return np.asarray(~self.covered.any(axis=1))


def correct(tracks: Tracks, edges: Array, measurement: MeasurementModel) -> tuple[Tracks, Bools]:
    """Correct the drives of vehicles, each by its detection; also return which were seen whole.

    Parameters
    ----------
    tracks : Tracks
        N vehicles, predicted into this frame.
    edges : (N, 4) array
        Edges of the detection of each, px.
    measurement : MeasurementModel
        How a detector measures edges in this image.
    """
    compared = Comparison.of(tracks.drives, edges, measurement)
    # Judge all four edges by the prediction, then correct once.
    verdict = which_edges(tracks, compared)
    return replace(tracks, drives=apply_verdict(tracks.drives, compared, verdict)), verdict.whole


def which_edges(tracks: Tracks, compared: Comparison) -> Verdict:
    """Judge which edges of detections are where vehicles end; see `correct`."""
    # Residuals in their standard deviations, inward positive.
    normal = compared.inward / compared.expected
    opposite = opposites(normal)
    # Smaller than both: a prediction may have grown wrongly, a detection may be of two vehicles.
    shrunk = compared.sides < _WHOLE * np.minimum(compared.own, compared.latest)
    jumped = (normal > _JUMP) & (opposite > 0)  # a vehicle that brakes pushes it out
    # Of two edges that are drawn in, the one that is more so.
    crept = both_ends(shrunk) & (normal > np.maximum(opposite, 0.0))
    recede = _recede(tracks, compared) & ~compared.unknown.any(axis=1)
    covered = (jumped | crept) & ~(compared.unknown | recede[:, np.newaxis])
    patient = _patient(tracks)
    return Verdict(compared.unknown | (covered & patient[:, np.newaxis]), covered, recede)


def _patient(tracks: Tracks) -> Bools:
    """Find vehicles (N,) whose covered edges are left out."""
    known = tracks.beliefs.paths.matches >= _KNOWN_FROM
    # Not for ever, or a size that was wrong from the start would never be corrected.
    return np.asarray(known & (tracks.drives.extents.partial < _COVERED_FOR))


def _recede(tracks: Tracks, compared: Comparison) -> Bools:
    """Find vehicles (N,) that became smaller as a whole, and go on so: they drive away.

    What covers one draws an edge in, and changes its shape.
    """
    across, down = np.log(compared.sides / compared.own).T
    alike = np.abs(across - down) < 2 * compared.noise  # that of four edges
    drawn_in = compared.inward[:, _ENDS] > 0
    lately = tracks.drives.drift[:, _ENDS] <= 0
    in_sight = np.array([len(covers) == 0 for covers in tracks.visibility.covers], np.bool_)
    smaller = (across < 0) & (down < 0) & (drawn_in & lately).all(axis=1)
    return np.asarray(in_sight & alike & smaller)


def apply_verdict(drives: Drives, compared: Comparison, verdict: Verdict) -> Drives:
    """Apply a verdict: measure the edges that are where the vehicles end."""
    bounds = compared.bounds & ~verdict.left_out
    inexact = verdict.left_out | bounds
    residuals = np.where(inexact, 0.0, -compared.inward)
    drives = _widened(drives, compared, residuals, verdict.recede)
    # An infinite deviation is a gain of zero: the edge moves by its correlations only.
    exact = np.where(inexact, np.inf, compared.spread)
    gaussians = drives.gaussians.measured(compared.detected, exact)
    if bounds.any():
        # The edge is there or beyond, so that the state is moved but made no surer: else a long
        # vehicle that comes in keeps the length which was assumed, until no detection fits it.
        bounding = np.where(bounds, compared.spread, np.inf)
        moved = gaussians.measured(compared.detected, bounding)
        gaussians = replace(moved, covariance=gaussians.covariance)
    # Successive residuals agree: states stay behind.
    lag = _FOLLOWED * np.where(verdict.left_out, 0.0, compared.detected - gaussians.edges)
    extents = replace(
        drives.extents,
        # Relative to the state, so that it grows with the vehicle as that comes near.
        shown=compared.latest / gaussians.mean[:, W:ACROSS],
        partial=np.where(verdict.whole, 0, drives.extents.partial + 1),
    )
    return replace(drives, gaussians=gaussians, lag=lag, extents=extents)


def _widened(drives: Drives, compared: Comparison, residuals: Array, recede: Bools) -> Drives:
    """Be less sure of drives that detections keep contradicting.

    Where the horizon is wrong or the road bends, a drive is wrong in every frame by a little, on
    the same side, and a state that is sure of it would stay behind until no detection fits. The
    covariance is then that by which the residuals were expected, as in the strong tracking filter
    of Zhou and Frank (1996). Only an edge outside the prediction counts, unless the vehicle
    recedes, and as far as the opposite edge has moved, too: what covers a vehicle draws an edge in,
    and a box of two vehicles pushes one out.

    Parameters
    ----------
    drives : Drives
        Drives of N vehicles, predicted into this frame.
    compared : Comparison
        Their predictions, and their detections.
    residuals : (N, 4) array
        Detection less prediction, outward, zero of edges that are not measured, px.
    recede : (N,) array
        True where the vehicle drives away.
    """
    # 1. Drift of each edge's residuals.
    # Chance has no direction, and averages out; a wrong drive stays on one side.
    drift = drives.drift + _FOLLOWED * (residuals / compared.expected - drives.drift)
    # 2. Edges that count, and their variances as expected and as seen.
    away = recede[:, np.newaxis]
    outward = np.maximum(np.where(away, -drift, drift), 0.0)
    outward = np.minimum(outward, np.abs(opposites(drift)))
    seen = ((residuals > 0) | away) & (outward > 0)
    expected = np.where(seen, compared.variances, 0.0).sum(axis=1)
    lacking = np.where(seen, residuals**2 - compared.spread**2, 0.0).sum(axis=1)
    # 3. One for each edge: by less, errors that detectors repeat would be followed, too; by more,
    # boxes would stay behind vehicles that come near.
    wrong = ((outward**2).sum(axis=1) > len(Edge)) & (lacking > expected)
    if wrong.any():
        # Among others a residual may be of a neighbour's box.
        wrong &= are_alone(compared.predicted)
        wider = np.where(wrong, lacking / np.where(wrong, expected, 1.0), 1.0)
        # What has widened the covariance is used up: once is enough for the next gain.
        drift = np.where(wrong[:, np.newaxis], 0.0, drift)
        drives = replace(drives, gaussians=drives.gaussians.widened(wider))
    return replace(drives, drift=drift)
