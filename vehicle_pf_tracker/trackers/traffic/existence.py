# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence that tracks are vehicles: what confirms them, what ends them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from vehicle_pf_tracker.core.overlaps import inside_image
from vehicle_pf_tracker.trackers.traffic.association import FrameDetections
from vehicle_pf_tracker.trackers.traffic.detection_evidence import (
    CERTAIN,
    HALF,
    LITTLE,
    DetectionEvidence,
    places_of,
)
from vehicle_pf_tracker.trackers.traffic.occlusion import Returns
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.track import FEW, SEEN_WITHIN, Track, edges_of
from vehicle_pf_tracker.trackers.traffic.vehicle_state import FAR, SETTLED_AFTER

_MOST = 3.0
"""Log odds, one in twenty, that one detection adds at most by its score, and by where it is: no
single one proves a vehicle. As much against it refutes one."""
_SCORE_DOUBT = 0.5
"""Log odds that one score takes off at most, so that a detector which knows little about a vehicle
does not hide it for ever; and that are taken off each, in confirming by scores alone."""
_PROVEN = 4.0
"""Sum of the log odds of scores above which no drive is asked for."""
_MISSED = 0.15
"""Log odds that a detection missed in plain sight takes off a vehicle: something unknown may hide
it, so that only 50 take off all that it can have."""
_NEW_VEHICLES = 0.1
"""Vehicles that come into view per image: one in a third of a second at 30 Hz."""
_SURELY_DRIVES = 50.0
"""Evidence for a drive above which scores are ignored: false alarms side by side reach 35."""
_PRIOR = 10.0
"""Vehicles in plain sight that were detected, and that were missed, before any was seen."""
_BLIND_FROM = 2
"""Least vehicles in sight, all missed in one image, for the detector to have failed:
they did not all vanish at once."""
_BLIND_FOR = 150.0
"""Nominal periods after which a vehicle that no detector sees is doubted even so: 5 s at 30 Hz."""


class Existence:
    """Confirms and ends tracks.

    Parameters
    ----------
    parameters : TrafficParameters
        Parameters.
    evidence : DetectionEvidence
        Learns what becomes of detections.

    Attributes
    ----------
    reappearances, uncoverings : Returns
        What became of vehicles that vanished in plain sight, and of parts of others that did.
    """

    def __init__(self, parameters: TrafficParameters, evidence: DetectionEvidence) -> None:
        self.parameters = parameters
        self._evidence = evidence
        self._detected, self._asked = _PRIOR, 2 * _PRIOR
        self.reappearances, self.uncoverings = Returns(), Returns()

    @property
    def detection_rate(self) -> float:
        """Share of the vehicles in plain sight that the detector finds."""
        return self._detected / self._asked

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
            Log odds by where it is.
        """
        fit = min(max(fit, -_MOST), _MOST)
        stands = track.has_driven and track.state.speed_ratio < FAR
        return self._add(track, found, index, 0.0 if track.confirmed and stands else fit)

    def resume(self, hidden: Track, track: Track) -> None:
        """Let a hidden vehicle go on as the new track that it turned out to be."""
        self._note_found(hidden)
        hidden.resume(track)

    def _note_found(self, track: Track) -> None:
        if track.vanished is not None:
            self.reappearances.learn(track.vanished, found=True)
            if (place := track.take_shortened()) is not None:
                self.uncoverings.learn(place, found=True)

    def _add(self, track: Track, found: FrameDetections, index: int, fit: float) -> bool:
        sample, log_odds = found.samples[index], float(found.log_odds[index])
        gain = log_odds if track.confirmed else float(found.gains[index])
        self._note_found(track)
        track.add_evidence(found.edges[index], min(max(gain, -_SCORE_DOUBT), _MOST), fit)
        doubted = min(max(log_odds - _SCORE_DOUBT, -_SCORE_DOUBT), _MOST)
        # Scores prove what has not moved only if most vehicles' detections have lower ones: a spot
        # that looks like a vehicle does so each time, and many such scores are worth one.
        if track.way < LITTLE and found.ranks[index] < HALF:
            doubted = -_SCORE_DOUBT
        track.prove(doubted, sample)
        if track.has_driven or track.given:
            if track.given or track.state.speed_ratio > FAR:
                self._evidence.learn(sample, True)
            return False
        known = track.confirmed or track.log_odds >= self.parameters.birth.evidence
        is_old = track.age >= found.wait
        track.judge(known and is_old and self._drives(track))
        self._teach(track)
        proven = track.has_driven or track.strength > _PROVEN
        return not track.confirmed and known and is_old and proven

    def _teach(self, track: Track) -> None:
        """Learn from the detections of what has driven, or stands for long."""
        if track.has_driven:
            for one in track.take_samples():
                self._evidence.learn(one, True)
        else:
            for one in track.take_samples(SETTLED_AFTER):
                if not track.confirmed and track.way < LITTLE:
                    self._evidence.learn(one, False)

    def _drives(self, track: Track) -> bool:
        evidence = track.drive()
        # False alarms side by side look like a short drive.
        doubt = track.doubt if evidence < _SURELY_DRIVES else 0.0
        needed = self.parameters.birth.displacement * (1 + HALF * doubt)
        return track.way > needed and evidence > CERTAIN

    def fade(self, tracks: Sequence[Track], elapsed: float, size: tuple[int, int]) -> None:
        """Take off evidence from tracks that a detector has not seen.

        Parameters
        ----------
        tracks : sequence of Track
            All, after detections were given to them.
        elapsed : float
            Nominal periods since the last frame.
        size : (int, int)
            Width and height of the image.
        """
        is_blind = not any(one.confirmed and one.undetected == 0 for one in tracks)
        if is_blind and _in_sight(tracks) >= _BLIND_FROM:
            return
        places = places_of(edges_of(tracks), size)
        for track, place in zip(tracks, places, strict=True):
            if track.has_driven and track.in_sight and track.unseen < SEEN_WITHIN:
                self._detected += track.undetected == 0
                self._asked += 1
            if track.undetected == 0 or (track.given and track.unseen < SEEN_WITHIN):
                continue
            if track.in_sight:
                track.miss(elapsed * self._missed(track), place)

    def _missed(self, track: Track) -> float:
        return _MISSED if track.confirmed else -math.log(1 - self.detection_rate)

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
            has_left = track.inside < HALF and track.unseen >= SEEN_WITHIN
            is_old = unseen > self.parameters.lost_after
            track.lose(is_old or has_left or self._is_doubtful(track))
            if self._goes_on(track, unseen, inside):
                kept.append(track)
                continue
            if track.confirmed:
                if inside > LITTLE:
                    self._note_end(track)
                continue
            # What drove may have been a vehicle, and tells nothing about its detections.
            if track.matches < FEW or not self._drives(track):
                for sample in track.samples:
                    self._evidence.learn(sample, False)
        return kept

    def _note_end(self, track: Track) -> None:
        for returns, place in (
            (self.reappearances, track.vanished),
            (self.uncoverings, track.take_shortened()),
        ):
            if place is not None:
                returns.learn(place, found=False)

    def _is_doubtful(self, track: Track) -> bool:
        """Test whether a vehicle is rather not there, by what is known of it or of its place."""
        place = track.vanished
        return track.log_odds < 0 or (place is not None and self.reappearances.share(place) < HALF)

    def _goes_on(self, track: Track, unseen: float, inside: float) -> bool:
        if not track.confirmed:
            waiting = track.undetected <= FEW / self.detection_rate
            return waiting and track.log_odds >= -CERTAIN and inside > 0
        if inside < LITTLE:
            return False
        longest = self.parameters.lost_after + self.parameters.forgotten_after
        return track.log_odds >= -_MOST and unseen <= longest


def _in_sight(tracks: Sequence[Track]) -> int:
    """Count the vehicles that a detector should see: it lately did, and pixels still do."""
    return sum(
        track.confirmed
        and track.unseen < SEEN_WITHIN
        and track.undetected <= _BLIND_FOR
        and track.in_sight
        for track in tracks
    )
