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

"""Stills of a recording around its longest occlusions.

The truth is drawn with white dashes, an estimate as a box in colour with a number.
"""

from __future__ import annotations

import base64
from collections.abc import Collection, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

import cv2
import numpy as np

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame, frame_size
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.plots import STYLES, stretches
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredRun
from vehicle_pf_tracker.evaluation.scores import SETTLING_FRAMES
from vehicle_pf_tracker.image.compressed_image import jpeg
from vehicle_pf_tracker.offline.drawing import draw_box, write_words
from vehicle_pf_tracker.recordings.source import open_source

_BLACK, _WHITE = (0, 0, 0), (255, 255, 255)
_LETTER = 13
"""Height of a row of letters, px: the numbers of different systems are seldom over each other."""
MOST_OCCLUSIONS = 4
"""Largest number of occlusions shown for a recording, the longest ones: a page stays readable."""
WIDTH, HEIGHT = 280, 210
"""Size of a still in px."""
_QUALITY = 78


class Still(NamedTuple):
    """A still, as the text of a ``data:`` address."""

    caption: str
    alt: str
    data: str


def film_strips(
    entry: Source,
    truths: Mapping[int, Truth],
    runs: Mapping[str, ScoredRun],
    slots: Mapping[str, int],
) -> dict[str, list[Still]]:
    """Take the stills of a recording, by the titles of the strips they stand in.

    Parameters
    ----------
    entry : Source
        The recording.
    truths : mapping of int to Truth
        Truths by the number of the frame.
    runs : mapping of str to ScoredRun
        One run for each system, by label.
    slots : mapping of str to int
        Number of the style of those systems that are shown.

    Raises
    ------
    InputError
        If the recording is gone, or its images are not those of the evaluation.
    """
    plans = {stretch: _moments(truths, stretch) for stretch in longest_occlusions(truths)}
    frames = take_frames(entry, {number for moments in plans.values() for number in moments})
    strips: dict[str, list[Still]] = {}
    for stretch, moments in plans.items():
        strip = strips[_title(truths, stretch)] = []
        for number in moments:
            boxes = {
                slots[label]: box
                for label, run in runs.items()
                if label in slots and (box := run.boxes[number - 1]) is not None
            }
            if number in frames:
                image = draw_still(frames[number], truths[number].box, boxes)
                alt = f"Frame {number} with the true box and {len(boxes)} estimated"
                strip.append(Still(f"{moments[number]}, frame {number}", alt, _address(image)))
    return strips


def longest_occlusions(truths: Mapping[int, Truth]) -> list[tuple[int, int]]:
    """Return the first and last frames of the longest occlusions, partial ones too, in order."""
    occluded = stretches(truths, {Occlusion.PARTIAL, Occlusion.TOTAL})
    longest = sorted(occluded, key=lambda stretch: stretch[0] - stretch[1])[:MOST_OCCLUSIONS]
    return sorted(longest)


def take_frames(entry: Source, numbers: Collection[int]) -> dict[int, Frame]:
    """Read the frames of these numbers, those that can be decoded.

    Raises
    ------
    InputError
        If the recording is gone, or its images are not those of the evaluation.
    """
    recording = open_source(entry.path, topic=entry.topic or None)
    frames: dict[int, Frame] = {}
    for number, found in enumerate(islice(recording.frames(), max(numbers, default=0)), start=1):
        if found.frame is None or number not in numbers:
            continue
        if frame_size(found.frame) != (entry.width, entry.height):
            raise InputError(f"the recording {entry.path} has other images than were evaluated")
        frames[number] = found.frame
    return frames


def draw_still(frame: Frame, truth: Box, boxes: Mapping[int, Box]) -> Frame:
    """Return the part of `frame` about the true box and the `boxes`, with all of them drawn.

    `boxes` are given by the number of their style.
    """
    left, top, width, height = view_of([truth, *boxes.values()], frame_size(frame))
    part = np.ascontiguousarray(frame[top : top + height, left : left + width])
    scale = WIDTH / width
    way = cv2.INTER_CUBIC if scale > 1 else cv2.INTER_AREA
    image: Frame = np.asarray(cv2.resize(part, (WIDTH, HEIGHT), interpolation=way), dtype=np.uint8)

    def shown(box: Box) -> Box:
        x, y = (box.x - left) * scale, (box.y - top) * scale
        return Box(x, y, box.width * scale, box.height * scale)

    marks = [(shown(box), colour_of(slot), False) for slot, box in reversed([*boxes.items()])]
    for box, colour, dashed in [*marks, (shown(truth), _WHITE, True)]:
        draw_box(image, box, _BLACK, 4, dashed=dashed)
        draw_box(image, box, colour, 2, dashed=dashed)
    for slot, box in boxes.items():
        corner = shown(box)
        x = int(np.clip(corner.x + corner.width, 0, WIDTH - _LETTER))
        y = int(np.clip(corner.y + _LETTER * (1 + slot % 3), _LETTER, HEIGHT))
        write_words(image, str(slot + 1), (x, y), colour_of(slot))
    return image


def view_of(boxes: Sequence[Box], size: tuple[int, int]) -> tuple[int, int, int, int]:
    """Return left, top, width and height (px) of the part of 4 x 3 that holds `boxes` with room.

    Boxes outside the image of this `size` do not draw it out of the image.
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
    return int(x), int(y), int(width), int(height)


def colour_of(slot: int) -> tuple[int, int, int]:
    """Return the colour of a style as (red, green, blue)."""
    red, green, blue = bytes.fromhex(STYLES[slot].colour[1:])
    return red, green, blue


def _total(truths: Mapping[int, Truth], stretch: tuple[int, int]) -> list[int]:
    """Return the totally occluded frames of a stretch."""
    frames = (n for n in range(stretch[0], stretch[1] + 1) if n in truths)
    return [n for n in frames if truths[n].occlusion is Occlusion.TOTAL]


def _title(truths: Mapping[int, Truth], stretch: tuple[int, int]) -> str:
    first, last = stretch
    total = _total(truths, stretch)
    if not total:
        return f"Partial occlusion, frames {first} to {last}"
    return f"Occlusion, frames {first} to {last} (total from {total[0]} to {total[-1]})"


def _moments(truths: Mapping[int, Truth], stretch: tuple[int, int]) -> dict[int, str]:
    """Name the frames with truth that show an occlusion, by their numbers."""
    first, last = stretch
    total = _total(truths, stretch) or [first, last]
    moments = {
        first - 1: "before",
        (total[0] + total[-1]) // 2: "within",
        last + 1: "behind it",
        last + SETTLING_FRAMES: f"{SETTLING_FRAMES} frames on",
    }
    return {number: moment for number, moment in moments.items() if number in truths}


def _address(image: Frame) -> str:
    return f"data:image/jpeg;base64,{base64.b64encode(jpeg(image, _QUALITY)).decode('ascii')}"
