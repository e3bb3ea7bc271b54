# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pictures of a run of `traffic`: paths, and where vehicles drove and stood."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.showing.heat_picture import HeatPicture
from vehicle_pf_tracker.showing.path_picture import PathPicture
from vehicle_pf_tracker.showing.pictures import Pictures
from vehicle_pf_tracker.trackers.traffic.estimate import TrackEstimate

PATHS_FILE = "summary.png"
"""Picture of the vehicles' paths."""
HEAT_FILE = "heat.png"
"""Picture of where vehicles drove and stood."""


class TrafficPictures:
    """Pictures of the frames, and two of the whole run, of which each may fail by itself.

    Parameters
    ----------
    of_frames : Pictures
        Video and live page.

    Attributes
    ----------
    of_frames : Pictures
        As given.
    side : SideProducts
        Notes what fails.
    """

    def __init__(self, of_frames: Pictures) -> None:
        self.of_frames = of_frames
        self.side = of_frames.side
        self._paths = PathPicture()
        self._heat = HeatPicture()

    def add(
        self, frame: Frame, estimates: Sequence[TrackEstimate], stamp_ns: int, period: float
    ) -> None:
        """Take the next frame and the nominal period in s."""
        with self.side.attempt(PATHS_FILE):
            self._paths.add(frame, estimates)
        with self.side.attempt(HEAT_FILE):
            self._heat.add(frame, estimates, stamp_ns, period)

    def write(self, folder: Path, counter: Counter) -> bool:
        """Write the pictures that have not failed, and return whether there is one of the paths.

        Without a frame there is none, and none of an earlier run is left.
        """
        ground = self._paths.ground
        for name in (PATHS_FILE, HEAT_FILE):
            with self.side.attempt(name):
                (folder / name).unlink(missing_ok=True)
        if ground is None:
            return False
        if not self.side.failed(PATHS_FILE):
            with self.side.attempt(PATHS_FILE):
                self._paths.write(folder / PATHS_FILE, counter)
        if not self.side.failed(HEAT_FILE):
            with self.side.attempt(HEAT_FILE):
                self._heat.write(folder / HEAT_FILE, ground)
        return not self.side.failed(PATHS_FILE)
