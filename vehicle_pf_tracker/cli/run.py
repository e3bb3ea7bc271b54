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

"""`run`: track a recording offline, and score it where there is truth."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from vehicle_pf_tracker.cli import parameter_options
from vehicle_pf_tracker.cli.console import UsageError, show, tell_notices
from vehicle_pf_tracker.cli.progress import OnProgress, counting
from vehicle_pf_tracker.cli.shared_options import add_max_diff
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.estimates import interpolated_columns
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.offline import OfflineTracker
from vehicle_pf_tracker.evaluation.run_folder import RunFolder, RunInfo, describe_run
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.evaluation.tables import comparison
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.trackers.registry import VARIANTS, find_variant


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
    add = parser.add_argument
    add("recording", type=Path, metavar="REC", help="rosbag2 folder or MCAP file")
    add("--variant", required=True, metavar="NAME", help=f"one of: {', '.join(VARIANTS)}")
    add(
        "-o", "--output", type=Path, required=True, metavar="DIR",
        help="folder for estimates.csv, metrics.json and run.json; those in it are replaced",
    )  # fmt: skip
    add("--topic", help="the image topic, if the recording has several")
    add_max_diff(parser)
    add(
        "--interpolate-occlusions", action="store_true",
        help="add columns to estimates.csv with the path drawn straight through the frames that "
        "are not TRACKING; they are not scored",
    )  # fmt: skip
    parameter_options.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    """Track, write the results, and print the metrics."""
    variant = find_variant(args.variant)
    chosen = parameter_options.chosen(variant, args)
    recording = Recording(args.recording, args.topic)
    first_truth = None if chosen.session.target.box else _first_truth(recording)
    tracker = OfflineTracker(
        variant, chosen.tracker, chosen.session, first_truth=first_truth, max_diff=args.max_diff
    )
    folder = RunFolder(args.output)
    with counting("tracked") as progress:
        rows = list(tracker.rows(_frames(recording, progress)))
    notices = [*recording.notices, *tracker.notices, *tracker.road_notices]
    tell_notices(notices)
    info = RunInfo(
        args.command, str(args.recording), recording.image_topic, tracker.start_frame, notices
    )
    extra: dict[str, list[float | None]] = tracker.road_columns
    if args.interpolate_occlusions:
        extra |= interpolated_columns(rows)
    folder.write_run(rows, describe_run(info, tracker.session), extra)
    metrics = measure(score_frames(rows, recording.truth(), args.max_diff))
    folder.write_metrics(metrics)
    show(comparison({variant.name: metrics}))
    print(f"results are in {folder.path}")
    return 0


def _first_truth(recording: Recording) -> Truth:
    truth = recording.first_truth()
    if truth is None:
        raise UsageError(
            f"the recording {recording.path} has no truth to start on; "
            "give the vehicle's box in the first image with --target x,y,w,h"
        )
    return truth


def _frames(recording: Recording, progress: OnProgress) -> Iterator[tuple[int, Frame | None]]:
    for number, stamped in enumerate(recording.frames(), start=1):
        progress(number, recording.frame_count)
        yield stamped.stamp_ns, stamped.frame
