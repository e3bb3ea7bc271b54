# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`import`: convert a video file or a frame folder to a recording."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.cli.console import counting, tell_notices
from vehicle_pf_tracker.cli.requests import option, positional
from vehicle_pf_tracker.cli.shared_options import OverwriteOption, TruthOptions
from vehicle_pf_tracker.core.outputs import claimed
from vehicle_pf_tracker.recordings.importing import IMPORT_FORMATS, import_recording


@dataclass(frozen=True, kw_only=True)
class Request(OverwriteOption, TruthOptions):
    """Request of `import`."""

    source: Path = positional(
        metavar="SRC",
        help="video file, or folder of images with the truth that lies beside them",
    )  # fmt: skip
    out: Path = positional(metavar="OUT", help="rosbag2 folder to write")
    fps: float | None = option(metavar="HZ", help="frame rate, instead of the one that SRC states")
    format: str | None = option(
        choices=IMPORT_FORMATS,
        help="how images are stored (default: JPEG files as they are, videos as JPEG, PNG raw)",
    )  # fmt: skip


def run(request: Request) -> int:
    """Import the footage, and print a summary of the recording."""
    with (
        claimed([request.out], [request.source, request.truth], overwrite=request.overwrite),
        counting("imported") as progress,
    ):
        summary, notices = import_recording(
            request.source,
            request.out,
            truth=request.truth,
            identity=request.id,
            fps=request.fps,
            format=request.format,
            progress=progress,
            overwrite=request.overwrite,
        )
    tell_notices(notices)
    print(f"{request.out}: {summary}")
    return 0
