# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Motion of points: their flow from image to image, and what most of them share.

The flow is Lucas and Kanade's on a pyramid. Points share the motion of a background, or of a
vehicle that turns or grows.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.image.window import Grey

Alive: TypeAlias = npt.NDArray[np.bool_]
Flow: TypeAlias = npt.NDArray[np.float32]
"""Displacement by [y, x], as x and y, to where the pixel was in an earlier image, px."""
CellBlock: TypeAlias = npt.NDArray[np.intp]
"""First column and row, and number of columns and rows, (2, 2); a cell has `CELL` px."""
Points: TypeAlias = npt.NDArray[np.float32]
"""x, y in px as OpenCV counts them, the middle of the first pixel being 0, shape (N, 2)."""
_Complex: TypeAlias = npt.NDArray[np.complex128]
PointMask: TypeAlias = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class PointFlow:
    """Search for points in another image.

    Attributes
    ----------
    window : int
        Side in px of the square around a point that is compared.
    levels : int
        Levels of the pyramid above the image itself; each doubles the motion that is found.
    steps : int
        Most iterations on a level; the default is OpenCV's.
    precision : float
        Step in px below which the iteration ends; the default is OpenCV's.
    """

    window: int
    levels: int
    steps: int = 30
    precision: float = 0.01

    def follow(
        self, before: Grey, after: Grey, points: Points, guess: Points | None = None
    ) -> tuple[Points, PointMask]:
        """Find the points of `before` in `after`, starting from a guess (N, 2) if there is one.

        Returns
        -------
        moved : (N, 2) array
            Positions in `after`.
        found : (N,) array
            True for the points that were found.
        """
        start = np.ascontiguousarray(points, np.float32).reshape(-1, 1, 2)
        first = None if guess is None else np.array(guess, np.float32).reshape(-1, 1, 2)
        moved, found, _ = cv2.calcOpticalFlowPyrLK(
            before,
            after,
            start,
            first,  # type: ignore[arg-type]  # None is allowed
            winSize=(self.window, self.window),
            maxLevel=self.levels,
            criteria=(cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, self.steps, self.precision),
            flags=0 if guess is None else cv2.OPTFLOW_USE_INITIAL_FLOW,
        )
        return np.asarray(moved, np.float32).reshape(-1, 2), np.asarray(found).ravel() > 0

    def follow_and_return(
        self, before: Grey, after: Grey, points: Points, guess: Points | None = None
    ) -> tuple[Points, PointMask, Points]:
        """Find points as `follow`, then follow them back (Kalal et al. 2010).

        Returns
        -------
        moved, found
            As from `follow`; found both ways.
        error : (N, 2) array
            Offset of the end of the way back from where it should be.
        """
        moved, found = self.follow(before, after, points, guess)
        back = None if guess is None else points
        again, returned = self.follow(after, before, moved, back)
        return moved, found & returned, again - points


AGREEING_PX = 0.7
"""Residual of a corner that agrees with the motion, in px of the reduced frame."""
LEAST_CORNERS = 6
"""Fewest corners that four numbers are fitted to."""
STILL_SHARE = 0.5
"""Share of corners at rest from which the camera stands: a lorry moves many, not half."""
FITS = 5
"""Reweighted fits; the weights change little after the third."""
TURN_FITS = 2
"""Fits of the turn: one for all, and one in which those that strayed from it count less."""
TURN_INERTIA = 0.3
"""Resistance of the turn's fit, as the sum of the squared places of five points: the few that an
occluder leaves must not turn all."""
FEWEST_POINTS = 12
"""Fewest tracked points that tell a change of size."""
APART = 0.25
"""Least distance of two points that tell a change of size, of the size."""
LARGEST_STRETCH = 0.15
"""Bound of the change of log size per frame: vehicles that pass a camera at 10 images a second
change by 0.12."""
LEAST_RATIO = 0.2
"""Bound of the ratio of two distances, whose logarithm is taken."""

CELL = 4
"""Px between points of a surface: dense flow is no finer."""
STRAYED_PX = 3.0
"""Distance in px from where its vehicle would have taken it, from which a point has moved on its
own: what a second occluder drives, or flow that has failed."""
FEWEST_CARRIED = 8
"""Fewest points that a turn is fitted to."""
NEARLY = 1.3
"""Factor to the limits within which points take part in the fit of the turn."""


def shared_similarity(before: Array, after: Array) -> Array:
    """Fit a similarity to the motion that most points share.

    Parameters
    ----------
    before, after : (N, 2) arrays
        Points in both frames, px.

    Returns
    -------
    (2, 3) array
        Rotation times scale, and shift in px. That of no motion where half of the points rest, or
        too few agree.
    """
    # As complex numbers, of which a similarity is a factor and a summand.
    start, end = (np.ascontiguousarray(points).view(complex).ravel() for points in (before, after))
    flow, rest = end - start, np.eye(2, 3)
    if len(flow) < LEAST_CORNERS:
        return rest
    if (np.abs(flow) < AGREEING_PX).mean() >= STILL_SHARE:
        return rest
    # A zoom or a roll spreads the flow over the image, hence the wide neighbourhood.
    apart = np.abs(flow[:, np.newaxis] - flow)
    densest = int((apart < 3 * AGREEING_PX).sum(axis=1).argmax())
    agreeing = apart[densest] < 5 * AGREEING_PX
    if agreeing.sum() < LEAST_CORNERS:
        return rest
    factor, shift = _robust_similarity(start[agreeing], end[agreeing])
    (along, across), (x, y) = ((each.real, each.imag) for each in (factor, shift))
    return np.array([[along, -across, x], [across, along, y]])


def _robust_similarity(start: _Complex, end: _Complex) -> tuple[complex, complex]:
    """Fit by least squares, reweighted so that points far off count little."""
    weights = np.ones(len(start))
    for _ in range(FITS):
        shares = weights / weights.sum()
        middle, target = shares @ start, shares @ end
        off = start - middle
        weighted = weights * off.conj()
        factor = weighted @ (end - target) / ((weighted @ off).real + 1e-9)
        shift = target - factor * middle
        residual = np.abs(end - factor * start - shift)
        scale = max(1.5 * median(residual), AGREEING_PX / 2)
        weights = 1 / (1 + (residual / scale) ** 2) ** 2
    return factor, shift


def median(values: Array) -> float:
    """Median of up to some hundred finite values, in a fraction of the time of `np.median`."""
    ordered, half = np.sort(values), len(values) // 2
    return float((ordered[(len(values) - 1) // 2] + ordered[half]) / 2)


def shared_turn(before: Array, after: Array, strayed: float) -> Array:
    """Linear map (2, 2) that most places (N, 2) in a box have moved by: a vehicle that turns.

    It has no shift, so that points which stay behind with an occluder do not fit into it. Those
    that are `strayed` off count half.
    """
    turn, kept = np.eye(2), TURN_INERTIA * np.eye(2)
    for _ in range(TURN_FITS):
        off = after - before @ turn
        far = (off[:, 0] ** 2 + off[:, 1] ** 2) / strayed**2
        weighted = before.T / (1 + far)
        turn = solved(weighted @ before + kept, weighted @ after + kept)
    return turn


def solved(matrix: Array, right: Array) -> Array:
    """Solve a (2, 2) system, in a fraction of the time of `np.linalg.solve`."""
    (a, b), (c, d) = matrix.tolist()
    return np.asarray(np.array([[d, -b], [-c, a]]) @ right / (a * d - b * c))


def staying(before: Array, after: Array, alive: Alive, strayed: float) -> Alive:
    """Tell which of the places (N, 2) that are alive turn with most of these.

    Parameters
    ----------
    before, after : (N, 2) arrays
        Places in the box when they were chosen, and now, in sizes of the box.
    alive : (N,) array
        False for places that count as lost already.
    strayed : float
        A place farther than this from where it should be does not stay.
    """
    turn = shared_turn(before[alive], after[alive], strayed)
    off = after - before @ turn
    return np.asarray(alive & (np.hypot(off[:, 0], off[:, 1]) < strayed))


def shared_stretch(before: Array, after: Array, size: Array) -> Array:
    """Median change of the log distance of points (N, 2) along x and y, of a box of a size."""
    change = np.zeros(2)
    half = len(before) // 2
    for axis in (0, 1):
        # Each of the lower half with one of the upper half: far apart for most, and no N² pairs.
        order = before[:, axis].argsort(kind="stable")
        low, high = order[:half], order[-half:]
        old, new = before[high, axis] - before[low, axis], after[high, axis] - after[low, axis]
        far = old > APART * size[axis]
        if far.sum() >= FEWEST_POINTS // 2:
            ratio = np.maximum(new[far] / old[far], LEAST_RATIO)
            change[axis] = median(np.log(ratio))
    return np.minimum(np.maximum(change, -LARGEST_STRETCH), LARGEST_STRETCH)


def carried_share(
    flow: Flow, cells: CellBlock, places: Array, vehicle: Array, background: Array
) -> float:
    """Share of the points of a box that have moved with its vehicle.

    A point counts that came from close to where the vehicle, turned and grown as most of them are,
    would have taken it from, and from closer to there than to where the background was.

    Parameters
    ----------
    flow : (h, w, 2) array of float32
        Flow of the image that has the box; see `Flow`.
    cells : (2, 2) array of intp
        The box; see `CellBlock`. Points are the middles of its cells, px.
    places, vehicle : (2, 2) arrays
        Factors and then summands, along x and y, that take a point to its place in the box, in
        sizes from the centre; and to where its place was in the earlier image, px.
    background : (3, 2) or (0, 2) array
        Matrix and then summand that take a point to where the background there was; empty where the
        two have hardly moved apart.
    """
    (left, top), (columns, rows) = cells.tolist()
    block = slice(top, top + rows), slice(left, left + columns)
    points = _middles(*flow.shape[:2])[block].reshape(-1, 2)
    source = points + flow[CELL // 2 :: CELL, CELL // 2 :: CELL][block].reshape(-1, 2)
    place = points * places[0] + places[1]
    off = source - (points * vehicle[0] + vehicle[1])
    limits = np.full(len(points), STRAYED_PX)
    if len(background):
        stays = source - (points @ background[:2] + background[2])
        limits = np.minimum(limits, np.hypot(stays[:, 0], stays[:, 1]))
    near = np.hypot(off[:, 0], off[:, 1]) < NEARLY * limits
    if near.sum() >= FEWEST_CARRIED:
        gram = place[near].T @ place[near] + np.eye(2) * TURN_INERTIA
        off = off - place @ solved(gram, place[near].T @ off[near])
    return float((np.hypot(off[:, 0], off[:, 1]) < limits).mean())


@functools.cache
def _middles(height: int, width: int) -> Array:
    """Middles of all cells, by [row, column]."""
    x, y = (np.arange(CELL // 2, side, CELL) + 0.5 for side in (width, height))
    return np.stack(np.meshgrid(x, y), axis=-1)
