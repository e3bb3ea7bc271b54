# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The plan of a grid: its systems, recordings and seeds, and so its cells."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import NamedTuple

from vehicle_pf_tracker.core.association import PAIRED_WITHIN_S
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.cache_key import result_key, variant_modules
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    FOLDER_FORMAT,
    PLAN_FILE,
    RECORDINGS_FOLDER,
    RESTART_KEY,
    TRUTH_FILE,
    Source,
    cell_folder,
    safe_name,
    write_truth,
)
from vehicle_pf_tracker.evaluation.systems import System
from vehicle_pf_tracker.results.output_files import make_folder, write_json
from vehicle_pf_tracker.results.run_folder import versions
from vehicle_pf_tracker.trackers.registry import find_variant


@dataclass(frozen=True, slots=True)
class GridCell:
    """One run: a system on a recording with a seed.

    Attributes
    ----------
    source : Source
        The recording.
    system : System
        The system that tracks the vehicle.
    seed : int
        Seed of the random numbers.
    max_diff : float
        Largest difference of stamps that belong together, in s.
    restart : int or None
        Run a second time, with restarts so many frames after a failure; None: once.
    """

    source: Source
    system: System
    seed: int
    max_diff: float
    restart: int | None = None

    def key(self) -> str:
        """Return its cache key: recording, parameters, seed, code and versions."""
        facts = {
            "recording": self.source.digest,
            "topic": self.source.topic,
            "max_diff": self.max_diff,
            RESTART_KEY: self.restart,
            **self.system.facts(self.seed),
        }
        # A baseline runs none of our trackers: their changes leave its results valid.
        kind = self.system.kind
        modules = () if self.system.is_baseline else variant_modules(find_variant(kind))
        return result_key(facts, modules)

    def folder(self, evaluation: Path) -> Path:
        """Return its folder in the folder of the evaluation."""
        return cell_folder(evaluation, self.source.name, self.system.label, self.seed)


class Part(NamedTuple):
    """One of several equal parts of the cells, from 1."""

    number: int
    total: int

    @classmethod
    def parse(cls, text: str) -> Part:
        """Read ``2/4``.

        Raises
        ------
        InputError
            If it is not a part.
        """
        number, _, total = text.partition("/")
        if number.isdecimal() and total.isdecimal() and 1 <= int(number) <= int(total):
            return cls(int(number), int(total))
        raise InputError(f"{text!r} is not a part: 2/4 is the second of four")


ALL_CELLS = Part(1, 1)
"""The only part of an evaluation that one machine runs."""


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
    part : Part
        Share of the cells that is run.
    restart : int or None
        Frames from a failure to the next start, in a second run of each cell; None: no such run.

    Raises
    ------
    InputError
        If two systems would share a folder.
    """

    recordings: Mapping[Source, Mapping[int, Truth]]
    systems: Sequence[System]
    seeds: Sequence[int]
    command: list[str]
    max_diff: float = PAIRED_WITHIN_S
    part: Part = ALL_CELLS
    restart: int | None = None

    def __post_init__(self) -> None:
        taken: set[str] = set()
        for system in self.systems:
            # By the folder's name: labels that differ in signs only would share it.
            name = safe_name(system.label)
            if name in taken:
                raise InputError(f"several systems would be called {system.label}; name them apart")
            taken.add(name)

    def cells(self) -> list[GridCell]:
        """Return the cells of this part, recording by recording."""
        # Baselines are slow: begun last, they would be waited for.
        ordered = sorted(self.systems, key=lambda system: not system.is_baseline)
        whole = [
            GridCell(source, system, seed, self.max_diff, self.restart)
            for source, system in itertools.product(self.recordings, ordered)
            for seed in system.seeds(self.seeds)
        ]
        # One in so many, so that every part has its share of the slow systems and recordings.
        return whole[self.part.number - 1 :: self.part.total]

    def write(self, folder: Path) -> None:
        """Write `evaluation.json` and the truth of every recording."""
        for source, truths in self.recordings.items():
            write_truth(make_folder(folder / RECORDINGS_FOLDER / source.name) / TRUTH_FILE, truths)
        # The seeds of each system, too: a reader of the folder need not know which are
        # deterministic.
        restart = {} if self.restart is None else {RESTART_KEY: self.restart}
        plan = {
            "format": FOLDER_FORMAT,
            "command": self.command,
            "recordings": [asdict(source) for source in self.recordings],
            "systems": [
                {**system.to_json(), "seeds": list(system.seeds(self.seeds))}
                for system in self.systems
            ],
            "seeds": list(self.seeds),
            "versions": versions(),
            "options": {"max_diff": self.max_diff, **restart},
        }
        write_json(folder / PLAN_FILE, plan)
