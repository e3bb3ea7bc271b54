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

"""Words written into images."""

from __future__ import annotations

import cv2

from vehicle_pf_tracker.core.frame import Frame, frame_size


def line_width(picture: Frame) -> int:
    """Return the width of lines that suits the picture's size, px."""
    return line_width_of(frame_size(picture))


def line_width_of(size: tuple[int, int]) -> int:
    """Return the width of lines that suits pictures of a width and height, px."""
    return max(1, round(min(size) / 300))


def write_words(
    picture: Frame,
    words: str,
    corner: tuple[int, int],
    colour: tuple[int, int, int],
    width: int = 1,
) -> None:
    """Write words with a dark edge.

    Parameters
    ----------
    picture : Frame
        Written to.
    words : str
        One line.
    corner : (int, int)
        Lower left corner of the words, px.
    colour : (int, int, int)
        Red, green, blue.
    width : int
        Width of the strokes, px; the letters grow with it.
    """
    font, scale, smooth = cv2.FONT_HERSHEY_SIMPLEX, 0.45 * width, cv2.LINE_AA
    x, y = corner
    # Not by a thicker stroke: in OpenCV 5 that makes the letters wider.
    for across, down in ((-width, 0), (width, 0), (0, -width), (0, width)):
        cv2.putText(picture, words, (x + across, y + down), font, scale, (0, 0, 0), width, smooth)
    cv2.putText(picture, words, corner, font, scale, colour, width, smooth)
