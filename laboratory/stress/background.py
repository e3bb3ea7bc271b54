# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Motion of the background through a sequence, for objects that stand on it.

This is a measurement of its own, not the trackers' `camera_motion`: a battery must not change with
the tracker that it tests.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import cv2
import numpy as np
import numpy.typing as npt

from laboratory.stress.footage import StressFootage, open_footage
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.evaluation.evaluation_folder import Source

Matrix = npt.NDArray[np.float64]
Grey = npt.NDArray[np.uint8]

_WIDTH = 320
"""Width in px that images are reduced to: flow is exact enough there, and takes 1 ms."""
_CORNERS = 150
"""Most corners: a fit that traffic disturbs needs many of the background."""
_LEAST_CORNERS = 12
"""Least corners: three for each of four unknowns."""
_CLEARANCE = 0.75
"""Corners closer to the target's centre than this share of its size are the target's."""
_RANSAC_PX = 1.0
"""Distance of reduced px to the model below which a corner agrees: flow is good to about 0.3."""
_STILL_PX = 0.2
"""Median flow of the reduced image below which a frame does not move: JPEG noise gives 0.05."""
_STILL_SHARE = 0.9
"""Share of frames that must not move for a camera that stands; gusts of wind are the rest."""
_AGREEING = 0.6
"""Least median share of corners that follow one similarity, for a background that is one plane.
Corners on other vehicles and at several depths do not."""
_LOOMING = 0.005
"""Median change of scale per frame from which the camera drives into the scene: what stands there
is soon passed. Two cameras in cars gave 0.008 and 0.013, five drones up to 0.004."""


@dataclass(frozen=True, eq=False)
class Background:
    """Motion of the background through a sequence.

    Attributes
    ----------
    stands : bool
        The camera does not move; all matrices are the identity.
    coherent : bool
        The matrices describe the background; always so where it stands.
    from_first : (N, 3, 3) array
        Similarity from the first frame to each frame, px.
    """

    stands: bool
    coherent: bool
    from_first: Matrix

    def between(self, anchor: int, frames: range) -> Matrix:
        """Return the similarities from frame `anchor` to `frames`, (len(frames), 3, 3)."""
        inverse = np.linalg.inv(self.from_first[anchor])
        return np.asarray(self.from_first[frames.start : frames.stop] @ inverse)


@functools.lru_cache(maxsize=64)
def background_of(source: Source) -> Background:
    """Measure the motion of a sequence's background."""
    footage = open_footage(source)
    steps = []
    flows = []
    shares = []
    for step, flow, share in _steps(footage):
        steps.append(step)
        flows.append(flow)
        shares.append(share)
    count = len(steps) + 1
    identity = np.broadcast_to(np.eye(3), (count, 3, 3))
    # Judged over the whole recording: one gust, or a lorry that fills the image, is no drive.
    if not steps or np.mean(np.array(flows) < _STILL_PX) >= _STILL_SHARE:
        return Background(True, True, identity)
    # Logarithms, so that driving in and driving out are alike.
    scales = np.abs(np.log([np.hypot(step[0, 0], step[1, 0]) for step in steps]))
    if np.median(shares) < _AGREEING or np.median(scales) > _LOOMING:
        return Background(False, False, identity)
    matrices = [np.eye(3)]
    for step in steps:
        # Chained, and not measured against the first frame: what that one showed is soon out of
        # view. The drift of a chain carries the occluder with it, and shifts no truth.
        matrices.append(step @ matrices[-1])
    return Background(False, True, np.array(matrices))


def _steps(footage: StressFootage) -> Iterator[tuple[Matrix, float, float]]:
    """Yield the similarity, the median flow (reduced px) and the agreeing share of each frame."""
    # Of consecutive frames: over a longer time the corners of a moving camera are out of view.
    last, zoom = _reduced(footage.frame(0))
    for index in range(1, len(footage.truth)):
        present, _ = _reduced(footage.frame(index))
        truth = footage.truth[index - 1]
        yield _step(last, present, zoom, truth.box if truth else None)
        last = present


def _step(
    last: Grey, present: Grey, zoom: float, target: Box | None
) -> tuple[Matrix, float, float]:
    before, after = _flow(last, present, _without_target(last, zoom, target))
    # A share of 0, as of no agreement at all: many such frames make the background incoherent.
    if len(before) < _LEAST_CORNERS:
        return np.eye(3), 0.0, 0.0
    median = float(np.median(np.hypot(*(after - before).T)))
    # Four unknowns: occluders turn and grow with the background, and are never sheared.
    fit = cv2.estimateAffinePartial2D(
        before, after, method=cv2.RANSAC, ransacReprojThreshold=_RANSAC_PX
    )
    matrix, agreeing = cast(tuple[Matrix | None, Grey], fit)
    if matrix is None:
        return np.eye(3), median, 0.0
    step = np.vstack([matrix, [0.0, 0.0, 1.0]])
    # Only the shift has a unit of pixels; turn and scale are those of the whole image.
    step[:2, 2] /= zoom
    return step, median, float(np.mean(agreeing))


def _flow(last: Grey, present: Grey, mask: Grey) -> tuple[Matrix, Matrix]:
    # Weak corners, too (1 % of the strongest), as roads have few; 7 px apart, so that they spread
    # over the image and not over the best textured vehicle in it.
    strongest = cv2.goodFeaturesToTrack(last, _CORNERS, 0.01, 7, mask=mask)
    corners = cast(npt.NDArray[np.float32] | None, strongest)
    if corners is None:
        return np.empty((0, 2)), np.empty((0, 2))
    moved, status, _ = cv2.calcOpticalFlowPyrLK(last, present, corners, corners.copy())
    kept = status.ravel() > 0
    before = corners[kept].reshape(-1, 2)
    after = moved[kept].reshape(-1, 2)
    return np.asarray(before, np.float64), np.asarray(after, np.float64)


def _without_target(grey: Grey, zoom: float, target: Box | None) -> Grey:
    mask = np.full_like(grey, 255)
    if target is not None:
        x, y = target.centre
        width = target.width
        height = target.height
        left, right = (round(zoom * (x + side * _CLEARANCE * width)) for side in (-1, 1))
        top, bottom = (round(zoom * (y + side * _CLEARANCE * height)) for side in (-1, 1))
        mask[max(top, 0) : max(bottom, 0), max(left, 0) : max(right, 0)] = 0
    return mask


def _reduced(frame: Frame) -> tuple[Grey, float]:
    width, height = frame_size(frame)
    # Small images are not enlarged: that adds no detail.
    zoom = min(1.0, _WIDTH / width)
    size = round(width * zoom), round(height * zoom)
    grey = cv2.cvtColor(frame, cv2.COLOR_RGB2GRAY)
    # Area means, as fine texture that is merely skipped would flow at random.
    return np.asarray(cv2.resize(grey, size, interpolation=cv2.INTER_AREA), np.uint8), zoom
