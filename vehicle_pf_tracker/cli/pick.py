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

"""`pick`: point at vehicles, or at points of the road, and get their boxes or pixels."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from vehicle_pf_tracker.cli.console import UsageError, counting
from vehicle_pf_tracker.cli.picking import BOXES, POINTS, ask, write_pairs
from vehicle_pf_tracker.cli.requests import option, switch
from vehicle_pf_tracker.cli.shared_options import OverwriteOption, SourceOptions, positive
from vehicle_pf_tracker.cli.targets import TargetOption, write_targets
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.offline.drawing import draw_pixel_grid
from vehicle_pf_tracker.offline.output_files import write_picture
from vehicle_pf_tracker.recordings.source import Source, frame_at, open_source
from vehicle_pf_tracker.road.calibration import format_pairs
from vehicle_pf_tracker.road.plane import Pair

PickedT = TypeVar("PickedT")


@dataclass(frozen=True, kw_only=True)
class Request(SourceOptions, OverwriteOption):
    """Request of `pick`."""

    frame: int = option(
        type=positive, default=1, metavar="N", help="frame to begin with (default: 1)"
    )
    output: Path | None = option(
        "-o", type=Path, metavar="FILE",
        help="write the targets to FILE, for run --targets, or the points, for road calibrate "
        "--pairs; otherwise they are printed",
    )  # fmt: skip
    road: bool = switch(
        help="pick points of the road instead, four or more, with their places in m"
    )
    grid: Path | None = option(
        type=Path, metavar="PNG",
        help="no page: write the frame with a grid labelled in px to PNG, to read boxes off",
    )  # fmt: skip


def run(request: Request) -> int:
    """Serve the page until the user is done, and print or write the targets."""
    source = open_source(request.source, topic=request.topic, fps=request.fps)
    output = request.output if request.grid is None else request.grid
    with claimed([output], [request.source], overwrite=request.overwrite):
        return _pick(request, source)


def _pick(request: Request, source: Source) -> int:
    if request.grid is not None:
        with counting("read") as progress:
            frame = frame_at(source, request.frame, progress)
        write_picture(request.grid, draw_pixel_grid(frame))
        print(f"frame {request.frame} with a grid is in {request.grid}")
        return 0
    if request.road:
        points = ask(source, POINTS, request.frame)
        _give(points, request.output, write_pairs, "road calibrate --pairs", _pair_words)
    else:
        targets = ask(source, BOXES, request.frame)
        _give(targets, request.output, write_targets, "run --targets", _target_words)
    return 0


def _give(
    picked: Sequence[PickedT],
    path: Path | None,
    write: Callable[[Path, Sequence[PickedT]], None],
    use: str,
    words: Callable[[PickedT], str],
) -> None:
    """Write what was picked to `path`, or print it as the words of a command."""
    if not picked:
        raise UsageError("nothing was picked")
    if path is None:
        print(" ".join(words(one) for one in picked))
        return
    write(path, picked)
    print(f"what was picked ({len(picked)}) is in {path}; use {use} {path}")


def _target_words(target: TargetOption) -> str:
    box = target.box
    place = f"{target.name}@{target.frame}:"
    numbers = ",".join(f"{value:g}" for value in (box.x, box.y, box.width, box.height))
    return f"--target {place}{numbers}"


def _pair_words(pair: Pair) -> str:
    return f"--pair {format_pairs((pair,))}"
