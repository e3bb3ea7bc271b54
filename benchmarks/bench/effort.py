# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Effort of a run of the benchmarks."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Effort:
    """Effort of the whole run.

    Attributes
    ----------
    case_seconds : float
        Wall seconds for two pieces of work in turns.
    frames : int
        Frames of each drive that trackers follow.
    passes : int
        Drives.
    starts : int
        Times that each kind of process is started.
    batches, batch_frames : int
        Turns of each node, and images that it gets in one.
    fleet_nodes : int
        Nodes that run at once.
    fleet_seconds : float
        Time that these are watched, s.
    cases : tuple of str
        Patterns of the cases that are measured unless others are named.
    """

    case_seconds: float
    frames: int
    passes: int
    starts: int
    batches: int
    batch_frames: int
    fleet_nodes: int
    fleet_seconds: float
    cases: tuple[str, ...] = ("*",)


# `FULL` follows the whole drive of 112 frames, three times; `QUICK` shows within minutes whether a
# change is worth a full run.
# `TOY` has 21 frames: the first and two turns of ten.
FULL = Effort(
    case_seconds=2.0,
    frames=112,
    passes=3,
    starts=5,
    batches=9,
    batch_frames=60,
    fleet_nodes=8,
    fleet_seconds=30.0,
)
QUICK = Effort(
    case_seconds=0.3,
    frames=30,
    passes=1,
    starts=2,
    batches=3,
    batch_frames=30,
    fleet_nodes=8,
    fleet_seconds=5.0,
)
TOY = Effort(
    case_seconds=0.0,
    frames=21,
    passes=1,
    starts=1,
    batches=1,
    batch_frames=5,
    fleet_nodes=2,
    fleet_seconds=0.5,
    cases=(
        "kernel*/joint512/41x31/vga/n50",
        "kernel/three_features/*",
        "bandwidth/*/n200",
        "step/*/csrt",
        "cost/particles/apf/n50",
        "cost/trackers/apf/4",
        "memory/trackers/apf/*",
        "startup/apf/warm",
        "node/apf/with*_step",
        "memory/node/apf",
        "fleet/*",
    ),
)
"""Some cases of every part, to see that all of them run; its figures mean nothing."""
