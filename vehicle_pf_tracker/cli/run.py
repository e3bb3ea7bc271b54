# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`run`: track vehicles in any source offline, show them, and score them where there is truth."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.cli.console import (
    PROGRAM_NAME,
    UsageError,
    counting,
    print_rows,
    tell_notices,
)
from vehicle_pf_tracker.cli.many_sources import follow_each
from vehicle_pf_tracker.cli.requests import MaxDiffOption, NameChoices, TruthOptions, option, switch
from vehicle_pf_tracker.cli.serving import served
from vehicle_pf_tracker.cli.source_lists import SeveralSources
from vehicle_pf_tracker.cli.source_part import cut_short, numbered_part
from vehicle_pf_tracker.cli.stopping import Stop, stopping
from vehicle_pf_tracker.cli.target_options import by_name
from vehicle_pf_tracker.cli.tracking_options import chosen
from vehicle_pf_tracker.core.addresses import short_name
from vehicle_pf_tracker.core.association import max_diff_ns
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.evaluation.columns import METRIC_COLUMNS, number_text
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.following.driver import OfflineTracker, follow
from vehicle_pf_tracker.recordings.source import ImageSource, open_source
from vehicle_pf_tracker.recordings.truth.files import Beside
from vehicle_pf_tracker.results.estimates import EstimateRow, summary, write_tracks
from vehicle_pf_tracker.results.output_files import write_json
from vehicle_pf_tracker.results.run_folder import (
    ESTIMATES_FILE,
    METRICS_FILE,
    RUN_FILE,
    describe_run,
    write_run,
)
from vehicle_pf_tracker.results.trajectories import trajectory_files, write_trajectories
from vehicle_pf_tracker.showing.estimates_recording import run_recording
from vehicle_pf_tracker.showing.pictures import Pictures
from vehicle_pf_tracker.trackers.registry import VARIANTS, Variant, find_variant

SHEET_FILE = "summary.png"
"""Picture of the key frames."""
TRACKS = "tracks.csv"
"""Table of several targets, instead of `ESTIMATES_FILE`."""
PRODUCTS = (ESTIMATES_FILE, METRICS_FILE, RUN_FILE, SHEET_FILE, TRACKS)
"""Files of a run, which `--overwrite` replaces: no others in the folder are touched."""


@dataclass(frozen=True, kw_only=True)
class Request(SeveralSources, MaxDiffOption, TruthOptions):
    """Request of `run`."""

    variant: str = option(
        default="fusion", choices=NameChoices(VARIANTS), metavar="NAME",
        help=f"one of: {', '.join(VARIANTS)}, or a plug-in (default: fusion)",
    )  # fmt: skip
    output: Path | None = option(
        "-o", metavar="DIR",
        help="folder for estimates.csv, run.json, summary.png, and metrics.json where there is "
        "truth (default: results/ and the source's name)",
    )  # fmt: skip
    recording: Path | None = option(
        metavar="OUT",
        help="write images (JPEG), truth, estimates and Foxglove's annotations to the rosbag2 "
        "folder OUT",
    )  # fmt: skip
    tum: Path | None = option(
        metavar="FILE",
        help="write the positions (px) as a TUM trajectory for evo, and the true ones as "
        "FILE_truth; for several targets FILE_NAME",
    )  # fmt: skip
    particles: bool = switch(help="draw the particles too")


def run(request: Request) -> int:
    """Track in the source, or in each of several, and print a summary."""
    if not request.is_of_several:
        return run_one(request)
    variant = find_variant(request.variant)
    return follow_each(request, variant, run_one, functools.partial(chosen, variant))


def run_one(request: Request) -> int:
    """Track in one source, write the results, and print a summary of each target."""
    variant = find_variant(request.variant)
    # What cannot be read of the truth beside images costs the scores, and not the run.
    source = open_source(
        request.source,
        topic=request.topic,
        fps=request.fps,
        truth=request.truth,
        identity=request.id,
        beside=Beside.NOTED,
    )
    path = request.output or Path("results", short_name(request.source) or "run")
    outputs = (Products(path, PRODUCTS), request.video, request.recording, *_tum_files(request))
    stop = Stop()
    with claimed(outputs, (*request.inputs, request.truth), overwrite=request.overwrite):
        status = _track(request, variant, source, path, stop)
    return stop.ended(status)


def _track(
    request: Request, variant: Variant, source: ImageSource, folder: Path, stop: Stop
) -> int:
    """Track, write the results, print notices and summaries, and return the exit status."""
    sheet = folder / SHEET_FILE
    pictures = Pictures(request.video, particles=request.particles, sheet=sheet)
    trackers, rows = _follow(request, variant, source, stop, pictures)
    ended = cut_short(stop, source, max(map(len, rows.values())))
    of_trackers = [
        f"{name}: {sentence}" if len(trackers) > 1 else sentence
        for name, tracker in trackers.items()
        for sentence in tracker.notices
    ]
    pictures.write_sheet()  # before the notices, which say whether it failed
    side = pictures.side
    notices = [*source.notices, *of_trackers, *side.notices, *ended]
    tell_notices(notices)
    (folder / TRACKS).unlink(missing_ok=True)
    for name, tracker in trackers.items():
        provenance = request.command, request.source, source.image_topic, notices
        description = describe_run(tracker.session, tracker.start_frame, *provenance)
        part = folder if len(trackers) == 1 else folder / name
        write_run(part, rows[name], description, tracker.road_columns)
    if len(trackers) > 1:
        write_tracks(folder / TRACKS, rows)
    else:
        _score(request, source, folder, *rows.values())
    if request.tum:
        write_trajectories(request.tum, rows, source.truth())
    for name, of_target in rows.items():
        size = trackers[name].session.size
        print(f"{name + ': ' if len(rows) > 1 else ''}{summary(of_target, size)}")
    has_sheet = sheet.exists()
    print(f"results are in {folder}{f'; {SHEET_FILE} shows the key frames' if has_sheet else ''}")
    if pictures.has_video:
        print(f"the video is {request.video}")
    if request.recording and not side.failed(_recording_of(request)):
        print(f"the recording is {request.recording}, for Foxglove and `ros2 bag play`")
    return stop.status if ended else int(bool(side.notices))


def _tum_files(request: Request) -> list[Path]:
    """Return every trajectory file that the run may write."""
    if request.tum is None:
        return []
    # Only the names count here; frames are checked when the first one is known.
    names = list(by_name(request.given_targets(), 1))
    return trajectory_files(request.tum, names)


def _follow(
    request: Request, variant: Variant, source: ImageSource, stop: Stop, pictures: Pictures
) -> tuple[dict[str, OfflineTracker], dict[str, list[EstimateRow]]]:
    """Follow all targets to the end or to a signal; return their trackers and rows by name."""
    with (
        stopping(stop),
        counting("tracked") as progress,
        served(request.serve, request.token, pictures.side) as page,
    ):
        (first, found), frames = numbered_part(source, request.start, request.end, stop, progress)
        trackers = _trackers(request, variant, source, first, found.stamp_ns)
        if not request.recording:
            return trackers, follow(trackers, frames, pictures, page=page)
        node = f"{variant.name}_tracker"
        recording = run_recording(request.recording, node, list(trackers), source.truth())
        with pictures.side.growing(_recording_of(request), recording) as on_frame:
            return trackers, follow(trackers, frames, pictures, on_frame, page)


def _recording_of(request: Request) -> str:
    """Name the recording of the run, for sentences."""
    return f"the recording {request.recording}"


def _trackers(
    request: Request, variant: Variant, source: ImageSource, first: int, first_ns: int
) -> dict[str, OfflineTracker]:
    """Make a tracker for each target given; without any, for the one configured, or for truth."""
    configuration = chosen(variant, request)
    targets = by_name(request.given_targets(), first)
    box = configuration.session.target.box
    targets = targets or {"1": {} if box is None else {first: box}}
    truth = None
    if not any(targets.values()):
        earliest = first_ns - max_diff_ns(request.max_diff)
        truth = next((one for one in source.truth() if one.stamp_ns >= earliest), None)
        if truth is None:
            tell_notices(source.notices)  # they say which truth was seen and not read
            raise UsageError(
                f"{request.source} has no truth to start on; draw a box around the vehicle with "
                f"`{PROGRAM_NAME} pick {request.source}`, or give it with --target x,y,w,h"
            )
    return {
        name: OfflineTracker(
            variant,
            configuration.tracker,
            configuration.session,
            first_truth=truth,
            targets=boxes,
            max_diff=request.max_diff,
        )
        for name, boxes in targets.items()
    }


def _score(
    request: Request, source: ImageSource, folder: Path, rows: Sequence[EstimateRow]
) -> None:
    """Write and print the metrics of the run of one target, where there is truth."""
    metrics = measure(score_frames(rows, source.truth(), request.max_diff))
    if metrics.frames_scored:
        write_json(folder / METRICS_FILE, metrics.to_json())
        print_rows(["", request.variant], run_rows(metrics))


def run_rows(metrics: Metrics) -> list[list[str]]:
    """Return a row for each metric that the run has: its title, and its value."""
    values = [(column, column.value(metrics)) for column in METRIC_COLUMNS]
    return [
        [column.title, number_text(value, column.decimals)]
        for column, value in values
        if value is not None
    ]
