# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Localisation of a track in a stream: its estimates with lens and pose from topics."""

from __future__ import annotations

import contextlib

from std_msgs.msg import Header

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.ros.messages import stamp_ns
from vehicle_pf_tracker.ros.node.camera_inputs import CameraInputs
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.localisation import Localisation
from vehicle_pf_tracker.trackers.road_follower import RoadEstimate


class StreamLocalisation:
    """Localisation of a track with lens and pose from topics.

    Parameters
    ----------
    variant : str
        Name of the variant.
    parameters : RoadParameters
        Mapping to the road.
    cameras : CameraInputs
        Where lens and pose come from.
    """

    def __init__(self, variant: str, parameters: RoadParameters, cameras: CameraInputs) -> None:
        self._track = Localisation(variant, parameters)
        self._cameras = cameras
        self._misfit = ""

    def reconfigure(self, parameters: RoadParameters) -> None:
        """Take another mapping to the road; lens and pose that came from outside are kept."""
        self._track.reconfigure(parameters)

    def locate(self, estimate: Estimate, header: Header, frame: Frame, period: float) -> None:
        """Take the estimate of the image `frame`, with the nominal frame period in s."""
        track = self._track
        parameters = track.parameters
        lens = self._cameras.lens
        # First lens and pose: the estimate is mapped by those of its own image.
        if lens is not None:
            track.set_lens(lens.lens)
        if parameters.from_tf:
            with contextlib.suppress(InputError):  # TF does not have it yet
                track.set_pose(self._cameras.poses.find(header.frame_id, parameters.frame_id))
        track.follow(estimate, stamp_ns(header), period)
        width, height = frame_size(frame)
        # Set anew with each image: a driver may correct its camera_info.
        self._misfit = ""
        if lens is not None and lens.size != (width, height) and parameters.from_camera_info:
            self._misfit = (
                f"camera_info is for {lens.size[0]}x{lens.size[1]} px, "
                f"the image has {width}x{height}"
            )

    @property
    def has_road(self) -> bool:
        """True where a mapping to the road is asked for."""
        return self._track.has_road

    @property
    def road(self) -> RoadEstimate | None:
        """Last position on the road; None where there is none."""
        # A lens of another resolution puts the vehicle elsewhere: no position is better.
        return None if self._misfit else self._track.road

    @property
    def road_frame_id(self) -> str:
        """Frame of positions on the road."""
        return self._track.parameters.frame_id

    @property
    def covariance(self) -> Array:
        """Covariance (2, 2) of the last estimate's position, px²."""
        return self._track.covariance

    @property
    def values(self) -> dict[str, object]:
        """Road position and speed for `~/mode` by name, or the reason why there are none."""
        if not self.has_road:
            return {}
        road = self.road
        objection = self._misfit or self._track.objection
        return {"road": objection or "ok", **(road.scalars() if road else {})}

    @property
    def words(self) -> str:
        """Speed for people; empty where there is none."""
        road = self.road
        return f"{road.speed:.1f} +- {road.speed_deviation:.1f} km/h" if road else ""
