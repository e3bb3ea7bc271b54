# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Lines and zones that vehicles are counted at, and regions that they are looked for in."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from vehicle_pf_tracker.core.box import LARGEST_COORDINATE_PX, Position
from vehicle_pf_tracker.core.errors import InputError, suggestion
from vehicle_pf_tracker.parameters.files import read_yaml_file

_MOST_CORNERS = 100
"""Corners of a polygon; drawn by hand it has ten, and every vehicle is tested against all."""
_LONGEST_NAME = 80
"""Letters of a name, which is written into pictures and tables."""

_SECTIONS = ("lines", "zones", "roi", "targets", "pairs")
"""Sections of a file of `pick`; the last two are for others."""
_LINE_KEYS = ("from", "to", "directions")
_REGION_KEYS = ("inside", "outside")
_DEFAULT_DIRECTIONS = ("in", "out")


@dataclass(frozen=True, slots=True)
class CountingLine:
    """Line that vehicles are counted at when they cross it.

    Attributes
    ----------
    name : str
        Name of the line.
    start, end : (float, float)
        Ends of the line, px.
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
        x, y = self.start
        to_x, to_y = self.end
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
class Region:
    """Polygon in or outside of which vehicles are looked for.

    Attributes
    ----------
    corners : tuple of (float, float)
        Corners in px, in order around it.
    is_inside : bool
        True: vehicles are looked for in it, and in others like it; False: nowhere in it.
    """

    corners: tuple[Position, ...]
    is_inside: bool


@dataclass(frozen=True, slots=True)
class CountingPlan:
    """All lines and zones, of distinct names, and the regions of interest."""

    lines: tuple[CountingLine, ...] = ()
    zones: tuple[CountingZone, ...] = ()
    regions: tuple[Region, ...] = ()

    @property
    def is_counting(self) -> bool:
        """True where there is a line or a zone to count at."""
        return bool(self.lines or self.zones)

    def outside(self, width: int, height: int) -> list[str]:
        """Return the names of the lines and zones of which nothing is in an image of this size."""
        shapes = [(line.name, np.array([line.start, line.end])) for line in self.lines]
        shapes += [(zone.name, np.array(zone.corners)) for zone in self.zones]
        low = (0, 0)
        high = (width, height)
        return [n for n, at in shapes if (at.max(0) < low).any() or (at.min(0) > high).any()]


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
    """Make the plan of a document: ``lines``, ``zones`` and ``roi``, each a mapping by name.

    Other sections of a file of `pick` are left to their own readers.

    Raises
    ------
    InputError
        If a key is unknown, a point is not two numbers, or a line or polygon is degenerate.
    """
    sections = _mapping(document, "the file", _SECTIONS)
    lines = _named(sections.get("lines"), "lines")
    zones = _named(sections.get("zones"), "zones")
    for name in lines:
        if name in zones:
            raise InputError(f"{name!r} is the name of a line and of a zone; rename one")
    plan = CountingPlan(
        tuple(_line(name, body) for name, body in lines.items()),
        tuple(
            CountingZone(name, _polygon(body, f"the zone {name!r}")) for name, body in zones.items()
        ),
        tuple(_region(name, body) for name, body in _named(sections.get("roi"), "roi").items()),
    )
    if not (plan.is_counting or plan.regions):
        raise InputError("there is neither a line nor a zone nor a region of interest in it")
    return plan


def _mapping(value: Any, what: str, known: Sequence[str]) -> Mapping[str, Any]:
    """Return `value` if it is a mapping of known keys; `what` names it in errors."""
    if not isinstance(value, Mapping):
        raise InputError(f"{what} must have keys of these: {', '.join(known)}")
    for key in value:
        if key not in known:
            hint = suggestion(str(key), known) or f" (known: {', '.join(known)})"
            raise InputError(f"{what} has the unknown key {str(key)[:_LONGEST_NAME]!r}{hint}")
    return value


def _named(section: Any, what: str) -> Mapping[str, Any]:
    """Return a section as a mapping by name, empty where it is missing, its names checked."""
    if section is None:
        return {}
    if not isinstance(section, Mapping):
        raise InputError(f"{what} must be a mapping by name, as {what}: {{north: …}}")
    for name in section:
        if not (isinstance(name, str) and name.strip() and name.isprintable()):
            raise InputError(f"{what} has the name {name!r}, which is not text; put it in quotes")
        if len(name) > _LONGEST_NAME:
            raise InputError(f"{what} has a name of more than {_LONGEST_NAME} letters")
    return section


def _line(name: str, body: Any) -> CountingLine:
    what = f"the line {name!r}"
    keys = _mapping(body, what, _LINE_KEYS)
    for key in ("from", "to"):
        if key not in keys:
            raise InputError(f"{what} lacks the point {key!r}, as {key}: [12, 340]")
    directions = _directions(keys.get("directions", list(_DEFAULT_DIRECTIONS)), what)
    line = CountingLine(name, _point(keys["from"], what), _point(keys["to"], what), directions)
    if line.length < 1:
        raise InputError(f"{what} is shorter than a pixel; give two points that differ")
    return line


def _directions(value: Any, what: str) -> tuple[str, str]:
    names = value if isinstance(value, list) else []
    good = [name for name in names if isinstance(name, str) and name.strip()]
    if len(names) != 2 or len(good) != 2 or good[0] == good[1]:
        # YAML reads the bare words on, off, yes and no as truth values.
        hint = "; put them in quotes" if any(isinstance(name, bool) for name in names) else ""
        raise InputError(f"{what} needs two different names as directions, as [in, out]{hint}")
    return good[0], good[1]


def _region(name: str, body: Any) -> Region:
    what = f"the region {name!r}"
    sides = _mapping(body, what, _REGION_KEYS)
    if len(sides) != 1:
        raise InputError(f"{what} must have one of the keys {' and '.join(_REGION_KEYS)}")
    ((side, corners),) = sides.items()
    return Region(_polygon(corners, what), side == "inside")


def _polygon(body: Any, what: str) -> tuple[Position, ...]:
    """Read the corners of a polygon that has an area and does not cross itself."""
    if not isinstance(body, list) or len(body) < 3:
        raise InputError(f"{what} needs three corners or more, as [[0, 0], [90, 0], [90, 60]]")
    if len(body) > _MOST_CORNERS:
        raise InputError(f"{what} has more than {_MOST_CORNERS} corners")
    # Points first: what is no number has neither area nor crossings.
    corners = tuple(_point(corner, what) for corner in body)
    if abs(_area(corners)) < 1:
        raise InputError(f"{what} has no area; its corners lie on a line")
    if _crosses_itself(corners):
        raise InputError(f"{what} crosses itself; give its corners in order around it")
    return corners


def _point(value: Any, what: str) -> Position:
    if not (
        isinstance(value, list)
        and len(value) == 2
        and all(type(part) in (int, float) and abs(part) <= LARGEST_COORDINATE_PX for part in value)
    ):
        raise InputError(f"{what} has the point {str(value)[:60]}, which is not [x, y] in px")
    return float(value[0]), float(value[1])


_Points: TypeAlias = tuple[Position, ...]


def _area(corners: _Points) -> float:
    """Return the area with the sign of the turn (Gauss's formula), px²."""
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise((*corners, corners[0]))) / 2


def _crosses_itself(corners: _Points) -> bool:
    """Test whether two edges cross at a point within both; common corners do not count."""
    return any(
        _turn(a, b, c) * _turn(a, b, d) < 0 and _turn(c, d, a) * _turn(c, d, b) < 0
        for (a, b), (c, d) in combinations(pairwise((*corners, corners[0])), 2)
    )


def _turn(a: Position, b: Position, c: Position) -> float:
    """Return twice a triangle's area, px²: above 0 if `c` is right of a walk from `a` to `b`."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
