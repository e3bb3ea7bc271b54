# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A vehicle in the middle of an image that detections have measured often."""

import numpy as np
from traffic_samples import track_of

from vehicle_pf_tracker.trackers.traffic.box_edges import MeasurementModel
from vehicle_pf_tracker.trackers.traffic.correction import correct
from vehicle_pf_tracker.trackers.traffic.vehicle_state import Gaussians, Motion

SIZE = (320, 240)
STILL = Motion(0.001, 0.5, 400.0)
BOX = np.array([100.0, 100, 140, 130])


def exactly(edges):
    """Known well, under a far horizon."""
    return Gaussians.around(edges[None], np.full((1, 4), 0.3), np.array([-1e4]), STILL)


class Vehicle:
    """A vehicle whose box has been measured often."""

    def __init__(self, edges=BOX):
        self.tracks = track_of(exactly(edges), matches=20, shown=1.0)

    def see(self, detection, *, noise=0.05):
        """Be detected; True if that shows all of it."""
        edges = np.array([detection], float)
        self.tracks, whole = correct(self.tracks, edges, MeasurementModel(SIZE, noise))
        return bool(whole[0])

    @property
    def edges(self):
        return self.tracks.edges[0]
