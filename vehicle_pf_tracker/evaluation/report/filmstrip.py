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

"""Stills of a recording: around its occlusions, and where each system was worst.

The truth is drawn with white dashes, an estimate as a box in colour with a number.
"""

from __future__ import annotations

import base64
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.occlusions import SETTLING_FRAMES
from vehicle_pf_tracker.evaluation.plots import STYLES, stretches
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredRun
from vehicle_pf_tracker.offline.drawing import draw_box, write_words
from vehicle_pf_tracker.recordings.source import open_source

_BLACK, _WHITE, _YELLOW = (0, 0, 0), (255, 255, 255), (240, 228, 66)


class Mark(NamedTuple):
    """An estimate to draw: its box, and the number of its style.

    Its tag is that number and 1; without a style it stands alone, yellow and without a tag.
    """

    box: Box
    slot: int | None


class Crop(NamedTuple):
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
    boxes = [(mark.box, colour_of(mark.slot), False) for mark in reversed(marks)]
    boxes += [(truth, _WHITE, True)] if truth else []
    for box, colour, dashed in boxes:
        scaled = _shown(box, view)
        draw_box(image, scaled, _BLACK, 4, dashed=dashed)
        draw_box(image, scaled, colour, 2, dashed=dashed)
    for box, slot in marks:
        if slot is not None:
            scaled = _shown(box, view)
            x = int(np.clip(scaled.x + scaled.width, 0, shown[0] - _LETTER))
            y = int(np.clip(scaled.y + _LETTER * (1 + slot % 3), _LETTER, shown[1]))
            write_words(image, str(slot + 1), (x, y), colour_of(slot))
    return image


def colour_of(slot: int | None) -> tuple[int, int, int]:
    """Return the colour of a style as (red, green, blue)."""
    if slot is None:
        return _YELLOW
    value = STYLES[slot].colour
    return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)


def _shown(box: Box, view: Crop) -> Box:
    """Return a box in the px of the shown image."""
    x, y = (box.x - view.left) * view.scale, (box.y - view.top) * view.scale
    return Box(x, y, box.width * view.scale, box.height * view.scale)


_LETTER = 13
"""Height of a row of letters, px: the numbers of different systems are seldom over each other."""
MOST_OCCLUSIONS = 4
"""Largest number of occlusions shown for a recording, the longest ones: a page stays readable."""
WIDTH = 280
"""Width of a still in px."""
_QUALITY = 78


class Shot(NamedTuple):
    """A still to take: the number of its frame, what it says, and what is drawn."""

    frame: int
    caption: str
    truth: Box
    marks: tuple[Mark, ...]


class Still(NamedTuple):
    """A still that was taken, as the text of a ``data:`` address."""

    caption: str
    alt: str
    data: str


def plan_strips(
    truths: Mapping[int, Truth], runs: Mapping[str, ScoredRun], slots: Mapping[str, int]
) -> dict[str, Sequence[Shot]]:
    """Choose the stills of a recording, by the titles of the strips they stand in.

    Parameters
    ----------
    truths : mapping of int to Truth
        Truths by the number of the frame.
    runs : mapping of str to ScoredRun
        One run for each system, by label.
    slots : mapping of str to int
        Number of the style of those systems that are shown together.
    """
    together = {label: run for label, run in runs.items() if label in slots}
    strips: dict[str, Sequence[Shot]] = {
        _title(truths, stretch): list(_around(truths, stretch, together, slots))
        for stretch in longest_occlusions(truths)
    }
    worst = [_worst(truths, label, run, slots) for label, run in runs.items()]
    title = "Where each system was worst while the vehicle could be seen"
    return {**strips, title: [shot for shot in worst if shot is not None]}


def longest_occlusions(truths: Mapping[int, Truth]) -> list[tuple[int, int]]:
    """Return the first and last frames of the longest occlusions, partial ones too, in order."""
    occluded = stretches(truths, {Occlusion.PARTIAL, Occlusion.TOTAL})
    longest = sorted(occluded, key=lambda stretch: stretch[0] - stretch[1])[:MOST_OCCLUSIONS]
    return sorted(longest)


def take_stills(entry: Source, shots: Iterable[Shot]) -> dict[Shot, Still]:
    """Read the frames of all shots from the recording in one pass, and draw on them.

    Raises
    ------
    InputError
        If the recording is gone, or its images are not those of the evaluation.
    """
    waiting: dict[int, list[Shot]] = {}
    for shot in shots:
        waiting.setdefault(shot.frame, []).append(shot)
    stills: dict[Shot, Still] = {}
    recording = open_source(entry.path, topic=entry.topic or None)
    for number, stamped in enumerate(recording.frames(), start=1):
        if not waiting:
            break
        if stamped.frame is None or number not in waiting:
            continue
        if frame_size(stamped.frame) != (entry.width, entry.height):
            raise InputError(f"the recording {entry.path} has other images than were evaluated")
        stills |= {shot: _still(stamped.frame, shot) for shot in waiting.pop(number)}
    return stills


def _title(truths: Mapping[int, Truth], stretch: tuple[int, int]) -> str:
    first, last = stretch
    total = [n for n in range(first, last + 1) if _is_total(truths, n)]
    if not total:
        return f"Partial occlusion, frames {first} to {last}"
    return f"Occlusion, frames {first} to {last} (total from {total[0]} to {total[-1]})"


def _is_total(truths: Mapping[int, Truth], number: int) -> bool:
    return number in truths and truths[number].occlusion is Occlusion.TOTAL


def _around(
    truths: Mapping[int, Truth],
    stretch: tuple[int, int],
    runs: Mapping[str, ScoredRun],
    slots: Mapping[str, int],
) -> Iterator[Shot]:
    first, last = stretch
    total = [n for n in range(first, last + 1) if _is_total(truths, n)] or [first, last]
    moments = {
        first - 1: "before",
        (total[0] + total[-1]) // 2: "within",
        last + 1: "behind it",
        last + SETTLING_FRAMES: f"{SETTLING_FRAMES} frames on",
    }
    for number, moment in moments.items():
        if number in truths:
            marks = (
                Mark(box, slots[label])
                for label, run in runs.items()
                if (box := run.boxes[number - 1]) is not None
            )
            yield Shot(number, f"{moment}, frame {number}", truths[number].box, tuple(marks))


def _worst(
    truths: Mapping[int, Truth], label: str, run: ScoredRun, slots: Mapping[str, int]
) -> Shot | None:
    visible = [number not in truths or not _is_total(truths, number)
               for number in range(1, len(run.errors) + 1)]  # fmt: skip
    errors = np.where(visible, np.nan_to_num(run.errors, nan=-1.0), -1.0)
    if not len(errors) or errors.max() < 0:
        return None
    index = int(errors.argmax())
    box, truth = run.boxes[index], truths.get(index + 1)
    if box is None or truth is None:
        return None
    caption = f"{label}: {errors[index]:.0f} px in frame {index + 1}, {run.rows[index].mode}"
    return Shot(index + 1, caption, truth.box, (Mark(box, slots.get(label)),))


def _still(frame: Frame, shot: Shot) -> Still:
    boxes = [shot.truth, *(mark.box for mark in shot.marks)]
    image = draw_overlay(
        frame, Crop.around(boxes, frame_size(frame), WIDTH), shot.truth, shot.marks
    )
    quality = [cv2.IMWRITE_JPEG_QUALITY, _QUALITY]
    _, coded = cv2.imencode(".jpg", cv2.cvtColor(image, cv2.COLOR_RGB2BGR), quality)
    data = base64.b64encode(coded.tobytes()).decode("ascii")
    alt = f"Frame {shot.frame} with the true box and {len(shot.marks)} estimated"
    return Still(shot.caption, alt, f"data:image/jpeg;base64,{data}")
