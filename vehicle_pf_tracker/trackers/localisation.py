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

"""Uncertainty and road position of a track, beside its tracker.

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
from vehicle_pf_tracker.trackers.uncertainty import Uncertainty, calibration_of
from vehicle_pf_tracker.trackers.uncertainty_table import CALIBRATIONS


class Localisation:
    """Covariance of a track's positions and, where a road is set, its place and speed on it.

    Parameters
    ----------
    variant : str
        Name of the variant, by which clouds are calibrated.
    parameters : RoadParameters
        Mapping to the road.

    Attributes
    ----------
    has_road : bool
        True where a mapping to the road is asked for.
    road : RoadEstimate or None
        Last place on the road; None where there is none, for the reason `objection`.
    objection : str
        Reason why there is no place on the road; empty where there is one, or no road is set.
    """

    def __init__(self, variant: str, parameters: RoadParameters) -> None:
        self._uncertainty = Uncertainty(calibration_of(variant, CALIBRATIONS))
        self._estimate: Estimate | None = None
        self._period = 1.0
        self._lens, self._pose = parameters.lens, parameters.pose
        self._parameters = parameters
        self.has_road = parameters.is_set
        self._follower: RoadFollower | None = None
        self.road: RoadEstimate | None = None
        self.objection = ""
        self._make_follower()

    @property
    def parameters(self) -> RoadParameters:
        """Mapping to the road."""
        return self._parameters

    def reconfigure(self, parameters: RoadParameters) -> None:
        """Take another mapping to the road; lens and pose that came from outside are kept."""
        before, self._parameters = self._parameters, parameters
        self.has_road = parameters.is_set
        if not (before.from_camera_info and parameters.from_camera_info):
            self._lens = parameters.lens
        if not (before.from_tf and parameters.from_tf):
            self._pose = parameters.pose
        self._make_follower()

    def set_lens(self, lens: Lens) -> None:
        """Take the lens from outside, where the parameters ask for that."""
        if self._parameters.from_camera_info and lens != self._lens:
            self._lens = lens
            self._take_plane()

    def set_pose(self, pose: Pose) -> None:
        """Take the camera's pose from outside, where the parameters ask for that."""
        if self._parameters.from_tf and not pose.equals(self._pose):
            self._pose = pose
            self._take_plane()

    def follow(self, estimate: Estimate, stamp_ns: int, period: float) -> None:
        """Take the next estimate, with the nominal frame period in s."""
        self._estimate, self._period = estimate, period
        self._uncertainty.follow(estimate, stamp_ns)
        if self._follower is not None:
            self.road = self._follower.follow(estimate, self.covariance, stamp_ns)
            self.objection = self._follower.objection

    @property
    def covariance(self) -> Array:
        """Covariance (2, 2) of the last estimate's position, px²."""
        assert self._estimate is not None
        return self._uncertainty.covariance(self._estimate, self._period)

    def _make_follower(self) -> None:
        self._follower, self.road, self.objection = None, None, ""
        self._take_plane()

    def _take_plane(self) -> None:
        """Make the plane as soon as all that it needs is there."""
        parameters = self._parameters
        if not self.has_road:
            return
        if parameters.from_camera_info and self._lens is None:
            self.objection = "no camera_info yet"
        elif parameters.from_tf and self._pose is None:
            self.objection = f"no transform from {parameters.frame_id} to the camera yet"
        else:
            try:
                plane = parameters.plane(self._lens, self._pose)
            except InputError as error:
                self._follower, self.road, self.objection = None, None, str(error)
                return
            if self._follower is None:
                self.objection = ""
                self._follower = RoadFollower(plane, parameters.acceleration)
            else:
                self._follower.move(plane)
