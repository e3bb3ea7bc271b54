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
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from types import MappingProxyType
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    EvaluationFolder,
    read_document,
    safe_name,
)
from vehicle_pf_tracker.evaluation.grid.cells import BESIDE, FRAMES, RESTARTS, SHIFTED
from vehicle_pf_tracker.evaluation.report.page_tables import number_cell
from vehicle_pf_tracker.evaluation.tables import Header, Table
from vehicle_pf_tracker.offline.run_folder import METRICS, damage

_SUCCESS = "success_auc"
Documents = Mapping[str, Sequence[Mapping[str, Any]]]
"""JSON documents of one system, by recording."""
Measure = Callable[[Documents, Documents], float | None]
"""Takes the documents of the robustness runs, and those of the usual start."""


def _mean(key: str) -> Measure:
    return lambda found, _: _mean_of_means(found, lambda document: document.get(key))


def _usual(found: Documents, usual: Documents) -> float | None:
    return _mean(_SUCCESS)({name: usual[name] for name in found if name in usual}, {})


def _change(found: Documents, usual: Documents) -> float | None:
    other, own = _mean(_SUCCESS)(found, usual), _usual(found, usual)
    return None if other is None or own is None else other - own


def _worst(found: Documents, _: Documents) -> float | None:
    values = [document[_SUCCESS] for some in found.values() for document in some]
    return min((value for value in values if value is not None), default=None)


def _on_target(found: Documents, _: Documents) -> float | None:
    def held(document: Mapping[str, Any]) -> float | None:
        share = document.get("on_target")
        return None if share is None else float(share > 0.5)

    return _mean_of_means(found, held)


def _runs(found: Documents, _: Documents) -> float:
    return sum(map(len, found.values()))


_KINDS: Mapping[str, Mapping[Header, tuple[str, Measure]]] = MappingProxyType(
    {
        SHIFTED: {
            Header("usual start", "success AUC"): (".3f", _usual),
            Header("other starts", "success AUC"): (".3f", _mean(_SUCCESS)),
            Header("change", "success AUC"): ("+.3f", _change),
            Header("worst run", "success AUC"): (".3f", _worst),
            Header("on target", "share of runs"): (".2f", _on_target),
            Header("runs"): ("d", _runs),
        },
        FRAMES: {
            Header("success AUC"): (".3f", _mean(_SUCCESS)),
            Header("precision at 20 px"): (".3f", _mean("precision_20px")),
            Header("RMSE", "px"): (".1f", _mean("rmse_px")),
            Header("runs"): ("d", _runs),
        },
        RESTARTS: {
            Header("failures", "per run"): (".2f", _mean("failures")),
            Header("accuracy", "mean overlap"): (".3f", _mean("accuracy")),
            Header("robustness"): (".3f", _mean("robustness")),
            Header("runs"): ("d", _runs),
        },
    }
)
"""Columns of each kind of robustness run, by the name of its folder and option."""


def robustness_tables(folder: EvaluationFolder, order: Sequence[str]) -> dict[str, Table]:
    """Read what was asked for besides the grid; systems without a result there are left out."""
    asked = folder.plan.get("options", {})
    systems = {system.label: system for system in folder.systems}
    tables = {}
    for kind, columns in _KINDS.items():
        files = "restarts.json" if kind == RESTARTS else f"*/{METRICS}"
        rows = {}
        for label in order if asked.get(kind) else ():
            system = safe_name(label)
            found = _found(folder, f"{BESIDE}/{kind}", f"{system}/seed-*/{files}")
            if found:
                seed = folder.seeds_of(systems[label])[0]  # that of the robustness runs
                usual = _found(folder, "cells", f"{system}/seed-{seed}/{METRICS}")
                rows[label] = [
                    number_cell(measure(found, usual), form) for form, measure in columns.values()
                ]
        if rows:
            tables[kind] = Table(list(columns), rows)
    return tables


def _found(folder: EvaluationFolder, above: str, below: str) -> Documents:
    """Read the documents of each recording that has any: ``above/recording/below``."""
    found: dict[str, list[dict[str, Any]]] = {}
    for entry in folder.recordings:
        for path in sorted((folder.path / above / entry.name).glob(below)):
            with suppress(InputError):  # a cell that is being written
                if not damage(path.parent):
                    found.setdefault(entry.name, []).append(read_document(path))
    return found


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
