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
    fleet_seconds : float
        Time that many nodes at once are watched, s.
    """

    case_seconds: float
    frames: int
    passes: int
    starts: int
    batches: int
    batch_frames: int
    fleet_seconds: float


FULL = Effort(
    case_seconds=2.0,
    frames=112,
    passes=3,
    starts=5,
    batches=9,
    batch_frames=60,
    fleet_seconds=30.0,
)
QUICK = Effort(
    case_seconds=0.3,
    frames=30,
    passes=1,
    starts=2,
    batches=3,
    batch_frames=30,
    fleet_seconds=5.0,
)
