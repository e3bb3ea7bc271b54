# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""State of `traffic`, what the camera has taught, and the input of one step."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.road.plane import RoadPlane
from vehicle_pf_tracker.trackers.traffic.bodies import NO_COMPANIONS, Companions
from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins
from vehicle_pf_tracker.trackers.traffic.detection_evidence import DetectionEvidence
from vehicle_pf_tracker.trackers.traffic.detection_rate import DetectionRate
from vehicle_pf_tracker.trackers.traffic.horizon import Horizon
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.speeds import Speeds
from vehicle_pf_tracker.trackers.traffic.tracks import Tracks
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Motion

Grey: TypeAlias = npt.NDArray[np.uint8]

_VEHICLE_WIDTH = 1.8
"""Width of a car in m, by which speeds and accelerations become widths: without a calibrated road
the vehicle itself is the only scale in the image."""
DENSE = 1 / 24
"""Longest interval of images, s, of the clips that bounds on numbers of images are from: at shorter
ones a leaf that swings, or what hides a vehicle, is the same in many images."""
_FOCAL = 1.2
"""Focal length, of the image's width: that of a camera with a field of view of 45 degrees, 1 / (2
tan 22.5°). A choice; it weighs uncertainty along the road against that across."""


@dataclass(frozen=True, slots=True, eq=False)
class Experience:
    """Experience with this camera, by place: all that changes in place.

    Attributes
    ----------
    detections : DetectionEvidence
        Outcomes of detections, by their scores and places.
    rate : DetectionRate
        Share of the vehicles in plain sight that the detector finds.
    speeds : Speeds
        Speeds of vehicles that have left.
    """

    detections: DetectionEvidence = field(default_factory=DetectionEvidence)
    rate: DetectionRate = field(default_factory=DetectionRate)
    speeds: Speeds = field(default_factory=Speeds)


class State(NamedTuple):
    """State of the tracker after a frame.

    Attributes
    ----------
    tracks : Tracks
        Vehicles that are followed, nearest first, new ones last.
    experience : Experience
        Statistics learnt from this camera; the only part that is changed in place.
    horizon : Horizon
        Row of the horizon, and what it is known by.
    companions : Companions
        Pairs of tracks that may be one body.
    last_identity, last_serial : int
        Number of the newest vehicle, and of the newest track.
    grey : (H, W) array or None
        The frame in grey, from which pixels are followed into the next one; None before the first.
    bad_states : int
        Vehicles dropped so far because their state was no Gaussian any more.
    """

    tracks: Tracks
    experience: Experience
    # Kept beside the tracks, as it outlives them: vehicles that have left still show it.
    horizon: Horizon = Horizon()
    companions: Companions = NO_COMPANIONS
    last_identity: int = 0
    last_serial: int = 0
    grey: Grey | None = None
    bad_states: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A frame, and what all parts of a step use.

    Attributes
    ----------
    size : (int, int)
        Width and height of the image.
    grey : (H, W) array
        The frame in grey.
    colours : ColourBins
        Joint colour bins of the frame.
    parameters : TrafficParameters
        Parameters.
    road : RoadPlane or None
        Calibrated road; None: horizon and depth are estimated from the boxes.
    period : float
        Nominal frame period in s.
    elapsed : float
        Time since the frame before, in nominal frame periods.
    normals : (P, 3) array
        Standard normal numbers that make particles.
    """

    size: tuple[int, int]
    grey: Grey
    colours: ColourBins
    parameters: TrafficParameters
    road: RoadPlane | None
    period: float
    elapsed: float
    normals: Array

    @property
    def motion(self) -> Motion:
        """Motion model of vehicles in this image and at this rate."""
        motion = self.parameters.motion
        # From SI units to widths and periods: m/s² by s² is m per period², over m.
        acceleration = motion.acceleration * self.period**2 / _VEHICLE_WIDTH
        top_speed = motion.top_speed * self.period / _VEHICLE_WIDTH
        return Motion(acceleration, top_speed, _FOCAL * self.size[0])

    @property
    def sparsity(self) -> float:
        """Interval of images over the longest dense one, at least 1: what each counts for."""
        return max(self.period / DENSE, 1.0)

    @property
    def measurement(self) -> MeasurementModel:
        """How a detector measures edges in this image."""
        return MeasurementModel(self.size, self.parameters.detections.edge_noise)
