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

"""State of `fusion`, its memory of the vehicle, and the input of one step."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum, Flag
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.camera_motion import CameraFlow
from vehicle_pf_tracker.image.foreground import Foreground
from vehicle_pf_tracker.image.window import keep_inside
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance, View
from vehicle_pf_tracker.trackers.fusion.departure import Departure, Strangers
from vehicle_pf_tracker.trackers.fusion.hypotheses import Hypotheses
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.perspective import Sightings
from vehicle_pf_tracker.trackers.fusion.surface_flow import SurfaceFlow
from vehicle_pf_tracker.trackers.fusion.surface_points import SurfacePoints
from vehicle_pf_tracker.trackers.fusion.turning import Turned, Turning

_LEAST_SIDE, _LARGEST_SHARE = 3.0, 1.5
"""Bounds of the sides: px, and share of the image."""


class Visibility(Enum):
    """How much of the vehicle is seen."""

    VISIBLE = "visible"
    PARTLY_HIDDEN = "partly hidden"
    TURNING = "turning"
    HIDDEN = "hidden"
    GONE = "gone"

    @property
    def is_seen(self) -> bool:
        """True where the vehicle itself tells where it is."""
        return self not in (Visibility.HIDDEN, Visibility.GONE)


class Work(Flag):
    """Costly tasks of a step: to follow the size; to judge the surface's flow and train."""

    SIZE = 1
    TRAINING = 2
    BOTH = SIZE | TRAINING


class State(NamedTuple):
    """Belief about the vehicle after a frame.

    Attributes
    ----------
    particles : Hypotheses
        Positions, velocities, growth, and visibility of each.
    position, size : (2,) arrays
        Centre, and width and height, px.
    visibility : Visibility
        How much of it is seen.
    whole : float
        Probability that it is seen as a whole, given that it is visible.
    frames : int
        Frames since the first one.
    work : Work
        Tasks of this frame.
    measured : (2,) array
        Size when it was measured last, before the vehicle was partly or wholly hidden, px.
    growth : float
        Rate at which a partly hidden vehicle grows.
    turning : Turning
        Outlines that may be those of a vehicle that turns.
    departure : Departure or None
        How one that is gone has left.
    left_image : bool
        True where the prediction's mean is outside the image.
    sets_off : bool
        True in a first step that has measured what moves in the first box.
    sightings : Sightings
        Earlier positions and sizes.
    points : SurfacePoints
        Points on the vehicle.
    surface : SurfaceFlow
        Share of the surface that moves with the vehicle.
    strangers : Strangers
        Response to what is not the vehicle.
    """

    particles: Hypotheses
    position: Array
    size: Array
    measured: Array
    visibility: Visibility = Visibility.VISIBLE
    whole: float = 0.99
    frames: int = 0
    work: Work = Work.BOTH
    growth: float = 0.0
    turning: Turning = Turning()
    departure: Departure | None = None
    left_image: bool = False
    sets_off: bool = False
    sightings: Sightings = Sightings()
    points: SurfacePoints = SurfacePoints()
    surface: SurfaceFlow = SurfaceFlow()
    strangers: Strangers = Strangers()

    @property
    def box(self) -> Box:
        """Box in the image, px."""
        return Box.around((self.position[0], self.position[1]), *self.size.tolist())

    @property
    def extent(self) -> float:
        """Geometric mean of the sides of the box, px."""
        return float(np.sqrt(self.size.prod()))

    @property
    def turned(self) -> Turned:
        """Outline of a vehicle that is `TURNING`."""
        vehicle = self.turning.vehicle
        assert vehicle is not None, "only a proven turn makes a vehicle `TURNING`"
        return vehicle

    @property
    def is_whole(self) -> bool:
        """True where it is likelier that all of the vehicle is seen than a part of it."""
        return self.whole > 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Memory:
    """Appearance of the vehicle, and earlier frames; each changes in place.

    `predict` adds the present frame to those of `camera` and `foreground`. `learn` trains
    `appearance`; its usual response is set by the first view, which everything is relative to.
    """

    appearance: Appearance
    camera: CameraFlow = field(default_factory=CameraFlow)
    foreground: Foreground = field(default_factory=Foreground)


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A frame, the frame periods since the one before, and what all parts of a step use."""

    frame: Frame
    elapsed: float
    parameters: FusionParameters
    rng: np.random.Generator
    memory: Memory

    def inside(self, positions: Array) -> Array:
        """Move positions (..., 2) into the image."""
        return keep_inside(self.frame, positions)

    def bounded(self, size: Array) -> Array:
        """Bound width and height."""
        largest = _LARGEST_SHARE * max(frame_size(self.frame))
        return np.minimum(np.maximum(size, _LEAST_SIDE), largest)

    def share_inside(self, position: Array, size: Array) -> float:
        """Share of a box, whose centre is inside the image, that is inside."""
        low, high = np.maximum(position - size / 2, 0), position + size / 2
        return float(((np.minimum(high, frame_size(self.frame)) - low) / size).prod())

    def hidden_velocity_sigma(self, sightings: Sightings) -> float:
        """Change of a hidden vehicle's velocity, of the size, per frame squared.

        Larger where sightings were carried along with a camera that moved: the background's motion
        is not quite that of the road under the vehicle.
        """
        motion = self.parameters.motion
        if sightings.are_steady:
            return motion.hidden_velocity_sigma
        return math.hypot(motion.hidden_velocity_sigma, motion.camera_velocity_sigma)


@dataclass(frozen=True, slots=True, eq=False)
class Observation:
    """The vehicle as it was found in the present frame.

    Attributes
    ----------
    view : View
        The response around it.
    position : (2,) array
        Centre, px.
    response : float
        Height of the peak there, relative to the usual one.
    again : bool
        True for a vehicle that was hidden before.
    """

    view: View
    position: Array
    response: float
    again: bool
