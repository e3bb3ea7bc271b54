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

"""Options and numbers that several verbs read from the command line."""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle_pf_tracker.cli.requests import VerbRequest, option, positional, switch
from vehicle_pf_tracker.core.clock import MAX_DIFF


@dataclass(frozen=True, kw_only=True)
class OverwriteOption(VerbRequest):
    """Request that can replace outputs."""

    overwrite: bool = switch(help="replace outputs that exist")


@dataclass(frozen=True, kw_only=True)
class MaxDiffOption(VerbRequest):
    """Request that associates estimates and truth."""

    max_diff: float = option(
        type=float, default=MAX_DIFF, metavar="S",
        help=f"largest difference of stamps that belong together (default: {MAX_DIFF:g} s)",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class RosOption(VerbRequest):
    """Request with an option after which all words are ROS's."""

    ros_args: Sequence[str] = option(
        nargs=argparse.REMAINDER, default=[], metavar="...", help="all words after this go to ROS"
    )


@dataclass(frozen=True, kw_only=True)
class SourceOptions(VerbRequest):
    """Request that reads images of any source."""

    source: str = positional(
        metavar="SOURCE",
        help="recording, video file, folder of images, index of a camera, or URL of a stream",
    )  # fmt: skip
    topic: str | None = option(help="the image topic, if a recording has several")
    fps: float | None = option(
        type=float, metavar="HZ", help="frame rate, instead of the one that SOURCE states"
    )


def positive(text: str) -> int:
    """Read an integer >= 1."""
    return _at_least(1, text)


def natural(text: str) -> int:
    """Read an integer >= 0."""
    return _at_least(0, text)


def _at_least(least: int, text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) < least:
        raise argparse.ArgumentTypeError(f"{text!r} is not an integer >= {least}")
    return int(text)


def positive_number(text: str) -> float:
    """Read a finite number above 0."""
    value = number(text)
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text} is not more than 0")
    return value


def number(text: str) -> float:
    """Read a finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return value


@dataclass(frozen=True, kw_only=True)
class WorkersOption(VerbRequest):
    """Request for work in several processes."""

    workers: int = option(
        type=positive, default=os.cpu_count() or 1, metavar="N",
        help="processes; results do not depend on it (default: one per processor)",
    )  # fmt: skip
