# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Optical flow on the vehicle: the share of its surface that still moves with it.

Where an occluder covers the vehicle the image moves with the occluder: with the background where a
wall stands, and its own way where a lorry drives by. A turn changes the vehicle's appearance, and
with it the filter's response, but its surface still moves with it.
"""

from __future__ import annotations

import math
import threading
from typing import NamedTuple

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.correlation.canonical_patch import Patch
from vehicle_pf_tracker.image.kernels.interface import BY_NUMPY, Kernels
from vehicle_pf_tracker.image.motion.box_motion import (
    FLOW_CELL_PX,
    CellBlock,
    Flow,
    solved,
)
from vehicle_pf_tracker.image.motion.camera_motion import CameraMotion
from vehicle_pf_tracker.image.motion.explained_variance import explained_variance
from vehicle_pf_tracker.trackers.fusion.parameters import EVEN_SHARE

_KEPT = 8
"""Patches kept: over eight frames a vehicle gets `_APART_PX` ahead of the background by half a
canonical px per frame, and `_TELLING_PX` by a quarter; a slower one is taken to stand."""
_APART_PX = 4.0
"""Canonical px that vehicle and background should have moved apart since the patch that the present
one is compared with: the youngest such patch is taken. Flow is good to about one."""
_TELLING_PX = 2.0
"""Motion apart in canonical px below which the background's flow is too close to the vehicle's:
twice the error."""
_SIDE = 96
"""Side in canonical px of the middle of a patch that flow is measured in: a target has 77 px at
most, and flow of all 128 takes 1.7 times as long."""
BOX_REACH = 0.45
"""Distance of the outermost points from the centre, fraction of the size: half a cell, a twentieth
of the canonical size, inside the box."""
_REFINED = 5
"""Iterations of the flow's smoothing (Brox et al. 2004): plain surfaces move with their edges. Five
is a choice; flow is good to one px with it, and each iteration costs time."""
USUAL_RATE = 0.05
"""Rate per frame at which the usual share follows the present one in clear frames: in 20 frames, a
choice. An occluder that covers the vehicle within fewer does not move it."""
_LEAST_USUAL_SHARE = 0.3
"""Usual share below which flow is not reliable: a vehicle of a few px, or motion blur. That of a
vehicle of which .3 to .5 is visible is .33 (laboratory/notes/fusion_tried.md)."""
_LEAST_KEPT = 3
"""Patches from which a share counts as usual: the first two have hardly moved apart, so that all of
the image moves with the vehicle."""
_EXPLAINED = 0.5
"""Share of the variance of the box's grey levels below which flow has failed: it explains less than
it leaves. A choice; under lorries that came within three frames it explains a fifth, in real turns
.53 and more but once (laboratory/notes/fusion_tried.md)."""


class _Search(threading.local):
    """OpenCV's object that measures flow, with its buffers; one for each thread.

    Its results depend on nothing that it measured before. Trackers, which are copied, cannot have
    it: it has no copies.
    """

    def __init__(self) -> None:
        self.method = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_ULTRAFAST)
        self.method.setVariationalRefinementIterations(_REFINED)


_search = _Search()


class _Kept(NamedTuple):
    """An earlier patch, the vehicle's position and size in it, and the camera's next motion."""

    patch: Patch
    position: Array
    size: Array
    camera: CameraMotion = CameraMotion()


class SurfaceFlow(NamedTuple):
    """Earlier patches, and the share of the surface that moves with the vehicle between two.

    Attributes
    ----------
    patches : tuple of _Kept
        The last patches, oldest first.
    usual, latest : float
        Usual share of the box that moves with the vehicle, and the share when last judged.
    share : float
        Ratio of the two, at most 1; 1 where too little usually moves with the vehicle.
    is_reliable : bool
        True where `share` is evidence: enough usually moves with the vehicle, and flow was
        informative where the filter hardly responded (see `judged`).
    """

    patches: tuple[_Kept, ...] = ()
    usual: float = 0.0
    latest: float = 1.0
    share: float = 1.0
    is_reliable: bool = False

    def restarted(self) -> SurfaceFlow:
        """Discard all patches, but not the usual share."""
        return SurfaceFlow((), self.usual, self.latest)

    def moved(self, camera: CameraMotion) -> SurfaceFlow:
        """Let the camera move, once between two patches that are kept."""
        if camera.still or not self.patches:
            return self
        # With the patch that it starts from: `_earlier` composes all motions from a patch on.
        latest = self.patches[-1]._replace(camera=camera)
        return self._replace(patches=(*self.patches[:-1], latest))

    def kept(self, patch: Patch, position: Array, size: Array) -> SurfaceFlow:
        """Keep a patch, and position and size of the vehicle in it, px."""
        patches = (*self.patches, _Kept(_middle(patch), position, size))
        return self._replace(patches=patches[-_KEPT:])

    def judged(
        self,
        patch: Patch,
        position: Array,
        size: Array,
        kernels: Kernels = BY_NUMPY,
        *,
        is_low: bool = False,
    ) -> SurfaceFlow:
        """Judge how much of the vehicle still moves with it.

        Parameters
        ----------
        patch : Patch
            Shows the present frame.
        position, size : (2,) arrays
            Estimated centre, and width and height, px.
        kernels : Kernels
            Implementation that counts what moves with the vehicle.
        is_low : bool
            True where the filter hardly responds. Then flow is evidence for the vehicle only if
            both have moved apart from the background, and it explains what is seen.
        """
        if not self.patches:
            return self
        kept, camera, apart = self._earlier(position, patch.zoom)
        background = camera if apart >= _TELLING_PX else None
        middle = _middle(patch)
        flow = _flow(middle, kept.patch)
        latest = _moving_share(middle, flow, kept, (position, size), background, kernels)
        # The first share is its own usual one: no other is known.
        usual = self.usual or latest
        is_reliable = usual >= _LEAST_USUAL_SHARE
        # More than usual is no better than visible; an unreliable share must not speak against it.
        share = min(latest / usual, 1.0) if is_reliable else 1.0
        # Patches are centred on the vehicle: no flow counts as its motion. So an occluder may count
        # as its surface, before a vehicle that hardly moves, or where it covers one within few
        # frames, as flow finds nothing then.
        if is_low and share > EVEN_SHARE:
            cells = _cells(middle, position, size)
            explained = explained_variance(middle.grey, kept.patch.grey, flow, cells)
            is_reliable &= apart >= _TELLING_PX and explained >= _EXPLAINED
        return SurfaceFlow(self.patches, usual, latest, share, is_reliable)

    def learnt_usual(self) -> SurfaceFlow:
        """Count the present share as one of a clear frame."""
        # A share of patches that have hardly moved apart would make all later ones look low.
        if len(self.patches) < _LEAST_KEPT:
            return self
        return self._replace(usual=self.usual + USUAL_RATE * (self.latest - self.usual))

    def _earlier(self, position: Array, zoom: Array) -> tuple[_Kept, CameraMotion, float]:
        """Choose a patch to compare with; the camera's motion since, and the vehicle's beyond."""
        # From the youngest on, as appearance has changed least; if none is far enough, the oldest.
        since = CameraMotion()
        for kept in reversed(self.patches):
            if not kept.camera.still:
                since = since.after(kept.camera)
            start = kept.position if since.still else since.apply(kept.position)
            apart = math.hypot(*((position - start) * zoom).tolist())
            if apart >= _APART_PX:
                break
        return kept, since, apart


def _moving_share(
    patch: Patch,
    flow: Flow,
    kept: _Kept,
    box: tuple[Array, Array],
    camera: CameraMotion | None,
    kernels: Kernels,
) -> float:
    """Share of the box that has moved with the vehicle since the earlier patch.

    `flow` leads there; `box` is its present centre and size. `camera` is the motion since, None if
    the background has moved too nearly as the vehicle. All maps are from the present patch's px: a
    point p is mapped to p * map[0] + map[1] where a map has two rows, and the background's to
    p @ map[:2] + map[2], since the camera may roll.
    """
    position, size = box
    # 1. Maps from the patch to the frame, and on to the box: positions as fractions of its size.
    before = kept.patch
    half = _SIDE / 2
    to_frame = 1 / patch.zoom, patch.centre - half / patch.zoom
    to_box = np.array([to_frame[0] / size, (to_frame[1] - position) / size])  # (2, 2)
    # 2. From the box to the earlier patch, if all of it had moved and grown with the vehicle.
    grown = kept.size * before.zoom
    start = (kept.position - before.centre) * before.zoom + half
    vehicle = np.array([to_box[0] * grown, to_box[1] * grown + start])  # (2, 2)
    # 3. The same if it had stood still: back by the camera's motion.
    background = np.empty((0, 2))
    if camera is not None:
        back = solved(camera.turn, np.eye(2)).T * before.zoom
        shift = (to_frame[1] - camera.shift) @ back + half - before.centre * before.zoom
        background = np.array([*(to_frame[0][:, np.newaxis] * back), shift])  # (3, 2)
    # 4. A point counts for the vehicle if flow leads nearer to the second map than to the third.
    cells = _cells(patch, position, size)
    return kernels.carried_share(flow, cells, to_box, vehicle, background)


def _middle(patch: Patch) -> Patch:
    """Cut out what flow is measured in."""
    # OpenCV's flow asks for a contiguous image.
    middle = patch.middle(_SIDE)
    return Patch(middle.image, np.ascontiguousarray(middle.grey), patch.centre, patch.zoom)


def _flow(present: Patch, before: Patch) -> Flow:
    """Flow from the present patch to an earlier one, canonical px.

    By dense inverse search (Kroeger et al. 2016), whose stripes, and so its results, do not depend
    on the number of threads.
    """
    flow = _search.method.calc(present.grey, before.grey, None)  # type: ignore[call-overload]
    return np.asarray(flow, np.float32)


def _cells(patch: Patch, position: Array, size: Array) -> CellBlock:
    """Cells of the patch that lie in the box, at least one."""
    middles = patch.to_patch(position).tolist()
    halves = (BOX_REACH * size * patch.zoom).tolist()
    last = patch.side // FLOW_CELL_PX - 1
    firsts = []
    counts = []
    for middle, half in zip(middles, halves, strict=True):
        # Cells whose middles are inside: half a cell less on either side.
        low = min(max(math.ceil((middle - half) / FLOW_CELL_PX - 0.5), 0), last)
        high = min(max(math.floor((middle + half) / FLOW_CELL_PX - 0.5), low), last)
        firsts.append(low)
        counts.append(high - low + 1)
    return np.array([firsts, counts], np.intp)
