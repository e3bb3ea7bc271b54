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

"""Optical flow on the vehicle: the share of its surface that still moves with it.

Where an occluder covers the vehicle the image moves with the occluder: with the background where a
wall stands, and its own way where a lorry drives by. What turns changes its looks, and with them
the filter's response, but still moves with the vehicle.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.image.canonical_patch import Patch

_KEPT = 8
"""Patches kept; by less than half a canonical px per frame a vehicle is taken to stand."""
_APART_PX = 4.0
"""Canonical px that vehicle and background should have moved apart since the patch that the present
one is compared with: the youngest such patch is taken. Flow is good to about one."""
_TELLING_PX = 2.0
"""The same below which the background's flow cannot be told from the vehicle's."""
_STRAYED_PX = 3.0
"""Distance in canonical px from where the vehicle would have taken it, from which a point has moved
on its own: what a second occluder drives, or flow that has failed."""
_CELL = 4
"""Canonical px between points: dense flow is no finer."""
_REACH = 0.45
"""Outermost points from the centre, of the size: the box's rim is background."""
_REFINED = 5
"""Iterations of the flow's smoothing (Brox et al. 2004): plain surfaces move with their edges."""
_TURN_INERTIA = 0.3
"""Resistance of the fit of the vehicle's turn, as the sum of squared places of five points."""
_FEWEST = 8
"""Fewest points that a turn is fitted to."""
_NEARLY = 1.3
"""Factor to the limits within which points take part in the fit of the turn."""
_USUAL_RATE = 0.05
"""Rate per frame at which the usual share follows the present one in clear frames."""
_LEAST_USUAL = 0.3
"""Usual share below which flow tells nothing: a vehicle of a few px, or motion blur."""
_LEAST_KEPT = 3
"""Patches from which a share counts as usual."""


@dataclass(slots=True, eq=False)
class _Kept:
    """An earlier patch, the vehicle's position and size in it, and the camera's motion since."""

    patch: Patch
    position: Array
    size: Array
    turn: Array = field(default_factory=lambda: np.eye(2))
    shift: Array = field(default_factory=lambda: np.zeros(2))
    still: bool = True

    def move(self, camera: CameraMotion) -> None:
        """Let the camera move."""
        self.turn, self.shift = camera.turn @ self.turn, camera.apply(self.shift)
        self.still = False

    def background(self, positions: Array) -> Array:
        """Where the background at present positions (..., 2) was then, px."""
        if self.still:
            return positions
        return np.asarray((positions - self.shift) @ np.linalg.inv(self.turn).T)


class SurfaceFlow:
    """Compares the present patch with an earlier one, point by point.

    Attributes
    ----------
    share : float
        Share of the points in the box that move with the vehicle, of the usual share; 1 where flow
        tells nothing.
    tells : bool
        True where it was judged in the present frame.
    """

    def __init__(self) -> None:
        self._usual = 0.0
        self._latest = 1.0
        self.restart()

    def restart(self) -> None:
        """Forget all patches, but not the usual share."""
        self._kept: deque[_Kept] = deque(maxlen=_KEPT)
        self.forget_share()

    def forget_share(self) -> None:
        """Take all of the surface to move with the vehicle until it is judged again."""
        self.share, self.tells = 1.0, False

    def move_with_camera(self, camera: CameraMotion) -> None:
        """Let the camera move."""
        if camera.still:
            return
        for kept in self._kept:
            kept.move(camera)

    def keep(self, patch: Patch, position: Array, size: Array) -> None:
        """Keep a patch, and position and size of the vehicle in it, px."""
        self._kept.append(_Kept(patch, position, size))

    def judge(self, patch: Patch, position: Array, size: Array) -> float | None:
        """Judge how much of the vehicle still moves with it.

        Parameters
        ----------
        patch : Patch
            Shows the present frame.
        position, size : (2,) arrays
            Estimated centre, and width and height, px.

        Returns
        -------
        float or None
            `share`; None where flow tells nothing.
        """
        kept, apart = self._earlier(position, patch.zoom)
        if kept is None:
            return None
        moves = self._moving(patch, kept, position, size, apart)
        self._latest = float(moves.mean())
        if not self._usual:
            self._usual = self._latest
        self.tells = self._usual >= _LEAST_USUAL
        self.share = min(self._latest / self._usual, 1.0) if self.tells else 1.0
        return self.share if self.tells else None

    def learn_usual(self) -> None:
        """Count the present share as one of a clear frame."""
        if len(self._kept) >= _LEAST_KEPT:
            self._usual += _USUAL_RATE * (self._latest - self._usual)

    def _earlier(self, position: Array, zoom: Array) -> tuple[_Kept | None, float]:
        """Choose a patch to compare with, and tell how far vehicle and background came apart."""
        apart = 0.0
        for kept in reversed(self._kept):
            move = position - (kept.turn @ kept.position + kept.shift)
            apart = float(np.hypot(*(move * zoom)))
            if apart >= _APART_PX:
                return kept, apart
        return (self._kept[0], apart) if self._kept else (None, apart)

    def _moving(
        self, patch: Patch, kept: _Kept, position: Array, size: Array, apart: float
    ) -> npt.NDArray[np.bool_]:
        """Tell which points of the box have moved with the vehicle since the earlier patch."""
        cells = _cells(patch, position, size)
        source = cells + 0.5 + _flow(patch, kept.patch, cells)
        points = patch.to_frame(np.asarray(cells + 0.5, np.float64))
        places = (points - position) / size
        off = source - kept.patch.to_patch(kept.position + places * kept.size)
        limits = np.full(len(cells), _STRAYED_PX)
        if apart >= _TELLING_PX:
            stays = source - kept.patch.to_patch(kept.background(points))
            limits = np.minimum(limits, np.hypot(stays[:, 0], stays[:, 1]))
        near = np.hypot(off[:, 0], off[:, 1]) < _NEARLY * limits
        if near.sum() >= _FEWEST:
            off = off - places @ _shared_turn(places[near], off[near])
        return np.asarray(np.hypot(off[:, 0], off[:, 1]) < limits)


def _flow(present: Patch, before: Patch, cells: npt.NDArray[np.intp]) -> Array:
    """Flow (N, 2) at points (N, 2) from the present patch to an earlier one, canonical px.

    By dense inverse search (Kroeger et al. 2016), whose stripes, and so its results, do not depend
    on the number of threads.
    """
    method = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_ULTRAFAST)
    method.setVariationalRefinementIterations(_REFINED)
    # The middle of a wide patch is not in one piece of memory.
    images = (np.ascontiguousarray(each.grey) for each in (present, before))
    flow = method.calc(*images, None)  # type: ignore[call-overload]
    return np.asarray(flow[cells[:, 1], cells[:, 0]], np.float64)


def _cells(patch: Patch, position: Array, size: Array) -> npt.NDArray[np.intp]:
    """Points (N, 2) of the patch's grid that lie in the box, at least one, as x and y."""
    middle, half = patch.to_patch(position), _REACH * size * patch.zoom
    last = patch.side // _CELL - 1
    low = np.clip(np.ceil((middle - half) / _CELL - 0.5), 0, last).astype(np.intp)
    high = np.clip(np.floor((middle + half) / _CELL - 0.5), low, last).astype(np.intp)
    columns, rows = (np.arange(low[axis], high[axis] + 1) * _CELL + _CELL // 2 for axis in (0, 1))
    return np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)


def _shared_turn(places: Array, off: Array) -> Array:
    """Linear map (2, 2) by which most points have left their places: a turn, or growth."""
    gram = places.T @ places + np.eye(2) * _TURN_INERTIA
    return np.asarray(np.linalg.solve(gram, places.T @ off))
