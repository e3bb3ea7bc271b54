# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Targets that a user gives: on the command line, or in a file of `pick`."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.files import read_yaml_file

EntryT = TypeVar("EntryT")

TARGET_FORM = "{name: van, frame: 1, box: [310, 202, 40, 30]}"
"""Form of a target in a file, for errors."""
# A target on the command line, as `van@1:310,202,40,30`: name and frame may be left out. Nine
# digits of a frame are years of video, and fit every integer.
_WORDS = re.compile(r"(?:(?P<name>[A-Za-z0-9_-]*)(?:@(?P<frame>[0-9]{1,9}))?:)?(?P<box>[^:@]*)")


def parse_box(text: str) -> Box:
    """Read ``x,y,w,h`` of a command line."""
    try:
        x, y, width, height = map(float, text.split(","))
    except ValueError:
        raise InputError(f"{text!r} is not x,y,w,h in px") from None
    if not all(map(math.isfinite, (x, y, width, height))):
        raise InputError(f"{text!r} has a number that is not finite")
    return Box(x, y, width, height)


@dataclass(frozen=True, slots=True)
class TargetOption:
    """A target as it was given.

    Attributes
    ----------
    box : Box
        Box of the vehicle in px.
    name : str
        Name of the vehicle; empty for the next free number.
    frame : int or None
        Number of the frame, from 1; None is the first of the part that is tracked.
    """

    box: Box
    name: str = ""
    frame: int | None = None


def parse_target(text: str) -> TargetOption:
    """Read ``[NAME][@FRAME:]x,y,w,h`` of a command line."""
    match = _WORDS.fullmatch(text)
    if match is None:
        raise InputError(
            f"{text!r} is not [NAME][@FRAME:]x,y,w,h, as 310,202,40,30 or van@130:310,202,40,30"
        )
    frame = int(match["frame"]) if match["frame"] else None
    if frame == 0:
        raise InputError(f"{text!r} has frame 0; frames are counted from 1")
    return TargetOption(parse_box(match["box"]), match["name"] or "", frame)


def target_of(entry: Mapping[str, Any]) -> TargetOption:
    """Read a target of a file, as `TARGET_FORM` shows one."""
    numbers = entry["box"]
    name = str(entry.get("name", ""))
    if not isinstance(numbers, list):
        raise TypeError(numbers)
    return parse_target(f"{name}@{entry.get('frame', 1)}:{','.join(map(str, numbers))}")


def read_list(path: Path, key: str, example: str, read: Callable[[Any], EntryT]) -> list[EntryT]:
    """Read the list that a YAML file has under `key`.

    Raises
    ------
    InputError
        If the file cannot be read, or an entry is not as `list_in` expects it.
    """
    return list_in(read_yaml_file(path, key), str(path), key, example, read)


def list_in(
    document: Any, where: str, key: str, example: str, read: Callable[[Any], EntryT]
) -> list[EntryT]:
    """Read the list that `document` has under `key`, with `example` for a user to follow.

    Raises
    ------
    InputError
        If there is none, or `read` does not take an entry.
    """
    try:
        return [read(entry) for entry in document[key]]
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
    except (ValueError, KeyError, TypeError, AttributeError):
        raise InputError(f"{where} holds no {key}; it must read {key}: [{example}]") from None


def by_name(targets: Iterable[TargetOption], first: int) -> dict[str, dict[int, Box]]:
    """Group targets: for each name the boxes by frame.

    Targets without a name are named 1, 2, ...; a repeated name sets its target again, in the later
    frame.

    Parameters
    ----------
    targets : iterable of TargetOption
        The targets in the order given.
    first : int
        Number of the first frame tracked, for targets without one.

    Raises
    ------
    InputError
        If a box is smaller than a pixel, a name has two in one frame, or a frame lies before the
        first.
    """
    groups: dict[str, dict[int, Box]] = {}
    for target in targets:
        name = target.name or next(n for n in map(str, range(1, 10**6)) if n not in groups)
        frame = first if target.frame is None else target.frame
        if target.box.width < 1 or target.box.height < 1:
            raise InputError(f"the target {target.box} is smaller than one pixel")
        boxes = groups.setdefault(name, {})
        if frame in boxes:
            raise InputError(f"the target {name} has two boxes in frame {frame}")
        if frame < first:
            raise InputError(f"the target {name} is in frame {frame}; tracking begins at {first}")
        boxes[frame] = target.box
    return groups
