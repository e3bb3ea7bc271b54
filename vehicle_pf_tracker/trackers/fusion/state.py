# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""State of `fusion`, its memory of the vehicle, and the input of one step."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
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
from vehicle_pf_tracker.trackers.fusion.turning import Branch, Turning

_LEAST_SIDE, _LARGEST_SIDE = 3.0, 1.5
"""Bounds of the sides: px, as less has no gradient inside; and of the image's longer side, as a
vehicle that passes the camera is partly outside before it fills the image."""
_WHOLE_AT_FIRST = 0.99
"""Probability of `State.whole` in the first frame, whose box is given: 2 frames of no share at all,
at a log ratio of -3 each, make it partly hidden, and not a single one."""


class Visibility(Enum):
    """Visibility of the vehicle, which decides what a step does."""

    VISIBLE = "visible"
    PARTLY_HIDDEN = "partly hidden"
    TURNING = "turning"
    HIDDEN = "hidden"
    GONE = "gone"

    @property
    def is_visible(self) -> bool:
        """True where the position is measured on the vehicle, and not predicted."""
        return self not in (Visibility.HIDDEN, Visibility.GONE)


class State(NamedTuple):
    """Belief about the vehicle after a frame.

    Attributes
    ----------
    particles : Hypotheses
        Positions, velocities, growth, and visibility of each.
    position, size : (2,) arrays
        Centre, and width and height, px.
    visibility : Visibility
        Visible, turning, hidden, or gone.
    whole : float
        Probability that all of it is visible, given that a part of it is.
    frames : int
        Frames since the first one.
    follows_size, trains_filter : bool
        Costly tasks of this frame: to track points and follow the size; to judge the surface's
        flow and train the filter. Both, but undisturbed frames do them in turns.
    measured : (2,) array
        Size when it was measured last, before the vehicle was partly or wholly hidden, px.
    growth : float
        Rate at which a partly hidden vehicle grows.
    turning : Turning
        Outlines that may be those of a vehicle that turns.
    departure : Departure or None
        Where and how a vehicle that is `GONE` has left; None for others.
    left_image : bool
        True where the prediction's mean is outside the image.
    sets_off : bool
        True in the first step if it has measured what moves in the first box.
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
    whole: float = _WHOLE_AT_FIRST
    frames: int = 0
    follows_size: bool = True
    trains_filter: bool = True
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
    def turned(self) -> Branch:
        """Outline of a vehicle that is `TURNING`."""
        vehicle = self.turning.vehicle
        assert vehicle is not None, "only a proven turn makes a vehicle `TURNING`"
        return vehicle

    @property
    def is_whole(self) -> bool:
        """True where all of the vehicle is likelier to be visible than a part of it."""
        return self.whole > 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Memory:
    """Appearance of the vehicle, and earlier frames: all that changes in place.

    `learn` alone trains `appearance`, but the first view after a start sets the usual response,
    as the response is relative to it. `predict` adds each frame to `camera` and `foreground`,
    which compare it with earlier ones, and an occlusion lets the latter learn its background.
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
        largest = _LARGEST_SIDE * max(frame_size(self.frame))
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
        camera = 0.0 if sightings.are_steady else motion.camera_velocity_sigma
        return math.hypot(motion.hidden_velocity_sigma, camera)


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
    was_hidden : bool
        True if the vehicle was hidden or gone in the frame before, so that what was kept of that
        frame shows an occluder, and no displacement since then is known.
    """

    view: View
    position: Array
    response: float
    was_hidden: bool
