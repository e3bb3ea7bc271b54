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

import math
from collections.abc import Sequence

import numpy as np

from vehicle_pf_tracker.core.box import intersections
from vehicle_pf_tracker.trackers.traffic.association import FrameDetections
from vehicle_pf_tracker.trackers.traffic.detections import (
    INSIDE,
    SHIPPED,
    DetectionEvidence,
    TrafficNumbers,
    areas,
    inside_image,
    overlaps,
)
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.track import SETTLED_AFTER, Track, edges_of

_LEAST, _MOST = -0.6, 2.0
"""Bounds of the log odds that the score of one detection adds: a few good scores are no proof, and
a detector that knows little about a vehicle must not hide it for ever."""
_SCORE_DOUBT = 0.5
"""Log odds per detection that are taken off, in confirming by scores alone."""
_NEW_VEHICLES = 0.05
"""Vehicles that come into view per image: one in two thirds of a second at 30 Hz."""
_MOST_FIT = 3.0
"""Most log odds by where a detection is: no single one proves a vehicle."""
_STRAIGHT, _DRIVES = 0.8, 7.0
"""Straightness of a drive, which a leap between two places that flicker cannot reach (0.75), and
least evidence for it: one in a thousand that flicker in one place have as much. What ended
unconfirmed after such a drive may have been a vehicle: taken for false alarms, its detections kept
those after it from being confirmed, too."""
_MOVING = 4.0
"""Standard deviations of its speed from zero above which a vehicle does not stand."""
_DOUBTED = 2.0
"""Log odds against a track, by the scores of its detections, for which it has to drive twice as
far: false alarms side by side look like a short drive."""
_SURELY_DRIVES = 50.0
"""Evidence for a drive above which scores are ignored, and the way is only to be longer than boxes
shake: false alarms side by side reach 35."""
_SMALLEST = 0.25
"""Size of the smallest vehicle on the road, of the usual one, by which large ones count more: a
motorcycle among lorries. Smaller ones that drive are parts of vehicles."""
_LARGEST = 1.0
"""Largest size on the road that is learnt: a box that reaches the horizon has no known distance,
and one that was far too large would make all others small for ever."""
_SIZE_MEMORY = 0.998
"""Weight of the detections before in the usual size: some minutes."""
_STANDING = 0.2
"""Way, of the size, below which it stands: boxes shake by less."""
_STILL, _USUAL = 0.05, 0.5
"""Way, of the size, below which a track has not moved at all; and share of the vehicles' detections
with lower scores above which scores prove it even so: a spot of the road that looks like a vehicle
does so each time, and many such scores are worth one."""
_PRIOR = 10.0
"""Vehicles in plain sight that were detected, and that were missed, before any was seen."""
_MOST_DETECTED = 0.9
"""Bound of the share of these that is detected: vehicles differ."""
_WAITS = 4.0
"""Detections that a tentative vehicle may miss by expectation before it is given up."""
_ONE_PERIOD = 1.5
"""Nominal periods since pixels held a vehicle in the frame before, at most: stamps jitter."""
_DOUBLE = 0.3
"""Log odds that a track without a detection loses while it is one box with a detected one."""
_SAME = 0.5
"""Intersection over union above which two boxes are one."""
_BLIND_FROM = 2
"""Least vehicles in sight, all missed in one image, for the detector to have failed:
they did not all vanish at once."""
_BLIND_FOR = 150.0
"""Nominal periods after which a vehicle that no detector sees is doubted even so: 5 s at 30 Hz."""
_IMPLAUSIBLE = -7.0
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
        self._sizes = np.zeros(2)
        self._detected, self._asked = _PRIOR, 2 * _PRIOR

    @property
    def detection_rate(self) -> float:
        """Share of the vehicles in plain sight that the detector finds."""
        return min(self._detected / self._asked, _MOST_DETECTED)

    def begun(self, track: Track, found: FrameDetections, index: int) -> bool:
        """Take the first detection of a new track; True if that is already enough."""
        fit = math.log(_NEW_VEHICLES) - float(found.clutter[index])
        return self._add(track, found, index, fit)

    def detected(self, track: Track, found: FrameDetections, index: int, fit: float) -> bool:
        """Add the evidence of a detection to its track; True if that proves a tentative one.

        Parameters
        ----------
        track : Track
            Track, measured already.
        found : FrameDetections
            Detections of the frame.
        index : int
            Which of them is the track's.
        fit : float
            Log odds by where it is, of `fits`; not used for a confirmed one.
        """
        if track.confirmed:
            drives = track.state.speed_ratio > _MOVING or not track.has_driven
            fit = self._numbers.agreement if drives else 0.0
        return self._add(track, found, index, min(fit, _MOST_FIT))

    def _add(self, track: Track, found: FrameDetections, index: int, fit: float) -> bool:
        sample, log_odds = found.samples[index], float(found.log_odds[index])
        gain = log_odds if track.confirmed else float(found.gains[index])
        track.add_evidence(found.edges[index], min(max(gain, _LEAST), _MOST), fit)
        doubted = min(max(log_odds - _SCORE_DOUBT, _LEAST), _MOST)
        if track.way < _STILL and found.ranks[index] < _USUAL:
            doubted = _LEAST
        track.prove(doubted, sample)
        if track.has_driven or track.given:
            if track.given or track.state.speed_ratio > _MOVING:
                self._evidence.learn(sample, True)
                size = min(track.state.road_size, _LARGEST)
                self._sizes = _SIZE_MEMORY * self._sizes + (size, size**2)
            return False
        known = track.confirmed or track.log_odds >= self.parameters.birth.evidence
        track.judge(known and self._drives(track))
        self._teach(track)
        proven = track.has_driven or track.strength > self._numbers.proven_by_scores
        return not track.confirmed and known and proven

    def _teach(self, track: Track) -> None:
        """Learn from the detections of what has driven, or stands for long."""
        if track.has_driven:
            for one in track.samples:
                self._evidence.learn(one, True)
            track.samples.clear()
        elif len(track.samples) > SETTLED_AFTER:
            oldest = track.samples.pop(0)
            if not track.confirmed and track.way < _STANDING:
                self._evidence.learn(oldest, False)

    def _drives(self, track: Track) -> bool:
        total, squared = self._sizes.tolist()
        is_small = total > 0 and track.state.road_size < _SMALLEST * squared / total
        if track.matches < self.parameters.birth.matches or is_small:
            return False
        evidence = _straight_drive(track)
        needed = self.parameters.birth.displacement * (1 + track.doubt / _DOUBTED)
        if evidence > _SURELY_DRIVES:
            needed = _STANDING
        return track.way > needed and evidence > _DRIVES

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
        doubles = _doubles([one for one in tracks if one.confirmed and one.undetected], detected)
        for track in tracks:
            if track.has_driven and track.in_sight and track.unseen <= _ONE_PERIOD:
                self._detected += track.undetected == 0
                self._asked += 1
            if track.undetected == 0 or (track.given and track.unseen <= _ONE_PERIOD):
                continue
            if track in doubles:
                track.miss(_DOUBLE * elapsed)
            if track.in_sight:
                track.miss(elapsed * self._missed(track))

    def _missed(self, track: Track) -> float:
        if not track.confirmed:
            return -math.log(1 - self.detection_rate)
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
        shares = inside_image(edges_of(tracks), size).tolist()
        for track, inside in zip(tracks, shares, strict=True):
            unseen = track.unseen * period
            track.lose(unseen > self.parameters.lost_after or track.log_odds < 0)
            if self._goes_on(track, unseen, inside):
                kept.append(track)
                continue
            if track.confirmed:
                continue
            if _straight_drive(track) <= _DRIVES:
                for sample in track.samples:
                    self._evidence.learn(sample, False)
        return kept

    def _goes_on(self, track: Track, unseen: float, inside: float) -> bool:
        if not track.confirmed:
            waiting = track.undetected <= _WAITS / self.detection_rate
            return waiting and track.log_odds >= _IMPLAUSIBLE and inside > 0
        if inside < (_LEFT if track.unseen == 0 else _LEFT_UNSEEN):
            return False
        longest = self.parameters.lost_after + self.parameters.forgotten_after
        return track.log_odds >= _REFUTED and unseen <= longest


def _straight_drive(track: Track) -> float:
    """Evidence that a track drives straight; 0 where it is not straight enough."""
    straightness, evidence = track.drive()
    return evidence if straightness > _STRAIGHT else 0.0


def _in_sight(tracks: Sequence[Track]) -> int:
    """Count the vehicles that a detector should see: it lately did, and pixels still do."""
    return sum(
        track.confirmed
        and track.unseen <= _ONE_PERIOD
        and track.undetected <= _BLIND_FOR
        and track.in_sight
        for track in tracks
    )


def _doubles(tracks: Sequence[Track], detected: Sequence[Track]) -> set[Track]:
    """Find tracks without a detection that are the same vehicle as a detected one."""
    boxes, others = edges_of(tracks)[:, np.newaxis], edges_of(detected)
    inside = (intersections(boxes, others) / areas(boxes)).max(axis=1, initial=0.0)
    same = overlaps(boxes, others).max(axis=1, initial=0.0) > _SAME
    return {
        track
        for track, is_same, share in zip(tracks, same, inside, strict=True)
        if is_same or (track.matches < SETTLED_AFTER and share > INSIDE)
    }
