"""Motion of the camera, from the flow of corners outside the target."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.small_grey import SmallGrey

Points = npt.NDArray[np.float64]

_LEAST_SIDE = 32
_GRID = (8, 6)
"""Cells along x and y that give one corner each, so that no lorry gives most of them."""
_BORDER = 6
_LEAST_STRENGTH = 1e-4
_REFRESHED_AFTER = 5
"""Frames that corners are followed before others are found."""
_WEAR_IN_PLACE = 1 / 3
"""What a frame counts for in this in which they stay where they are."""
_STANDS_AFTER = 30
"""Frames of measured stillness after which the camera is taken to be mounted, and only"""
_CHECKED_EVERY = 5
"""every fifth frame is measured, unless corners change."""
_UNCHANGED = 4.0
"""Mean change around a corner in grey levels below which it has not moved: noise, no edge."""
_NEIGHBOURHOOD = (5, 5)
_CLEARANCE = 0.75
"""Distance of corners from the target's centre, of its size."""
_AGREEING_PX = 0.7
"""Distance to the model below which a corner takes part, in px of the reduced frame."""
_LEAST_CORNERS = 6
_PREFERENCE = 0.6
"""Share of the largest support with which standing still is believed."""


@dataclass(frozen=True, slots=True)
class CameraMotion:
    """Where the background goes from one frame to the next: ``scale * p + shift``, px."""

    shift: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0

    def apply(self, positions: Points) -> Points:
        """Take positions (..., 2) along."""
        return np.asarray(positions * self.scale + np.array(self.shift))

    @property
    def still(self) -> bool:
        """Whether nothing moves."""
        return self == CameraMotion()


def fit_camera_motion(before: Points, after: Points) -> CameraMotion:
    """Fit shift and scale to most of the corners.

    The support of standing still, of the median flow and of the densest flow are compared;
    standing still is preferred, since a lorry that fills the view moves most corners but not the
    camera. The best is refined on the corners that agree with it.

    Parameters
    ----------
    before, after : (N, 2) arrays
        Corners in both frames, px.
    """
    if len(before) < _LEAST_CORNERS:
        return CameraMotion()
    flow = after - before
    standing = int((np.hypot(flow[:, 0], flow[:, 1]) < 2 * _AGREEING_PX).sum())
    if standing >= _PREFERENCE * len(flow):  # no other guess can have more than all
        return CameraMotion()
    guesses = np.vstack([np.zeros(2), np.median(flow, axis=0), flow])
    distances = np.linalg.norm(flow[np.newaxis] - guesses[:, np.newaxis], axis=2)
    supports = (distances < 2 * _AGREEING_PX).sum(axis=1)
    best = int(supports.argmax())
    if supports[0] >= _PREFERENCE * supports[best]:
        return CameraMotion()
    agreeing = distances[best] < 2 * _AGREEING_PX
    motion = CameraMotion()
    for _ in range(3):
        if agreeing.sum() < _LEAST_CORNERS:
            return CameraMotion()
        motion = _least_squares(before[agreeing], after[agreeing])
        agreeing = np.linalg.norm(after - motion.apply(before), axis=1) < _AGREEING_PX
    return motion


def _least_squares(before: Points, after: Points) -> CameraMotion:
    middle, target = before.mean(axis=0), after.mean(axis=0)
    centred = before - middle
    spread = float((centred**2).sum())
    scale = float((centred * (after - target)).sum()) / spread if spread > 0 else 1.0
    scale = min(max(scale, 0.9), 1.1)
    x, y = target - scale * middle
    return CameraMotion((float(x), float(y)), scale)


class CameraFlow:
    """Follows corners of the background from frame to frame."""

    def __init__(self) -> None:
        self._last: npt.NDArray[np.uint8] | None = None
        self._corners = np.empty((0, 1, 2), np.float32)
        self._age = 0.0
        self._still = 0

    @property
    def _is_mounted(self) -> bool:
        return self._still >= _STANDS_AFTER and self._still % _CHECKED_EVERY != 0

    def measure(self, small: SmallGrey, target: Box) -> CameraMotion:
        """Motion since the last frame shown; none for the first one.

        Parameters
        ----------
        small : SmallGrey
            The reduced frame.
        target : Box
            In px of the whole frame; corners in and close to it take no part.
        """
        reduced, zoom = small.image, small.zoom
        last, self._last = self._last, reduced
        if last is None or last.shape != reduced.shape or min(reduced.shape) < _LEAST_SIDE:
            return CameraMotion()
        corners = self._background(last, target, zoom)
        if len(corners) < _LEAST_CORNERS:
            return CameraMotion()
        if self._is_mounted and _stand(last, reduced, corners):
            self._age += _WEAR_IN_PLACE - 1
            self._still += 1
            return CameraMotion()
        moved, found = _track(last, reduced, corners)
        kept = found.ravel() > 0
        self._corners = np.ascontiguousarray(moved[kept])
        before = corners[kept].reshape(-1, 2).astype(np.float64)
        motion = fit_camera_motion(before, moved[kept].reshape(-1, 2).astype(np.float64))
        self._still = self._still + 1 if motion.still else 0
        x, y = motion.shift
        return CameraMotion((x / zoom, y / zoom), motion.scale)

    def _background(
        self, grey: npt.NDArray[np.uint8], target: Box, zoom: float
    ) -> npt.NDArray[np.float32]:
        """Corners outside the target, found afresh now and then, (N, 1, 2)."""
        self._age += 1
        if self._age >= _REFRESHED_AFTER or len(self._corners) < _GRID[0] * _GRID[1] // 3:
            self._corners, self._age = _find_corners(grey), 0.0
        x, y = self._corners[:, 0, 0] / zoom, self._corners[:, 0, 1] / zoom
        middle_x, middle_y = target.centre
        outside = np.abs(x - middle_x) > _CLEARANCE * target.width
        outside |= np.abs(y - middle_y) > _CLEARANCE * target.height
        return np.ascontiguousarray(self._corners[outside])


def _stand(
    last: npt.NDArray[np.uint8], present: npt.NDArray[np.uint8], corners: npt.NDArray[np.float32]
) -> bool:
    """Whether so many corners look unchanged that flow need not be measured: the usual case."""
    change = cv2.boxFilter(cv2.absdiff(last, present), cv2.CV_32F, _NEIGHBOURHOOD)
    places = np.rint(corners[:, 0]).astype(np.intp)
    places = np.clip(places, 0, (present.shape[1] - 1, present.shape[0] - 1))
    unchanged = change[places[:, 1], places[:, 0]] < _UNCHANGED
    return bool(unchanged.mean() >= _PREFERENCE)


def _track(
    last: npt.NDArray[np.uint8], present: npt.NDArray[np.uint8], corners: npt.NDArray[np.float32]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint8]]:
    """Lucas-Kanade on a pyramid: where the corners are now, and which of them were found."""
    guess = corners.copy()
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 10, 0.03)
    moved, found, _ = cv2.calcOpticalFlowPyrLK(
        last, present, corners, guess, winSize=(13, 13), maxLevel=3, criteria=criteria
    )
    return np.asarray(moved, np.float32), np.asarray(found, np.uint8)


def _find_corners(grey: npt.NDArray[np.uint8]) -> npt.NDArray[np.float32]:
    """Find the strongest corner of each cell of a grid, (N, 1, 2)."""
    strength = cv2.cornerMinEigenVal(grey, 3)
    rows, columns = grey.shape
    wide, high = (columns - 2 * _BORDER) // _GRID[0], (rows - 2 * _BORDER) // _GRID[1]
    inner = strength[_BORDER : _BORDER + high * _GRID[1], _BORDER : _BORDER + wide * _GRID[0]]
    cells = inner.reshape(_GRID[1], high, _GRID[0], wide).transpose(0, 2, 1, 3)
    flat = cells.reshape(_GRID[0] * _GRID[1], high * wide)
    best, cell = flat.argmax(axis=1), np.arange(_GRID[0] * _GRID[1])
    x = _BORDER + (cell % _GRID[0]) * wide + best % wide
    y = _BORDER + (cell // _GRID[0]) * high + best // wide
    strong = flat[cell, best] > _LEAST_STRENGTH
    corners = np.column_stack([x, y])[strong].astype(np.float32)
    return np.asarray(corners.reshape(-1, 1, 2), np.float32)
