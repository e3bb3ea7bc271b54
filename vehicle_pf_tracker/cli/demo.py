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

"""`demo`: recording, node, lock-step replay through ROS, evaluation against truth."""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from vehicle_pf_tracker.cli.console import show, tell_notices
from vehicle_pf_tracker.cli.replay_progress import progress_view
from vehicle_pf_tracker.cli.synth import record_scene
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.estimates_recording import write_with_estimates
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.offline import OfflineTracker
from vehicle_pf_tracker.evaluation.output_files import make_folder, write_text
from vehicle_pf_tracker.evaluation.plots import overview_figure, save
from vehicle_pf_tracker.evaluation.run_folder import RunFolder, RunInfo, describe_run
from vehicle_pf_tracker.evaluation.scores import Scores, score_frames
from vehicle_pf_tracker.evaluation.tables import Comparison, MetricRow, comparison
from vehicle_pf_tracker.parameters.table import Value, from_mapping
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.scenes.catalogue import make_scene
from vehicle_pf_tracker.trackers.registry import find_variant

SCENE, SCENE_SEED = "highway", 0
ROS_SEED = 0
_PATIENCE = 600.0
"""Patience with a busy machine, s; a quiet one needs a few, and a node that ends is noticed at
once."""

# Particles and features are the same for both. Each has its own best sigma, found on other scenes
# and seeds: `python -m reproduction.demo_sigma`.
CONTESTANTS: Mapping[str, Mapping[str, Value]] = MappingProxyType(
    {
        "apf": {"num_particles": 200, "histogram_bits": 3, "motion.sigma_w": 5.0},
        "pf": {"num_particles": 200, "histogram_bits": 3, "sigma": 2.0},
    }
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this verb."""
    add = parser.add_argument
    add(
        "-o", "--output", type=Path, default=Path("results/demo"), metavar="DIR",
        help="folder for recordings, results and pictures (default: results/demo)",
    )  # fmt: skip
    add(
        "--seeds", type=int, default=10, metavar="N",
        help="how many more seeds to run offline (default: 10)",
    )  # fmt: skip


def run(args: argparse.Namespace) -> int:
    """Run the whole chain; return 1 if frames were lost or ROS and offline runs differ."""
    folder = make_folder(args.output)
    recording = _record(folder / "recording")
    answers = {name: _through_ros(recording, name) for name in CONTESTANTS}
    truth = recording.truth()
    scores = {name: score_frames(rows, truth) for name, rows in answers.items()}
    metrics = {name: measure(scored) for name, scored in scores.items()}
    same = {}
    for name, rows in answers.items():
        tracker = _offline(recording, name, ROS_SEED)
        same[name] = _numbers(_track(recording, tracker)) == _numbers(rows)
        _write(folder / name, rows, metrics[name], tracker, args.command)
    others = {name: _other_seeds(recording, name, args.seeds) for name in CONTESTANTS}
    table = _table(metrics, answers, same, others)
    show(table)
    write_text(folder / "summary.md", table.to_markdown())
    write_text(folder / "summary.csv", table.to_csv())
    _draw(recording, scores, folder / "demo.png")
    runs = {f"{name}_tracker": rows for name, rows in answers.items()}
    write_with_estimates(folder / "with_estimates", recording, runs, overwrite=True)
    print(
        f"results are in {folder}: demo.png shows them, {folder / 'with_estimates'} opens in "
        "Foxglove and evo"
    )
    complete = all(len(rows) == recording.frame_count for rows in answers.values())
    return 0 if complete and all(same.values()) else 1


def _record(path: Path) -> Recording:
    print(f"1. a recording of the scene {SCENE!r} with exact truth: {path}", flush=True)
    record_scene(make_scene(SCENE, seed=SCENE_SEED), path, overwrite=True)
    return Recording(path)


def _through_ros(recording: Recording, name: str) -> Sequence[EstimateRow]:
    """Replay in lock-step to a node that runs as a process of its own."""
    _stay_local()
    from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
    from vehicle_pf_tracker.ros.replay.replaying import replay
    from vehicle_pf_tracker.ros.replay.tracker_process import tracker_process

    print(f"2. the node {name}_tracker, fed in lock-step through ROS", flush=True)
    node = f"/{name}_tracker"
    options = ReplayOptions(lockstep=True, nodes=(node,), timeout=_PATIENCE)
    parameters = {**CONTESTANTS[name], "seed": ROS_SEED, "queue_depth": 10}
    with (
        tracker_process(name, parameters, recording.image_topic) as tracker,
        progress_view() as on_progress,
    ):
        report = replay(
            recording,
            options,
            on_progress,
            lambda sentence: tell_notices([sentence]),
            tracker.check,
        )
    if report.interrupted:
        raise KeyboardInterrupt
    answered = report.nodes[0]
    print(f"   {report.frames} frames out, {answered.answered} estimates in", flush=True)
    if answered.answered != report.frames:
        raise InputError(f"{node} answered {answered.answered} of {report.frames} frames")
    return answered.rows


def _stay_local() -> None:
    """Choose a ROS domain of its own, away from robots and other demos, unless the user has."""
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 101))
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")


def _offline(recording: Recording, name: str, seed: int) -> OfflineTracker:
    variant = find_variant(name)
    parameters = from_mapping(variant.parameters, {**CONTESTANTS[name], "seed": seed})
    return OfflineTracker(variant, parameters, first_truth=recording.first_truth())


def _track(recording: Recording, tracker: OfflineTracker) -> list[EstimateRow]:
    return list(tracker.rows((image.stamp_ns, image.frame) for image in recording.frames()))


def _numbers(rows: Sequence[EstimateRow]) -> list[tuple[object, ...]]:
    """Return the part of a result that does not depend on the machine's speed."""
    return [(r.frame, r.stamp_ns, r.x, r.y, r.mode, r.confidence, r.n_eff) for r in rows]


def _other_seeds(recording: Recording, name: str, count: int) -> list[Metrics]:
    print(f"3. {count} more seeds of {name}, offline", flush=True)
    truth = recording.truth()
    return [
        measure(score_frames(_track(recording, _offline(recording, name, seed)), truth))
        for seed in range(ROS_SEED + 1, ROS_SEED + 1 + count)
    ]


def _write(
    path: Path,
    rows: Sequence[EstimateRow],
    metrics: Metrics,
    tracker: OfflineTracker,
    command: Sequence[str],
) -> None:
    recording = path.parent / "recording"
    info = RunInfo(command, str(recording), "", tracker.start_frame, ["estimated through ROS"])
    folder = RunFolder(path)
    folder.write_run(rows, describe_run(info, tracker.session))
    folder.write_metrics(metrics)


def _draw(recording: Recording, scores: Mapping[str, Scores], path: Path) -> None:
    """Draw paths over a frame from the middle, and the errors below."""
    frame = next(recording.frames(recording.duration_ns / 2e9)).frame
    assert frame is not None, "we have just written it"
    save(overview_figure(frame, scores, "through ROS, in lock-step"), path)


def _table(
    metrics: Mapping[str, Metrics],
    answers: Mapping[str, Sequence[EstimateRow]],
    same: Mapping[str, bool],
    others: Mapping[str, Sequence[Metrics]],
) -> Comparison:
    """Compare the runs through ROS, and count over the other seeds."""
    table = comparison(metrics)
    answered = tuple(sum(row.mode != "DROPPED" for row in rows) for rows in answers.values())
    recovered = tuple(
        f"{sum(all(m.recovered) for m in runs)} of {len(runs)}" for runs in others.values()
    )
    extra = (
        MetricRow("estimates in", "", answered),
        MetricRow("same numbers offline", "", tuple(same.values())),
        MetricRow("other seeds that recovered every time", "", recovered),
    )
    return Comparison(table.columns, (*table.lines, *extra))
