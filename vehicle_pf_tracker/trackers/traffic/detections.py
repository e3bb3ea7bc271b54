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

"""Boxes that a detector found in a frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle_pf_tracker.core.array import Array

MOST_DETECTIONS = 1000
"""Detections of a frame that are looked at, the highest scores first. No camera shows as many
vehicles; a detector that reports more is out of order, and association would take seconds."""

_LARGEST_SHARE = 4
"""Largest side of a detection, in sides of the image; a larger one is no vehicle."""


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
    """

    boxes: Array
    scores: Array
    labels: tuple[str, ...]

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

    def take(self, indices: Array) -> Detections:
        """Those at `indices`, in this order."""
        labels = tuple(self.labels[i] for i in indices.tolist())
        return Detections(self.boxes[indices], self.scores[indices], labels)

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
            good &= boxes[:, 2] <= _LARGEST_SHARE * width
            good &= boxes[:, 3] <= _LARGEST_SHARE * height
            good &= (boxes[:, 0] < width) & (boxes[:, 1] < height) & (right > 0) & (bottom > 0)
        kept = np.flatnonzero(good)
        # Stable: equal scores stay in the detector's order, so that runs repeat.
        kept = kept[np.argsort(-scores[kept], kind="stable")]
        _, first = np.unique(boxes[kept], axis=0, return_index=True)
        kept = kept[np.sort(first)][:MOST_DETECTIONS]
        return self.take(np.sort(kept))
