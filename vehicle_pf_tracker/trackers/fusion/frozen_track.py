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

"""The track as it was when the vehicle was hidden: what a return is measured against.

A look-alike beside the predicted path may be taken for the vehicle, and is learnt from then on. So
the track of before is kept for a while and driven on without being weighed. The return is undone
where the filter of before answers better, given the distance from the path, at another place.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass, field

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.appearance import Appearance, View
from vehicle_pf_tracker.trackers.fusion.hypotheses import (
    ACROSS_LANES,
    LARGEST_GROWTH,
    Hypotheses,
)
from vehicle_pf_tracker.trackers.fusion.parameters import VisibilityParameters
from vehicle_pf_tracker.trackers.fusion.perspective import CLEAR_RESPONSE, Sightings
from vehicle_pf_tracker.trackers.fusion.visibility import SAME_VEHICLE, WIDE_FROM

_COMPARED_FOR = 30.0
"""Frames after a return for which other places are compared: one second, in which a look-alike that
came out first shows more than the vehicle behind it."""
LOOKS_EVERY = 2
"""Frames from one comparison to the next, each of which costs as much as a whole step."""
_MARGIN = 1.5
"""Log ratio by which another place has to be likelier (odds of 4.5 to 1), in two looks in a row."""
_CONFIRMED = 2
_LEAST_SIGMA = 0.1
"""Least standard deviation of the predicted position, of the size: about that of peaks."""


@dataclass(slots=True, eq=False)
class FrozenTrack:
    """State at the beginning of an occlusion, driven on.

    Attributes
    ----------
    appearance : Appearance
        Appearance that had been learnt.
    sightings : Sightings
        Sightings of the vehicle until then.
    particles : Hypotheses
        Predicted, and never weighed: their spread is the prior of a return.
    size : (2,) array
        Width and height, px.
    """

    appearance: Appearance
    sightings: Sightings
    particles: Hypotheses
    size: Array
    _since_return: float | None = None
    _better: int = 0
    _scale: float = 1.0
    _first_size: Array = field(init=False)

    def __post_init__(self) -> None:
        self._first_size = self.size

    @property
    def extent(self) -> float:
        """Geometric mean of the sides, px."""
        return float(np.sqrt(self.size.prod()))

    @property
    def is_over(self) -> bool:
        """True when the return has lasted long enough to be believed."""
        return self._since_return is not None and self._since_return > _COMPARED_FOR

    def take_return(self, appearance: Appearance, sightings: Sightings) -> None:
        """Keep what is known as a return is believed, before that is learnt."""
        self.appearance, self.sightings = appearance.twin(), copy.copy(sightings)
        self._since_return, self._better = 0.0, 0

    def pass_time(self, elapsed: float, camera: CameraMotion) -> None:
        """Let `elapsed` frames pass and the camera move."""
        if self._since_return is not None:
            self._since_return += elapsed
            self.sightings.pass_time(elapsed, camera)
        if not camera.still:
            self.particles = self.particles.moved(camera)

    def drive(
        self, rng: np.random.Generator, elapsed: float, sigmas: tuple[float, float]
    ) -> None:  # fmt: skip
        """Predict, by standard deviations of position and velocity in parts of the size."""
        growth = float(self.particles.weights @ self.particles.growths)
        self._scale = min(self._scale * float(np.exp(growth * elapsed)), LARGEST_GROWTH)
        self.size = self._first_size * self._scale
        noise = sigmas[0] * self.extent, sigmas[1] * self.extent
        self.particles = self.particles.driven(rng, elapsed, noise, across=ACROSS_LANES)

    def likelier_place(
        self, frame: Frame, position: Array, padding: Array, parameters: VisibilityParameters
    ) -> tuple[View, Array] | None:
        """Find a place, away from `position`, that is clearly likelier to be the vehicle's.

        Parameters
        ----------
        position : (2,) array
            Where the vehicle was taken to return, px.
        padding : (2,) array
            Sides of what the filter has learnt, of the vehicle's.

        Returns
        -------
        (View, (2,) array) or None
            What the filter of before responds, and the place, px.
        """
        mean = self.particles.mean
        wide = self.particles.spread > WIDE_FROM * self.extent
        patch = self.appearance.patch(frame, mean, self.size * padding, wide=wide)
        view = self.appearance.view(patch)
        scores = self._scores(view, parameters)
        offsets = view.offsets() - (position - mean)
        same = np.hypot(offsets[..., 0], offsets[..., 1]) < SAME_VEHICLE * self.extent
        here = float(scores[same].max()) if same.any() else -np.inf
        scores[same] = -np.inf
        row, column = np.unravel_index(int(scores.argmax()), scores.shape)
        clear = float(view.response[row, column]) > CLEAR_RESPONSE
        # There the vehicle would have stayed hidden all the time since the return.
        unseen = -float(np.log1p(-parameters.return_rate)) * (self._since_return or 0.0)
        better = clear and float(scores[row, column]) > here + _MARGIN + unseen
        self._better = self._better + 1 if better else 0
        if self._better < _CONFIRMED:
            return None
        return view, view.peak_near(mean + view.offsets()[row, column], 1)[0]

    def _scores(self, view: View, parameters: VisibilityParameters) -> Array:
        """Log ratio of every place of the response, less what its distance from the path costs."""
        off = self.particles.positions - self.particles.mean
        spread = off.T @ off / len(off) + np.eye(2) * (_LEAST_SIGMA * self.extent) ** 2
        offsets = view.offsets()
        costs = 0.5 * (offsets @ np.linalg.inv(spread) * offsets).sum(axis=2)
        response = np.clip(view.response, 0.0, 1.0).astype(np.float64)
        ratios = parameters.response_slope * (response - parameters.response_middle)
        return np.asarray(ratios - costs)
