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

"""The plan of an evaluation: recordings, systems and seeds, and the cells they make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.core.clock import MAX_DIFF
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    FORMAT,
    PLAN,
    TRUTH,
    Source,
    safe_name,
    write_truth,
)
from vehicle_pf_tracker.evaluation.grid.cells import (
    RESTARTS,
    USUAL,
    GridCell,
    Start,
    System,
    VariantSystem,
    seeds_of,
    shifted_starts,
    start_frames,
)
from vehicle_pf_tracker.offline.output_files import make_folder, write_json
from vehicle_pf_tracker.offline.run_folder import versions


@dataclass(frozen=True, slots=True)
class Robustness:
    """The robustness runs, beside the grid.

    Attributes
    ----------
    shifted_starts : bool
        True for runs from the twelve shifted and scaled boxes of OTB.
    start_frames : int
        Number of runs from other frames.
    restarts : bool
        True for runs that are started anew after each failure, as in VOT.
    """

    shifted_starts: bool = False
    start_frames: int = 0
    restarts: bool = False

    def starts(self, truths: Sequence[Truth]) -> list[Start]:
        """Return the starts on a recording with `truths`."""
        starts = shifted_starts() if self.shifted_starts else []
        starts += start_frames(truths, self.start_frames)
        return starts + ([Start(RESTARTS)] if self.restarts else [])


@dataclass(frozen=True, slots=True)
class Plan:
    """Recordings, systems and seeds of an evaluation.

    Attributes
    ----------
    recordings : mapping of Source to truth
        Recordings, with the truth by the number of the frame.
    systems : sequence of System
        Systems with distinct labels.
    seeds : sequence of int
        Seeds of the systems with randomness; deterministic ones run with the first.
    command : list of str
        Command line that repeats the evaluation.
    max_diff : float
        Largest difference of stamps that belong together, in s.
    robustness : Robustness
        The robustness runs.

    Raises
    ------
    InputError
        If two systems would share a folder.
    """

    recordings: Mapping[Source, Mapping[int, Truth]]
    systems: Sequence[System]
    seeds: Sequence[int]
    command: list[str]
    max_diff: float = MAX_DIFF
    robustness: Robustness = field(default_factory=Robustness)

    def __post_init__(self) -> None:
        taken: set[str] = set()
        for system in self.systems:
            name = safe_name(system.label)
            if name in taken:
                raise InputError(f"several systems would be called {system.label}; name them apart")
            taken.add(name)

    def cells(self) -> list[GridCell]:
        """Return all cells: the grid first, recording by recording, then what is run beside it."""
        grid = [cell for source in self.recordings for cell in self._cells(source, [USUAL])]
        beside = [
            cell
            for source, truths in self.recordings.items()
            for cell in self._cells(source, self.robustness.starts(self._in_order(truths)))
        ]
        return grid + beside

    def _cells(self, source: Source, starts: Sequence[Start]) -> Iterator[GridCell]:
        # Baselines are slow: begun last, they would be waited for.
        ordered = sorted(self.systems, key=lambda system: isinstance(system, VariantSystem))
        for start in starts:
            for system in ordered:
                # Other starts are variation enough; failures are counted over all seeds.
                is_varied = start.kind in {"", RESTARTS}
                seeds = seeds_of(system, self.seeds if is_varied else self.seeds[:1])
                for seed in seeds:
                    yield GridCell(source, system, seed, self.max_diff, start)

    @staticmethod
    def _in_order(truths: Mapping[int, Truth]) -> list[Truth]:
        return sorted(truths.values(), key=lambda truth: truth.stamp_ns)

    def write(self, folder: Path) -> None:
        """Write `evaluation.json` and the truth of every recording.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        for source, truths in self.recordings.items():
            write_truth(make_folder(folder / "recordings" / source.name) / TRUTH, truths)
        write_json(folder / PLAN, self.to_json())

    def to_json(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "format": FORMAT,
            "command": self.command,
            "recordings": [source.to_json() for source in self.recordings],
            "systems": [
                {**system.to_json(), "seeds": list(seeds_of(system, self.seeds))}
                for system in self.systems
            ],
            "seeds": list(self.seeds),
            "versions": versions(),
            "options": {
                "max_diff": self.max_diff,
                "shifted_starts": self.robustness.shifted_starts,
                "start_frames": self.robustness.start_frames,
                "restarts": self.robustness.restarts,
            },
        }
