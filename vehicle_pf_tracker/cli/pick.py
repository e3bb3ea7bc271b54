# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`pick`: draw vehicles, lines, zones, regions and points of the road on a page served here."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import yaml

from vehicle_pf_tracker.cli.console import counting
from vehicle_pf_tracker.cli.option_values import positive
from vehicle_pf_tracker.cli.pick_page import ask
from vehicle_pf_tracker.cli.picked_shapes import (
    PAIRS_SECTION,
    SECTION_USES,
    TARGETS_SECTION,
    checked,
    words_of,
)
from vehicle_pf_tracker.cli.requests import option, switch
from vehicle_pf_tracker.cli.shared_options import OverwriteOption, SourceOptions
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.parameters.files import read_yaml_file
from vehicle_pf_tracker.recordings.source import ImageSource, frame_at
from vehicle_pf_tracker.results.output_files import write_picture, write_text
from vehicle_pf_tracker.showing.grids import draw_pixel_grid


@dataclass(frozen=True, kw_only=True)
class Request(SourceOptions, OverwriteOption):
    """Request of `pick`."""

    frame: int = option(
        type=positive, default=1, metavar="N", help="frame to begin with (default: 1)"
    )
    output: Path | None = option(
        "-o", help="file for run --targets, traffic --lines and road calibrate --pairs; without "
        "it, what was drawn is printed",
    )  # fmt: skip
    edit: Path | None = option(help="change such a file, or with -o a copy of it")
    road: bool = switch(help="only points of the road, four or more, with their x and y in metres")
    grid: Path | None = option(
        metavar="PNG",
        help="no page: write the frame with a grid labelled in px to PNG, to read boxes off",
    )  # fmt: skip


def run(request: Request) -> int:
    """Serve the page until the user is done, and print or write what was drawn."""
    source = request.open_source()
    output = request.grid or request.output or request.edit
    is_in_place = output == request.edit
    inputs = [request.source, None if is_in_place else request.edit]
    with claimed([output], inputs, overwrite=request.overwrite or is_in_place):
        if request.grid is None:
            return _draw(request, source, output)
        with counting("read") as progress:
            frame = frame_at(source, request.frame, progress)
        write_picture(request.grid, draw_pixel_grid(frame))
        print(f"frame {request.frame} with a grid is in {request.grid}")
        return 0


def _draw(request: Request, source: ImageSource, output: Path | None) -> int:
    """Let the user draw, and write the shapes to `output`, or print them without one."""
    before = None
    if request.edit is not None:
        where = f"the file {request.edit}"
        before = checked(read_yaml_file(request.edit, "file"), where)
    drawn = ask(
        source, (PAIRS_SECTION,) if request.road else tuple(SECTION_USES), request.frame, before
    )
    text = yaml.safe_dump(drawn, sort_keys=False, default_flow_style=None, allow_unicode=True)
    if output is None:
        print(words_of(drawn) if set(drawn) <= {TARGETS_SECTION, PAIRS_SECTION} else text)
        return 0
    write_text(output, text)
    uses = " and ".join(dict.fromkeys(f"{SECTION_USES[key]} {output}" for key in drawn))
    print(f"what was drawn is in {output}; use {uses}")
    return 0
