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

"""Frames of a source for the verbs that track."""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.cli.parameter_options import ParameterOptions
from vehicle_pf_tracker.cli.progress import OnProgress
from vehicle_pf_tracker.cli.requests import option, switch
from vehicle_pf_tracker.cli.shared_options import OverwriteOption, SourceOptions
from vehicle_pf_tracker.cli.stopping import Stop
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import Source
from vehicle_pf_tracker.recordings.span import Moment, numbered_part


def _moment(text: str) -> Moment:
    try:
        return Moment.parse(text)
    except InputError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


@dataclass(frozen=True, kw_only=True)
class TrackingRequest(SourceOptions, ParameterOptions, OverwriteOption):
    """Request to track in a source, or in a part of it."""

    start: Moment | None = option(
        type=_moment, metavar="AT",
        help="first frame: its number, from 1, or its time in seconds, as 4.3s",
    )  # fmt: skip
    end: Moment | None = option(type=_moment, metavar="AT", help="last frame, likewise")
    targets: Path | None = option(type=Path, metavar="FILE", help="targets that `pick` wrote")
    show: bool = switch(help="show them in a window meanwhile; q ends the run")

    @property
    def inputs(self) -> tuple[str | Path | None, ...]:
        """The source, and the files that options name."""
        return self.source, self.params, self.targets


Numbered: TypeAlias = Iterator[tuple[int, StampedFrame]]


def numbered_frames(
    source: Source, request: TrackingRequest, stop: Stop, progress: OnProgress
) -> Numbered:
    """Yield the frames from ``--start`` to ``--end`` with their numbers, until a stop comes."""
    part = numbered_part(stop.until(source.frames()), request.start, request.end)
    for number, found in part:
        progress(number, source.frame_count)
        yield number, found


def peeked(frames: Numbered) -> tuple[tuple[int, StampedFrame], Numbered]:
    """Return the first frame, and all frames.

    Raises
    ------
    InputError
        If there is none.
    """
    first = next(frames, None)
    if first is None:
        raise InputError("the source ended before its first image")
    return first, itertools.chain([first], frames)


def cut_short(stop: Stop, source: Source, done: int) -> list[str]:
    """Say that a signal ended the run after `done` frames; empty if it is whole.

    A live source ends by a signal, and so its run is whole then.
    """
    if not stop.came or source.frame_count is None:
        return []
    return [f"a signal ended the run after {done} of {source.frame_count} frames"]
