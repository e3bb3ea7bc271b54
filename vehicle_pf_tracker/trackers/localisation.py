# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Uncertainty, road position and speed of a track, beside its tracker.

Nothing here goes back into the tracker: estimates are the same with and without it.
"""

from __future__ import annotations

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.poses import Pose
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.road_follower import RoadEstimate, RoadFollower
from vehicle_pf_tracker.trackers.uncertainty import Uncertainty
from vehicle_pf_tracker.trackers.uncertainty_table import CALIBRATIONS


class Localisation:
    """Covariance of a track's positions and, where a road is set, its position and speed on it.

    Parameters
    ----------
    variant : str
        Name of the variant, by which clouds are calibrated.
    parameters : RoadParameters
        Mapping to the road.

    Attributes
    ----------
    parameters : RoadParameters
        Mapping to the road in use.
    has_road : bool
        True where a mapping to the road is asked for; read with each image.
    road : RoadEstimate or None
        Last position on the road; None where there is none, for the reason `objection`.
    objection : str
        Reason why there is no position on the road; empty where there is one, or no road is set.
    """

    def __init__(self, variant: str, parameters: RoadParameters) -> None:
        self._uncertainty = Uncertainty(CALIBRATIONS.get(variant, CALIBRATIONS["*"]))
        self._estimate: Estimate | None = None
        self._period = 1.0
        self._lens = parameters.lens
        self._pose = parameters.pose
        self.parameters = parameters
        self.has_road = parameters.is_set
        self._follower: RoadFollower | None = None
        self.road: RoadEstimate | None = None
        self.objection = ""
        self._take_plane()

    def reconfigure(self, parameters: RoadParameters) -> None:
        """Take another mapping to the road; lens and pose that came from outside are kept."""
        before = self.parameters
        self.parameters = parameters
        self.has_road = parameters.is_set
        # A lens of another source is another lens.
        if not (before.from_camera_info and parameters.from_camera_info):
            self._lens = parameters.lens
        if not (before.from_tf and parameters.from_tf):
            self._pose = parameters.pose
        self._follower = None
        self.road = None
        self.objection = ""
        self._take_plane()

    def set_lens(self, lens: Lens) -> None:
        """Take the lens from outside, where the parameters ask for that."""
        if self.parameters.from_camera_info and lens != self._lens:
            self._lens = lens
            self._take_plane()

    def set_pose(self, pose: Pose) -> None:
        """Take the camera's pose from outside, where the parameters ask for that."""
        if self.parameters.from_tf and not pose.equals(self._pose):
            self._pose = pose
            self._take_plane()

    def follow(self, estimate: Estimate, stamp_ns: int, period: float) -> None:
        """Take the next estimate, with the nominal frame period in s."""
        self._estimate = estimate
        self._period = period
        self._uncertainty.follow(estimate, stamp_ns)
        if self._follower is not None:
            self.road = self._follower.follow(estimate, self.covariance, stamp_ns)
            self.objection = self._follower.objection

    @property
    def covariance(self) -> Array:
        """Covariance (2, 2) of the last estimate's position, px²."""
        assert self._estimate is not None
        return self._uncertainty.covariance(self._estimate, self._period)

    def _take_plane(self) -> None:
        """Make the plane as soon as all that it needs is there."""
        parameters = self.parameters
        if not self.has_road:
            return
        if parameters.from_camera_info and self._lens is None:
            # Until it comes there is no road, which is no error.
            self.objection = "no camera_info yet"
        elif parameters.from_tf and self._pose is None:
            self.objection = f"no transform from {parameters.frame_id} to the camera yet"
        else:
            try:
                plane = parameters.plane(self._lens, self._pose)
            except InputError as error:
                self._follower = None
                self.road = None
                self.objection = str(error)
                return
            if self._follower is None:
                self.objection = ""
                self._follower = RoadFollower(plane, parameters.acceleration)
            else:
                # The camera has moved, the vehicle has not: its contact and speed go on.
                self._follower.move(plane)
