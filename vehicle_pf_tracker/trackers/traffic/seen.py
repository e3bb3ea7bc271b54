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

"""Detections of one frame, with what is known about each, while they are given to tracks."""

from __future__ import annotations

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.trackers.traffic.colours import ColourBins
from vehicle_pf_tracker.trackers.traffic.detection_evidence import DetectionEvidence
from vehicle_pf_tracker.trackers.traffic.detections import Detections

_NOTHING = np.empty((0, 4))


class Seen:
    """Detections of one frame.

    Parameters
    ----------
    detections : Detections
        Usable ones.
    evidence : DetectionEvidence
        What became of earlier ones.
    colours : ColourBins
        Of the frame.
    size : (int, int)
        Width and height of the image.

    Attributes
    ----------
    edges : (N, 4) array
        Left, top, right and bottom in px.
    scores : (N,) array
        As the detector gave them.
    labels : tuple of str
        Classes.
    samples : list of Sample
        For learning what becomes of them.
    log_odds : (N,) array
        That each is a vehicle.
    free : list of int
        Those that no track has taken.
    """

    def __init__(
        self,
        detections: Detections,
        evidence: DetectionEvidence,
        colours: ColourBins,
        size: tuple[int, int],
    ) -> None:
        boxes = detections.boxes
        self.edges = np.hstack([boxes[:, :2], boxes[:, :2] + boxes[:, 2:]])
        self.scores = detections.scores
        self.labels = detections.labels
        self.samples = [
            evidence.sample(edges, score, size)
            for edges, score in zip(self.edges, self.scores.tolist(), strict=True)
        ]
        self.log_odds = evidence.log_odds(self.samples)
        self.free = list(range(len(boxes)))
        self._colours = colours
        self._histograms: dict[int, Array] = {}

    def histogram(self, index: int) -> Array:
        """Colours of a detection."""
        if index not in self._histograms:
            self._histograms[index] = self._colours.histogram(self.edges[index], _NOTHING)
        return self._histograms[index]
