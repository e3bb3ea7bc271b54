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

"""`import`: convert a video file or a frame folder to a recording."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehicle_pf_tracker.cli.console import megabytes, tell_notices
from vehicle_pf_tracker.cli.progress import counting
from vehicle_pf_tracker.cli.shared_options import add_overwrite
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.recordings.importing import (
    FORMATS,
    ExpectedSize,
    expected_size,
    import_recording,
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
    add = parser.add_argument
    add(
        "source", type=Path, metavar="SRC",
        help="video file, or folder of images, with groundtruth.csv where truth is known",
    )  # fmt: skip
    add("out", type=Path, metavar="OUT", help="rosbag2 folder to write")
    add(
        "--truth", type=Path, metavar="FILE",
        help="truth of a video: a table frame,x,y,w,h,occ (frames from 1, top-left corner in px, "
        "0 in view, 1 partly, 2 totally hidden); a frame without a row has none",
    )  # fmt: skip
    add("--fps", type=float, metavar="HZ", help="frame rate, instead of the one that SRC states")
    add(
        "--format", choices=FORMATS,
        help="how images are stored (default: JPEG files as they are, videos as JPEG, PNG raw)",
    )  # fmt: skip
    add_overwrite(parser)


def run(args: argparse.Namespace) -> int:
    """Import the footage, and print a summary of the recording."""
    expected = expected_size(args.source, fps=args.fps, format=args.format)
    if expected is not None:
        print(f"{args.out} will take {_words(expected)}", flush=True)
    with (
        claimed([args.out], [args.source, args.truth], overwrite=args.overwrite),
        counting("imported") as progress,
    ):
        made = import_recording(
            args.source,
            args.out,
            truth=args.truth,
            fps=args.fps,
            format=args.format,
            progress=progress,
            overwrite=args.overwrite,
        )
    tell_notices(made.notices)
    print(
        f"{made.path}: {made.frames} frames of {made.width}x{made.height} px "
        f"at {made.fps:g} frames/s, {made.truths} with truth; {megabytes(made.size)}"
    )
    return 0


def _words(expected: ExpectedSize) -> str:
    about = "up to" if expected.is_raw else "about"
    if expected.images is None:
        return f"{about} {megabytes(expected.image)} for each image"
    return f"{about} {megabytes(expected.image * expected.images)}"
