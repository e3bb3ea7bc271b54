# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boxes that a detector reports in one image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import LARGEST_SHARE
from vehicle_pf_tracker.parameters.counting_plan import Region

MOST_DETECTIONS = 300
"""Detections of a frame that are looked at, the highest scores first. No camera shows as many
vehicles; a detector that reports more is out of order, and association would take seconds."""

NO_SCORE = 1.0
"""Score of a box that has none, as files of MOTChallenge have it."""


@dataclass(frozen=True, slots=True)
class Detections:
    """Detections of one frame.

    Attributes
    ----------
    boxes : array, shape (N, 4)
        Left, top, width and height in px.
    scores : array, shape (N,)
        Scores of the detector: between 0 and 1 the probability of a vehicle, as it says; of
        another scale, or 1, only their order counts.
    labels : tuple of str
        Class of each, or "".
    are_shapes : bool
        True where they are shapes of what has changed, and may be of pieces of vehicles, which
        drive as well.
    ambiguous : int
        Number of blobs of which it is not sure how many vehicles they hold: of several vehicles
        that are followed, or divided by their shape alone. 0 of detectors that report vehicles.
    joined : array, shape (J, 5), or None
        Boxes of blobs that are as large as several vehicles, and an estimate of how many of them no
        vehicle that is followed stands for. None while it is not known how large vehicles are, and
        of detectors that report vehicles.
    """

    boxes: Array
    scores: Array
    labels: tuple[str, ...]
    are_shapes: bool = False
    ambiguous: int = 0
    joined: Array | None = None

    @classmethod
    def make(
        cls, boxes: object, scores: object = None, labels: Sequence[str] | None = None
    ) -> Detections:
        """Make them from anything that numpy takes; without scores all count alike."""
        array = np.asarray(boxes, dtype=np.float64).reshape(-1, 4)
        count = len(array)
        values = np.full(count, NO_SCORE)
        if scores is not None:
            values = np.asarray(scores, dtype=np.float64).ravel()
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
        """Select those at `indices`, in this order."""
        labels = tuple(self.labels[i] for i in indices.tolist())
        return replace(self, boxes=self.boxes[indices], scores=self.scores[indices], labels=labels)

    def within(self, regions: Sequence[Region]) -> Detections:
        """Select those whose centre is in one of the inner regions, if any, and in no outer one."""
        kept = self.take(np.flatnonzero(_are_within(self.boxes, regions)))
        if self.joined is None:
            return kept
        return replace(kept, joined=self.joined[_are_within(self.joined[:, :4], regions)])

    def usable(self, width: int, height: int) -> Detections:
        """Select those that a tracker can use in an image of `width` x `height` px.

        Boxes that are not finite, have no area, are far larger than the image or wholly outside it
        are left out, and so are scores that are not finite, exact duplicates, and whatever is
        beyond the `MOST_DETECTIONS` highest scores.
        """
        boxes = self.boxes
        scores = self.scores
        with np.errstate(invalid="ignore", over="ignore"):
            right = boxes[:, 0] + boxes[:, 2]
            bottom = boxes[:, 1] + boxes[:, 3]
            good = np.isfinite(boxes).all(axis=1) & np.isfinite(scores)
            good &= (boxes[:, 2] >= 1) & (boxes[:, 3] >= 1)
            good &= boxes[:, 2] <= LARGEST_SHARE * width
            good &= boxes[:, 3] <= LARGEST_SHARE * height
            # Touching the image is enough: a vehicle that comes in is partly outside.
            good &= (boxes[:, 0] < width) & (boxes[:, 1] < height) & (right > 0) & (bottom > 0)
        singles = list(map(tuple, boxes.tolist()))
        if good.all() and len(set(singles)) == len(singles) <= MOST_DETECTIONS:
            return self
        kept = np.flatnonzero(good)
        # Stable: equal scores stay in the detector's order, so that runs repeat.
        kept = kept[np.argsort(-scores[kept], kind="stable")]
        # Of exact duplicates the best one stays; stop as soon as there are enough.
        single: dict[tuple[float, ...], int] = {}
        for index in kept.tolist():
            single.setdefault(singles[index], index)
            if len(single) == MOST_DETECTIONS:
                break
        # In the order of the detector again.
        return self.take(np.array(sorted(single.values()), np.intp))


def _are_within(boxes: Array, regions: Sequence[Region]) -> npt.NDArray[np.bool_]:
    """Find which boxes have their centre in an inner region, if any, and in no outer one."""
    # Centres decide, so that a box on the rim is in or out as a whole.
    centres = (boxes[:, :2] + boxes[:, 2:] / 2).astype(np.float32)
    kept = np.ones(len(boxes), bool)
    inner = np.zeros(len(boxes), bool)
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
    return kept
