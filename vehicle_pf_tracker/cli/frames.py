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
from typing import TypeAlias

from vehicle_pf_tracker.cli.progress import OnProgress
from vehicle_pf_tracker.cli.stopping import Stop
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.reader import StampedFrame
from vehicle_pf_tracker.recordings.source import Source
from vehicle_pf_tracker.recordings.span import numbered_part

Numbered: TypeAlias = Iterator[tuple[int, StampedFrame]]


def numbered_frames(
    source: Source, args: argparse.Namespace, stop: Stop, progress: OnProgress
) -> Numbered:
    """Yield the frames from ``--start`` to ``--end`` with their numbers, until a stop comes."""
    part = numbered_part(stop.until(source.frames()), args.start, args.end)
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
