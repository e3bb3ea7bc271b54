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

"""`demo`: a synthetic scene, tracked through ROS and offline, scored against truth, and shown."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import MappingProxyType

from vehicle_pf_tracker.cli.console import (
    OnFrames,
    counting,
    show,
    tell_notice,
    tell_notices,
)
from vehicle_pf_tracker.cli.replay import shown_replay
from vehicle_pf_tracker.cli.requests import OverwriteOption, option
from vehicle_pf_tracker.cli.synth import record_scene
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.plots import overview_figure, save
from vehicle_pf_tracker.evaluation.scores import Scores, score_frames
from vehicle_pf_tracker.evaluation.tables import Comparison, MetricRow, comparison
from vehicle_pf_tracker.image.kernels.choice import load_kernels, takes_long
from vehicle_pf_tracker.offline.driver import Numbered, OfflineTracker, follow
from vehicle_pf_tracker.offline.estimates import EstimateRow
from vehicle_pf_tracker.offline.estimates_recording import write_with_estimates
from vehicle_pf_tracker.offline.output_files import make_folder, write_text
from vehicle_pf_tracker.offline.pictures import Pictures
from vehicle_pf_tracker.offline.run_folder import RunFolder, RunInfo, describe_run
from vehicle_pf_tracker.parameters.table import Value, from_mapping
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.scenes.catalogue import make_scene
from vehicle_pf_tracker.trackers.registry import find_variant

SHOWN_SEED = 0
_PATIENCE = 600.0
"""Patience with a busy machine, s; a quiet one needs a few, and a node that ends is noticed at
once."""

# `fusion` is as it ships. `pf` has its best sigma, found on other scenes and seeds: `python -m
# reproduction.demo_sigma`.
CONTESTANTS: Mapping[str, Mapping[str, Value]] = MappingProxyType(
    {
        "fusion": {},
        "pf": {"num_particles": 200, "histogram_bits": 3, "sigma": 2.0},
    }
)
"""Parameters over the defaults, by variant."""


def absence_of_ros() -> str:
    """Return a clause that says why nodes cannot be run here; empty where they can."""
    _stay_local()
    try:
        import_module("vehicle_pf_tracker.ros.replay.replaying")
    except ModuleNotFoundError as error:
        if (error.name or "").startswith(__package__.partition(".")[0]):
            raise  # a fault of ours, not something that is left to install
        return f"ROS is not installed or not sourced (no Python module {error.name})"
    except ImportError as error:
        return f"ROS cannot be loaded ({error})"
    return ""


def _tracker(recording: Recording, name: str) -> OfflineTracker:
    """Make a contestant's tracker, to start on the recording's first true box."""
    variant = find_variant(name)
    parameters = from_mapping(variant.parameters, {**CONTESTANTS[name], "seed": SHOWN_SEED})
    return OfflineTracker(variant, parameters, first_truth=recording.first_truth())


def _numbered(recording: Recording, progress: OnFrames) -> Numbered:
    for number, found in enumerate(recording.frames(), start=1):
        yield number, found
        progress(number, recording.frame_count)


def track_through_ros(recording: Recording) -> dict[str, Sequence[EstimateRow]]:
    """Replay in lock-step, once, to a node of each contestant, each a process of its own.

    Raises
    ------
    InputError
        If a node ends or does not answer every image.
    """
    from vehicle_pf_tracker.ros.replay.discovery import tracker_process
    from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
    from vehicle_pf_tracker.ros.replay.replaying import replay

    nodes = {f"/{name}_tracker": name for name in CONTESTANTS}
    options = ReplayOptions(lockstep=True, nodes=tuple(nodes), timeout=_PATIENCE)
    with ExitStack() as stack:
        on_progress = stack.enter_context(shown_replay())
        fixed = {"seed": SHOWN_SEED, "queue_depth": 10}
        trackers = [
            stack.enter_context(tracker_process(name, {**own, **fixed}, recording.image_topic))
            for name, own in CONTESTANTS.items()
        ]

        def check() -> None:
            for tracker in trackers:
                tracker.check()

        report = replay(recording, options, on_progress, tell_notice, check)
    if report.interrupted:
        raise KeyboardInterrupt
    for node in report.nodes:
        print(f"   {node.name}: {report.frames} frames out, {node.answered} estimates in")
        if node.answered != report.frames:
            raise InputError(f"{node.name} answered {node.answered} of {report.frames} frames")
    rows = {nodes[node.name]: node.rows for node in report.nodes}
    return {name: rows[name] for name in CONTESTANTS}


def _stay_local() -> None:
    """Choose a ROS domain of its own, away from robots and other demos, unless the user has."""
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 101))
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")


SCENE, SCENE_SEED = "highway", 0
PICTURE, VIDEO, ESTIMATES = "demo.png", "demo.mp4", "with_estimates"
PRODUCTS = ("recording", PICTURE, VIDEO, ESTIMATES, "summary.*")


@dataclass(frozen=True, kw_only=True)
class Request(OverwriteOption):
    """Request of `demo`."""

    output: Path = option(
        "-o", type=Path, default=Path("results/demo"), metavar="DIR",
        help="folder for recordings, results, picture and video (default: results/demo)",
    )  # fmt: skip


def run(request: Request) -> int:
    """Run the whole chain; return 1 if ROS and offline runs differ."""
    absence = absence_of_ros()
    if absence:
        tell_notice(f"{absence}, so the nodes are left out and everything is tracked offline")
    with claimed([Products(request.output, PRODUCTS)], [], overwrite=request.overwrite):
        return _run_chain(request, make_folder(request.output), absence)


def _run_chain(request: Request, folder: Path, absence: str) -> int:
    steps = itertools.count(1)
    if takes_long("auto"):
        # Once, and here: the nodes, which start side by side, would each compile all of them.
        _announce(steps, "kernels: the first start compiles for up to a minute, later ones load")
        load_kernels("auto")
    _announce(steps, f"a recording of the scene {SCENE!r} with exact truth")
    recording = record(folder / "recording")
    answers: Mapping[str, Sequence[EstimateRow]] = {}
    if not absence:
        nodes = ", ".join(f"{name}_tracker" for name in CONTESTANTS)
        _announce(steps, f"the nodes {nodes}, fed in lock-step through ROS")
        answers = track_through_ros(recording)
    _announce(steps, f"{', '.join(CONTESTANTS)} offline, and the video")
    trackers = {name: _tracker(recording, name) for name in CONTESTANTS}
    pictures = Pictures(folder / VIDEO)
    with counting("tracked") as progress:
        offline = follow(trackers, _numbered(recording, progress), pictures)
    tell_notices(pictures.notices)
    same = [_numbers(rows) == _numbers(offline[name]) for name, rows in answers.items()]
    found = {name: score_frames(r, recording.truth()) for name, r in (answers or offline).items()}
    _announce(steps, "the picture and the scores")
    _write_runs(folder, recording, trackers, found, request.command, bool(answers))
    _draw(folder, recording, found, bool(answers))
    table = comparison({name: measure(scored) for name, scored in found.items()})
    if same:
        first = MetricRow("same numbers offline", "", tuple(same))
        table = Comparison(table.columns, (*table.lines, first))
    show(table)
    write_text(folder / "summary.md", table.to_markdown())
    write_text(folder / "summary.csv", table.to_csv())
    print(f"the picture is {folder / PICTURE}")
    print(f"the video is {folder / VIDEO}")
    print(f"the recording {folder / ESTIMATES} opens in Foxglove and evo; all else is in {folder}")
    return 0 if all(same) else 1


def _announce(steps: Iterator[int], what: str) -> None:
    print(f"{next(steps)}. {what}", flush=True)


def record(path: Path) -> Recording:
    """Render the scene of the demo into the recording `path`, and open it."""
    record_scene(make_scene(SCENE, seed=SCENE_SEED), path, overwrite=True)
    return Recording(path)


def _numbers(rows: Sequence[EstimateRow]) -> list[tuple[object, ...]]:
    """Return the part of a result that does not depend on the machine's speed."""
    return [(r.frame, r.stamp_ns, r.x, r.y, r.mode, r.confidence, r.n_eff) for r in rows]


def _write_runs(
    folder: Path,
    recording: Recording,
    trackers: Mapping[str, OfflineTracker],
    scores: Mapping[str, Scores],
    command: Sequence[str],
    through_ros: bool,
) -> None:
    """Write a folder for each contestant, and the recording with the estimates of all."""
    notices = ["estimated through ROS"] if through_ros else []
    rows = {name: [frame.row for frame in scored.frames] for name, scored in scores.items()}
    for name, tracker in trackers.items():
        info = RunInfo(command, str(recording.path), "", tracker.start_frame, notices)
        results = RunFolder(folder / name)
        results.write_run(rows[name], describe_run(info, tracker.session))
        results.write_metrics(measure(scores[name]).to_json())
    by_node = {f"{name}_tracker": of_name for name, of_name in rows.items()}
    write_with_estimates(folder / ESTIMATES, recording, by_node, overwrite=True)


def _draw(
    folder: Path, recording: Recording, scores: Mapping[str, Scores], through_ros: bool
) -> None:
    """Draw the paths over a frame from the middle, and the errors below."""
    middle = next(recording.frames(recording.duration_ns / 2e9)).frame
    assert middle is not None, "it was written by this command"
    title = "through ROS, in lock-step" if through_ros else "offline"
    save(overview_figure(middle, scores, title), folder / PICTURE)
