# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boxes that a detector found, their overlaps, and what experience says about them.

The probability that a detection is a vehicle is learnt from the outcomes of earlier ones. Two
things tell: the score, of which only the order counts, so that a detector whose scores are squared
or halved is the same one; and the place, because a tree in the wind is reported again and again. A
place only speaks against a detection: where many vehicles pass, parts of vehicles are detected as
well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeAlias

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import LARGEST_SHARE, intersections
from vehicle_pf_tracker.parameters.counting_plan import Region
from vehicle_pf_tracker.trackers.traffic.vehicle_state import SETTLED_AFTER

IntArray: TypeAlias = npt.NDArray[np.intp]
Place: TypeAlias = tuple[int, int]
"""Row and column of a grid over the image."""

MOST_DETECTIONS = 300
"""Detections of a frame that are looked at, the highest scores first. No camera shows as many
vehicles; a detector that reports more is out of order, and association would take seconds."""

INSIDE = 0.7
"""Share of a box inside another one above which it is a part of it: a bonnet, a second box."""
HALF, LITTLE = 0.5, 0.1
"""Shares of a box, or of what is counted, above which it is most of it, and below which none."""
LEAST_PART = 0.15
"""Smallest share of a vehicle that is seen as a part of it. At a tenth IDF1 of YOLOX behind the
bridge falls by six (association); with other shares for blobs, HOTA by motion there by seven."""
NOTHING = np.empty((0, 4))
"""No boxes."""


@dataclass(frozen=True, slots=True)
class Detections:
    """Detections of one frame.

    Attributes
    ----------
    boxes : array, shape (N, 4)
        Left, top, width and height in px.
    scores : array, shape (N,)
        Scores of the detector, of any scale: only their order counts.
    labels : tuple of str
        Class of each, or "".
    are_shapes : bool
        True where they are shapes of what has changed, and may be of pieces of vehicles, which
        drive as well.
    """

    boxes: Array
    scores: Array
    labels: tuple[str, ...]
    are_shapes: bool = False

    @classmethod
    def make(
        cls, boxes: object, scores: object = None, labels: Sequence[str] | None = None
    ) -> Detections:
        """Make them from anything that numpy takes; without scores all count alike."""
        array = np.asarray(boxes, dtype=np.float64).reshape(-1, 4)
        count = len(array)
        values = np.ones(count) if scores is None else np.asarray(scores, dtype=np.float64).ravel()
        if len(values) != count or (labels is not None and len(labels) != count):
            raise ValueError("as many scores and labels as boxes are needed")
        return cls(array, values, tuple(labels) if labels is not None else ("",) * count)

    @classmethod
    def none(cls) -> Detections:
        """Make the result of a detector that saw nothing."""
        return cls.make(np.empty((0, 4)))

    def __len__(self) -> int:
        return len(self.boxes)

    def take(self, indices: npt.NDArray[np.intp]) -> Detections:
        """Those at `indices`, in this order."""
        labels = tuple(self.labels[i] for i in indices.tolist())
        return replace(self, boxes=self.boxes[indices], scores=self.scores[indices], labels=labels)

    def within(self, regions: Sequence[Region]) -> Detections:
        """Those whose centre lies in one of the inner regions, if any, and in no outer one."""
        centres = (self.boxes[:, :2] + self.boxes[:, 2:] / 2).astype(np.float32)
        kept, inner = np.ones(len(self), bool), np.zeros(len(self), bool)
        for region in regions:
            outline = np.asarray(region.corners, np.float32)
            signs = [cv2.pointPolygonTest(outline, one, False) for one in centres.tolist()]
            inside = np.array(signs, np.float64) >= 0  # of no detection too
            if region.is_inside:
                inner |= inside
            else:
                kept &= ~inside
        if any(region.is_inside for region in regions):
            kept &= inner
        return self.take(np.flatnonzero(kept))

    def usable(self, width: int, height: int) -> Detections:
        """Those a tracker can use in an image of `width` x `height` px.

        Boxes that are not finite, have no area, are far larger than the image or wholly outside it
        are left out, and so are scores that are not finite, exact duplicates, and whatever is
        beyond the `MOST_DETECTIONS` highest scores.
        """
        boxes, scores = self.boxes, self.scores
        with np.errstate(invalid="ignore", over="ignore"):
            right, bottom = boxes[:, 0] + boxes[:, 2], boxes[:, 1] + boxes[:, 3]
            good = np.isfinite(boxes).all(axis=1) & np.isfinite(scores)
            good &= (boxes[:, 2] >= 1) & (boxes[:, 3] >= 1)
            good &= boxes[:, 2] <= LARGEST_SHARE * width
            good &= boxes[:, 3] <= LARGEST_SHARE * height
            good &= (boxes[:, 0] < width) & (boxes[:, 1] < height) & (right > 0) & (bottom > 0)
        kept = np.flatnonzero(good)
        # Stable: equal scores stay in the detector's order, so that runs repeat.
        kept = kept[np.argsort(-scores[kept], kind="stable")]
        single: dict[tuple[float, ...], int] = {}
        for index in kept.tolist():
            single.setdefault(tuple(boxes[index].tolist()), index)
            if len(single) == MOST_DETECTIONS:
                break
        return self.take(np.array(sorted(single.values()), np.intp))


def areas(edges: Array) -> Array:
    """Measure the areas in px² of boxes (..., 4), at least one."""
    sides = np.maximum(edges[..., 2:] - edges[..., :2], 0.0)
    return np.asarray(np.maximum(sides[..., 0] * sides[..., 1], 1.0))


def overlaps(edges: Array, others: Array) -> Array:
    """Measure the intersection over union of boxes (..., 4) with others (..., 4)."""
    common = intersections(edges, others)
    return np.asarray(common / (areas(edges) + areas(others) - common))


def inside_image(edges: Array, size: tuple[int, int]) -> Array:
    """Measure the shares of boxes (..., 4) that lie in an image of this width and height."""
    return np.asarray(intersections(edges, np.array([0.0, 0.0, *size])) / areas(edges))


def clipped(edges: Array, size: tuple[int, int]) -> Array:
    """Cut boxes (N, 4) at the borders of the image, at least one px wide and high."""
    limits = np.array([*size, *size], dtype=np.float64)
    low = np.clip(edges[:, :2], 0.0, limits[:2] - 1)
    return np.hstack([low, np.maximum(np.clip(edges[:, 2:], 0.0, limits[2:]), low + 1)])


_MEMORY = 2000
"""Detections that are remembered, some minutes of a few vehicles; and images after which what is
known of places is halved: light and wind change in a minute."""
_NEIGHBOURS = 40
"""Detections of about the same score, by rank, that a probability is taken from."""
_PRIOR = 2.0
"""Weight of the prior on each side, in detections."""
GRID = 16
"""Places along each side of the image."""
_FALSE_ALARMS = 1.0
"""False alarms per image that are expected before any is seen; this, and the mean of all places for
the number of one, is worth `SETTLED_AFTER` images."""
CERTAIN = 7.0
"""Log odds, one in a thousand, beyond which nothing is surer: however long a vehicle was seen, some
missed detections in plain sight speak against it."""


class Sample(NamedTuple):
    """Score and place of a detection whose outcome is to be learnt."""

    score: float
    place: Place


def places_of(edges: Array, size: tuple[int, int]) -> list[Place]:
    """Rows and columns, in a grid over the image, of boxes (N, 4) in px."""
    centres = (edges[:, :2] + edges[:, 2:]) / 2
    cells = np.clip(centres / size * GRID, 0, GRID - 1).astype(int)
    return [(row, column) for column, row in cells.tolist()]


class DetectionEvidence:
    """Outcomes of detections by score, and false alarms by place."""

    def __init__(self) -> None:
        self._outcomes = np.zeros((_MEMORY, 2))  # score, and 1 of a vehicle's
        self._learnt = self._fresh = 0
        self._sorted = np.empty(0)
        self._sums = np.zeros(1)
        self._images = 0.0
        self._false = np.zeros((GRID, GRID))
        self._places = np.full((2, GRID, GRID), _PRIOR)

    def look(self) -> None:
        """Note that the detector has looked at another image."""
        self._images += 1
        if self._images > _MEMORY:
            self._images /= 2
            self._false /= 2
            self._places = (self._places + _PRIOR) / 2
        if self._fresh >= min(_NEIGHBOURS // 2, self._learnt) > 0:
            scores, genuine = self._outcomes[: self._learnt].T
            order = np.argsort(scores, kind="stable")
            self._sorted = scores[order]
            self._sums = np.concatenate([[0.0], np.cumsum(genuine[order])])
            self._fresh = 0

    def samples(self, edges: Array, scores: Array, size: tuple[int, int]) -> list[Sample]:
        """Describe detections by their edges (N, 4) in px and their scores."""
        places = places_of(edges, size)
        return [Sample(*one) for one in zip(scores.tolist(), places, strict=True)]

    @property
    def cluttered(self) -> int:
        """Number of places, of a grid, that had a false alarm lately."""
        return int(np.count_nonzero(self._false >= 0.5))

    def learn(self, sample: Sample, genuine: bool, *, alone: bool = True) -> None:
        """Add the outcome of a detection; one beside a vehicle is no false alarm of its place."""
        self._outcomes[self._learnt % _MEMORY] = sample.score, genuine
        self._learnt += 1
        self._fresh += 1
        row, column = sample.place
        self._false[row, column] += alone and not genuine
        self._places[int(genuine), row, column] += 1

    def log_odds(self, samples: list[Sample]) -> Array:
        """Logarithm of the odds that detections are vehicles, (N,); 0 where nothing is known.

        A place only speaks against a detection: where many vehicles pass, parts of vehicles are
        detected as well.
        """
        scores, rows, columns = _columns(samples)
        totals = self._places.sum(axis=(1, 2))
        here = self._places[:, rows, columns]
        by_place = np.log(here[1] / here[0]) - np.log(totals[1] / totals[0])
        both = self._by_score(scores) + np.minimum(by_place, 0.0)
        return np.asarray(np.clip(both, -CERTAIN, CERTAIN))

    def gains(self, scores: Array) -> Array:
        """Logarithm of how much more often vehicles have scores (N,) than false alarms have."""
        genuine, total = self._sums[-1], len(self._sorted)
        usual = np.log((genuine + _PRIOR) / (total - genuine + _PRIOR))
        return np.asarray(self._by_score(scores) - usual)

    def ranks(self, scores: Array) -> Array:
        """Share of the vehicles' detections with lower scores, (N,); 0 before enough are known."""
        below = self._sums[np.searchsorted(self._sorted, scores)]
        return np.asarray(below / max(self._sums[-1], _NEIGHBOURS))

    def clutter(self, samples: list[Sample]) -> Array:
        """Logarithm of the false alarms per image, (N,), in a place as large as the image.

        The number in one place is that of a Poisson process, its prior the mean of all places.
        """
        _, rows, columns = _columns(samples)
        images = self._images + SETTLED_AFTER
        usual = (self._false.sum() + _FALSE_ALARMS * SETTLED_AFTER) / images
        seen = self._false[rows, columns] * GRID**2 + SETTLED_AFTER * usual
        return np.asarray(np.log(seen / images))

    def _by_score(self, scores: Array) -> Array:
        left = np.searchsorted(self._sorted, scores, "left")
        middle = (left + np.searchsorted(self._sorted, scores, "right")) // 2
        low = np.maximum(middle - _NEIGHBOURS // 2, 0)
        high = np.minimum(middle + _NEIGHBOURS // 2, len(self._sorted))
        genuine = self._sums[high] - self._sums[low]
        return np.asarray(np.log((genuine + _PRIOR) / (high - low - genuine + _PRIOR)))


def _columns(samples: list[Sample]) -> tuple[Array, IntArray, IntArray]:
    """Scores, rows and columns (N,) of samples."""
    places = np.array([one.place for one in samples], dtype=np.intp).reshape(-1, 2)
    return np.array([one.score for one in samples]), places[:, 0], places[:, 1]


@dataclass(frozen=True, slots=True)
class TrafficNumbers:
    """Thresholds of the detection of motion.

    Attributes
    ----------
    colour_threshold : float
        Least sum of the differences of the three channels of a pixel that has changed.
    patience : float
        Images for which what has changed is not learnt as background: four seconds, in which a slow
        lorry passes.
    shadow : float
        Least brightness of a shadow, of the background's.
    apart : float
        Advantage in shape above which a blob is taken for several vehicles.
    """

    colour_threshold: float = 32.0
    patience: float = 100.0
    shadow: float = 0.6
    apart: float = 1.0


SHIPPED = TrafficNumbers()
"""Numbers in use."""
