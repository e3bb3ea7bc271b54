# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The material of one step: the frame, what was learnt before it, and what it shows."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.motion.camera_flow import CameraFlow
from vehicle_pf_tracker.image.motion.foreground import Foreground
from vehicle_pf_tracker.image.patches.side_network import SideNetwork, side_network
from vehicle_pf_tracker.image.windows.window import keep_inside
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance, View
from vehicle_pf_tracker.trackers.fusion.departure import Departure
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.perspective import Sightings
from vehicle_pf_tracker.trackers.fusion.schedule import Tasks

_LEAST_SIDE = 3.0
"""Least side of a box, px: less has no gradient inside."""
_LARGEST_SIDE = 1.5
"""Largest side of a box, as a multiple of the image's longer one: a vehicle that passes the camera
is partly outside before it fills the image."""


@dataclass(frozen=True, slots=True, eq=False)
class Memory:
    """Appearance of the vehicle, and earlier frames: all that changes in place.

    `learn` trains `appearance`, whose level `observe` sets in the first frame after a start, as all
    responses are relative to it. `predict` adds each frame to `camera` and `foreground`, which
    compare it with earlier ones; `follow` lets the latter learn its background where an occlusion
    begins. `network`, which has learnt from other vehicles, stays.
    """

    # The filter's spectra and the kept frames are large: they alone change in place.
    appearance: Appearance
    camera: CameraFlow = field(default_factory=CameraFlow)
    foreground: Foreground = field(default_factory=Foreground)
    network: SideNetwork = field(default_factory=side_network)


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A frame, and what all parts of its step use.

    Attributes
    ----------
    frame : Frame
        The present image, RGB.
    elapsed : float
        Frame periods since the frame before; 1 unless frames were dropped or stamps jitter.
    parameters : FusionParameters
        Parameters in use.
    rng : Generator
        Source of everything random.
    memory : Memory
        Appearance of the vehicle, motion of the camera and foreground, as learnt so far.
    tasks : Tasks
        Costly tasks of the frame before, by which those of this frame are chosen.
    period : float
        Nominal time between two frames, s.
    """

    frame: Frame
    elapsed: float
    parameters: FusionParameters
    rng: np.random.Generator
    memory: Memory
    tasks: Tasks
    period: float

    def inside(self, positions: Array) -> Array:
        """Move positions (..., 2) into the image."""
        # Beyond the border a patch repeats the outermost pixels: nothing is measured there.
        return keep_inside(self.frame, positions)

    def bounded(self, size: Array) -> Array:
        """Bound width and height (2,), px, by what can be measured and what fits into an image."""
        # Neither bound keeps the ratio of the sides: each side alone could become useless.
        largest = _LARGEST_SIDE * max(frame_size(self.frame))
        return np.minimum(np.maximum(size, _LEAST_SIDE), largest)

    def share_inside(self, position: Array, size: Array) -> float:
        """Share of a box, whose centre is inside the image, that is inside."""
        share = 1.0
        sides = zip(position.tolist(), size.tolist(), frame_size(self.frame), strict=True)
        for middle, side, length in sides:
            # The centre is inside, so that the differences are positive and their product a share.
            share *= (min(middle + side / 2, length) - max(middle - side / 2, 0)) / side
        return share

    def hidden_velocity_sigma(self, sightings: Sightings) -> float:
        """Return the deviation of a hidden vehicle's change of velocity, sizes per frame squared.

        Larger where sightings were carried along with a camera that moved: the background's motion
        is not quite that of the road under the vehicle.
        """
        # The vehicle's own changes of speed and the camera's error are independent: variances add.
        motion = self.parameters.motion
        camera = 0.0 if sightings.are_steady else motion.camera_velocity_sigma
        return math.hypot(motion.hidden_velocity_sigma, camera)


class Prediction(NamedTuple):
    """Findings of a prediction, beside the state that is predicted.

    Attributes
    ----------
    left_image : bool
        True where the mean of the hypotheses is outside the image.
    sets_off : bool
        True in the first step if it has measured what moves in the first box.
    """

    left_image: bool
    sets_off: bool


@dataclass(frozen=True, slots=True, eq=False)
class Observation:
    """The vehicle as it was observed in the present frame.

    Attributes
    ----------
    view : View
        Response of the filter around the prediction.
    position : (2,) array
        Centre of the vehicle, px.
    response : float
        Height of the peak there, relative to the usual one.
    was_hidden : bool
        True if the vehicle was hidden or gone in the frame before, so that what was kept of that
        frame shows an occluder, and no displacement since then is known.
    tasks : Tasks
        Costly tasks of this frame.
    departure : Departure or None
        Search for the return of a vehicle that was gone, with what this frame shows; else None.
    """

    view: View
    position: Array
    response: float
    was_hidden: bool
    tasks: Tasks
    departure: Departure | None = None
