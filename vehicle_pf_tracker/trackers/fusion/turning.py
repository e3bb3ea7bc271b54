"""Turns before a still camera: the vehicle's blob tells its place and box while its looks change.

A vehicle that turns leaves its path with both of its sides, to the same side of it, and keeps its
area and its colours. One that is being covered loses area, and an occluder moves one side only.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.trackers.fusion.foreground import (
    Blob,
    Edges,
    Foreground,
    Span,
    around,
    joined,
)

Colour = Callable[[Frame], float]
"""Gives the mean share of pixels (n, 1, 3) that speaks for the target."""

_LOOKED_AT = 0.9
"""What is looked at around the expected box for its blob, of its sides."""
_BELONGS = 0.35
"""Centres of the target's blobs lie within this share around the expected box."""
_LEAST_AREA = 0.03
_LEAST_PART = 0.12
"""Of the largest blob; smaller ones are noise."""
_SAME_AREA = 0.1
_HALF_COVERED = 0.93
_SETTLED = 20
_RATE = 0.2
_RIM_FRAMES = 15
"""Frames that tell how far the blob reaches over the box: its shadow does."""
_TRUSTED_AFTER = 8
_FITTED = 24
_FEWEST = 5
_LATEST = 25
"""Sides are foretold from 5 to 24 sightings, the last of them 8 to 25 frames ago."""
_MOVES = 0.02
_ASIDE = 0.08
"""Least speed, and how far both sides leave their paths, of the size."""
_VOTES = 2
_MISSES = 3
_STRAIGHT_FRAMES = 9
_STRAIGHT = 0.12
"""Change of direction over these, rad, below which the turn has ended; and that of the sides:"""
_SAME_SIDES = 0.08


@dataclass(slots=True)
class _Usual:
    """The blob in clear frames: its edges off the place, its area and colour."""

    offsets: Edges
    area: float
    colour: float


class Turns:
    """Watches one target for turns, and follows it round them."""

    def __init__(self) -> None:
        self.foreground: Foreground | None = None
        self._time = 0.0
        self._clear_frames = 0
        self.forget()
        self._rim = np.zeros(4)
        self._rim_frames = 0

    def forget(self) -> None:
        """Forget how the blob looks, as after a turn."""
        self.active = False
        self._usual: _Usual | None = None
        self._sides: deque[tuple[float, Edges]] = deque(maxlen=40)
        self._votes = self._misses = 0
        self._area = 0.0
        self._boxes: list[Box] = []

    def watch(self, frame: Frame, target: Box, elapsed: float, *, still: bool, seen: bool) -> None:
        """Learn the background of a camera that is `still`, where the target is not.

        Where the target is has to be `seen`, or nothing is learnt.
        """
        self._time += elapsed
        if not still or (self.foreground is not None and not self.foreground.fits(frame)):
            self.foreground = None
            self.forget()
        elif self.foreground is None:
            self.foreground = Foreground(frame, target)
        elif seen:
            self.foreground.learn(frame, target)

    @property
    def undecided(self) -> bool:
        """Whether the next frame may show that what seems an occlusion is a turn."""
        return self._votes > 0

    @property
    def usual_area(self) -> float | None:
        """Area of the blob in clear frames, px²."""
        return self._usual.area if self._usual is not None else None

    @property
    def usual_colour(self) -> float:
        """Mean share of its colours in clear frames."""
        return self._usual.colour if self._usual is not None else 0.0

    def notice(self, frame: Frame, target: Box, colour: Colour, *, clear: bool) -> Box | None:
        """Learn the blob of a clear frame; in doubt, look whether the target turns.

        Returns
        -------
        Box or None
            The target's box, where a turn has begun.
        """
        self._clear_frames += clear
        blob = self._blob(frame, self._expected(target))
        if blob is None:
            self._votes = 0
            return None
        if self._usual is not None and abs(blob.area / self._usual.area - 1) < _SAME_AREA:
            self._sides.append((self._time, blob.edges))
        if clear:
            self._votes = 0
            self._learn(blob, target, colour)
            return None
        if self._usual is None:
            return None
        self._votes = self._votes + 1 if self._leaves(blob, colour, self._usual) else 0
        if self._votes < _VOTES:
            return None
        self.begin(blob.area)
        return self.box_of(blob)

    def begin(self, area: float) -> None:
        """Follow the blob, of `area` px², from now on."""
        self.active, self._area, self._misses, self._boxes = True, area, 0, []

    def follow(self, frame: Frame, predicted: Box, colour: Colour) -> Box | None:
        """Find the box of a turning target; None where it is not seen.

        `active` turns false where the turn ends, or the blob is lost for several frames.
        """
        blob = self._blob(frame, predicted)
        if (
            blob is None
            or not 0.6 * self._area < blob.area < 1.5 * self._area
            or colour(blob.pixels) < 0.5 * self.usual_colour
        ):
            self._misses += 1
            if self._misses >= _MISSES:
                self.forget()
            return None
        self._misses = 0
        self._area += 0.3 * (blob.area - self._area)
        box = self.box_of(blob)
        self._boxes = [*self._boxes[1 - _STRAIGHT_FRAMES :], box]
        if len(self._boxes) == _STRAIGHT_FRAMES and _is_straight(self._boxes):
            self.forget()
        return box

    def box_of(self, blob: Blob) -> Box:
        """Box of a vehicle that looks like this blob: without what is usually its shadow."""
        usual = self._usual.offsets if self._usual is not None else blob.edges
        rim = self._rim * _side(usual)
        left, top, right, bottom = (blob.edges - rim).tolist()
        return Box(left, top, max(right - left, 4.0), max(bottom - top, 4.0))

    def _expected(self, target: Box) -> Box:
        """Box of the blob around the target."""
        if self._usual is None:
            return target
        left, top, right, bottom = self._usual.offsets.tolist()
        x, y = target.centre
        width, height = max(target.width, right - left), max(target.height, bottom - top)
        return Box.around((x + (left + right) / 2, y + (top + bottom) / 2), width, height)

    def _blob(self, frame: Frame, box: Box) -> Blob | None:
        """Foreground of the target; None if there is none, or it goes on beyond the window."""
        if self.foreground is None:
            return None
        span, own = around(frame, box, _LOOKED_AT), around(frame, box, _BELONGS)
        least = max(6.0, _LEAST_AREA * box.width * box.height)
        blobs = [one for one in self.foreground.blobs(frame, span, least) if _within(one, own)]
        if not blobs or not self.foreground.knows(span):
            return None
        largest = max(one.area for one in blobs)
        blob = joined([one for one in blobs if one.area > _LEAST_PART * largest])
        return None if _goes_on(frame, blob, span) else blob

    def _learn(self, blob: Blob, target: Box, colour: Colour) -> None:
        place = np.array([*target.centre, *target.centre])
        share = colour(blob.pixels)
        usual = self._usual
        if usual is None:
            self._usual = _Usual(blob.edges - place, blob.area, share)
        elif blob.area < _HALF_COVERED * usual.area and self._clear_frames > _SETTLED:
            usual.area *= 0.998  # it drives away, or is being covered
            return
        else:
            usual.offsets = usual.offsets + _RATE * (blob.edges - place - usual.offsets)
            usual.area += _RATE * (blob.area - usual.area)
            usual.colour += _RATE * (share - usual.colour)
        if self._rim_frames < _RIM_FRAMES:
            self._rim_frames += 1
            box = np.array([target.x, target.y, target.x + target.width, target.y + target.height])
            over = (blob.edges - box) / _side(blob.edges)
            self._rim = self._rim + (over - self._rim) / self._rim_frames

    def _leaves(self, blob: Blob, colour: Colour, usual: _Usual) -> bool:
        """Whether both sides of the blob have left their paths to the same side."""
        known = [one for one in self._sides if one[0] <= self._time - _TRUSTED_AFTER][-_FITTED:]
        if len(known) < _FEWEST or self._time - known[-1][0] > _LATEST:
            return False
        times, sides = np.array([one[0] for one in known]), np.array([one[1] for one in known])
        off = times - times.mean()
        slopes = off @ sides / (off @ off)
        foretold = sides.mean(axis=0) + slopes * (self._time - times.mean())
        velocity = (slopes[:2] + slopes[2:]) / 2
        speed, size = float(np.hypot(*velocity)), _side(foretold)
        if speed < _MOVES * size or not 0.6 * usual.area < blob.area < 1.35 * usual.area:
            return False
        if colour(blob.pixels) < 0.6 * usual.colour:
            return False
        across = np.array([-velocity[1], velocity[0]]) / speed
        low, high = np.subtract(_extent(blob.edges, across), _extent(foretold, across)).tolist()
        return bool(low * high > 0 and min(abs(low), abs(high)) > _ASIDE * size)


def _within(blob: Blob, span: Span) -> bool:
    x, y = blob.centre
    return span.left <= x <= span.right and span.top <= y <= span.bottom


def _goes_on(frame: Frame, blob: Blob, span: Span) -> bool:
    """Whether a blob reaches the border of what was looked at, other than that of the image."""
    width, height = frame_size(frame)
    left, top, right, bottom = blob.edges.tolist()
    return bool(
        (left <= span.left and left > 0)
        or (top <= span.top and top > 0)
        or (right >= span.right and right < width)
        or (bottom >= span.bottom and bottom < height)
    )


def _side(edges: Edges) -> float:
    """Geometric mean of the sides, px."""
    left, top, right, bottom = edges.tolist()
    return math.sqrt(max(right - left, 1.0) * max(bottom - top, 1.0))


def _extent(edges: Edges, across: Edges) -> tuple[float, float]:
    """Least and largest coordinate of a box along a direction."""
    x = edges[[0, 2]] * across[0]
    y = edges[[1, 3]] * across[1]
    return float(x.min() + y.min()), float(x.max() + y.max())


def _is_straight(boxes: list[Box]) -> bool:
    """Whether neither direction nor size changed over the boxes."""
    first, middle, last = boxes[0], boxes[len(boxes) // 2], boxes[-1]
    (a, b), (c, d), (e, f) = first.centre, middle.centre, last.centre
    before, after = (c - a, d - b), (e - c, f - d)
    angle = math.atan2(
        before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]
    )
    change = max(abs(last.width / first.width - 1), abs(last.height / first.height - 1))
    return abs(angle) < _STRAIGHT and change < _SAME_SIDES
