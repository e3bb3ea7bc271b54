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

"""Lines and zones that vehicles are counted at."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from pathlib import Path
from typing import Any, TypeAlias

from vehicle_pf_tracker.core.box import Position
from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.parameters.files import read_yaml_file

_LARGEST = 1e5
"""Bound of coordinates in px: three times the largest side of an image (32767 px)."""
_MOST_CORNERS = 100
"""Corners of a zone; one that is drawn by hand has ten, and every vehicle is tested against all."""
_LONGEST_NAME = 80
"""Letters of a name, which is written into pictures and tables."""

_SECTIONS = ("lines", "zones", "targets", "pairs")
"""Sections of a file of `pick`; the last two are for others."""
_LINE_KEYS = ("from", "to", "directions")
_DEFAULT_DIRECTIONS = ("in", "out")


@dataclass(frozen=True, slots=True)
class CountingLine:
    """Line that vehicles are counted at when they cross it.

    Attributes
    ----------
    name : str
        Name of the line.
    start, end : (float, float)
        Its ends in px.
    directions : (str, str)
        Name of the crossing from the left to the right of a walk from `start` to `end` in the
        picture (over a line drawn from left to right: downwards), and of the one back.
    """

    name: str
    start: Position
    end: Position
    directions: tuple[str, str] = _DEFAULT_DIRECTIONS

    @property
    def length(self) -> float:
        """Length in px."""
        return math.dist(self.start, self.end)

    def distance(self, point: Position) -> float:
        """Distance of `point` from the endless line in px; positive on the right-hand side."""
        return _turn(self.start, self.end, point) / self.length

    def share(self, point: Position) -> float:
        """Where along the line `point` is: 0 at the start, 1 at the end, beyond them outside."""
        (x, y), (to_x, to_y) = self.start, self.end
        along = (point[0] - x) * (to_x - x) + (point[1] - y) * (to_y - y)
        return along / self.length**2


@dataclass(frozen=True, slots=True)
class CountingZone:
    """Polygon whose vehicles are counted.

    Attributes
    ----------
    name : str
        Name of the zone.
    corners : tuple of (float, float)
        Corners in px, in order around it.
    """

    name: str
    corners: tuple[Position, ...]


@dataclass(frozen=True, slots=True)
class CountingPlan:
    """All lines and zones; their names are distinct."""

    lines: tuple[CountingLine, ...] = ()
    zones: tuple[CountingZone, ...] = ()

    def outside(self, width: int, height: int) -> list[str]:
        """Return the names of those that no vehicle in an image of this size can reach."""
        points = {
            **{line.name: (line.start, line.end) for line in self.lines},
            **{zone.name: zone.corners for zone in self.zones},
        }
        return [name for name, some in points.items() if _all_beyond(some, width, height)]


def read_counting_plan(path: Path) -> CountingPlan:
    """Read a file of lines and zones.

    Raises
    ------
    InputError
        If it cannot be read, or anything in it is not as `parse_counting_plan` expects it.
    """
    document = read_yaml_file(path, "counting lines")
    try:
        return parse_counting_plan(document)
    except InputError as error:
        raise InputError(f"the counting lines {path}: {error}") from None


def parse_counting_plan(document: Any) -> CountingPlan:
    """Make the plan of a document: ``lines`` and ``zones``, each a mapping by name.

    Other sections of a file of `pick` are left to their own readers.

    Raises
    ------
    InputError
        If a key is unknown, a point is not two numbers, or a line or zone is degenerate.
    """
    sections = _mapping(document, "the file", _SECTIONS)
    lines = _named(sections.get("lines"), "lines")
    zones = _named(sections.get("zones"), "zones")
    for name in lines:
        if name in zones:
            raise InputError(f"{name!r} is the name of a line and of a zone; rename one")
    plan = CountingPlan(
        tuple(_line(name, body) for name, body in lines.items()),
        tuple(_zone(name, body) for name, body in zones.items()),
    )
    if not (plan.lines or plan.zones):
        raise InputError("there is neither a line nor a zone in it")
    return plan


def _mapping(value: Any, what: str, known: Sequence[str]) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise InputError(f"{what} must have the keys {' and '.join(known)}")
    for key in value:
        if key not in known:
            hint = suggestion(str(key), known) or f" (known: {', '.join(known)})"
            raise InputError(f"{what} has the unknown key {str(key)[:_LONGEST_NAME]!r}{hint}")
    return value


def _named(section: Any, what: str) -> Mapping[str, Any]:
    if section is None:
        return {}
    if not isinstance(section, Mapping):
        raise InputError(f"{what} must be a mapping by name, as {what}: {{north: …}}")
    for name in section:
        if not (isinstance(name, str) and name.strip() and name.isprintable()):
            raise InputError(f"{what} has the name {name!r}, which is no text; put it in quotes")
        if len(name) > _LONGEST_NAME:
            raise InputError(f"{what} has a name of more than {_LONGEST_NAME} letters")
    return section


def _line(name: str, body: Any) -> CountingLine:
    what = f"the line {name!r}"
    keys = _mapping(body, what, _LINE_KEYS)
    for key in ("from", "to"):
        if key not in keys:
            raise InputError(f"{what} lacks the point {key!r}, as {key}: [12, 340]")
    line = CountingLine(
        name,
        _point(keys["from"], what),
        _point(keys["to"], what),
        _directions(keys.get("directions", list(_DEFAULT_DIRECTIONS)), what),
    )
    if line.length < 1:
        raise InputError(f"{what} is shorter than a pixel; give two points that differ")
    return line


def _directions(value: Any, what: str) -> tuple[str, str]:
    names = value if isinstance(value, list) else []
    good = [name for name in names if isinstance(name, str) and name.strip()]
    if len(names) != 2 or len(good) != 2 or good[0] == good[1]:
        raise InputError(f"{what} needs two different names as directions, as [in, out]")
    return good[0], good[1]


def _zone(name: str, body: Any) -> CountingZone:
    what = f"the zone {name!r}"
    if not isinstance(body, list) or len(body) < 3:
        raise InputError(f"{what} needs three corners or more, as [[0, 0], [90, 0], [90, 60]]")
    if len(body) > _MOST_CORNERS:
        raise InputError(f"{what} has more than {_MOST_CORNERS} corners")
    corners = tuple(_point(corner, what) for corner in body)
    if abs(_area(corners)) < 1:
        raise InputError(f"{what} has no area; its corners lie on a line")
    if _crosses_itself(corners):
        raise InputError(f"{what} crosses itself; give its corners in order around it")
    return CountingZone(name, corners)


def _point(value: Any, what: str) -> Position:
    if not (
        isinstance(value, list)
        and len(value) == 2
        and all(isinstance(part, int | float) and not isinstance(part, bool) for part in value)
        and all(-_LARGEST <= part <= _LARGEST for part in value)
    ):
        raise InputError(f"{what} has the point {str(value)[:60]}, which is not [x, y] in px")
    return float(value[0]), float(value[1])


_Points: TypeAlias = tuple[Position, ...]


def _area(corners: _Points) -> float:
    """Return the area with the sign of the turn (Gauss's formula), px²."""
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise((*corners, corners[0]))) / 2


def _crosses_itself(corners: _Points) -> bool:
    edges = list(pairwise((*corners, corners[0])))
    return any(_cross(a, b) for a, b in combinations(edges, 2))


def _cross(one: _Points, other: _Points) -> bool:
    """Test whether two edges cross at a point within both; common corners do not count."""
    (a, b), (c, d) = one, other
    return _turn(a, b, c) * _turn(a, b, d) < 0 and _turn(c, d, a) * _turn(c, d, b) < 0


def _turn(a: Position, b: Position, c: Position) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _all_beyond(points: Sequence[Position], width: int, height: int) -> bool:
    """Test whether all points lie beyond the same border of the image."""
    xs, ys = zip(*points, strict=True)
    return bool(max(xs) < 0 or max(ys) < 0 or min(xs) > width or min(ys) > height)
