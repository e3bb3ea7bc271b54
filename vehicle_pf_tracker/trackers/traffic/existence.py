# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Evidence that tracks are vehicles: what confirms them, what ends them."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.trackers.traffic.detections import (
    SHIPPED,
    DetectionEvidence,
    Sample,
    TrafficNumbers,
    areas,
    inside_image,
    overlaps,
)
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.track import MOST_EVIDENCE, Track, edges_of

_LEAST, _MOST = -0.6, 2.0
"""Bounds of the log odds that one detection adds: a few good scores are no proof, and a detector
that knows little about a vehicle must not hide it for ever."""
_SCORE_DOUBT = 0.5
"""Log odds per detection that are taken off, in confirming by scores alone."""
_STRAIGHT = 0.8
"""Straightness of the way of a vehicle; of flickering leaves it is below one half."""
_STRAIGHT_MATCHES = 15
"""Fewest detections that a straightness is judged by."""
_MOVED_MATCHES = 5
"""Fewest detections by which what ended unconfirmed is known to have driven: it may have been a
vehicle, and tells nothing about its detections. Taken for false alarms, vehicles that reach the
next bridge too soon kept those after them from being confirmed, too: of forty, six."""
_MISSED_TENTATIVE = 1.0
"""Log odds that a detection missed in plain sight takes off a new vehicle."""
_ONE_PERIOD = 1.5
"""Nominal periods since pixels held a vehicle in the frame before, at most: stamps jitter."""
_DOUBLE = 0.3
"""Log odds that a track without a detection loses while it is one box with a detected one."""
_SAME = 0.5
"""Intersection over union above which two boxes are one."""
_PART = 0.7
"""A young track covered by a detected one by more than this fraction is taken for a part of it."""
_YOUNG = 30
"""Detections by which a track has shown that it is a vehicle of its own."""
_BLIND_FROM = 2
"""Least vehicles in sight, all missed in one image, for the detector to have failed:
they did not all vanish at once."""
_BLIND_FOR = 150.0
"""Nominal periods after which a vehicle that no detector sees is doubted even so: 5 s at 30 Hz."""
_PLAIN_SIGHT = 0.5
"""Share of a vehicle in sight, and in the image, in which it ought to be detected."""
_TENTATIVE_PERIODS = 5.0
"""Nominal periods without a detection after which a tentative vehicle is given up."""
_IMPLAUSIBLE = -2.0
_REFUTED = -3.0
"""Log odds below which a tentative, and a confirmed, vehicle is given up."""
_LEFT, _LEFT_UNSEEN = 0.1, 0.35
"""Share in the image below which a vehicle has left it, if it is seen and if it is not."""


class Existence:
    """Confirms and ends tracks.

    Parameters
    ----------
    parameters : TrafficParameters
        Parameters.
    evidence : DetectionEvidence
        Learns what becomes of detections.
    numbers : TrafficNumbers
        Weights of the evidence.
    """

    def __init__(
        self,
        parameters: TrafficParameters,
        evidence: DetectionEvidence,
        numbers: TrafficNumbers = SHIPPED,
    ) -> None:
        self.parameters = parameters
        self._numbers = numbers
        self._evidence = evidence

    def detected(self, track: Track, edges: Array, sample: Sample, log_odds: float) -> None:
        """Add the evidence of a detection (edges in px) to its track."""
        track.unseen = track.undetected = 0.0
        track.hidden_by = None
        track.matches += 1
        agreement = self._numbers.agreement if track.matches > 1 else 0.0
        gain = min(max(log_odds, _LEAST), _MOST) + agreement
        track.log_odds = min(track.log_odds + gain, MOST_EVIDENCE)
        track.strength += min(max(log_odds - _SCORE_DOUBT, _LEAST), _MOST)
        if track.confirmed:
            self._evidence.learn(sample, True)
            return
        track.samples.append(sample)
        track.note_place((edges[:2] + edges[2:]) / 2)
        if self._is_vehicle(track):
            track.confirmed = True
            for one in track.samples:
                self._evidence.learn(one, True)
            track.samples.clear()

    def _is_vehicle(self, track: Track) -> bool:
        birth = self.parameters.birth
        if track.matches < birth.matches or track.log_odds < birth.evidence:
            return False
        if track.strength > self._numbers.proven_by_scores:
            return True
        return track.matches >= _STRAIGHT_MATCHES and self._drives(track)

    def _drives(self, track: Track) -> bool:
        return track.straightness > _STRAIGHT and track.way > self.parameters.birth.displacement

    def fade(self, tracks: Sequence[Track], elapsed: float) -> None:
        """Take off evidence from tracks that a detector has not seen.

        Parameters
        ----------
        tracks : sequence of Track
            All, after detections were given to them.
        elapsed : float
            Nominal periods since the last frame.
        """
        detected = [one for one in tracks if one.confirmed and one.undetected == 0]
        if not detected and _in_sight(tracks) >= _BLIND_FROM:
            return
        boxes = edges_of(detected)
        for track in tracks:
            if track.undetected == 0 or (track.given and track.unseen <= _ONE_PERIOD):
                continue
            if track.confirmed and _is_double(track, boxes):
                track.log_odds -= _DOUBLE * elapsed
            if min(track.visible, track.inside) > _PLAIN_SIGHT:
                track.log_odds -= elapsed * self._missed(track)

    def _missed(self, track: Track) -> float:
        if not track.confirmed:
            return _MISSED_TENTATIVE
        # Pixels are asked later in the frame: they held it if they did in the frame before.
        numbers = self._numbers
        return numbers.missed_held if track.unseen <= _ONE_PERIOD else numbers.missed_hidden

    def survivors(
        self, tracks: Sequence[Track], size: tuple[int, int], period: float
    ) -> list[Track]:
        """Tracks that go on, of which some are LOST.

        Parameters
        ----------
        tracks : sequence of Track
            All.
        size : (int, int)
            Width and height of the image.
        period : float
            Nominal frame period in s.
        """
        kept = []
        for track in tracks:
            unseen = track.unseen * period
            track.lost = unseen > self.parameters.lost_after or track.log_odds < 0
            if self._goes_on(track, unseen, inside_image(track.state.edges, size)):
                kept.append(track)
                continue
            if track.confirmed:
                continue
            if track.matches < _MOVED_MATCHES or not self._drives(track):
                for sample in track.samples:
                    self._evidence.learn(sample, False)
        return kept

    def _goes_on(self, track: Track, unseen: float, inside: float) -> bool:
        if not track.confirmed:
            waiting = track.undetected <= _TENTATIVE_PERIODS
            return waiting and track.log_odds >= _IMPLAUSIBLE and inside > 0
        if inside < (_LEFT if track.unseen == 0 else _LEFT_UNSEEN):
            return False
        longest = self.parameters.lost_after + self.parameters.forgotten_after
        return track.log_odds >= _REFUTED and unseen <= longest


def _in_sight(tracks: Sequence[Track]) -> int:
    """Count the vehicles that a detector should see: it lately did, and pixels still do."""
    return sum(
        track.confirmed
        and track.unseen <= _ONE_PERIOD
        and track.undetected <= _BLIND_FOR
        and min(track.visible, track.inside) > _PLAIN_SIGHT
        for track in tracks
    )


def _is_double(track: Track, detected: Array) -> bool:
    """Test whether a track without a detection is the same vehicle as a detected one."""
    if not len(detected):
        return False
    edges = track.state.edges
    if overlaps(edges, detected).max() > _SAME:
        return True
    share = intersections(edges, detected).max() / areas(edges)
    return track.matches < _YOUNG and float(share) > _PART
