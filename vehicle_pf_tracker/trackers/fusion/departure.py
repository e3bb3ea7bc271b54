# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A vehicle that has left by a border of the image.

From then on whatever resembles it may be a stranger, and on a road strangers come by all the time.
It is taken to be back only where it comes back from: something enters by the same border and moves
inwards. Its response has to be above that of anything else while the vehicle was tracked, frame
after frame.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.trackers.fusion.appearance import View
from vehicle_pf_tracker.trackers.fusion.parameters import PROOF_FRAMES
from vehicle_pf_tracker.trackers.fusion.perspective import CLEAR_RESPONSE

_ENTERS_WITHIN = 1.5
"""Largest distance from the border, in sizes, at which something that enters is first seen: its
centre has to be half a size inside, and moves at less than one per frame."""
PROOF_DISTANCE = 0.5
"""Least distance in sizes moved within `PROOF_FRAMES` that proves a vehicle: the background stands,
and the noise of peaks is a tenth of that."""
_FARTHEST_STEP = 1.0
"""Largest distance in sizes from one frame to the next at which peaks are of the same vehicle:
centres of two vehicles in a lane are at least a length apart."""
_STRANGERS_RATE = 0.005
"""Rate per frame at which the strangers' response fades: the road behind is another one. It halves
in some 140 frames, a choice between the seconds that a stranger passes in and a whole track."""


class _Candidate(NamedTuple):
    """A possible return: first and latest position (2,), px, frames in a row, and their periods."""

    first: Array
    latest: Array
    frames: int = 1
    elapsed: float = 0.0


class Strangers(NamedTuple):
    """Response of the filter to what is not the vehicle, measured while it is visible.

    Attributes
    ----------
    response : float
        Highest response elsewhere, relative to the vehicle's usual one.
    """

    response: float = 0.0

    @property
    def level(self) -> float:
        """Response that no stranger has reached, and that is clear in any case."""
        return max(CLEAR_RESPONSE, self.response)

    def measured(self, view: View, position: Array, size: Array) -> Strangers:
        """Take a frame in which the vehicle is at `position`, px."""
        # Twice the box is left out: the vehicle's own peak has slopes beyond its sides.
        elsewhere = view.response.copy()
        left, top = view.place(position - size)
        right, bottom = view.place(position + size)
        elsewhere[top : bottom + 1, left : right + 1] = 0.0
        # A maximum, not a mean: one strong answer is enough to be taken for the vehicle.
        faded = self.response * (1 - _STRANGERS_RATE)
        return Strangers(max(faded, float(elsewhere.max())))


class Departure(NamedTuple):
    """Departure of a vehicle, and the search for its return at the place and size where it left.

    Attributes
    ----------
    reason : str
        The border that it left by.
    return_direction : (2,) array
        Direction that a return has to move in: into the image.
    position, size : (2,) arrays
        Centre where it left, carried along with the background, and its width and height then, px.
    response : float
        Response that a return has to reach, relative to the usual one.
    candidate : _Candidate or None
        Peak that may be the vehicle on its way back.
    """

    reason: str
    return_direction: Array
    position: Array
    size: Array
    response: float
    candidate: _Candidate | None = None

    @classmethod
    def by_border(
        cls, frame: Frame, position: Array, size: Array, strangers: Strangers
    ) -> Departure:
        """Depart by the border next to a position."""
        width, height = frame_size(frame)
        x, y = position.tolist()
        # A position inside the image: the border that is next to it is the one that was crossed.
        borders = {"left": x, "right": width - x, "top": y, "bottom": height - y}
        inwards = {"left": (1, 0), "right": (-1, 0), "top": (0, 1), "bottom": (0, -1)}
        border = min(borders, key=borders.__getitem__)
        direction = np.array(inwards[border], float)
        return cls(f"left at the {border}", direction, position, size, strangers.level)

    def moved(self, camera: CameraMotion) -> Departure:
        """Move with the background: where the camera pans, all that stands moves in the image."""
        if camera.still:
            return self
        candidate = self.candidate
        if candidate is not None:
            first, latest = camera.apply(np.stack([candidate.first, candidate.latest]))
            candidate = candidate._replace(first=first, latest=latest)
        return self._replace(position=camera.apply(self.position), candidate=candidate)

    def observed(self, view: View, elapsed: float = 1.0) -> Departure:
        """Look for a return in the next frame, which `view` shows around the place of departure."""
        return self._replace(candidate=self._found_in(view, elapsed))

    @property
    def returned(self) -> tuple[Array, Array] | None:
        """Position and velocity, px, of a vehicle whose return is proven."""
        if self.candidate is None:
            return None
        # Motion is asked for beside frames, since scenery answers in every frame but stands still.
        first, latest, frames, elapsed = self.candidate
        moved = latest - first
        if (
            frames < PROOF_FRAMES
            or float(moved @ self.return_direction) < PROOF_DISTANCE * self._extent
        ):
            return None
        # Over periods, not frames: some may have been dropped. 1e-3: stamps may repeat.
        return latest, moved / max(elapsed, 1e-3)

    @property
    def _extent(self) -> float:
        return float(np.sqrt(self.size.prod()))

    def _found_in(self, view: View, elapsed: float) -> _Candidate | None:
        """Continue the candidate by the highest peak, or begin another one there."""
        # Only the highest peak: weaker ones are nearer to the strangers, and several candidates at
        # a time would multiply the chances of a false return.
        row, column = np.unravel_index(int(view.response.argmax()), view.response.shape)
        found = view.position(float(column), float(row))
        # A frame below the level ends the candidate: the proof asks for frames in a row.
        before = self.candidate
        if float(view.response[row, column]) < self.response:
            return None
        reach = _FARTHEST_STEP * self._extent
        if before is not None and np.linalg.norm(found - before.latest) <= reach:
            return _Candidate(before.first, found, before.frames + 1, before.elapsed + elapsed)
        # Seen for the first time, it is as near to the border as one that enters. From the middle
        # of the view: with a camera that pans the place of departure itself may leave the image.
        depth = float((found - view.patch.centre) @ self.return_direction)
        return _Candidate(found, found) if depth < _ENTERS_WITHIN * self._extent else None
