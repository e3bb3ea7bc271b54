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
import os

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.association import MAX_DIFF
from vehicle_pf_tracker.recordings.span import Moment


def add_overwrite(parser: argparse.ArgumentParser) -> None:
    """Add the option that outputs may replace what exists."""
    parser.add_argument("--overwrite", action="store_true", help="replace outputs that exist")


def add_max_diff(parser: argparse.ArgumentParser) -> None:
    """Add what association of estimates and truth needs."""
    parser.add_argument(
        "--max-diff", type=float, default=MAX_DIFF, metavar="S",
        help=f"largest difference of stamps that belong together (default: {MAX_DIFF:g} s)",
    )  # fmt: skip


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Add the number of processes."""
    parser.add_argument(
        "--workers", type=positive, default=os.cpu_count() or 1, metavar="N",
        help="processes; results do not depend on it (default: one per processor)",
    )  # fmt: skip


def add_ros_args(parser: argparse.ArgumentParser) -> None:
    """Add the option after which all words are ROS's."""
    parser.add_argument(
        "--ros-args", nargs=argparse.REMAINDER, default=[], metavar="...",
        help="all words after this go to ROS",
    )  # fmt: skip


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


def add_span(parser: argparse.ArgumentParser) -> None:
    """Add the part of the source."""
    parser.add_argument(
        "--start", type=_moment, metavar="AT",
        help="first frame: its number, from 1, or its time in seconds, as 4.3s",
    )  # fmt: skip
    parser.add_argument("--end", type=_moment, metavar="AT", help="last frame, likewise")


def _moment(text: str) -> Moment:
    try:
        return Moment.parse(text)
    except InputError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
