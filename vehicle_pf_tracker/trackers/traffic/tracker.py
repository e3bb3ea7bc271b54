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

"""Tracker of every vehicle in view."""

from __future__ import annotations

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.trackers.traffic.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters


class TrafficTracker:
    """Follow all vehicles of a stream of images.

    The same images, detections, parameters and seed give bit-identical estimates.

    Parameters
    ----------
    parameters : TrafficParameters, optional
        Parameters; None: the defaults.

    Attributes
    ----------
    frame_period : float
        Nominal frame period in s, from which seconds become frames.
    """

    def __init__(self, parameters: TrafficParameters | None = None) -> None:
        self.parameters = parameters or TrafficParameters()
        self.frame_period = 1 / 30

    @property
    def seed(self) -> int:
        """Seed in use."""
        raise NotImplementedError

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
            One for every vehicle that is followed, by identity.
        """
        raise NotImplementedError

    def add(self, box: Box, label: str = "") -> int:
        """Follow the vehicle in `box` of the latest frame from now on, and return its identity."""
        raise NotImplementedError

    def remove(self, identity: int) -> bool:
        """Forget a vehicle; False if there is none of this identity."""
        raise NotImplementedError

    def reset(self) -> None:
        """Forget all vehicles; identities go on from where they were."""
        raise NotImplementedError

    def reconfigure(self, parameters: TrafficParameters) -> None:
        """Take new parameters between two frames; no vehicle is lost by it."""
        raise NotImplementedError
