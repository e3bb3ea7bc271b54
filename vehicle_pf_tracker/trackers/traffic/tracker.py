# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tracker of every vehicle in view."""

from __future__ import annotations

import math
from collections.abc import Sequence

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, check_target, intersections
from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD
from vehicle_pf_tracker.core.frame import Frame, check_frame, frame_size
from vehicle_pf_tracker.core.overlaps import areas
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.base import drawn_seed
from vehicle_pf_tracker.trackers.traffic.association import (
    GATE,
    FrameDetections,
    assign,
    birth_odds,
    cut_edges,
    former,
    is_double,
    pair_costs,
)
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins, similarity
from vehicle_pf_tracker.trackers.traffic.detection_evidence import INSIDE, DetectionEvidence
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate
from vehicle_pf_tracker.trackers.traffic.existence import Existence
from vehicle_pf_tracker.trackers.traffic.horizon import Horizon
from vehicle_pf_tracker.trackers.traffic.measuring import first_state, measure, outgrown
from vehicle_pf_tracker.trackers.traffic.occlusion import cover, nearest_first
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.pixel_hold import PixelHold
from vehicle_pf_tracker.trackers.traffic.track import Track, edges_of, predict
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Drive, Edge

_VEHICLE_WIDTH = 1.8
"""Width of a car in m, by which speeds and accelerations become widths."""
_WAIT = 0.5
"""Time in s before a track of shapes is a vehicle. On 34 public clips of 24 to 30 Hz, 8, 15 and 22
images give 42.4, 44.2 and 43.3 IDF1; on a close road at 10 Hz 15 images are too long."""
_FOCAL = 1.2
"""Focal length, of the image's width: that of a camera with a field of view of 45 degrees."""


class TrafficTracker:
    """Follow all vehicles of a stream of images.

    The same images, detections, parameters and seed give bit-identical estimates.

    Parameters
    ----------
    parameters : TrafficParameters, optional
        Parameters; None: the defaults.
    road : RoadPlane, optional
        Calibrated road, which tells the horizon and which vehicle is nearer; None: both are taken
        from the boxes.

    Attributes
    ----------
    road : RoadPlane or None
        Road in use; it can be replaced between two frames, and counts from the next on.
    frame_period : float
        Nominal frame period in s, from which seconds become frames.
    bad_states : int
        Vehicles dropped so far because their state was no Gaussian any more.
    last_identity : int
        Identity of the newest vehicle; 0 before the first.
    seed : int
        Seed in use.
    """

    def __init__(
        self, parameters: TrafficParameters | None = None, road: RoadPlane | None = None
    ) -> None:
        self.parameters = parameters or TrafficParameters()
        self.road = road
        self.frame_period = DEFAULT_PERIOD
        self.bad_states = 0
        self.last_identity = 0
        self._serial = 0
        self.seed = drawn_seed(self.parameters.seed)
        self._frame: Frame | None = None
        self._tracks: list[Track] = []
        self._clear()

    @property
    def cluttered_places(self) -> int:
        """Number of places in the image, of a grid, that had a false alarm lately."""
        return self._evidence.cluttered

    def step(
        self, frame: Frame, detections: Detections | None = None, elapsed: float = 1.0
    ) -> tuple[TrackEstimate, ...]:
        """Follow all vehicles into the next frame.

        Parameters
        ----------
        frame : Frame
            RGB image.
        detections : Detections, optional
            What a detector saw in this frame, possibly nothing; None: no detector has looked.
        elapsed : float
            Time since the frame before, in nominal frame periods.

        Returns
        -------
        tuple of TrackEstimate
            One for every vehicle that is followed, by identity, tentative ones last.
        """
        self._look(frame)
        followed = predict(self._tracks, self._row, elapsed, self._drive)
        self.bad_states += len(self._tracks) - len(followed)
        self._tracks = nearest_first(followed, self.road)
        cover(self._tracks, self._size, self.parameters.occlusions)
        normals = self._rng.standard_normal((self.parameters.num_particles, 3))
        if detections is not None:
            self._take(detections.usable(*self._size), elapsed)
        if self.parameters.pixels:
            self._pixels.hold(self._tracks, self._colours, normals)
        self._end()
        self._learn_similarity()
        ordered = sorted(self._tracks, key=lambda one: (one.identity or math.inf, one.serial))
        return tuple(track.estimate() for track in ordered)

    def add(self, box: Box, label: str = "") -> int:
        """Follow the vehicle in `box` of the latest frame from now on, and return its identity.

        Raises
        ------
        InputError
            If the box does not lie in the image.
        RuntimeError
            If no frame has been seen.
        """
        if self._frame is None:
            raise RuntimeError("show the tracker a frame before adding a vehicle")
        check_target(box, *self._size)
        track = self._begin(np.array([*box.corners[0], *box.corners[2]]))
        track.name(label, 1.0)
        self._confirm(track, given=True)
        track.learn_colours(self._colours.histogram(track.state.edges, track.covers))
        return track.identity

    def remove(self, identity: int) -> bool:
        """Discard a vehicle; False if there is none of this identity."""
        count = len(self._tracks)
        self._tracks = [track for track in self._tracks if track.identity != identity]
        return len(self._tracks) < count

    def reset(self) -> None:
        """Discard all vehicles and all that was learnt; identities go on from where they were.

        Vehicles can still be added to the latest frame.
        """
        self._clear()
        if self._frame is not None:
            self._look_for_horizon()

    def _clear(self) -> None:
        self._rng = np.random.default_rng(self.seed)
        self._tracks = []
        self._pixels = PixelHold()
        self._evidence = DetectionEvidence()
        self._existence = Existence(self.parameters, self._evidence)
        self._horizon = Horizon()

    def reconfigure(self, parameters: TrafficParameters) -> None:
        """Take new parameters between two frames; no vehicle is lost by it."""
        if parameters.seed != self.parameters.seed:
            self.seed = drawn_seed(parameters.seed)
            self._rng = np.random.default_rng(self.seed)
        self.parameters = self._existence.parameters = parameters

    def _look(self, frame: Frame) -> None:
        """Do once what all vehicles need of a frame."""
        self._frame = check_frame(frame)
        self._size = frame_size(frame)
        grey = np.asarray(cv2.cvtColor(frame, cv2.COLOR_RGB2GRAY), np.uint8)
        self._pixels.show(grey)
        self._look_for_horizon()
        self._colours = ColourBins(frame)

    def _look_for_horizon(self) -> None:
        """Estimate the horizon, and move that of the vehicles which are followed."""
        growths = (track.growth for track in self._tracks if track.confirmed)
        assumed = self.parameters.motion.horizon
        self._row = self._horizon.look(assumed, growths, self._size, self.road)

    def _take(self, detections: Detections, elapsed: float) -> None:
        """Give the detections to the tracks; what is left over may be new vehicles."""
        self._evidence.look()
        wait = _WAIT / self.frame_period
        found = FrameDetections(detections, self._evidence, self._colours, self._size, wait)
        confirmed = [one for one in self._tracks if one.confirmed]
        for least in (0.0, -math.inf):
            self._match([one for one in confirmed if one.undetected], found, least)
            self._drop_inside([one for one in confirmed if not one.undetected], found)
        self._match_tentative([one for one in self._tracks if not one.confirmed], found)
        self._merge_twins()
        confirmed = [one for one in self._tracks if one.confirmed]
        self._match(outgrown(confirmed, found.edges[found.free]), found, -math.inf)
        self._existence.fade(self._tracks, elapsed, self._size)
        self._drop_inside([one for one in self._tracks if one.confirmed], found, either=True)
        for index in found.free:
            self._begin_from(found, index)

    def _match(self, tracks: Sequence[Track], found: FrameDetections, least: float) -> None:
        """Pair confirmed tracks with free detections of log odds from `least`."""
        indices = [index for index in found.free if found.log_odds[index] >= least]
        if tracks and indices:
            costs = pair_costs(tracks, found, indices, self.parameters.detections)
            self._correct(tracks, indices, *costs, found)

    def _match_tentative(self, tracks: Sequence[Track], found: FrameDetections) -> None:
        """Pair new tracks with free detections that are rather theirs than false alarms."""
        if not tracks or not found.free:
            return
        indices = found.free.copy()
        odds = birth_odds(tracks, found, indices, self.parameters.detections.edge_noise)
        self._correct(tracks, indices, GATE - odds, odds, found)

    def _correct(
        self,
        tracks: Sequence[Track],
        indices: Sequence[int],
        costs: Array,
        odds: Array,
        found: FrameDetections,
    ) -> None:
        """Correct tracks (rows) by the detections (columns) that cost least."""
        pairs = assign(costs)
        if not pairs:
            return
        fits = [float(odds[pair]) for pair in pairs]
        tracks, indices = [tracks[row] for row, _ in pairs], [indices[one] for _, one in pairs]
        found.free = sorted(set(found.free).difference(indices))
        edges = found.edges[indices]
        settings, uncoverings = self.parameters.detections, self._existence.uncoverings
        whole = measure(tracks, edges, settings, self._size, found.edges, uncoverings)
        cut = np.asarray(cut_edges(edges, self._size, settings.edge_noise).any(axis=1))
        rows = zip(tracks, indices, fits, whole, cut, strict=True)
        for track, index, fit, is_whole, is_cut in rows:
            track.name(found.labels[index], float(found.scores[index]))
            if is_whole:
                track.learn_colours(found.histogram(index))
                if not is_cut:
                    track.growth.add(found.edges[index])
            if self._existence.detected(track, found, index, fit):
                self._confirm(track)

    def _merge_twins(self) -> None:
        """Merge vehicles that were born a second time with the ones that they are."""
        missed = [one for one in self._tracks if one.confirmed and one.undetected]
        if not (missed and self.parameters.returning):
            return
        longest = max(one.undetected for one in missed)
        for track in self._tracks.copy():
            if not track.confirmed or track.undetected or track.age >= longest or track.given:
                continue
            if (twin := former(track, missed)) is not None:
                self._existence.resume(twin, track)
                self._tracks.remove(track)
                missed.remove(twin)

    def _confirm(self, track: Track, *, given: bool = False) -> None:
        """Give a new vehicle its number, unless it is one that was hidden, or seen twice."""
        may_return = self.parameters.returning and not given
        if may_return and (hidden := former(track, self._tracks)) is not None:
            self._existence.resume(hidden, track)
            self._tracks.remove(track)
            return
        if given or not is_double(track, self._tracks):
            self.last_identity += 1
            track.confirm(self.last_identity, given=given)

    def _drop_inside(
        self, tracks: Sequence[Track], found: FrameDetections, *, either: bool = False
    ) -> None:
        """Drop free detections that are inside vehicles, bonnets or second boxes, or `either`."""
        boxes, edges = edges_of(tracks), found.edges[found.free, np.newaxis]
        smaller = np.minimum(areas(boxes), areas(edges)) if either else areas(edges)
        inside = np.asarray((intersections(edges, boxes) > INSIDE * smaller).any(axis=1))
        for index, is_inside in zip(found.free.copy(), inside.tolist(), strict=True):
            if is_inside:
                found.free.remove(index)
                self._evidence.learn(found.samples[index], False, alone=False)

    def _begin_from(self, found: FrameDetections, index: int) -> None:
        """Take a detection for a new vehicle, as yet without evidence."""
        track = self._begin(found.edges[index])
        track.name(found.labels[index], float(found.scores[index]))
        track.learn_colours(found.histogram(index))
        if self._existence.begun(track, found, index):
            self._confirm(track)

    @property
    def _drive(self) -> Drive:
        motion, period = self.parameters.motion, self.frame_period
        acceleration = motion.acceleration * period**2 / _VEHICLE_WIDTH
        top_speed = motion.top_speed * period / _VEHICLE_WIDTH
        return Drive(acceleration, top_speed, _FOCAL * self._size[0])

    def _begin(self, edges: Array) -> Track:
        """Begin a track in a box."""
        # A horizon below the box would have it drive on the sky.
        horizon = min(self._row, float(edges[Edge.BOTTOM]) - 1)
        self._serial += 1
        noise = self.parameters.detections.edge_noise
        state = first_state(edges, noise, horizon, self._drive, self._size)
        track = Track(self._serial, state)
        self._tracks.append(track)
        return track

    def _end(self) -> None:
        """End tracks that are no vehicles, or have left; the horizon is learnt from the others."""
        kept = self._existence.survivors(self._tracks, self._size, self.frame_period)
        for track in self._tracks:
            if track.confirmed and track not in kept:
                self._horizon.learn(track.growth, self._size[1])
        self._tracks = kept

    def _learn_similarity(self) -> None:
        """Learn the usual similarity of each detected vehicle's colours to those learnt."""
        for track in self._tracks:
            if track.confirmed and track.undetected == 0:
                now = self._colours.histogram(track.state.edges, track.covers)
                track.learn_similarity(similarity(track.colours, now))
