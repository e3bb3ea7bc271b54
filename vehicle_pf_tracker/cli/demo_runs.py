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

"""Runs of the demo: its contestants offline, and through ROS where that is installed."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from importlib import import_module
from itertools import tee
from types import MappingProxyType

from vehicle_pf_tracker.cli.console import tell_notices
from vehicle_pf_tracker.cli.progress import counting
from vehicle_pf_tracker.cli.replay_progress import progress_view
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.offline import OfflineTracker
from vehicle_pf_tracker.parameters.table import Value, from_mapping
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.trackers.registry import find_variant

SHOWN_SEED = 0
"""Seed of the runs that are shown; the others are counted only."""
_PATIENCE = 600.0
"""Patience with a busy machine, s; a quiet one needs a few, and a node that ends is noticed at
once."""

# `fusion` is as it ships. Of the other two, particles and features are the same, and each has its
# own best sigma, found on other scenes and seeds: `python -m reproduction.demo_sigma`.
CONTESTANTS: Mapping[str, Mapping[str, Value]] = MappingProxyType(
    {
        "fusion": {},
        "apf": {"num_particles": 200, "histogram_bits": 3, "motion.sigma_w": 5.0},
        "pf": {"num_particles": 200, "histogram_bits": 3, "sigma": 2.0},
    }
)
"""Parameters over the defaults, by variant."""


@dataclass(frozen=True, slots=True)
class Run:
    """A tracker and its rows, one for each frame so far."""

    tracker: OfflineTracker
    rows: list[EstimateRow] = field(default_factory=list)


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


def offline_tracker(recording: Recording, name: str, seed: int = SHOWN_SEED) -> OfflineTracker:
    """Make a contestant's tracker, to start on the recording's first true box."""
    variant = find_variant(name)
    parameters = from_mapping(variant.parameters, {**CONTESTANTS[name], "seed": seed})
    return OfflineTracker(variant, parameters, first_truth=recording.first_truth())


def track_offline(recording: Recording, more_seeds: int) -> dict[str, list[Run]]:
    """Track with every contestant, first with the seed shown; each frame is decoded once."""
    seeds = range(SHOWN_SEED, SHOWN_SEED + 1 + more_seeds)
    runs = {
        name: [Run(offline_tracker(recording, name, seed)) for seed in seeds]
        for name in CONTESTANTS
    }
    every = [run for of_name in runs.values() for run in of_name]
    images = ((image.stamp_ns, image.frame) for image in recording.frames())
    streams = [
        run.tracker.rows(stream) for run, stream in zip(every, tee(images, len(every)), strict=True)
    ]
    with counting("tracked") as progress:
        for number, of_frame in enumerate(zip(*streams, strict=True), start=1):
            for run, row in zip(every, of_frame, strict=True):
                run.rows.append(row)
            progress(number, recording.frame_count)
    return runs


def track_through_ros(recording: Recording) -> dict[str, Sequence[EstimateRow]]:
    """Replay in lock-step, once, to a node of each contestant, each a process of its own.

    Raises
    ------
    InputError
        If a node ends or does not answer every image.
    """
    from vehicle_pf_tracker.ros.replay.replay_options import ReplayOptions
    from vehicle_pf_tracker.ros.replay.replaying import replay
    from vehicle_pf_tracker.ros.replay.tracker_process import tracker_process

    nodes = {f"/{name}_tracker": name for name in CONTESTANTS}
    options = ReplayOptions(lockstep=True, nodes=tuple(nodes), timeout=_PATIENCE)
    with ExitStack() as stack:
        on_progress = stack.enter_context(progress_view())
        trackers = [
            stack.enter_context(tracker_process(name, _for_node(name), recording.image_topic))
            for name in CONTESTANTS
        ]

        def check() -> None:
            for tracker in trackers:
                tracker.check()

        report = replay(recording, options, on_progress, lambda s: tell_notices([s]), check)
    if report.interrupted:
        raise KeyboardInterrupt
    for node in report.nodes:
        print(f"   {node.name}: {report.frames} frames out, {node.answered} estimates in")
        if node.answered != report.frames:
            raise InputError(f"{node.name} answered {node.answered} of {report.frames} frames")
    rows = {nodes[node.name]: node.rows for node in report.nodes}
    return {name: rows[name] for name in CONTESTANTS}


def _for_node(name: str) -> dict[str, Value]:
    return {**CONTESTANTS[name], "seed": SHOWN_SEED, "queue_depth": 10}


def _stay_local() -> None:
    """Choose a ROS domain of its own, away from robots and other demos, unless the user has."""
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 101))
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
