# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`run`: track vehicles in any source offline, show them, and score them where there is truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from vehicle_pf_tracker.cli.console import (
    PROGRAM_NAME,
    UsageError,
    counting,
    print_rows,
    tell_notices,
)
from vehicle_pf_tracker.cli.many_sources import follow_each
from vehicle_pf_tracker.cli.option_values import NameChoices
from vehicle_pf_tracker.cli.requests import option, switch
from vehicle_pf_tracker.cli.serving import served
from vehicle_pf_tracker.cli.shared_options import MaxDiffOption, TruthOptions
from vehicle_pf_tracker.cli.source_lists import SeveralSources
from vehicle_pf_tracker.cli.source_part import cut_short, numbered_part
from vehicle_pf_tracker.cli.stopping import Stop, stopping
from vehicle_pf_tracker.cli.target_options import by_name
from vehicle_pf_tracker.core.addresses import short_name
from vehicle_pf_tracker.core.association import max_diff_ns
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.evaluation.columns import METRIC_COLUMNS, number_text
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker
from vehicle_pf_tracker.following.target_following import follow_targets
from vehicle_pf_tracker.recordings.source import ImageSource, open_source
from vehicle_pf_tracker.recordings.truth.files import Beside
from vehicle_pf_tracker.results.estimates import EstimateRow, summary, write_tracks
from vehicle_pf_tracker.results.output_files import write_json
from vehicle_pf_tracker.results.run_folder import (
    ESTIMATES_FILE,
    METRICS_FILE,
    RUN_FILE,
    describe_target_run,
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

Trackers: TypeAlias = Mapping[str, OfflineTracker]
"""Tracker of each target, by the target's name."""
Rows: TypeAlias = Mapping[str, list[EstimateRow]]
"""Estimates of each target, a row for each frame, by the target's name."""


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
    return follow_each(request, variant, run_one, lambda each: each.configuration(variant))


def run_one(request: Request) -> int:
    """Track in one source, write the results, and print a summary of each target."""
    # 1. Check what the command names; nothing is written yet.
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
    folder = request.output or Path("results", short_name(request.source) or "run")
    outputs = (Products(folder, PRODUCTS), request.video, request.recording, *_tum_files(request))
    stop = Stop()
    with claimed(outputs, (*request.inputs, request.truth), overwrite=request.overwrite):
        # 2. Follow the targets to the end or to a signal.
        sheet = folder / SHEET_FILE
        pictures = Pictures(request.video, particles=request.particles, sheet=sheet)
        trackers, rows = _follow(request, variant, source, stop, pictures)
        ended = cut_short(stop, source, max(map(len, rows.values())))
        pictures.write_sheet()  # before the notices, which say whether it failed
        notices = [*source.notices, *_notices(trackers), *pictures.side.notices, *ended]
        tell_notices(notices)
        # 3. Write the results, score them where there is truth, and say where they are.
        _write(request, source, folder, trackers, rows, notices)
        _tell(request, folder, trackers, rows, pictures)
    return stop.ended(stop.status if ended else int(bool(pictures.side.notices)))


def _tum_files(request: Request) -> list[Path]:
    """Return every trajectory file that the run may write."""
    if request.tum is None:
        return []
    # Only the names count here; frames are checked when the first one is known.
    names = list(by_name(request.given_targets(), 1))
    return trajectory_files(request.tum, names)


def _follow(
    request: Request, variant: Variant, source: ImageSource, stop: Stop, pictures: Pictures
) -> tuple[Trackers, Rows]:
    """Follow all targets to the end or to a signal; return their trackers and rows by name."""
    with (
        stopping(stop),
        counting("tracked") as progress,
        served(request.serve, request.token, pictures.side) as page,
    ):
        (number, first), frames = numbered_part(source, request.start, request.end, stop, progress)
        trackers = _trackers(request, variant, source, number, first.stamp_ns)
        if not request.recording:
            return trackers, follow_targets(trackers, frames, pictures, page=page)
        node = f"{variant.name}_tracker"
        recording = run_recording(request.recording, node, list(trackers), source.truth())
        with pictures.side.growing(_recording_of(request), recording) as on_frame:
            return trackers, follow_targets(trackers, frames, pictures, on_frame, page)


def _recording_of(request: Request) -> str:
    """Name the recording of the run, for sentences."""
    return f"the recording {request.recording}"


def _trackers(
    request: Request, variant: Variant, source: ImageSource, first: int, first_ns: int
) -> Trackers:
    """Make a tracker for each target given; without any, for the one configured, or for truth."""
    configuration = request.configuration(variant)
    targets = by_name(request.given_targets(), first)
    box = configuration.session.target.box
    targets = targets or {"1": {} if box is None else {first: box}}
    truth = None
    if not any(targets.values()):
        earliest_ns = first_ns - max_diff_ns(request.max_diff)
        truth = next((state for state in source.truth() if state.stamp_ns >= earliest_ns), None)
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


def _notices(trackers: Trackers) -> list[str]:
    """Collect the irregularities of all targets, with their names where there are several."""
    return [
        f"{name}: {sentence}" if len(trackers) > 1 else sentence
        for name, tracker in trackers.items()
        for sentence in tracker.notices
    ]


def _write(
    request: Request,
    source: ImageSource,
    folder: Path,
    trackers: Trackers,
    rows: Rows,
    notices: Sequence[str],
) -> None:
    """Write the results of each target, the scores of a single one, and the trajectories."""
    is_single = len(trackers) == 1
    (folder / TRACKS).unlink(missing_ok=True)
    for name, tracker in trackers.items():
        description = describe_target_run(
            tracker.session,
            tracker.start_frame,
            request.command,
            request.source,
            source.image_topic,
            notices,
        )
        own = folder if is_single else folder / name
        write_run(own, rows[name], description, tracker.road_columns)
    if is_single:
        _score(request, source, folder, *rows.values())
    else:
        write_tracks(folder / TRACKS, rows)
    if request.tum:
        write_trajectories(request.tum, rows, source.truth())


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


def _tell(
    request: Request, folder: Path, trackers: Trackers, rows: Rows, pictures: Pictures
) -> None:
    """Print a summary of each target, and where the results are."""
    for name, of_target in rows.items():
        label = f"{name}: " if len(rows) > 1 else ""
        print(f"{label}{summary(of_target, trackers[name].session.size)}")
    has_sheet = (folder / SHEET_FILE).exists()
    print(f"results are in {folder}{f'; {SHEET_FILE} shows the key frames' if has_sheet else ''}")
    if pictures.has_video:
        print(f"the video is {request.video}")
    if request.recording and not pictures.side.failed(_recording_of(request)):
        print(f"the recording is {request.recording}, for Foxglove and `ros2 bag play`")
