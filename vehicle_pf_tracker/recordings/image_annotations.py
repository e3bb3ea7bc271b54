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

"""Lines and words over an image, as the message that Foxglove draws."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from vehicle_pf_tracker.recordings.cdr import message_class
from vehicle_pf_tracker.recordings.foxglove_types import IMAGE_ANNOTATIONS

LINE_LOOP, LINE_STRIP, LINE_LIST = 2, 3, 4
"""Ways to join points: to a closed line, to an open one, and in pairs."""

Point: TypeAlias = tuple[float, float]
"""Continuous position in px; (0, 0) is the corner of the image, as it is for Foxglove."""
Colour: TypeAlias = tuple[int, int, int]
"""Red, green, blue, 0 to 255."""

_GROUND_OPACITY = 0.6
"""Opacity of the black behind words: they are legible on a bright road, which stays visible."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line: how its points are joined, the points, its colour, and its width in px."""

    kind: int
    points: Sequence[Point]
    colour: Colour
    thickness: float


@dataclass(frozen=True, slots=True)
class Label:
    """Words: their lower left corner, their colour, and the size of the font in px."""

    text: str
    corner: Point
    colour: Colour
    height: float


def image_annotations(stamp_ns: int, lines: Iterable[Line], labels: Iterable[Label]) -> Any:
    """Make the annotations of the image with this stamp in ns."""
    seconds, nanoseconds = divmod(stamp_ns, 1_000_000_000)
    stamp = message_class("builtin_interfaces/msg/Time")(sec=seconds, nanosec=nanoseconds)
    return message_class(IMAGE_ANNOTATIONS)(
        circles=[],
        points=[_points(stamp, line) for line in lines],
        texts=[_text(stamp, label) for label in labels],
    )


def _points(stamp: Any, line: Line) -> Any:
    return message_class("foxglove_msgs/msg/PointsAnnotation")(
        timestamp=stamp,
        type=line.kind,
        points=[_point(point) for point in line.points],
        outline_color=_colour(line.colour),
        outline_colors=[],
        fill_color=_colour((0, 0, 0), 0.0),
        thickness=line.thickness,
    )


def _text(stamp: Any, label: Label) -> Any:
    return message_class("foxglove_msgs/msg/TextAnnotation")(
        timestamp=stamp,
        position=_point(label.corner),
        text=label.text,
        font_size=label.height,
        text_color=_colour(label.colour),
        background_color=_colour((0, 0, 0), _GROUND_OPACITY),
    )


def _point(point: Point) -> Any:
    return message_class("foxglove_msgs/msg/Point2")(x=float(point[0]), y=float(point[1]))


def _colour(colour: Colour, opacity: float = 1.0) -> Any:
    red, green, blue = (value / 255 for value in colour)
    return message_class("foxglove_msgs/msg/Color")(r=red, g=green, b=blue, a=opacity)
