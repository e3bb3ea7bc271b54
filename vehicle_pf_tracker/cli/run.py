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

from vehicle_pf_tracker.cli import parameter_options
from vehicle_pf_tracker.cli.console import UsageError, counting, show, tell_notices
from vehicle_pf_tracker.cli.requests import option, switch
from vehicle_pf_tracker.cli.shared_options import MaxDiffOption
from vehicle_pf_tracker.cli.stopping import (
    Numbered,
    TrackingRequest,
    cut_short,
    numbered_frames,
    peeked,
    stopping,
)
from vehicle_pf_tracker.cli.targets import (
    PictureWindow,
    TargetOption,
    by_name,
    parse_target,
    read_targets,
)
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.clock import max_diff_ns
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.evaluation.tables import comparison
from vehicle_pf_tracker.image.target_pixels import doubts
from vehicle_pf_tracker.offline.contact_sheet import summary
from vehicle_pf_tracker.offline.driver import OfflineTracker, with_target
from vehicle_pf_tracker.offline.estimates import EstimateRow, interpolated_columns, write_tracks
from vehicle_pf_tracker.offline.estimates_recording import OnFrame, run_recording
from vehicle_pf_tracker.offline.following import Pictures, follow
from vehicle_pf_tracker.offline.run_folder import (
    ESTIMATES,
    METRICS,
    RUN,
    RunFolder,
    RunInfo,
    describe_run,
)
from vehicle_pf_tracker.offline.video_writer import NO_ENCODER, has_encoder
from vehicle_pf_tracker.recordings.reader import StampedFrame
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
    video: Path | None = option(
        type=Path, metavar="FILE", help="write the frames with box, path and mode to FILE, an mp4"
    )
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
    target: Sequence[TargetOption] = option(
        type=parse_target, action="append", default=[],
        metavar="[NAME][@FRAME:]X,Y,W,H",
        help="box to start on in px, top-left corner and size, in the first frame or in FRAME; "
        "repeatable, for several vehicles or to correct one later; otherwise the first true box",
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
    window = PictureWindow(request.source) if request.show else None
    show_in = window.show if window else None
    pictures = Pictures(request.video, particles=request.particles, show=show_in)
    with stopping() as stop, counting("tracked") as progress:
        first, frames = peeked(numbered_frames(source, request, stop, progress))
        targets = _targets(variant, source, request, first)
        trackers = {name: one.tracker for name, one in targets.items()}
        with _recording(request, variant, source, list(trackers)) as on_frame:
            rows = follow(trackers, _doubting(frames, targets), pictures, on_frame)
    notices = list(source.notices)
    for tracker in trackers.values():
        notices += [*tracker.notices, *tracker.road_notices]
    if request.video and not has_encoder():
        notices.append(NO_ENCODER)
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


@dataclass(frozen=True, slots=True)
class _Target:
    """A tracker, and its boxes by frame."""

    tracker: OfflineTracker
    boxes: Mapping[int, Box]


def _targets(
    variant: Variant, source: Source, request: Request, first: tuple[int, StampedFrame]
) -> dict[str, _Target]:
    """Make a tracker for each target; without any, one that starts on the first true box."""
    options = [*request.target, *(read_targets(request.targets) if request.targets else [])]
    configuration = parameter_options.chosen(variant, request)
    parameters, settings = configuration.tracker, configuration.session
    if not options:
        truth = None if settings.target.box else _first_truth(source, request, first[1].stamp_ns)
        tracker = OfflineTracker(
            variant, parameters, settings, first_truth=truth, max_diff=request.max_diff
        )
        box = settings.target.box
        return {"1": _Target(tracker, {first[0]: box} if box else {})}
    made = {}
    for name, boxes in by_name(options, first[0]).items():
        initial = boxes.get(first[0])
        later = {frame: box for frame, box in boxes.items() if frame != first[0]}
        own = with_target(settings, initial) if initial else settings
        tracker = OfflineTracker(variant, parameters, own, targets=later, max_diff=request.max_diff)
        made[name] = _Target(tracker, boxes)
    return made


def _first_truth(source: Source, request: Request, first_ns: int) -> Truth:
    earliest = first_ns - max_diff_ns(request.max_diff)
    truth = next((t for t in source.truth() if t.stamp_ns >= earliest), None)
    if truth is None:
        raise UsageError(
            f"{request.source} has no truth to start on; give the vehicle's box in the first image "
            "with --target x,y,w,h"
        )
    return truth


def _doubting(frames: Numbered, targets: Mapping[str, _Target]) -> Numbered:
    """Pass frames on; note what speaks against the targets given for them."""
    for number, found in frames:
        for name, target in targets.items():
            box = target.boxes.get(number)
            if box is not None and found.frame is not None:
                notices = target.tracker.notices
                notices += [
                    f"the target {name} is doubtful: {why}" for why in doubts(found.frame, box)
                ]
        yield number, found
