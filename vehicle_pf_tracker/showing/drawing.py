# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drawing into images: words, boxes, paths, and labels that do not cover each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import TypeAlias

import cv2
import numpy as np

from vehicle_pf_tracker.core.array import Array
from vehicle_pf_tracker.core.box import Box, Position, intersections
from vehicle_pf_tracker.core.frame import Frame, frame_size

Colour = tuple[int, int, int]
"""Red, green, blue."""
_LETTER_SCALE = 0.45
"""Scale of OpenCV's letters by the width of their strokes: ten widths high."""
LETTER = 14
"""Height of a line of words, in widths of a stroke."""
_SMALL = 2.0
"""Width of a letter's strokes in small pictures, px, which is twice that of their lines: letters of
a line's width are illegible in a player's window."""
_PART = 200.0
"""Height of a picture in widths of a letter's stroke at least: a line of words is a fourteenth."""
_SHADE = 0.35
"""Brightness that is left behind words in a corner, of the picture's: cameras write their names and
clocks there, and letters upon letters are illegible. The picture can still be seen."""
_DASH = 6
"""Length of a dash and of a gap, in line widths: the smallest boxes still have a few."""
_LAST_PIXEL = 20_000
"""Pixels beyond which OpenCV's coordinates, of 16 bits and a fraction, overflow."""
NEUTRAL: Colour = (200, 200, 200)
"""Colour of what is not sure: grey, which claims nothing."""

Label: TypeAlias = tuple[Box, Colour, tuple[str, ...]]
"""Box in px, its colour, and choices of words for it: the first that find room are written."""
Labels: TypeAlias = list[Label]


def line_width(picture: Frame) -> int:
    """Return the width of lines that suits the picture's size, px."""
    return line_width_of(frame_size(picture))


def line_width_of(size: tuple[int, int]) -> int:
    """Return the width of lines that suits pictures of a width and height, px."""
    return max(1, round(min(size) / 300))


def letter_width(picture: Frame) -> float:
    """Return the width of a letter's strokes that suits the picture's size, px."""
    part = min(frame_size(picture)) / _PART
    return max(line_width(picture), min(_SMALL, max(part, 1.0)))


def write_words(
    picture: Frame,
    words: str,
    corner: tuple[int, int],
    colour: Colour,
    width: float = 1,
    *,
    shaded: bool = False,
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
    width : float
        Width of the strokes, px; the letters grow with it.
    shaded : bool
        Darken the picture behind the words.
    """
    font = cv2.FONT_HERSHEY_SIMPLEX
    smooth = cv2.LINE_AA
    scale = _LETTER_SCALE * width
    pen = max(1, round(width))
    x, y = corner
    if shaded:
        (across, above), below = cv2.getTextSize(words, font, scale, pen)
        edge = 2 * pen
        rows = slice(max(y - above - edge, 0), max(y + below, 0))
        columns = slice(max(x - edge, 0), max(x + across + edge, 0))
        picture[rows, columns] = picture[rows, columns] * _SHADE
    # Not by a thicker stroke: in OpenCV 5 that makes the letters wider.
    for across, down in ((-pen, 0), (pen, 0), (0, -pen), (0, pen)):
        cv2.putText(picture, words, (x + across, y + down), font, scale, (0, 0, 0), pen, smooth)
    cv2.putText(picture, words, corner, font, scale, colour, pen, smooth)


def write_line(picture: Frame, words: str, colour: Colour, row: int = 1) -> None:
    """Write words into a row at the upper left, counted from 1."""
    width = letter_width(picture)
    corner = round(5 * width), round(16 * width * row)
    write_words(picture, words, corner, colour, width, shaded=True)


def pixels_at(points: Array) -> list[tuple[int, int]]:
    """Return the pixel that each continuous position (N, 2) lies in."""
    return [(int(x), int(y)) for x, y in np.floor(np.clip(points, -_LAST_PIXEL, _LAST_PIXEL))]


def draw_box(picture: Frame, box: Box, colour: Colour, width: int, *, dashed: bool = False) -> None:
    """Draw a box of px into `picture`, its lines `width` px wide."""
    corners = pixels_at(np.asarray(box.corners))
    if not dashed:
        cv2.rectangle(picture, corners[0], corners[2], colour, width)
        return
    for ends in dashes(corners, _DASH * width):
        start, end = pixels_at(ends)
        cv2.line(picture, start, end, colour, width)


def draw_path(
    picture: Frame, points: Iterable[Position], colour: Colour, *, closed: bool = False
) -> None:
    """Draw lines from point to point, px, as wide as suits the picture."""
    pixels = np.array(pixels_at(np.array(list(points)).reshape(-1, 2)), np.int32)
    path = pixels.reshape(-1, 1, 2)
    cv2.polylines(picture, [path], closed, colour, line_width(picture), cv2.LINE_AA)


def write_labels(picture: Frame, labels: Iterable[Label], width: float = 0) -> None:
    """Write words around boxes, in the picture, where no others are; the first go first.

    `NEUTRAL` ones, which are of no vehicle, are shaded. Strokes are `width` px wide or, with 0, as
    suits the picture.
    """
    width = width or letter_width(picture)
    taken = np.zeros((0, 4))
    for box, colour, choice in labels:
        options = [(words, at) for words in choice for at in _places(picture, words, box, width)]
        free = (option for option in options if not intersections(option[1], taken).any())
        # Without room the shortest words cover others: a vehicle always has its number.
        words, place = next(free, options[-4])
        taken = np.vstack([taken, place])
        corner = int(place[0]), round(float(place[3]) - 3 * width)
        write_words(picture, words, corner, colour, width, shaded=colour == NEUTRAL)


def _places(picture: Frame, words: str, box: Box, width: float) -> Array:
    """Return the edges (4, 4) of words above, below, right and left of a box, in the picture."""
    pen = max(1, round(width))
    scale = _LETTER_SCALE * width
    (across, _), _ = cv2.getTextSize(words, cv2.FONT_HERSHEY_SIMPLEX, scale, pen)
    left, top = box.corners[0]
    right, bottom = box.corners[2]
    size = np.array((across + 2 * pen, LETTER * width))  # with the dark edge
    corners = (left, top - size[1]), (left, bottom), (right, top), (left - size[0], top)
    room = np.subtract(frame_size(picture), size) - pen
    inside = np.clip(corners, pen, np.maximum(room, pen))
    return np.hstack([inside, inside + size])


def dashes(corners: Sequence[Position], dash: float) -> Iterator[Array]:
    """Yield the two ends (2, 2) of each dash of a closed line; `dash` is its length, px."""
    for start, end in pairwise(np.array([*corners, corners[0]], float)):
        length = float(np.hypot(*(end - start)))
        for along in np.arange(0.0, length, 2 * dash):
            yield start + (end - start) / length * np.array([[along], [min(along + dash, length)]])
