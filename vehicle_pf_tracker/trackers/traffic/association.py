# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Assignment of detections to tracks, and of new tracks to vehicles that were hidden.

The cost of a pair is the squared distance of the four edges in standard deviations, or, where the
detection lies inside the predicted box because something hides a part, that of the edges that are
not drawn in, and a price of what it lacks. Before a new vehicle is reported,
it is compared with those that are hidden near by: by distance, size and colours.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.overlaps import NOTHING, areas, clipped, overlaps
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins, similarity
from vehicle_pf_tracker.trackers.traffic.detection_evidence import (
    HALF,
    LEAST_PART,
    DetectionEvidence,
)
from vehicle_pf_tracker.trackers.traffic.parameters import DetectionParameters
from vehicle_pf_tracker.trackers.traffic.track import FALL, FEW, Track
from vehicle_pf_tracker.trackers.traffic.vehicle_state import (
    PIXEL_NOISE,
    SETTLED_AFTER,
    VehicleState,
)

GATE = 30.0
"""Largest cost of a pair: more than 23.5, the 0.9999 quantile of chi-squared with four degrees of
freedom, since the noise of edges is an estimate."""
INWARD = np.array([1.0, 1.0, -1.0, -1.0])
"""Sign of a residual (detection less prediction) of left, top, right, bottom that points inward."""
_SIZES = 2.0
"""Logarithm of the ratio of the largest and the smallest false alarms, by which they are spread. At
1 vehicles that pass close and fast are found late: IDF1 of three scenes is 67 instead of 83."""

_PARTIAL, _MISSING = 3.0, 12.0
"""Cost of taking a detection for a part of the vehicle, and of all of it that it lacks. At 0 and 15
IDF1 by motion behind the bridge falls by four: pieces of blobs are taken for the vehicle."""


def check_library() -> None:
    """Load the library of `assign` at the start: it takes a second, in which a node loses images.

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


def deviations(edges: Array, noise: float) -> Array:
    """Estimate the standard deviations (..., 4) of measured edges in px.

    Parameters
    ----------
    edges : (..., 4) array
        Boxes in px.
    noise : float
        Standard deviation of an edge, fraction of the size.
    """
    size = edges[..., 2:] - edges[..., :2]
    return np.asarray(np.hypot(np.concatenate([size, size], axis=-1) * noise, PIXEL_NOISE))


def edge_costs(predicted: Array, deviations: Array, detected: Array) -> Array:
    """Cost of each pair by the edges, (tracks, detections).

    Parameters
    ----------
    predicted, deviations : (T, 4) arrays
        Edges of the tracks and their standard deviations, measurement included, px.
    detected : (D, 4) array
        Edges of the detections, px.
    """
    inward = (detected[np.newaxis] - predicted[:, np.newaxis]) * INWARD
    normal = inward / deviations[:, np.newaxis]
    whole = (normal**2).sum(axis=2)
    outward = (np.minimum(normal, 0.0) ** 2).sum(axis=2)
    size = (predicted[:, 2:] - predicted[:, :2])[:, np.newaxis]
    lacking = np.maximum(inward, 0.0)
    kept = np.clip(1 - (lacking[..., :2] + lacking[..., 2:]) / size, 0.0, 1.0).prod(axis=2)
    part = outward + _PARTIAL + _MISSING * (1 - kept)
    return np.asarray(np.where(kept > LEAST_PART, np.minimum(whole, part), whole))


def assign(costs: Array) -> list[tuple[int, int]]:
    """Pairs (row, column) of least total cost, each below the gate."""
    if costs.size == 0:
        return []
    # Not at the top: help and parameters of `traffic` are printed without this library.
    from scipy.optimize import linear_sum_assignment  # noqa: PLC0415

    bounded = np.minimum(costs, GATE)
    rows, columns = linear_sum_assignment(bounded)
    good = bounded[rows, columns] < GATE
    return list(zip(rows[good].tolist(), columns[good].tolist(), strict=True))


class FrameDetections:
    """Detections of one frame, with what is known about each, while they are given to tracks.

    Parameters
    ----------
    detections : Detections
        Usable ones.
    evidence : DetectionEvidence
        Outcomes of earlier detections.
    colours : ColourBins
        Colours of the frame.
    size : (int, int)
        Width and height of the image.
    wait : float
        Nominal periods before a track of shapes is a vehicle.

    Attributes
    ----------
    size : (int, int)
        Width and height of the image.
    edges : (N, 4) array
        Left, top, right and bottom in px.
    scores : (N,) array
        As the detector gave them.
    labels : tuple of str
        Classes.
    wait : float
        Nominal periods before a track of them is a vehicle: a piece of a vehicle drives as well,
        and is soon joined with the rest.
    samples : list of Sample
        For learning what becomes of them.
    log_odds : (N,) array
        Log odds that each is a vehicle.
    gains, ranks : (N,) arrays
        How much likelier each score is a vehicle's, as a logarithm; and how high among theirs.
    clutter : (N,) array
        Logarithm of the false alarms per image as often as where each is.
    false : (N,) array
        Logarithm of the density of false alarms where each is, over its edges in px.
    free : list of int
        Indices of those that no track has taken.
    """

    def __init__(
        self,
        detections: Detections,
        evidence: DetectionEvidence,
        colours: ColourBins,
        size: tuple[int, int],
        wait: float = 0.0,
    ) -> None:
        boxes, self.size = detections.boxes, size
        self.edges = np.hstack([boxes[:, :2], boxes[:, :2] + boxes[:, 2:]])
        self.scores = detections.scores
        self.labels = detections.labels
        self.wait = wait if detections.are_shapes else 0.0
        self.samples = evidence.samples(self.edges, self.scores, size)
        self.log_odds = evidence.log_odds(self.samples)
        self.gains = evidence.gains(self.scores)
        self.ranks = evidence.ranks(self.scores)
        self.clutter = evidence.clutter(self.samples)
        sides = self.edges[:, 2:] - self.edges[:, :2]
        self.false = self.clutter - math.log(size[0] * size[1])
        self.false -= np.log(sides * _SIZES).sum(axis=1)
        self.free = list(range(len(boxes)))
        self._colours = colours
        self._histograms: dict[int, Array] = {}

    def histogram(self, index: int) -> Array:
        """Colours of a detection."""
        if index not in self._histograms:
            self._histograms[index] = self._colours.histogram(self.edges[index], NOTHING)
        return self._histograms[index]


def pair_costs(
    tracks: Sequence[Track],
    found: FrameDetections,
    indices: Sequence[int],
    settings: DetectionParameters,
) -> tuple[Array, Array]:
    """Cost of each pair of a track and one of the detections at `indices`, and its log odds."""
    states = VehicleState.stacked([track.state for track in tracks])
    variances = states.edge_covariance.diagonal(axis1=1, axis2=2)
    spread = np.sqrt(variances + deviations(states.edges, settings.edge_noise) ** 2)
    predicted, detected = clipped(states.edges, found.size), found.edges[indices]
    costs = edge_costs(predicted, spread, detected)
    peaks = -np.log(spread * math.sqrt(2 * math.pi)).sum(axis=1)
    odds = peaks[:, np.newaxis] - costs / 2 - found.false[indices]
    alone = (intersections(predicted[:, np.newaxis], predicted) > 0).sum(axis=1) == 1
    alone &= np.array([track.in_sight for track in tracks])
    # However sure its drive is, it was wrong where a likely vehicle overlaps it by half.
    may_be = alone[:, np.newaxis] & (found.log_odds[indices] > 0)
    overlap = overlaps(predicted[:, np.newaxis], detected)
    return np.minimum(costs, np.where(may_be, GATE * (1 + HALF - overlap), np.inf)), odds


def cut_edges(edges: Array, size: tuple[int, int], noise: float) -> npt.NDArray[np.bool_]:
    """Find the edges of boxes (..., 4) that lie beyond the borders of an image, or may do.

    They may where they are nearer than their own deviation; `noise` is that of `deviations`.
    """
    margin = deviations(edges, noise)[..., :2]
    return np.concatenate([edges[..., :2] <= margin, edges[..., 2:] >= size - margin], axis=-1)


def birth_odds(
    tracks: Sequence[Track], found: FrameDetections, indices: Sequence[int], noise: float
) -> Array:
    """Log odds (tracks, detections) that a detection is a new track's and no false alarm.

    The density of the prediction against that of false alarms there, which have any size. An edge
    that is cut in both tells nothing. Only where it is says so, neither scores nor colours.

    Parameters
    ----------
    tracks : sequence of Track
        Tracks, predicted into this frame.
    found : FrameDetections
        Detections of the frame.
    indices : sequence of int
        Those to compare with.
    noise : float
        Standard deviation of an edge, fraction of the size.
    """
    states = VehicleState.stacked([track.state for track in tracks])
    predicted, detected = states.edges, found.edges[indices]
    covariances, spread = states.edge_covariance, deviations(detected, noise)
    reach = np.sqrt(covariances.diagonal(axis1=1, axis2=2))
    cut, also_cut = (cut_edges(edges, found.size, noise) for edges in (predicted, detected))
    apart = np.abs(detected[:, 0] - predicted[:, :1])
    reachable = math.sqrt(GATE)
    rows, columns = np.nonzero(
        (apart < reachable * (reach[:, :1] + spread[:, 0])) | (cut[:, :1] & also_cut[:, 0])
    )
    for edge in range(1, 4):
        far = np.abs(detected[columns, edge] - predicted[rows, edge])
        near = far < reachable * (reach[rows, edge] + spread[columns, edge])
        near |= cut[rows, edge] & also_cut[columns, edge]
        rows, columns = rows[near], columns[near]
    sides = np.tile(detected[:, 2:] - detected[:, :2], 2)
    unknown = (_SIZES * sides[columns]) ** 2 / (2 * np.pi)
    both_cut = cut[rows] & also_cut[columns]
    covariance = covariances[rows]
    covariance[:, range(4), range(4)] += spread[columns] ** 2 + np.where(both_cut, unknown, 0.0)
    odds = np.full((len(tracks), len(detected)), -np.inf)
    odds[rows, columns] = (
        _log_density(detected[columns] - predicted[rows], covariance)
        - found.false[indices][columns]
    )
    return odds


def _log_density(residuals: Array, covariances: Array) -> Array:
    """Logarithm of Gaussian densities (N,) at residuals (N, 4) of edges: one after the other."""
    total = np.zeros(len(residuals))
    for _ in range(residuals.shape[1]):
        # Rounding leaves no edge less than its measurement's noise.
        variance = np.maximum(covariances[:, 0, 0], PIXEL_NOISE**2)
        total -= (residuals[:, 0] ** 2 / variance + np.log(2 * np.pi * variance)) / 2
        slope = covariances[:, 1:, 0] / variance[:, np.newaxis]
        residuals = residuals[:, 1:] - slope * residuals[:, :1]
        covariances = covariances[:, 1:, 1:] - slope[..., np.newaxis] * covariances[:, :1, 1:]
    return total


def is_double(track: Track, others: Sequence[Track]) -> bool:
    """Test whether most of a new vehicle's detection is in that of another one, or reversely.

    Networks give one vehicle two boxes, for many frames on end: of it all and of its front, or with
    and without its shadow. Two vehicles side by side soon show more of each.

    Parameters
    ----------
    track : Track
        The new one.
    others : sequence of Track
        All tracks.
    """
    detected = [one.detection for one in others if one.confirmed and one.undetected == 0]
    boxes, own = np.array(detected).reshape(-1, 4), track.detection
    smaller = np.minimum(areas(boxes), areas(own))
    return bool((intersections(own, boxes) > HALF * smaller).any())


def former(track: Track, others: Sequence[Track]) -> Track | None:
    """Find the hidden vehicle that a new one is, if it is any.

    Parameters
    ----------
    track : Track
        The new one.
    others : sequence of Track
        All tracks.
    """
    costs = [(cost, one.serial, one) for one in others if (cost := _cost(track, one)) is not None]
    return min(costs)[2] if costs else None


def _cost(track: Track, other: Track) -> float | None:
    """Distance in reaches; None where it cannot be the same vehicle."""
    if other is track or not other.confirmed or other.undetected < FEW:
        return None
    if track.confirmed and other.undetected <= track.age:  # there were two of them
        return None
    if other.visible < HALF:
        return None
    new, old = track.state.box, other.state.box
    if not HALF < new.area / old.area < 1 / HALF:  # it reappears part by part
        return None
    (x, y), (u, v) = new.centre, old.centre
    width = math.sqrt(new.width * old.width)
    distance = math.hypot(x - u, y - v) / width / (1 + other.undetected / SETTLED_AFTER)
    fall = other.usual_similarity - similarity(other.colours, track.colours)
    # A confirmed one is rather another: beside a lorry that hides a car there often is one.
    is_near = distance <= (HALF if track.confirmed else 1)
    return distance if is_near and fall <= FALL and np.any(track.colours) else None
