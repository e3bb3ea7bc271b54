# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that are followed: names, drives, evidence, visibility, appearance.

All are frozen arrays with one row for each vehicle, so that a step is one call for all of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.overlaps import NO_BOXES
from vehicle_pf_tracker.image.windows.box_colours import COLOUR_BINS
from vehicle_pf_tracker.trackers.traffic.horizon import Growths
from vehicle_pf_tracker.trackers.traffic.paths import Paths
from vehicle_pf_tracker.trackers.traffic.rows import Bools, Integers, Objects, Rows, filled
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Gaussians

IN_SIGHT = 0.5
"""Share of a box, not covered and inside the image, above which a detector should see it: most of
it. One bound for misses, matches and parts, so that what is excused in one is in the others."""
_SEEN_WITHIN = 2.0
"""Nominal periods within which a vehicle counts as seen: one frame may fail."""


@dataclass(frozen=True, slots=True, eq=False)
class Names(Rows):
    """Names of N vehicles.

    Attributes
    ----------
    serial : (N,) array
        Number of the track.
    identity : (N,) array
        Number of the vehicle; 0 until it is confirmed.
    by_hand : (N,) array
        True for those that were given by hand: that no detector finds one does not refute it.
    joined : (N,) array
        Number of the track as which it was found again; 0 if of none.
    votes : (N,) array of mapping of str to int
        Number of its detections by their class.
    """

    serial: Integers
    identity: Integers
    by_hand: Bools
    joined: Integers
    votes: Objects

    def voted(self, labels: Sequence[str]) -> Names:
        """Take the classes of a detection of each."""
        if not any(labels):
            return self
        votes = self.votes.copy()
        for row, label in enumerate(labels):
            if label:
                votes[row] = added_votes(votes[row], {label: 1})
        return replace(self, votes=votes)


def added_votes(votes: Mapping[str, int], others: Mapping[str, int]) -> dict[str, int]:
    """Add votes by class; of equally many the class that was seen first wins."""
    # A new mapping in the order of first votes: rows are shared between states.
    return {**votes, **{label: votes.get(label, 0) + count for label, count in others.items()}}


@dataclass(frozen=True, slots=True, eq=False)
class Extents(Rows):
    """How much is seen of each of N vehicles.

    Attributes
    ----------
    shown : (N, 2) array
        Largest width and height of its latest detections, fractions of the state's.
    partial : (N,) array
        Number of its latest detections in a row that showed only a part of it.
    crowded : (N,) array
        Number of its latest detections in a row that had another one beside them in its box.
    enclosed : (N,) array
        Number of images since its latest detection with a box around it.
    """

    shown: Array
    partial: Integers
    crowded: Integers
    enclosed: Integers


@dataclass(frozen=True, slots=True, eq=False)
class Drives(Rows):
    """Drives of N vehicles.

    Attributes
    ----------
    gaussians : Gaussians
        Place, size and velocity.
    before : (N, 4) array
        Edges in the frame before, px.
    drift : (N, 4) array
        Mean of the latest outward residuals of the edges, in standard deviations.
    lag : (N, 4) array
        Distance by which the state stays behind the detection, px; estimates add it.
    extents : Extents
        Visible extents.
    growths : Growths
        Regressions of the widths on the lower edges.
    """

    gaussians: Gaussians
    before: Array
    drift: Array
    lag: Array
    extents: Extents
    growths: Growths


@dataclass(frozen=True, slots=True, eq=False)
class Beliefs(Rows):
    """Evidence that N vehicles exist.

    Attributes
    ----------
    log_odds : (N,) array
        Log odds that it is a vehicle.
    strength : (N,) array
        Evidence by the scores of its detections alone.
    doubt : (N,) array
        Log odds against a vehicle by these scores; never below zero.
    has_driven : (N,) array
        True once its path has shown that it is no part of the scene.
    paths : Paths
        Paths through the image: how far, how straight, and for how long each has stood.
    samples : (N,) array of tuple of Sample
        Scores and places of detections whose outcome is still unknown.
    """

    log_odds: Array
    strength: Array
    doubt: Array
    has_driven: Bools
    paths: Paths
    samples: Objects


@dataclass(frozen=True, slots=True, eq=False)
class Absences(Rows):
    """How long N vehicles were not seen.

    Attributes
    ----------
    unseen, undetected : (N,) arrays
        Nominal periods since it was last seen, and last detected.
    searched : (N,) array
        Number of images that the detector has searched since its latest detection.
    lost : (N,) array
        True where it was hidden for too long to be predicted, has left, or is rather not there.
    """

    unseen: Array
    undetected: Array
    searched: Integers
    lost: Bools

    @property
    def seen(self) -> Bools:
        """True (N,) where it counts as seen, by a detector or by its pixels."""
        return np.asarray(self.unseen < _SEEN_WITHIN)

    def ended(self) -> Absences:
        """End all absences, as of tracks that were just detected."""
        count = len(self)
        zero = np.zeros(count)
        # `lost` stays: `ending.end_tracks` judges it anew in every frame.
        return Absences(zero, zero, np.zeros(count, np.intp), self.lost)


@dataclass(frozen=True, slots=True, eq=False)
class Visibility(Rows):
    """Visibility of N vehicles, as predicted.

    Attributes
    ----------
    uncovered, inside : (N,) arrays
        Share of its box that no nearer vehicle hides, and that lies in the image.
    covers : (N,) array of (K, 4) arrays
        Edges of the nearer boxes over its box, px.
    hidden_by : (N,) array
        Identity of the nearest vehicle that hides a good part of it; 0 if none does.
    """

    uncovered: Array
    inside: Array
    covers: Objects
    hidden_by: Integers

    @classmethod
    def full(cls, count: int) -> Visibility:
        """Visibility of vehicles that nothing hides."""
        shares = np.ones(count)
        return cls(shares, shares, filled(count, NO_BOXES), np.zeros(count, np.intp))


@dataclass(frozen=True, slots=True, eq=False)
class Appearance(Rows):
    """Colours of N vehicles.

    Attributes
    ----------
    colours : (N, COLOUR_BINS) array
        Histogram of its colours; zero while unknown.
    usual_similarity : (N,) array
        Similarity of its colours to those learnt, while it is detected.
    """

    colours: Array
    usual_similarity: Array

    @classmethod
    def unknown(cls, count: int) -> Appearance:
        """Appearance before the first detection: as similar as can be, until colours differ."""
        return cls(np.zeros((count, COLOUR_BINS)), np.ones(count))


@dataclass(frozen=True, slots=True, eq=False)
class LatestDetection(Rows):
    """Latest detection of each of N vehicles.

    Attributes
    ----------
    detection : (N, 4) array
        Edges of its latest detection, px.
    score : (N,) array
        Score of its detection in this frame; NaN without one.
    """

    detection: Array
    score: Array


@dataclass(frozen=True, slots=True, eq=False)
class Tracks(Rows):
    """N vehicles: all that the tracker knows of each, by what changes together."""

    names: Names
    drives: Drives
    beliefs: Beliefs
    visibility: Visibility
    absences: Absences
    appearance: Appearance
    latest: LatestDetection

    @classmethod
    def begun(cls, gaussians: Gaussians, serial: Integers, detections: Array) -> Tracks:
        """Begin tracks of which nothing is known but where they are."""
        count = len(gaussians)
        # Arrays are shared between fields: none is ever written in place.
        numbers = np.zeros(count, np.intp)
        zero = np.zeros(count)
        no = np.zeros(count, np.bool_)
        edges = np.zeros((count, 4))
        extents = Extents(np.zeros((count, 2)), numbers, numbers, numbers)
        return cls(
            names=Names(serial, numbers, no, numbers, filled(count, {})),
            drives=Drives(gaussians, edges, edges, edges, extents, Growths.unknown(count)),
            beliefs=Beliefs(zero, zero, zero, no, Paths.unknown(count), filled(count, ())),
            visibility=Visibility.full(count),
            absences=Absences(zero, zero, numbers, no),
            appearance=Appearance.unknown(count),
            latest=LatestDetection(detections, np.full(count, np.nan)),
        )

    @property
    def edges(self) -> Array:
        """Edges (N, 4), px."""
        return self.drives.gaussians.edges

    @property
    def confirmed(self) -> Bools:
        """True (N,) once it is known to be a vehicle."""
        return np.asarray(self.names.identity > 0)

    @property
    def detected(self) -> Bools:
        """True (N,) where it was detected in this frame."""
        return np.asarray(self.absences.undetected == 0)

    @property
    def in_sight(self) -> Bools:
        """True (N,) where nothing known hides it, and it is in the image."""
        # The smaller share: cover and border may take the same part.
        return np.asarray(np.minimum(self.visibility.uncovered, self.visibility.inside) > IN_SIGHT)


def no_tracks() -> Tracks:
    """Make the tracks of an empty road."""
    zero = np.zeros(0)
    none = Gaussians(np.zeros((0, 6)), np.zeros((0, 6, 6)), zero, NO_BOXES)
    return Tracks.begun(none, np.zeros(0, np.intp), NO_BOXES)
