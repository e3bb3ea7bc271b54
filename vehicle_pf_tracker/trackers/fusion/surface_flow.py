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

import math
from collections import deque
from dataclasses import dataclass, field

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.camera_motion import CameraMotion
from vehicle_pf_tracker.image.canonical_patch import Patch
from vehicle_pf_tracker.image.shared_motion import CELL, CellBlock, Flow, carried_share, solved

_KEPT = 8
"""Patches kept; by less than half a canonical px per frame a vehicle is taken to stand."""
_APART_PX = 4.0
"""Canonical px that vehicle and background should have moved apart since the patch that the present
one is compared with: the youngest such patch is taken. Flow is good to about one."""
_TELLING_PX = 2.0
"""The same below which the background's flow cannot be told from the vehicle's."""
_SIDE = 96
"""Side in canonical px of the middle of a patch that flow is measured in: a target has 77 px at
most, and flow of all 128 takes 1.7 times as long."""
_REACH = 0.45
"""Outermost points from the centre, of the size: the box's rim is background."""
_REFINED = 5
"""Iterations of the flow's smoothing (Brox et al. 2004): plain surfaces move with their edges."""
USUAL_RATE = 0.05
"""Rate per frame at which the usual share follows the present one in clear frames."""
_LEAST_USUAL = 0.3
"""Usual share below which flow tells nothing: a vehicle of a few px, or motion blur."""
_LEAST_KEPT = 3
"""Patches from which a share counts as usual."""


@dataclass(slots=True, eq=False)
class _Kept:
    """An earlier patch, the vehicle's position and size in it, and the camera's next motion."""

    patch: Patch
    position: Array
    size: Array
    camera: CameraMotion = field(default_factory=CameraMotion)


class SurfaceFlow:
    """Compares the present patch with an earlier one, point by point.

    Attributes
    ----------
    share : float
        Share of the points in the box that move with the vehicle, of the usual share; 1 where flow
        tells nothing.
    tells : bool
        True where flow told something when it was last asked.
    """

    def __init__(self) -> None:
        self._usual = 0.0
        self._latest = 1.0
        self.restart()

    def restart(self) -> None:
        """Discard all patches, but not the usual share."""
        self._kept: deque[_Kept] = deque(maxlen=_KEPT)
        self.share, self.tells = 1.0, False

    def move_with_camera(self, camera: CameraMotion) -> None:
        """Let the camera move, once between two patches that are kept."""
        if self._kept:
            self._kept[-1].camera = camera

    def keep(self, patch: Patch, position: Array, size: Array) -> None:
        """Keep a patch, and position and size of the vehicle in it, px."""
        self._kept.append(_Kept(_middle(patch), position, size))

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
        if not self._kept:
            return None
        kept, camera, apart = self._earlier(position, patch.zoom)
        background = camera if apart >= _TELLING_PX else None
        self._latest = self._moving(_middle(patch), kept, position, size, background)
        if not self._usual:
            self._usual = self._latest
        self.tells = self._usual >= _LEAST_USUAL
        self.share = min(self._latest / self._usual, 1.0) if self.tells else 1.0
        return self.share if self.tells else None

    def learn_usual(self) -> None:
        """Count the present share as one of a clear frame."""
        if len(self._kept) >= _LEAST_KEPT:
            self._usual += USUAL_RATE * (self._latest - self._usual)

    def _earlier(self, position: Array, zoom: Array) -> tuple[_Kept, CameraMotion, float]:
        """Choose a patch to compare with; the camera's motion since, and the vehicle's beyond."""
        since = CameraMotion()
        for kept in reversed(self._kept):
            if not kept.camera.still:
                since = since.after(kept.camera)
            apart = math.hypot(*((position - since.apply(kept.position)) * zoom).tolist())
            if apart >= _APART_PX:
                break
        return kept, since, apart

    def _moving(
        self, patch: Patch, kept: _Kept, position: Array, size: Array,
        camera: CameraMotion | None,
    ) -> float:  # fmt: skip
        """Share of the box that has moved with the vehicle since the earlier patch.

        `camera` is the motion since, if the background tells anything.
        """
        before, half = kept.patch, _SIDE / 2
        # As factor and summand: of the present patch to px, and of px to the earlier patch.
        to_px, from_px = (1 / patch.zoom, patch.centre - half / patch.zoom), before.zoom
        factor, summand = to_px[0] / size, (to_px[1] - position) / size
        grown = kept.size * from_px
        places = np.array([factor, summand])
        start = (kept.position - before.centre) * from_px + half
        vehicle = np.array([factor * grown, summand * grown + start])
        background = np.empty((0, 2))
        if camera is not None:
            back = solved(camera.turn, np.eye(2)).T * from_px
            shift = (to_px[1] - camera.shift) @ back + half - before.centre * from_px
            background = np.array([*(to_px[0][:, np.newaxis] * back), shift])
        cells = _cells(patch, position, size)
        return carried_share(_flow(patch, before), cells, places, vehicle, background)


def _middle(patch: Patch) -> Patch:
    """Cut out what flow is measured in."""
    middle = patch.middle(_SIDE)
    return Patch(middle.image, np.ascontiguousarray(middle.grey), patch.centre, patch.zoom)


def _flow(present: Patch, before: Patch) -> Flow:
    """Flow from the present patch to an earlier one, canonical px.

    By dense inverse search (Kroeger et al. 2016), whose stripes, and so its results, do not depend
    on the number of threads. Trackers are copied, which this object cannot be: it is made anew.
    """
    method = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_ULTRAFAST)
    method.setVariationalRefinementIterations(_REFINED)
    flow = method.calc(present.grey, before.grey, None)  # type: ignore[call-overload]
    return np.asarray(flow, np.float32)


def _cells(patch: Patch, position: Array, size: Array) -> CellBlock:
    """Cells of the patch that lie in the box, at least one."""
    middle, half = patch.to_patch(position), _REACH * size * patch.zoom
    last = patch.side // CELL - 1
    low = np.minimum(np.maximum(np.ceil((middle - half) / CELL - 0.5), 0), last)
    high = np.minimum(np.maximum(np.floor((middle + half) / CELL - 0.5), low), last)
    return np.array([low, high - low + 1], np.intp)
