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

"""Boxes drawn over images: the truth as corners in white, estimates in colour with a number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.evaluation.plots import STYLES

_BLACK, _WHITE, _YELLOW = (0, 0, 0), (255, 255, 255), (240, 228, 66)
_TAG = 13
"""Side of a tag in px."""
_DARK_STYLES = 3
"""Number of the first colours that are dark, and have white tags."""
_FONT = cv2.FONT_HERSHEY_SIMPLEX


@dataclass(frozen=True, slots=True)
class Mark:
    """An estimate to draw: its box, and the number of its style.

    Its tag is that number and 1; without a style it stands alone, yellow and without a tag.
    """

    box: Box
    slot: int | None


@dataclass(frozen=True, slots=True)
class Crop:
    """A crop of an image, and the scale it is shown at.

    Attributes
    ----------
    left, top, width, height : int
        The part in px.
    scale : float
        Pixels shown for each of the image.
    """

    left: int
    top: int
    width: int
    height: int
    scale: float

    @classmethod
    def whole(cls, frame: Frame, shown_width: int) -> Crop:
        """Show all of an image, `shown_width` px wide."""
        width, height = frame_size(frame)
        return cls(0, 0, width, height, shown_width / width)

    @classmethod
    def around(cls, boxes: Sequence[Box], size: tuple[int, int], shown_width: int) -> Crop:
        """Show the part of 4 x 3 that holds `boxes` with room about them.

        Parameters
        ----------
        boxes : sequence of Box
            At least one box; parts outside the image are ignored.
        size : (int, int)
            Width and height of the image in px.
        shown_width : int
            Width of what is shown, in px.
        """
        margin = max(boxes[0].diagonal, 12.0)
        left = min(box.x for box in boxes) - margin
        right = max(box.x + box.width for box in boxes) + margin
        top = min(box.y for box in boxes) - margin
        bottom = max(box.y + box.height for box in boxes) + margin
        width = max(right - left, (bottom - top) * 4 / 3, 6 * margin)
        width = min(width, size[0], size[1] * 4 / 3)
        height = width * 3 / 4
        x = min(max((left + right - width) / 2, 0), size[0] - width)
        y = min(max((top + bottom - height) / 2, 0), size[1] - height)
        return cls(int(x), int(y), int(width), int(height), shown_width / int(width))


def draw_overlay(frame: Frame, view: Crop, truth: Box | None, marks: Sequence[Mark]) -> Frame:
    """Return the part of `frame` that `view` shows, as an image of its own, with the boxes."""
    part = frame[view.top : view.top + view.height, view.left : view.left + view.width]
    shown = (round(view.width * view.scale), round(view.height * view.scale))
    way = cv2.INTER_CUBIC if view.scale > 1 else cv2.INTER_AREA
    resized = cv2.resize(np.ascontiguousarray(part), shown, interpolation=way)
    image: Frame = np.ascontiguousarray(resized, dtype=np.uint8)
    for mark in reversed(marks):
        _draw_mark(image, _shown(mark.box, view), mark.slot)
    if truth is not None:
        _draw_corners(image, _shown(truth, view))
    return image


def colour_of(slot: int | None) -> tuple[int, int, int]:
    """Return the colour of a style as (red, green, blue)."""
    if slot is None:
        return _YELLOW
    value = STYLES[slot].colour
    return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)


def _shown(box: Box, view: Crop) -> tuple[int, int, int, int]:
    """Return left, top, right and bottom in the shown image."""
    left, top = (box.x - view.left) * view.scale, (box.y - view.top) * view.scale
    corners = left, top, left + box.width * view.scale, top + box.height * view.scale
    return tuple(int(np.clip(round(value), -5000, 5000)) for value in corners)  # type: ignore[return-value]


def _draw_mark(image: Frame, corners: tuple[int, int, int, int], slot: int | None) -> None:
    left, top, right, bottom = corners
    for colour, width in ((_BLACK, 4), (colour_of(slot), 2)):
        cv2.rectangle(image, (left, top), (right, bottom), colour, width, cv2.LINE_AA)
    if slot is None:
        return
    x = min(max(right, 0), image.shape[1] - _TAG)
    y = min(max(top + _TAG * (slot % 3), 0), image.shape[0] - _TAG)  # seldom over each other
    cv2.rectangle(image, (x, y), (x + _TAG, y + _TAG), colour_of(slot), cv2.FILLED)
    text = _WHITE if slot < _DARK_STYLES else _BLACK
    corner = (x + 3, y + _TAG - 3)
    cv2.putText(image, str(slot + 1), corner, _FONT, 0.42, text, 1, cv2.LINE_AA)


def _draw_corners(image: Frame, corners: tuple[int, int, int, int]) -> None:
    left, top, right, bottom = corners
    arm_x, arm_y = max((right - left) // 4, 3), max((bottom - top) // 4, 3)
    for colour, width in ((_BLACK, 4), (_WHITE, 2)):
        for x, inward_x in ((left, arm_x), (right, -arm_x)):
            for y, inward_y in ((top, arm_y), (bottom, -arm_y)):
                cv2.line(image, (x, y), (x + inward_x, y), colour, width, cv2.LINE_AA)
                cv2.line(image, (x, y), (x, y + inward_y), colour, width, cv2.LINE_AA)
