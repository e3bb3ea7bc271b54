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

"""Localisation of a stream's estimates: lens and pose as they come, and what is said of it."""

from __future__ import annotations

from std_msgs.msg import Header

from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.road.poses import PoseTree
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.ros.node.camera_inputs import camera_pose
from vehicle_pf_tracker.ros.road_messages import ImageLens
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.localisation import Localisation


class StreamLocalisation(Localisation):
    """Localisation with lens and pose from topics.

    Parameters
    ----------
    variant : str
        Name of the variant.
    parameters : RoadParameters
        Mapping to the road.
    """

    def __init__(self, variant: str, parameters: RoadParameters) -> None:
        super().__init__(variant, parameters)
        self._tree: PoseTree | None = None
        self._size: tuple[int, int] | None = None

    def take_lens(self, found: ImageLens) -> None:
        """Take the lens of a CameraInfo."""
        self._size = found.size
        self.set_lens(found.lens)

    def take_poses(self, tree: PoseTree) -> None:
        """Take new poses; the camera's is looked up with the next image, which names its frame."""
        self._tree = tree

    def locate(self, estimate: Estimate, header: Header, frame: Frame, period: float) -> None:
        """Take the estimate of the image `frame`, with the nominal frame period in s."""
        parameters = self.parameters
        if parameters.from_tf and self._tree is not None:
            pose = camera_pose(self._tree, header.frame_id, parameters.frame_id)
            if pose is not None:
                self.set_pose(pose)
        self.follow(estimate, stamp_ns(header), period)
        (width, height), expected = frame_size(frame), self._size
        is_other = expected is not None and expected != (width, height)
        if expected and is_other and self.has_road and parameters.from_camera_info:
            self.road = None
            self.objection = (
                f"camera_info is for {expected[0]}x{expected[1]} px, the image has {width}x{height}"
            )

    @property
    def values(self) -> dict[str, object]:
        """Road position and speed for `~/mode` by name, or the reason why there are none."""
        if not self.has_road:
            return {}
        return {"road": self.objection or "ok", **(self.road.scalars() if self.road else {})}

    @property
    def words(self) -> str:
        """Speed for people; empty where there is none."""
        if self.road is None:
            return ""
        return f"{self.road.speed:.1f} +- {self.road.speed_deviation:.1f} km/h"
