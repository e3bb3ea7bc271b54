"""The folder of an evaluation: the plan, the truth, and what every cell of the grid left there.

::

    evaluation.json                                      the plan
    recordings/<recording>/truth.csv
    cells/<recording>/<system>/seed-<n>/estimates.csv    and metrics.json, run.json; or
    cells/<recording>/<system>/seed-<n>/failed.json      {"reason": a sentence}
    timings.json                                         of a serial pass, where it was asked for
    robustness/<kind>/<recording>/<system>/seed-<n>/     where it was asked for
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.estimates import EstimateRow, read_estimates
from vehicle_pf_tracker.evaluation.results import ESTIMATES, RUN
from vehicle_pf_tracker.evaluation.source import Source
from vehicle_pf_tracker.evaluation.truth_file import read_truth

PLAN, FAILED = "evaluation.json", "failed.json"
TIMINGS = "timings.json"
TRUTH = "truth.csv"


@dataclass(frozen=True, slots=True)
class SystemEntry:
    """A system as the plan names it.

    Attributes
    ----------
    label : str
        Its name in all tables.
    kind : str
        The variant, or the peer as ``peer:<name>``.
    parameter_set : str
        Where its parameters are from; empty for the defaults.
    overrides, parameters : mapping of str to Any
        What was set apart from that, and everything in effect.
    seeds : tuple of int or None
        Its seeds; the first alone for a system that draws nothing. None takes those of the plan.
    """

    label: str
    kind: str
    parameter_set: str
    overrides: Mapping[str, Any]
    parameters: Mapping[str, Any]
    seeds: tuple[int, ...] | None = None


@dataclass(frozen=True, slots=True)
class Cell:
    """One run of the grid: its rows and `run.json`, or the reason why there are none."""

    recording: str
    system: str
    seed: int
    rows: tuple[EstimateRow, ...] | None
    run: Mapping[str, Any]
    reason: str


class EvaluationFolder:
    """Reads the folder of an evaluation.

    Parameters
    ----------
    path : Path
        The folder.

    Attributes
    ----------
    plan : mapping of str to Any
        `evaluation.json` as it is.
    recordings : tuple of Source
        In the order of the plan.
    systems : tuple of SystemEntry
        In the order of the plan.
    seeds : tuple of int
        In the order of the plan.

    Raises
    ------
    InputError
        If it is no such folder, or the plan lacks something.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        if not (path / PLAN).is_file():
            raise InputError(f"{path} is no folder of an evaluation: it has no {PLAN}")
        self.plan: Mapping[str, Any] = read_document(path / PLAN)
        try:
            self.recordings = tuple(Source.from_json(entry) for entry in self.plan["recordings"])
            self.systems = tuple(_system(entry) for entry in self.plan["systems"])
            self.seeds = tuple(map(int, self.plan["seeds"]))
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(f"the plan {path / PLAN} is broken: {error!r}") from error

    def seeds_of(self, system: SystemEntry) -> tuple[int, ...]:
        """Return the seeds that a system runs with."""
        return self.seeds if system.seeds is None else system.seeds

    def truth(self, recording: str) -> dict[int, Truth]:
        """Return the truths of a recording by the number of their frame; empty without any."""
        path = self.path / "recordings" / recording / TRUTH
        return read_truth(path) if path.is_file() else {}

    def cell(self, recording: str, system: str, seed: int) -> Cell:
        """Read one cell of the grid."""
        folder = cell_folder(self.path, recording, system, seed)
        if (folder / FAILED).is_file():
            reason = str(read_document(folder / FAILED).get("reason", "no reason was given"))
            return Cell(recording, system, seed, None, {}, reason)
        if not (folder / ESTIMATES).is_file():
            return Cell(recording, system, seed, None, {}, "it was not run")
        rows = tuple(read_estimates(folder / ESTIMATES))
        run = read_document(folder / RUN) if (folder / RUN).is_file() else {}
        return Cell(recording, system, seed, rows, run, "")

    def timings(self) -> Mapping[str, Any] | None:
        """Return `timings.json`; None where the speed was not measured."""
        return _optional(self.path / TIMINGS)


def cell_folder(folder: Path, recording: str, system: str, seed: int, cells: str = "cells") -> Path:
    """Return the folder of one cell of the evaluation in `folder`."""
    return folder / cells / recording / safe_name(system) / f"seed-{seed}"


def safe_name(label: str) -> str:
    """Return `label` as a name that every file system takes."""
    return "".join(c if c.isalnum() or c in "._-" else "_" for c in label)


def read_document(path: Path) -> dict[str, Any]:
    """Read a JSON object.

    Raises
    ------
    InputError
        If it cannot be read, or is none.
    """
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path} is no JSON: {error}") from error
    if not isinstance(document, dict):
        raise InputError(f"{path} holds no JSON object")
    return document


def _optional(path: Path) -> Mapping[str, Any] | None:
    return read_document(path) if path.is_file() else None


def _system(entry: Mapping[str, Any]) -> SystemEntry:
    kind = entry["variant"] if entry.get("variant") else f"peer:{entry['peer']}"
    return SystemEntry(
        label=str(entry["label"]),
        kind=str(kind),
        parameter_set=str(entry.get("parameter_set") or ""),
        overrides=entry.get("overrides") or {},
        parameters=entry.get("parameters") or {},
        seeds=tuple(map(int, entry["seeds"])) if "seeds" in entry else None,
    )
