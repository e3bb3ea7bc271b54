# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The state of `fusion`: all that it believes about the vehicle after a frame."""

from __future__ import annotations

import math
from typing import NamedTuple

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.motion.camera_drift import CameraDrift
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.departure import Strangers
from vehicle_pf_tracker.trackers.fusion.entering import Entry
from vehicle_pf_tracker.trackers.fusion.hypotheses import Hypotheses
from vehicle_pf_tracker.trackers.fusion.perspective import Sightings
from vehicle_pf_tracker.trackers.fusion.sides import Sides
from vehicle_pf_tracker.trackers.fusion.surface_flow import SurfaceFlow
from vehicle_pf_tracker.trackers.fusion.surface_points import SurfacePoints
from vehicle_pf_tracker.trackers.fusion.verdict import (
    WHOLE_AT_FIRST,
    Gone,
    Hidden,
    Verdict,
    Visible,
)


class Wholeness(NamedTuple):
    """Belief that all of a vehicle is visible, and the size of a partly hidden one.

    Attributes
    ----------
    probability : float
        Probability that all of it is visible, given that a part of it is.
    measured : (2,) array
        Size when it was measured last, before the vehicle was partly or wholly hidden, px.
    growth : float
        Rate at which a partly hidden vehicle grows, per frame.
    entry : Entry or None
        What has come in of a vehicle whose first box the image's border cuts.
    """

    probability: float
    measured: Array
    growth: float = 0.0
    entry: Entry | None = None

    @property
    def is_likely(self) -> bool:
        """True where all of the vehicle is likelier to be visible than a part of it."""
        return self.probability > 0.5  # even odds: a probability needs no level of its own

    @classmethod
    def at_start(cls, size: Array) -> Wholeness:
        """Begin with the box that was given."""
        return cls(WHOLE_AT_FIRST, size)

    def moved(self, camera: CameraMotion) -> Wholeness:
        """Note that the camera has moved."""
        return self._replace(entry=self.entry.moved(camera)) if self.entry else self


class State(NamedTuple):
    """Belief about the vehicle after a frame.

    Attributes
    ----------
    particles : Hypotheses
        Weighted hypotheses: position, velocity, growth rate and visibility of each.
    position, size : (2,) arrays
        Centre, and width and height, px.
    whole : Wholeness
        Belief that all of it is visible.
    verdict : Verdict
        Judgement on the frame: visible, partly hidden, turning, hidden, or gone.
    frames : int
        Number of frames since the first one, however much time passed between them.
    sightings : Sightings
        Earlier positions, sizes and responses, which a hidden vehicle is predicted from.
    points : SurfacePoints
        Points on the vehicle, whose spread measures its change of size.
    surface : SurfaceFlow
        Earlier patches, and the share of the surface that moves with the vehicle.
    strangers : Strangers
        Highest response to what is not the vehicle, which a return has to exceed.
    drift : CameraDrift
        How far the camera has moved on of late.
    sides : Sides
        Sides of the vehicle relative to the followed box; only the reported box uses them.
    """

    particles: Hypotheses
    # Beside the particles: the position of a visible vehicle is the response's peak; and all have
    # one size, since each size that is tried costs a response of its own.
    position: Array
    size: Array
    whole: Wholeness
    verdict: Verdict = Visible()
    frames: int = 0
    # None of these is changed in place, so that one default serves all trackers.
    sightings: Sightings = Sightings()
    points: SurfacePoints = SurfacePoints()
    surface: SurfaceFlow = SurfaceFlow()
    strangers: Strangers = Strangers()
    drift: CameraDrift = CameraDrift()
    sides: Sides = Sides()

    @property
    def box(self) -> Box:
        """Box in the image, px."""
        x, y = self.position.tolist()
        return Box.around((x, y), *self.size.tolist())

    @property
    def extent(self) -> float:
        """Geometric mean of the sides of the box, px."""
        width, height = self.size.tolist()
        return math.sqrt(width * height)

    @property
    def is_visible(self) -> bool:
        """True where the position is measured on the vehicle, and not predicted."""
        # A vehicle that turns or is partly hidden is measured, by what is seen of it.
        return not isinstance(self.verdict, Hidden | Gone)
