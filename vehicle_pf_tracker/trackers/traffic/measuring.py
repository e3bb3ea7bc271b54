# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measurement of a vehicle by a detection, edge by edge.

An edge that the border of the image cuts, or that something covers, does not tell where the vehicle
ends: measured, it would brake the vehicle at an occluder and shrink it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.overlaps import areas
from vehicle_pf_tracker.trackers.traffic.association import INWARD, cut_edges, deviations
from vehicle_pf_tracker.trackers.traffic.detection_evidence import (
    HALF,
    INSIDE,
    LITTLE,
    Place,
    places_of,
)
from vehicle_pf_tracker.trackers.traffic.occlusion import Returns
from vehicle_pf_tracker.trackers.traffic.parameters import DetectionParameters
from vehicle_pf_tracker.trackers.traffic.track import FEW, RATE, Track, edges_of
from vehicle_pf_tracker.trackers.traffic.vehicle_state import (
    FAR,
    SETTLED_AFTER,
    USUAL_ASPECT,
    Drive,
    Edge,
    VehicleState,
)

_WHOLE = 0.85
"""Share of the width or height, of the predicted and of the latest detections, below which one of
the two edges is covered: at the rim of an occluder the edge does not jump, it creeps, and would
brake the vehicle."""
_ASPECT_DEVIATION = 0.25
"""Standard deviation of `USUAL_ASPECT` where a border cuts a vehicle when it is first seen: from
the side it is half of it."""
_OPPOSITE = [Edge.RIGHT, Edge.BOTTOM, Edge.LEFT, Edge.TOP]
_ENDS = [Edge.LEFT, Edge.RIGHT]


def first_state(
    edges: Array, noise: float, horizon: float, drive: Drive, size: tuple[int, int]
) -> VehicleState:
    """Make the state of a vehicle from its first detection, which borders of the image may cut.

    Parameters
    ----------
    edges : (4,) array
        Edges of the detection, px.
    noise : float
        Standard deviation of an edge, fraction of the size.
    horizon : float
        Row of the horizon, px.
    drive : Drive
        Motion model of vehicles.
    size : (int, int)
        Width and height of the image.
    """
    edges, spread = edges.copy(), deviations(edges, noise)
    cut = cut_edges(edges, size, noise)
    width, height = (edges[2:] - edges[:2]).tolist()
    for low, high, side, usual in (
        (Edge.TOP, Edge.BOTTOM, height, USUAL_ASPECT * width),
        (Edge.LEFT, Edge.RIGHT, width, height / USUAL_ASPECT),
    ):
        if side >= usual:
            continue
        if side < HALF * usual:
            spread[low] = spread[high] = _ASPECT_DEVIATION * usual
        if cut[low]:
            edges[low], spread[low] = edges[high] - usual, _ASPECT_DEVIATION * usual
        elif cut[high]:
            edges[high], spread[high] = edges[low] + usual, _ASPECT_DEVIATION * usual
    return VehicleState(edges, spread, horizon, drive)


def measure(
    tracks: Sequence[Track],
    edges: Array,
    settings: DetectionParameters,
    size: tuple[int, int],
    others: Array,
    uncoverings: Returns,
) -> npt.NDArray[np.bool_]:
    """Correct the states of tracks, each by its detection; True where the whole was measured.

    Parameters
    ----------
    tracks : sequence of N Track
        Tracks, predicted into this frame.
    edges : (N, 4) array
        Edges of the detection of each, px.
    settings : DetectionParameters
        Noise of an edge, and where an edge is taken to be covered.
    size : (int, int)
        Width and height of the image.
    others : (M, 4) array
        Edges of all detections, px.
    uncoverings : Returns
        Learns where missing parts of vehicles come back: there something covers them.
    """
    _divide(tracks, edges, others)
    states = VehicleState.stacked([track.state for track in tracks])
    predicted = states.edges
    spread = deviations(predicted, settings.edge_noise)
    variances = states.edge_covariance.diagonal(axis1=1, axis2=2)
    normal = (edges - predicted) * INWARD / np.sqrt(variances + spread**2)
    opposite = normal[:, _OPPOSITE]
    cut, also_cut = (cut_edges(one, size, settings.edge_noise) for one in (edges, predicted))
    unknown = cut & also_cut
    sides = edges[:, 2:] - edges[:, :2]
    own = predicted[:, 2:] - predicted[:, :2]
    latest = np.maximum(sides, own * np.array([track.shown for track in tracks]))
    shrunk = sides < _WHOLE * np.minimum(own, latest)
    jumped = (normal > FAR) & (opposite > 0)  # a vehicle that brakes pushes it out
    crept = np.tile(shrunk, 2) & (normal > np.maximum(opposite, 0.0))
    recede = _recede(tracks, edges, settings.edge_noise) & ~unknown.any(axis=1)
    covered = (jumped | crept) & ~unknown & ~recede[:, np.newaxis]
    places = places_of(predicted, size)
    shorter = (sides < _WHOLE * latest).any(axis=1)
    for index in np.flatnonzero(~unknown.any(axis=1)).tolist():
        _shorten(tracks[index], places[index], uncoverings, is_short=bool(shorter[index]))
    pairs = zip(tracks, places, strict=True)
    patient = np.array([_is_patient(track, place, uncoverings) for track, place in pairs])
    left_out = unknown | (covered & patient[:, np.newaxis])
    residuals = np.where(left_out, 0.0, (predicted - edges) * INWARD)
    drifts = _doubt_drives(tracks, states, residuals, spread, recede)
    states.measure(edges, np.where(left_out, np.inf, spread))
    states.give_back([track.state for track in tracks])
    whole = ~covered.any(axis=1)
    # Successive residuals agree: states stay behind.
    lags = RATE * np.where(left_out, 0.0, edges - states.edges)
    rows = zip(tracks, latest, drifts, lags, whole.tolist(), strict=True)
    for track, shown, drift, lag, is_whole in rows:
        track.measured(shown, drift, lag, is_whole=is_whole)
    return np.asarray(whole)


def _shorten(track: Track, place: Place, uncoverings: Returns, *, is_short: bool) -> None:
    """Note whether less of a vehicle was detected than before, and what becomes of the rest."""
    short = track.shorten(place, is_short=is_short)
    if short in (0, SETTLED_AFTER) and (began := track.take_shortened()) is not None:
        uncoverings.learn(began, found=short == 0)


def _is_patient(track: Track, place: Place, uncoverings: Returns) -> bool:
    """Test whether edges that seem covered are left out: the longer, where they are seen again."""
    if track.matches < FEW or track.partial >= SETTLED_AFTER:
        return False
    return track.partial < FEW or uncoverings.share(track.shortened or place) >= HALF


def _recede(tracks: Sequence[Track], edges: Array, noise: float) -> npt.NDArray[np.bool_]:
    """Find vehicles (N,) that became smaller as a whole, and go on so: they drive away.

    What covers one draws an edge in, and changes its shape; `edges` and `noise` are of detections.
    """
    predicted = edges_of(tracks)
    shares = np.log((edges[:, 2:] - edges[:, :2]) / (predicted[:, 2:] - predicted[:, :2]))
    alike = np.abs(shares[:, 0] - shares[:, 1]) < 2 * noise  # that of four edges
    drawn_in = ((edges - predicted) * INWARD > 0)[:, _ENDS]
    lately = np.array([track.drift for track in tracks])[:, _ENDS] <= 0
    in_sight = np.array([len(track.covers) == 0 for track in tracks])
    smaller = (shares < 0).all(axis=1) & (drawn_in & lately).all(axis=1)
    return np.asarray(in_sight & alike & smaller)


def _doubt_drives(
    tracks: Sequence[Track],
    states: VehicleState,
    residuals: Array,
    spread: Array,
    recede: npt.NDArray[np.bool_],
) -> Array:
    """Be less sure of drives that detections keep contradicting; the drifts (N, 4) from now on.

    Where the horizon is wrong or the road bends, a drive is wrong in every frame by a little, on
    the same side, and a state that is sure of it would stay behind until no detection fits. The
    covariance is then that by which the residuals were expected, as in the strong tracking filter
    of Zhou and Frank (1996). Only an edge outside the prediction counts, unless the vehicle
    recedes, and as far as the opposite edge has moved, too: what covers a vehicle draws an edge in,
    and a box of two vehicles pushes one out.

    Parameters
    ----------
    tracks : sequence of N Track
        Tracks, predicted into this frame.
    states : VehicleState
        Their states, stacked.
    residuals, spread : (N, 4) arrays
        Detection less prediction, outward, zero of edges that tell nothing; and the standard
        deviations of the measurement, px.
    recede : (N,) array
        True where the vehicle drives away.
    """
    variances = states.edge_covariance.diagonal(axis1=1, axis2=2)
    alone = (intersections(states.edges[:, np.newaxis], states.edges) > 0).sum(axis=1) == 1
    drift = np.array([track.drift for track in tracks])
    drift += RATE * (residuals / np.sqrt(variances + spread**2) - drift)
    away = recede[:, np.newaxis]
    outward = np.clip(np.where(away, -drift, drift), 0.0, np.abs(drift[:, _OPPOSITE]))
    seen = ((residuals > 0) | away) & (outward > 0)
    expected = np.where(seen, variances, 0.0).sum(axis=1)
    lacking = np.where(seen, residuals**2 - spread**2, 0.0).sum(axis=1)
    # One for each edge. At 2.5 errors that detectors repeat are followed, too: HOTA of CenterNet on
    # the exam's clip falls by one; at 9 more boxes stay behind vehicles that come near.
    wrong = ((outward**2).sum(axis=1) > len(Edge)) & (lacking > expected) & alone
    wider = np.where(wrong, lacking / np.where(wrong, expected, 1.0), 1.0)
    states.covariance *= wider[:, np.newaxis, np.newaxis]
    drift[wrong] = 0.0
    return drift


def _divide(tracks: Sequence[Track], edges: Array, others: Array) -> None:
    """Shrink boxes of several vehicles that were taken for one to the nearest one's.

    Vehicles that enter the image side by side are one blob, and drive apart later. The detection of
    one is then no part of a larger vehicle whose rest is hidden: the rest is there, behind it.

    Parameters
    ----------
    tracks : sequence of N Track
        Tracks, predicted into this frame.
    edges : (N, 4) array
        Edges of the detection of each, px.
    others : (M, 4) array
        Edges of all detections.
    """
    predicted = edges_of(tracks)
    each, own = predicted[:, np.newaxis], edges[:, np.newaxis]
    beside = (
        (intersections(each, others) > LITTLE * areas(each))
        & (intersections(own, others) < LITTLE * areas(others))
        & (others[:, Edge.BOTTOM] < own[..., Edge.BOTTOM])
    ).any(axis=1)
    known = intersections(predicted, edges) > INSIDE * areas(edges)
    for track, box, crowded in zip(tracks, edges, (known & beside).tolist(), strict=True):
        if track.crowd(crowded=crowded) >= FEW:
            track.fill(box)


def outgrown(tracks: Sequence[Track], edges: Array) -> list[Track]:
    """Find those that were known by a part only, and make each as large as the box around it.

    Where something hides a vehicle at first, or the background has its colour, it is followed by
    what is seen; a box of all of it then is too large to be its own.

    Parameters
    ----------
    tracks : sequence of N Track
        All vehicles.
    edges : (M, 4) array
        Edges of the detections that are no vehicle's.
    """
    boxes = edges_of(tracks)
    common = intersections(edges[:, np.newaxis], boxes)
    alone = (common > 0).sum(axis=1, keepdims=True) == 1
    found = []
    for row, column in np.argwhere(alone & (common > INSIDE * areas(boxes))).tolist():
        track = tracks[column]
        # Two that drive side by side are one for a while, too: boxes of it alone have to be few.
        if (
            track.undetected
            and track.in_sight
            and track.crowd(crowded=True) >= max(FEW, HALF * track.matches)
        ):
            track.fill(edges[row])
            found.append(track)
    return found
