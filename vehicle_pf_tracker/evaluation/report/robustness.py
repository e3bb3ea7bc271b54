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

"""Tables of what stands beside the grid: other starts, re-starts after failures, and speed."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    EvaluationFolder,
    SystemEntry,
    cell_folder,
    read_document,
    safe_name,
)
from vehicle_pf_tracker.evaluation.grid.cells import BESIDE, FRAMES, RESTARTS, SHIFTED
from vehicle_pf_tracker.evaluation.report.page_tables import number_cell
from vehicle_pf_tracker.evaluation.tables import Header, Table
from vehicle_pf_tracker.offline.run_folder import METRICS, damage

Documents = Mapping[str, Sequence[Mapping[str, Any]]]
"""JSON documents of one system, by recording."""
Measure = Callable[[Documents, Documents], float | None]
"""Takes the documents of the robustness runs, and those of the usual start."""


@dataclass(frozen=True, slots=True)
class RobustnessSection:
    """A table with a sentence about its runs."""

    title: str
    about: str
    table: Table


@dataclass(frozen=True, slots=True)
class _Kind:
    """A kind of robustness run: its words, its files below a seed's folder, and its columns."""

    title: str
    about: str
    files: str
    columns: tuple[tuple[Header, str, Measure], ...]


def _mean(key: str) -> Measure:
    return lambda found, _: _mean_of_means(found, lambda document: document.get(key))


def _usual(found: Documents, usual: Documents) -> float | None:
    return _mean("success_auc")({name: usual[name] for name in found if name in usual}, {})


def _change(found: Documents, usual: Documents) -> float | None:
    other, own = _mean("success_auc")(found, usual), _usual(found, usual)
    return None if other is None or own is None else other - own


def _worst(found: Documents, _: Documents) -> float | None:
    values = [document["success_auc"] for some in found.values() for document in some]
    return min((value for value in values if value is not None), default=None)


def _on_target(found: Documents, _: Documents) -> float | None:
    def held(document: Mapping[str, Any]) -> float | None:
        share = document.get("on_target")
        return None if share is None else float(share > 0.5)

    return _mean_of_means(found, held)


def _runs(found: Documents, _: Documents) -> float:
    return sum(map(len, found.values()))


_RUNS = (Header("runs"), "d", _runs)
_KINDS: Mapping[str, _Kind] = MappingProxyType(
    {
        SHIFTED: _Kind(
            "Shifted and scaled starts",
            "Started on the first true box moved by a tenth of its size in eight directions, and "
            "scaled to 0.8, 0.9, 1.1 and 1.2 (OTB's spatial robustness), with the first seed.",
            f"*/{METRICS}",
            (
                (Header("usual start", "success AUC"), ".3f", _usual),
                (Header("other starts", "success AUC"), ".3f", _mean("success_auc")),
                (Header("change", "success AUC"), "+.3f", _change),
                (Header("worst run", "success AUC"), ".3f", _worst),
                (
                    Header("on target", "share of runs", "Runs on target in most visible frames."),
                    ".2f",
                    _on_target,
                ),
                _RUNS,
            ),
        ),
        FRAMES: _Kind(
            "Other first frames",
            "Started on the true box of later frames, and scored from there on (OTB's temporal "
            "robustness), with the first seed.",
            f"*/{METRICS}",
            (
                (Header("success AUC"), ".3f", _mean("success_auc")),
                (Header("precision at 20 px"), ".3f", _mean("precision_20px")),
                (Header("RMSE", "px"), ".1f", _mean("rmse_px")),
                _RUNS,
            ),
        ),
        RESTARTS: _Kind(
            "Failures and re-starts",
            "In the manner of VOT: a track without overlap with the visible vehicle has failed, "
            "and is started anew on the truth five frames later, once the vehicle is in full view.",
            "restarts.json",
            (
                (
                    Header("failures", "per run", "Times that the estimate lost all overlap and "
                           "was restarted."),
                    ".2f",
                    _mean("failures"),
                ),
                (
                    Header("accuracy", "mean overlap", "While it was tracked, from ten frames "
                           "after a start."),
                    ".3f",
                    _mean("accuracy"),
                ),
                (
                    Header("robustness", "", "The chance to live through 30 frames: "
                           "exp(-30 failures / frames)."),
                    ".3f",
                    _mean("robustness"),
                ),
                _RUNS,
            ),
        ),
    }
)  # fmt: skip
"""Kinds of robustness runs, by the name of their folder and option."""


def robustness_sections(folder: EvaluationFolder, order: Sequence[str]) -> list[RobustnessSection]:
    """Read what was asked for besides the grid; systems without a result there are left out."""
    asked = folder.plan.get("options", {})
    systems = {system.label: system for system in folder.systems}
    sections = []
    for name, kind in _KINDS.items():
        rows = {}
        for label in order if asked.get(name) else ():
            below = folder.path / BESIDE / name, f"seed-*/{kind.files}"
            found = {
                entry.name: documents
                for entry in folder.recordings
                if (documents := _read(below[0] / entry.name / safe_name(label), below[1]))
            }
            if found:
                usual = _usual_runs(folder, systems[label])
                cells = [(measure(found, usual), form) for _, form, measure in kind.columns]
                rows[label] = [number_cell(*cell) for cell in cells]
        if rows:
            table = Table([header for header, _, _ in kind.columns], rows)
            sections.append(RobustnessSection(kind.title, kind.about, table))
    return sections


def _usual_runs(folder: EvaluationFolder, system: SystemEntry) -> Documents:
    """Read the metrics of the usual start, of the seed that robustness runs have."""
    seed = folder.seeds_of(system)[0]
    names = [entry.name for entry in folder.recordings]
    roots = {name: cell_folder(folder.path, name, system.label, seed) for name in names}
    return {name: found for name, root in roots.items() if (found := _read(root, METRICS))}


def _read(root: Path, pattern: str) -> list[dict[str, Any]]:
    return list(_documents(root, pattern))


def _documents(root: Path, pattern: str) -> Iterator[dict[str, Any]]:
    for path in sorted(root.glob(pattern)):
        with suppress(InputError):  # a cell that is being written
            if not damage(path.parent):
                yield read_document(path)


def _mean_of_means(
    found: Documents, value: Callable[[Mapping[str, Any]], float | None]
) -> float | None:
    """Return the mean over recordings of the means over their runs."""
    by_recording = ([value(document) for document in documents] for documents in found.values())
    known = ([number for number in values if number is not None] for values in by_recording)
    means = [statistics.fmean(values) for values in known if values]
    return statistics.fmean(means) if means else None


def speed_table(timings: Mapping[str, Any] | None, order: Sequence[str]) -> Table | None:
    """Make a table of step times; None where they were not measured.

    Parameters
    ----------
    timings : mapping or None
        ``{"clock", "cells": [{"recording", "system", "step_ms_p50", "step_ms_p95"}, ...]}``.
    order : sequence of str
        The systems.
    """
    cells = (timings or {}).get("cells", [])
    rows = {}
    for label in order:
        medians, slow = (
            [cell[key] for cell in cells if cell["system"] == label and cell.get(key) is not None]
            for key in ("step_ms_p50", "step_ms_p95")
        )
        if medians:
            middle = statistics.fmean(medians)
            rows[label] = [
                number_cell(middle, ".2f"),
                number_cell(statistics.fmean(slow) if slow else None, ".2f"),
                number_cell(max(medians), ".2f"),
                number_cell(1000.0 / middle if middle > 0 else None, ".0f"),
            ]
    headers = [
        Header("step, median", "ms", "Mean over the recordings of the median step."),
        Header(
            "step, 95 %", "ms", "Mean over the recordings of the time 95 % of steps stay below."
        ),
        Header("slowest recording", "ms", "The largest median of any recording."),
        Header("rate", "frames/s", "One second over the mean median step."),
    ]
    return Table(headers, rows) if rows else None


def speed_note(timings: Mapping[str, Any] | None) -> str:
    """Describe the measurement and the machine."""
    clock = (timings or {}).get("clock", "time of a step")
    processor = " with ".join(map(str, (timings or {}).get("processor", []) or ["unknown"]))
    return (
        f"Measured in a serial pass of its own: {clock}. Processor: {processor} cores. "
        "Compare systems by their ratios; other machines have other times."
    )
