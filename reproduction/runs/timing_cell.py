# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A cell that measures time: several trackers in turns, frame by frame, with nothing beside it."""

from __future__ import annotations

import os
import platform
import time
from dataclasses import asdict, dataclass
from typing import Any

from reproduction.experiment import Size
from reproduction.runs.cells import (
    Probe,
    Result,
    SceneChoice,
    System,
    start_session,
)
from vehicle_pf_tracker.parameters.table import to_mapping
from vehicle_pf_tracker.scenes.scene import SceneFrame
from vehicle_pf_tracker.trackers.session import Session

_SEEDS = 3
"""Runs that are timed: each frame of each is a measurement."""
_QUICK_SEEDS = 1
"""Runs of a quick check."""


def timed_seeds(size: Size) -> range:
    """Return the first few seeds of a size, which are timed."""
    return size.seeds[: size.of(_SEEDS, _QUICK_SEEDS)]


@dataclass(frozen=True, slots=True)
class TimingCell:
    """Several trackers with one seed on one scene.

    Its result has `step_ms`: for each tracker's label the thread's processor time of each step,
    the first frame's left out. Each frame is given to all of them before the next is, so that
    whatever slows the machine down for a while slows all of them alike.
    """

    scene: SceneChoice
    systems: tuple[System, ...]
    seed: int

    @property
    def label(self) -> str:
        """Scene and what is done."""
        return f"{self.scene.name} timing"

    @property
    def variants(self) -> tuple[str, ...]:
        """Name the variants in the order of the systems."""
        return tuple(system.variant for system in self.systems)

    @property
    def alone(self) -> bool:
        """True: nothing may run beside it."""
        return True

    def facts(self) -> dict[str, Any]:
        """Give scene, all parameters, and the machine."""
        return {
            "scene": asdict(self.scene),
            "systems": [
                (system.label, system.variant, to_mapping(system.parameters(self.seed)))
                for system in self.systems
            ],
            "processor": [platform.processor(), os.cpu_count()],
        }

    def start(self) -> Probe:
        """Begin to run."""
        return _Timing(self)


class _Timing:
    def __init__(self, cell: TimingCell) -> None:
        self._cell = cell
        self._sessions: dict[str, Session] = {}
        self._times: dict[str, list[float]] = {system.label: [] for system in cell.systems}

    def feed(self, shown: SceneFrame) -> None:
        is_first = not self._sessions
        if is_first:
            self._sessions = {
                system.label: start_session(system, self._cell.seed, shown)
                for system in self._cell.systems
            }
        for label, session in self._sessions.items():
            began = time.thread_time()
            session.feed(shown.frame, shown.truth.stamp_ns)
            if not is_first:
                self._times[label].append(1e3 * (time.thread_time() - began))

    def result(self) -> Result:
        return {"step_ms": self._times}
