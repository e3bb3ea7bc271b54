# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tracker of every vehicle in view; docs/traffic.md has the model."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box, check_target
from vehicle_pf_tracker.core.clock import DEFAULT_PERIOD
from vehicle_pf_tracker.core.frame import Frame, check_frame, frame_size
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.base import drawn_seed
from vehicle_pf_tracker.trackers.traffic.births import begin_in_boxes
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins
from vehicle_pf_tracker.trackers.traffic.ending import end_tracks
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate
from vehicle_pf_tracker.trackers.traffic.identity import number_by_hand
from vehicle_pf_tracker.trackers.traffic.observe import observe
from vehicle_pf_tracker.trackers.traffic.occlusion import find_occlusions
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.pixel_hold import hold_by_pixels
from vehicle_pf_tracker.trackers.traffic.prediction import find_horizon, predict
from vehicle_pf_tracker.trackers.traffic.recognition import learn_colours, learn_similarity
from vehicle_pf_tracker.trackers.traffic.report import estimates_of
from vehicle_pf_tracker.trackers.traffic.state import Experience, State, Step
from vehicle_pf_tracker.trackers.traffic.tracks import no_tracks


class MultiVehicleTracker:
    """Follow all vehicles of a stream of images.

    The same images, detections, parameters and seed give bit-identical estimates.

    Parameters
    ----------
    parameters : TrafficParameters, optional
        Parameters; None: the defaults.
    road : RoadPlane, optional
        Calibrated road, which gives the horizon and the order in depth; None: both are estimated
        from the boxes.

    Attributes
    ----------
    parameters : TrafficParameters
        Parameters in use.
    road : RoadPlane or None
        Road in use; it can be replaced between two frames, and counts from the next on.
    frame_period : float
        Nominal frame period in s, from which seconds become frames.
    seed : int
        Seed in use.
    """

    def __init__(
        self, parameters: TrafficParameters | None = None, road: RoadPlane | None = None
    ) -> None:
        self.parameters = parameters or TrafficParameters()
        self.road = road
        self.frame_period = DEFAULT_PERIOD
        self.seed = drawn_seed(self.parameters.seed)
        self._rng = np.random.default_rng(self.seed)
        self._state = State(no_tracks(), Experience())
        self._step: Step | None = None

    @property
    def last_identity(self) -> int:
        """Identity of the newest vehicle; 0 before the first."""
        return self._state.last_identity

    @property
    def bad_states(self) -> int:
        """Vehicles dropped so far because their state was no Gaussian any more."""
        return self._state.bad_states

    @property
    def cluttered_places(self) -> int:
        """Number of places in the image, of a grid, that had a false alarm lately."""
        return self._state.experience.detections.cluttered

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
        self._step = step = self._begin_step(check_frame(frame), elapsed)
        self._state = _advance(self._state, step, detections)
        return estimates_of(self._state.tracks)

    def _begin_step(self, frame: Frame, elapsed: float) -> Step:
        """Do once what all vehicles need of a frame."""
        # As many numbers in each frame, whatever is followed: a vehicle more or less does not
        # change the random numbers of the others, nor those of later frames.
        normals = self._rng.standard_normal((self.parameters.num_particles, 3))
        return Step(
            size=frame_size(frame),
            grey=np.asarray(cv2.cvtColor(frame, cv2.COLOR_RGB2GRAY), np.uint8),
            colours=ColourBins(frame),
            parameters=self.parameters,
            road=self.road,
            period=self.frame_period,
            elapsed=elapsed,
            normals=normals,
        )

    def add(self, box: Box, label: str = "") -> int:
        """Follow the vehicle in `box` of the latest frame from now on, and return its identity.

        Raises
        ------
        InputError
            If the box does not lie in the image.
        RuntimeError
            If no frame has been seen.
        """
        if self._step is None:
            raise RuntimeError("show the tracker a frame before adding a vehicle")
        # Parameters and the rate may have changed since.
        # Box and image are those of the latest frame; only settings are new.
        step = replace(self._step, parameters=self.parameters, period=self.frame_period)
        check_target(box, *step.size)
        edges = np.array([[*box.corners[0], *box.corners[2]]])
        state = number_by_hand(begin_in_boxes(self._state, edges, step))
        # A box by hand counts as seen whole: its colours are those that it is known again by.
        self._state = learn_colours(state, np.array([len(state.tracks) - 1]), [label], 1.0, step)
        return self._state.last_identity

    def remove(self, identity: int) -> bool:
        """Discard a vehicle; False if there is none of this identity."""
        tracks = self._state.tracks
        kept = tracks.names.identity != identity
        self._state = self._state._replace(tracks=tracks.take(kept))
        return not kept.all()

    def reset(self) -> None:
        """Discard all vehicles and all that was learnt; identities go on from where they were.

        Vehicles can still be added to the latest frame.
        """
        # The generator starts anew, too, so that a run after a reset repeats one from the
        # beginning.
        self._rng = np.random.default_rng(self.seed)
        # Numbers go on: none is ever given to a second vehicle.
        numbers = {
            name: getattr(self._state, name)
            for name in ("last_identity", "last_serial", "bad_states")
        }
        self._state = State(no_tracks(), Experience(), **numbers)
        if self._step is not None:
            self._step = replace(self._step, parameters=self.parameters, road=self.road)
            # Nothing was learnt yet: that is the assumed or the calibrated one, which `add` needs.
            self._state = find_horizon(self._state, self._step)

    def reconfigure(self, parameters: TrafficParameters) -> None:
        """Take new parameters between two frames; no vehicle is lost by it."""
        # Another seed only: the same one anew would repeat random numbers of earlier frames.
        if parameters.seed != self.parameters.seed:
            self.seed = drawn_seed(parameters.seed)
            self._rng = np.random.default_rng(self.seed)
        self.parameters = parameters


def _advance(state: State, step: Step, detections: Detections | None) -> State:
    """Go on by a frame; of `detections` None no detector has looked, and nothing is missed."""
    # 1. Predict, since all that follows is about where vehicles should be now.
    state = predict(state, step)
    # 2. Find who hides whom by the predictions: a missed detection counts only in plain sight.
    state = find_occlusions(state, step)
    # 3. Correct by detections, which are better evidence than pixels.
    if detections is not None:
        state = observe(state, step, detections)
    # 4. Hold by pixels what nothing detected. Even without such vehicles the frame is kept for the
    # next one.
    state = hold_by_pixels(state, step)
    # 5. End only now: a vehicle that pixels hold has been seen, and is not lost.
    state = end_tracks(state, step)
    # 6. Learn how alike colours usually are in the boxes that are reported, of those that go on.
    return learn_similarity(state, step)
