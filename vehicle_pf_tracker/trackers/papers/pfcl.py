# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`pfcl`: colour and line features, after Xiong and Debrunner 2004 (P1's [18]).

A colour particle filter whose likelihood is multiplied with that of the straight edge segments in
the window: a particle must have the vehicle's colours and its line directions. It has no occlusion
branch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.filtering.weights import from_log
from vehicle_pf_tracker.image.windows.lines import find_lines, line_histograms
from vehicle_pf_tracker.image.windows.similarity import bhattacharyya_coefficient
from vehicle_pf_tracker.image.windows.window import bounds
from vehicle_pf_tracker.parameters.table import group, parameter
from vehicle_pf_tracker.trackers.base import Cloud, Outcome
from vehicle_pf_tracker.trackers.papers.colour_tracker import ColourParameters, ColourTracker
from vehicle_pf_tracker.trackers.papers.shared import LikelihoodParameters, log_likelihood


@dataclass(frozen=True, slots=True)
class LineParameters:
    """Definition of lines, and their part in the likelihood."""

    sigma_v: float = parameter(
        0.35, "Smaller: weights fall faster as a particle's lines depart from the reference.",
        bounds=(1e-3, 100.0), source="Xiong 2004 (no value printed)", tuned=True,
    )  # fmt: skip
    bins: int = parameter(
        8, "More: finer directions, more easily upset by noise.", bounds=(1, 90),
        unit="bins over 180 degrees", effect="relearns",
    )  # fmt: skip
    edge_threshold: float = parameter(
        150.0, "Higher: only edges of more contrast make lines.", bounds=(1.0, 2000.0),
        unit="levels of 255", effect="relearns", tuned=True,
    )  # fmt: skip
    shortest: int = parameter(
        6, "Higher: short lines, and the noise among them, are left out.", bounds=(2, 1000),
        unit="px", effect="relearns",
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class PfclParameters(ColourParameters):
    """Parameters of `pfcl`."""

    lines: LineParameters = group(LineParameters)


class PfclTracker(ColourTracker[PfclParameters]):
    """The colour and line filter."""

    def __init__(self, parameters: PfclParameters) -> None:
        super().__init__(parameters)
        self.line_reference: Array = np.zeros(1)

    def _learn(self) -> None:
        super()._learn()
        # From the target's own patch, as later frames may show it covered.
        centre = np.asarray([self.target.centre])
        self.line_reference = self._line_histograms(self.target.patch, centre)[0]

    def _advance(self, frame: Frame, elapsed: float) -> Outcome:
        """Take one frame: resample, propagate, weigh by colour and by lines."""
        settings = self._settings
        parents = self._resample(self._cloud)
        particles, left_image = self._diffuse(frame, parents, settings.sigma * elapsed)
        # The two features are taken as independent: their likelihoods are multiplied.
        colour = log_likelihood(self.similarity(frame, particles), settings.likelihood)
        lines = log_likelihood(
            self.line_similarity(frame, particles), LikelihoodParameters(settings.lines.sigma_v)
        )
        cloud = Cloud(particles, *from_log(colour + lines))
        return self._report(frame, cloud, elapsed, left_image=left_image)

    def line_similarity(self, frame: Frame, positions: Array) -> Array:
        """Bhattacharyya coefficient of each window's lines with the reference's, shape (N,)."""
        if not self.line_reference.any():
            return np.ones(len(positions))  # a target without lines is similar to every window
        histograms = self._line_histograms(frame, positions)
        return bhattacharyya_coefficient(histograms, self.line_reference)

    def _line_histograms(self, frame: Frame, positions: Array) -> Array:
        settings = self._settings.lines
        windows = bounds(frame, positions, self.window)
        # Lines are searched once in the frame, and then counted by window: windows overlap.
        segments = find_lines(frame, windows, settings.edge_threshold, settings.shortest)
        return line_histograms(segments, windows, settings.bins)
