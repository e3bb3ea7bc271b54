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

"""Targets of a run: boxes in px, each with a name and the frame that it is given for.

A window that shows frames, where OpenCV has any.
"""

from __future__ import annotations

import argparse
import os
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import cv2
import yaml

from vehicle_pf_tracker.cli.parameter_options import parse_box
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.offline.output_files import write_text

_WORDS = re.compile(r"(?:(?P<name>[A-Za-z0-9_-]*)(?:@(?P<frame>[0-9]{1,9}))?:)?(?P<box>[^:@]*)")


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
    found = _WORDS.fullmatch(text)
    if found is None:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not [NAME][@FRAME:]x,y,w,h, as 310,202,40,30 or van@130:310,202,40,30"
        )
    frame = int(found["frame"]) if found["frame"] else None
    if frame == 0:
        raise argparse.ArgumentTypeError(f"{text!r} has frame 0; frames are counted from 1")
    return TargetOption(parse_box(found["box"]), found["name"] or "", frame)


def read_targets(path: Path) -> list[TargetOption]:
    """Read a file of targets, as `pick` writes it.

    Raises
    ------
    InputError
        If it cannot be read, or an entry is not a target.
    """
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
        entries = content["targets"]
        return [_entry(entry) for entry in entries]
    except OSError as error:
        raise InputError(f"cannot read the targets {path}: {error.strerror}") from error
    except InputError as error:
        raise InputError(f"the targets {path}: {error}") from error
    except (ValueError, KeyError, TypeError, RecursionError, yaml.YAMLError):
        raise InputError(
            f"{path} holds no targets; it must read targets: [{{name: van, frame: 1, "
            "box: [310, 202, 40, 30]}]"
        ) from None


def write_targets(path: Path, targets: Iterable[TargetOption]) -> None:
    """Write a file that `read_targets` reads."""
    entries = [
        {"name": one.name, "frame": one.frame or 1, "box": _numbers(one.box)} for one in targets
    ]
    text = yaml.safe_dump({"targets": entries}, sort_keys=False, default_flow_style=None)
    write_text(path, text)


def by_name(targets: Iterable[TargetOption], first: int) -> dict[str, dict[int, Box]]:
    """Group targets: for each name the boxes by frame.

    Targets without a name are named 1, 2, ...; a name that comes again is given to the tracker anew
    at that frame.

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


def _entry(entry: dict[str, object]) -> TargetOption:
    numbers = entry["box"]
    if not isinstance(numbers, list):
        raise TypeError(numbers)
    frame, name = entry.get("frame", 1), str(entry.get("name", ""))
    text = f"{name}@{frame}:{','.join(map(str, numbers))}"
    try:
        return parse_target(text)
    except argparse.ArgumentTypeError as error:
        raise InputError(str(error)) from None


def _numbers(box: Box) -> list[float]:
    return [round(value, 2) for value in (box.x, box.y, box.width, box.height)]


def has_display() -> bool:
    """Return whether windows can be shown."""
    return os.name != "posix" or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


class PictureWindow:
    """Shows one frame after the other.

    Parameters
    ----------
    title : str
        Title of the window.

    Raises
    ------
    InputError
        If there is no display, or this OpenCV has no windows.
    """

    def __init__(self, title: str) -> None:
        self._title = title
        try:
            # Without a display, Qt would end the program instead of raising.
            if not has_display():
                raise InputError("--show needs a display, and there is none; use --video FILE")
            cv2.namedWindow(title, cv2.WINDOW_NORMAL)
        except cv2.error:
            raise InputError(
                "--show needs an OpenCV with windows (opencv-python, not -headless); "
                "use --video FILE"
            ) from None

    def show(self, picture: Frame) -> bool:
        """Show a frame; False when the user presses q or Escape."""
        cv2.imshow(self._title, cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))
        return cv2.waitKey(1) & 0xFF not in (ord("q"), 27)
