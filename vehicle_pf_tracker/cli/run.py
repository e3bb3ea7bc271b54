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

"""`run`: track vehicles in any source offline, show them, and score them where there is truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.cli.console import UsageError, counting, show, tell_notices
from vehicle_pf_tracker.cli.requests import MaxDiffOption, option, switch
from vehicle_pf_tracker.cli.stopping import stopping
from vehicle_pf_tracker.cli.tracking_options import (
    Numbered,
    TrackingRequest,
    by_name,
    chosen,
    cut_short,
    numbered_frames,
    peeked,
)
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.clock import max_diff_ns
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.evaluation.tables import comparison
from vehicle_pf_tracker.image.target_pixels import doubts
from vehicle_pf_tracker.offline.driver import OfflineTracker, follow, with_target
from vehicle_pf_tracker.offline.estimates import (
    EstimateRow,
    interpolated_columns,
    summary,
    write_tracks,
)
from vehicle_pf_tracker.offline.estimates_recording import OnFrame, run_recording
from vehicle_pf_tracker.offline.pictures import Pictures
from vehicle_pf_tracker.offline.run_folder import (
    ESTIMATES,
    METRICS,
    RUN,
    RunFolder,
    RunInfo,
    describe_run,
)
from vehicle_pf_tracker.parameters.configuration import Configuration, SessionParameters
from vehicle_pf_tracker.recordings.source import Source, open_source
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant, find_variant

SHEET = "summary.png"
TRACKS = "tracks.csv"
PRODUCTS = (ESTIMATES, METRICS, RUN, SHEET, TRACKS)


@dataclass(frozen=True, kw_only=True)
class Request(TrackingRequest, MaxDiffOption):
    """Request of `run`."""

    variant: str = option(
        default="fusion", metavar="NAME", help=f"one of: {', '.join(VARIANTS)} (default: fusion)"
    )
    output: Path | None = option(
        "-o", type=Path, metavar="DIR",
        help="folder for estimates.csv, run.json, summary.png, and metrics.json where there is "
        "truth (default: results/ and the source's name)",
    )  # fmt: skip
    recording: Path | None = option(
        type=Path, metavar="OUT",
        help="write images (JPEG), truth, estimates and Foxglove's annotations to the rosbag2 "
        "folder OUT",
    )  # fmt: skip
    particles: bool = switch(help="draw the particles too")
    interpolate_occlusions: bool = switch(
        help="add columns to estimates.csv with the path drawn straight through the frames that "
        "are not TRACKING; they are not scored",
    )  # fmt: skip


def run(request: Request) -> int:
    """Track, write the results, and print a summary of each target."""
    variant = find_variant(request.variant)
    source = open_source(request.source, topic=request.topic, fps=request.fps)
    path = request.output or Path("results", Path(request.source).stem or "run")
    outputs = (Products(path, PRODUCTS), request.video, request.recording)
    with claimed(outputs, request.inputs, overwrite=request.overwrite):
        return _track(request, variant, source, RunFolder(path))


def _track(request: Request, variant: Variant, source: Source, folder: RunFolder) -> int:
    window = request.source if request.show else ""
    pictures = Pictures(request.video, particles=request.particles, window=window)
    with stopping() as stop, counting("tracked") as progress:
        first, frames = peeked(numbered_frames(source, request, stop, progress))
        configuration = chosen(variant, request)
        given = _boxes(request, configuration.session, first[0])
        truth = None if any(given.values()) else _first_truth(source, request, first[1].stamp_ns)
        trackers = {
            name: _tracker(request, variant, configuration, boxes, first[0], truth)
            for name, boxes in given.items()
        }
        with _recording(request, variant, source, list(trackers)) as on_frame:
            rows = follow(trackers, _doubting(frames, given, trackers), pictures, on_frame)
    notices = list(source.notices)
    for tracker in trackers.values():
        notices += [*tracker.notices, *tracker.road_notices]
    notices += pictures.notices
    ended = cut_short(stop, source, max(map(len, rows.values())))
    notices += ended
    tell_notices(notices)
    _write(folder, request, source, trackers, rows, notices)
    pictures.sheet.write(folder.path / SHEET)
    for name, found in rows.items():
        print(f"{name + ': ' if len(rows) > 1 else ''}{summary(found)}")
    print(f"results are in {folder.path}; {SHEET} shows the key frames")
    if request.video:
        print(f"the video is {request.video}")
    if request.recording:
        print(f"the recording is {request.recording}, for Foxglove and `ros2 bag play`")
    return stop.status if ended else 0


def _recording(
    request: Request, variant: Variant, source: Source, targets: Sequence[str]
) -> AbstractContextManager[OnFrame | None]:
    if request.recording is None:
        return nullcontext()
    return run_recording(request.recording, f"{variant.name}_tracker", targets, source.truth())


def _write(
    folder: RunFolder,
    request: Request,
    source: Source,
    trackers: Mapping[str, OfflineTracker],
    rows: Mapping[str, Sequence[EstimateRow]],
    notices: Sequence[str],
) -> None:
    """Write the run of one target to `folder`; of several to folders in it and to one table."""
    for earlier in (TRACKS, SHEET):
        (folder.path / earlier).unlink(missing_ok=True)
    for name, tracker in trackers.items():
        info = RunInfo(
            request.command, request.source, source.image_topic, tracker.start_frame, notices
        )
        part = folder if len(trackers) == 1 else RunFolder(folder.path / name)
        extra: dict[str, list[float | None]] = tracker.road_columns
        if request.interpolate_occlusions:
            extra |= interpolated_columns(rows[name])
        part.write_run(rows[name], describe_run(info, tracker.session), extra)
    if len(trackers) > 1:
        write_tracks(folder.path / TRACKS, rows)
        return
    (found,) = rows.values()
    metrics = measure(score_frames(found, source.truth(), request.max_diff))
    folder.write_metrics(metrics.to_json())
    if metrics.frames_scored:
        show(comparison({request.variant: metrics}))


Boxes: TypeAlias = Mapping[str, Mapping[int, Box]]
"""Boxes given by the user, px: for each target, by the number of the frame."""


def _boxes(request: Request, settings: SessionParameters, first: int) -> Boxes:
    """Return the targets given; without any, the target "1" of the parameters, if they have one."""
    configured = {} if settings.target.box is None else {first: settings.target.box}
    return by_name(request.given_targets(), first) or {"1": configured}


def _tracker(
    request: Request,
    variant: Variant,
    configuration: Configuration,
    boxes: Mapping[int, Box],
    first: int,
    truth: Truth | None,
) -> OfflineTracker:
    """Make the tracker of one target, which starts on `truth` where it has no boxes."""
    settings, later = configuration.session, dict(boxes)
    if (initial := later.pop(first, None)) is not None:
        settings = with_target(settings, initial)
    return OfflineTracker(
        variant, configuration.tracker, settings,
        first_truth=truth, targets=later, max_diff=request.max_diff,
    )  # fmt: skip


def _first_truth(source: Source, request: Request, first_ns: int) -> Truth:
    earliest = first_ns - max_diff_ns(request.max_diff)
    truth = next((t for t in source.truth() if t.stamp_ns >= earliest), None)
    if truth is None:
        raise UsageError(
            f"{request.source} has no truth to start on; give the vehicle's box in the first image "
            "with --target x,y,w,h"
        )
    return truth


def _doubting(frames: Numbered, given: Boxes, trackers: Mapping[str, OfflineTracker]) -> Numbered:
    """Pass frames on; note what speaks against the targets given for them."""
    for number, found in frames:
        for name, boxes in given.items():
            if number in boxes and found.frame is not None:
                trackers[name].notices += [
                    f"the target {name} is doubtful: {why}"
                    for why in doubts(found.frame, boxes[number])
                ]
        yield number, found
