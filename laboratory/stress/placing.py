# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Placing an occluder so that it hides the vehicle for a given time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from laboratory.stress.background import Background
from laboratory.stress.coverage import Floats
from laboratory.stress.occluder import Motion, Occluder, similarities
from laboratory.stress.painting import LORRY, POLE, Texture
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import TOTAL_BELOW, Occlusion, Truth
from vehicle_pf_tracker.scenes.random_streams import stream

LEAD, LEAST_LEAD = 40, 8
"""Frames in full view before an occluder touches the vehicle: as many as there are, up to a
second and a third; with fewer than eight a tracker has learnt nothing."""
TAIL, LEAST_TAIL = 45, 20
"""Frames after the last hidden one. A recovery is judged from 15 frames on, by at least 5."""
_LONGEST_TOUCH = 60
"""Frames that an occluder may cover the vehicle in part, before and after, together."""
_HEADING_FRAMES = 15
"""Frames before and after an occlusion that headings are taken over, half a second."""
_TURNING_DEGREES = 15.0
"""Change of heading that leaves a constant velocity a quarter of the way beside the vehicle."""
TURNING = "turning"
"""Course of a vehicle whose heading changes while something covers it."""
NEAR = "coming near"
"""Course of one that grows meanwhile."""
AWAY = "going away"
"""Course of one that shrinks meanwhile."""
ACROSS = "across"
"""Course of one that keeps its size meanwhile."""
_GROWN = 1.1
"""Factor of the size by which it comes near, or its inverse by which it goes away, while something
covers it: a tenth, above the noise of true boxes. In between it drives across."""
_LEAST_WAY = 0.15, 4.0
"""Way in diagonals, and in px, below which a heading is noise of the truth."""
_POLE_SHARES = (0.3, 0.5)
"""Width of a pole in widths (or heights) of the vehicle: partial, never total."""
_TOLERANCE = 0.25
"""Accepted deviation from the duration asked for, as a share: 5 and 10 frames stay apart."""


class OcclusionSpec(NamedTuple):
    """An occlusion to be painted.

    Attributes
    ----------
    style : str
        Wall, pole or lorry.
    duration : int
        Totally hidden frames; for a pole there are none.
    crossing : float
        Frames that a lorry takes to cover the vehicle.
    """

    style: str
    duration: int = 0
    crossing: float = 0.0


@dataclass(frozen=True, slots=True)
class Placed:
    """An occluder that keeps to its specification.

    Attributes
    ----------
    occluder : Occluder
        The occluder, whose texture is still to be chosen.
    first, count : int
        The frames of the sequence to play.
    hidden : int
        Totally hidden frames, of the exact truth.
    path : str
        ``straight`` or ``turning``: the vehicle's way across the occlusion.
    course : str
        `TURNING`, or of a straight way `NEAR`, `AWAY` or `ACROSS`.
    """

    occluder: Occluder
    first: int
    count: int
    hidden: int
    path: str
    course: str


class Placer:
    """Places occluders in one sequence.

    Parameters
    ----------
    truth : sequence of Truth or None
        Truth of every frame.
    background : Background
        Its motion carries standing occluders, which are refused where it is not coherent.
    size : (int, int)
        Width and height of the images, px.
    """

    def __init__(
        self, truth: Sequence[Truth | None], background: Background, size: tuple[int, int]
    ) -> None:
        self._truth = truth
        self._background = background
        self._size = size
        # NaN: a frame without truth can be looked up, and takes part in nothing.
        nowhere = np.full((4, 2), np.nan)
        self._corners = np.array(
            [nowhere if each is None else each.box.corners for each in truth], float
        )

    def place(self, spec: OcclusionSpec, anchor: int, seed: int) -> Placed | None:
        """Place an occluder that hides the vehicle around frame `anchor`; None if that fails."""
        # A standing occluder that does not move as its surroundings do is seen through at once.
        if spec.style != LORRY and not self._background.coherent:
            return None
        # 1. The frames in which an occlusion around the anchor could matter.
        span = self._span(anchor, spec.duration)
        if span is None:
            return None
        # 2. The occluder's motion through them, and the vehicle as seen from it.
        rng = stream(seed, "place", anchor)
        motion = self._motion(spec, anchor, span, rng)
        boxes = self._relative(motion, span)
        # 3. Rectangles of growing length, of which one hides it for about the right time.
        rectangles = _rectangles(spec, boxes, anchor - span.start, rng)
        # Counted by boxes first, which is cheap; only the best one is judged by its exact shape.
        counts = [(abs(_hidden(each, boxes) - spec.duration), each) for each in rectangles]
        miss, best = min(counts, key=lambda pair: pair[0])
        if miss > 2 * _slack(spec):  # far from it even by its outline, so nothing exact is computed
            return None
        # 4. The exact truth with that one decides.
        occluder = Occluder(best, motion, Texture(spec.style, seed, anchor, (0, 0, 1, 1)))
        return self._judge(occluder, span, _near(best, boxes), spec)

    def _span(self, anchor: int, duration: int) -> range | None:
        """Return the frames around `anchor`, all with truth, that an occlusion could matter in."""
        # Without truth nobody knows what the occluder hides: the span ends at the first gap.
        # Up to the occlusion's half, its ends, and what is played before or after it.
        reach = duration // 2 + _LONGEST_TOUCH + max(LEAD, TAIL)
        first = last = anchor
        while first > max(0, anchor - reach) and self._truth[first - 1] is not None:
            first -= 1
        end = min(len(self._truth) - 1, anchor + reach)
        while last < end and self._truth[last + 1] is not None:
            last += 1
        enough = anchor - first >= LEAST_LEAD and last - anchor >= LEAST_TAIL
        return range(first, last + 1) if enough and self._truth[anchor] is not None else None

    def _motion(
        self, spec: OcclusionSpec, anchor: int, span: range, rng: np.random.Generator
    ) -> Motion:
        standing = Motion(anchor)
        if self._background.coherent and not self._background.stands:
            carried = similarities(self._background.between(anchor, span))
            standing = Motion(anchor, (0.0, 0.0), span.start, carried)
        if spec.style != LORRY:
            return standing
        boxes = self._relative(standing, span)
        # Eleven frames, a third of a second: the difference of two boxes is noise of the truth.
        near = slice(max(0, anchor - span.start - 5), anchor - span.start + 6)
        # In the background's coordinates: a panning camera is no motion of the vehicle.
        velocity = np.mean(np.diff(_centres(boxes[near]), axis=0), axis=0)
        extent = boxes[anchor - span.start, 2] - boxes[anchor - span.start, 0]
        # A lorry drives along the road as the vehicle does, and passes it at a speed of its own.
        passing = rng.choice([-1.0, 1.0]) * extent / spec.crossing
        x, y = (velocity + np.array([passing, 0.0])).tolist()
        # Rounded, so that a case that is read from its file is the same to the last bit.
        return replace(standing, velocity=(round(x, 3), round(y, 3)))

    def _relative(self, motion: Motion, span: range) -> Floats:
        """Take the vehicle's boxes to the occluder's coordinates: left, top, right, bottom."""
        corners = motion.to_anchor(self._corners[span.start : span.stop], span.start)
        return np.concatenate([corners.min(axis=1), corners.max(axis=1)], axis=1)

    def _judge(
        self, occluder: Occluder, span: range, near: npt.NDArray[np.bool_], spec: OcclusionSpec
    ) -> Placed | None:
        """Choose the frames to play; None where the occlusion is not as specified.

        Frames in which the occluder is not near the vehicle have nothing hidden.
        """
        # 1. What it hides in each frame.
        shares = np.ones(len(span))
        for row in np.flatnonzero(near).tolist():
            shares[row] = self._share(occluder, span[row])
        hidden = np.flatnonzero(shares < TOTAL_BELOW)
        touched = np.flatnonzero(shares < 1.0)
        # 2. Hidden for the right time, in one run, and after enough frames in full view.
        is_total = spec.style != POLE
        if not len(touched) or not _is_right(hidden, spec) or touched[0] < LEAST_LEAD:
            return None
        # A post hides nothing wholly: its occlusion is the time that it touches the vehicle.
        core = hidden if is_total else touched
        if np.ptp(touched) + 1 - len(hidden) > _LONGEST_TOUCH and not is_total:
            return None
        # 3. The frames to play: some before the first touch, some after the last hidden one.
        first = max(span.start + int(touched[0]) - LEAD, span.start)
        last = min(span.start + int(core[-1]) + TAIL, span.stop - 1)
        # 4. Neither slow ends nor an occlusion of the sequence's own in between.
        if core[0] - touched[0] > _LONGEST_TOUCH or not self._in_view(first, last):
            return None
        if last - (span.start + int(core[-1])) < LEAST_TAIL:
            return None
        path = self._path(occluder.motion, span, int(core[0]), int(core[-1]))
        # While it is touched: the tracker has no clear view of its size then.
        begin = self._box(span[int(touched[0])])
        end = self._box(span[int(touched[-1])])
        course = TURNING if path == TURNING else course_of(begin, end)
        return Placed(occluder, first, last + 1 - first, len(hidden), path, course)

    def _share(self, occluder: Occluder, index: int) -> float:
        return occluder.visible_share(self._box(index), index, self._size)

    def _box(self, index: int) -> Box:
        """Return the true box of a frame of the span, all of which have truth."""
        truth = self._truth[index]
        assert truth is not None
        return truth.box

    def _in_view(self, first: int, last: int) -> bool:
        """Return whether the sequence itself shows the vehicle, in full where the case begins."""
        own = [truth.occlusion for truth in self._truth[first : last + 1] if truth is not None]
        # A vehicle that the sequence hides itself would make the occlusion longer than it says.
        return own[0] is Occlusion.NONE and Occlusion.TOTAL not in own

    def _path(self, motion: Motion, span: range, entry: int, leaving: int) -> str:
        """Compare the headings before row `entry` and after row `leaving` of the span."""
        # In the background's coordinates, as a lorry's own motion is none of the vehicle's.
        standing = replace(motion, velocity=(0.0, 0.0))
        before = span[max(0, entry - _HEADING_FRAMES) : entry + 1]
        after = span[leaving : leaving + _HEADING_FRAMES + 1]
        headings = []
        for frames in (before, after):
            boxes = self._relative(standing, frames)
            way = _centres(boxes)[-1] - _centres(boxes)[0]
            diagonal = float(np.hypot(*(boxes[0, 2:] - boxes[0, :2])))
            # A vehicle that stands has no heading, and does not turn.
            if np.hypot(*way) < max(_LEAST_WAY[0] * diagonal, _LEAST_WAY[1]):
                return "straight"
            headings.append(math.atan2(way[1], way[0]))
        # The shorter way round, within 180 degrees.
        turn = math.degrees(abs(math.remainder(headings[1] - headings[0], 2 * math.pi)))
        return TURNING if turn > _TURNING_DEGREES else "straight"


def course_of(first: Box, last: Box) -> str:
    """Tell by its true boxes whether a vehicle has come near, gone away, or driven across."""
    # Of areas, hence the square.
    grown = last.width * last.height / (first.width * first.height)
    if grown > _GROWN**2:
        return NEAR
    return AWAY if grown < 1 / _GROWN**2 else ACROSS


def _rectangles(
    spec: OcclusionSpec, boxes: Floats, anchor: int, rng: np.random.Generator
) -> Iterator[Box]:
    """Yield rectangles that hide the vehicle longer and longer around row `anchor`."""
    # Random margins: a tracker must not learn how far an occluder reaches beyond the vehicle.
    margins = rng.uniform(0.15, 0.9, 4)
    if spec.style == LORRY:
        margins = rng.uniform(0.05, 0.3, 4)
    share = rng.uniform(*_POLE_SHARES)
    # The more frames of the vehicle's way a rectangle covers, the longer it hides it.
    for length in range(1, max(spec.duration, 1) + 1):
        # Grown around the anchor, in the occluder's coordinates, where a vehicle that drives away
        # from its camera is hidden for longer the farther away it is.
        begin = max(0, anchor - (length - 1) // 2)
        inner = boxes[begin : begin + length]
        low = inner[:, :2].min(axis=0)
        high = inner[:, 2:].max(axis=0)
        axis = _axis(boxes, anchor) if spec.style != LORRY else 0
        # A post keeps a part of the vehicle in view at every moment.
        if spec.style == POLE:
            middle = (low[axis] + high[axis]) / 2
            extent = share * (high - low)[axis]
            low[axis] = middle - extent / 2
            high[axis] = middle + extent / 2
        # Beyond the vehicle on both sides of its way, so that it cannot pass by in view.
        across = 1 - axis
        side = high[across] - low[across]
        low[across] -= margins[0] * side
        high[across] += margins[1] * side
        left, top, width, height = (round(float(v), 2) for v in (*low, *(high - low)))
        yield Box(left, top, width, height)


def _axis(boxes: Floats, anchor: int) -> int:
    """Return the axis that the vehicle passes a standing occluder along: 0 for x, 1 for y."""
    near = _centres(boxes[max(0, anchor - 10) : anchor + 11])
    # In sizes of the vehicle: a long one that turns in place goes no way along its own axis.
    way = np.abs(near[-1] - near[0]) / (boxes[anchor, 2:] - boxes[anchor, :2])
    return int(way[1] > way[0])


def _near(rectangle: Box, boxes: Floats) -> npt.NDArray[np.bool_]:
    """Tell which boxes the rectangle may touch, with two pixels to spare for rounding."""
    low = np.array([rectangle.x, rectangle.y])
    high = low + np.array([rectangle.width, rectangle.height])
    return np.asarray(((boxes[:, :2] <= high + 2.0) & (low - 2.0 <= boxes[:, 2:])).all(axis=1))


def _hidden(rectangle: Box, boxes: Floats) -> int:
    """Count the boxes, as the occluder sees them, that are behind the rectangle."""
    low = np.maximum(boxes[:, :2], (rectangle.x, rectangle.y))
    high = np.minimum(boxes[:, 2:], (rectangle.x + rectangle.width, rectangle.y + rectangle.height))
    shared = np.prod(np.maximum(high - low, 0.0), axis=1)
    areas = np.prod(boxes[:, 2:] - boxes[:, :2], axis=1)
    return int(np.count_nonzero(shared > (1 - TOTAL_BELOW) * areas))


def _is_right(hidden: npt.NDArray[np.intp], spec: OcclusionSpec) -> bool:
    if spec.style == POLE:
        return len(hidden) == 0
    is_one_run = len(hidden) > 0 and np.ptp(hidden) + 1 == len(hidden)
    return bool(is_one_run) and abs(len(hidden) - spec.duration) <= _slack(spec)


def _slack(spec: OcclusionSpec) -> float:
    # A frame at least: lengths are whole numbers.
    return max(1.0, _TOLERANCE * spec.duration)


def _centres(boxes: Floats) -> Floats:
    return np.asarray((boxes[:, :2] + boxes[:, 2:]) / 2)
