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

"""Sections on the robustness runs: other starts, and re-starts after failures."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import (
    EvaluationFolder,
    SystemEntry,
    read_document,
    safe_name,
)
from vehicle_pf_tracker.evaluation.report.columns import SUCCESS, number_text
from vehicle_pf_tracker.evaluation.report.page_tables import Header, PageTable, Row, TableCell
from vehicle_pf_tracker.offline.run_folder import METRICS, damage

SHIFTED, FRAMES, RESTARTS = "shifted_starts", "start_frames", "restarts"
"""Names of the folders, and of the options that ask for them."""
_RESTARTS_FILE = "restarts.json"

Document = Mapping[str, Any]
Documents = Mapping[str, Sequence[Document]]
"""JSON documents of one system, by recording."""


@dataclass(frozen=True, slots=True)
class RobustnessSection:
    """A table with a sentence about its runs."""

    title: str
    about: str
    table: PageTable


def robustness_sections(
    folder: EvaluationFolder, order: Sequence[str], slots: Mapping[str, int]
) -> list[RobustnessSection]:
    """Read what was asked for besides the grid; systems without a result there are left out."""
    asked = folder.plan.get("options", {})
    systems = {system.label: system for system in folder.systems}
    ordered = [systems[label] for label in order]
    makers = {SHIFTED: _shifted, FRAMES: _frames, RESTARTS: _restarts}
    sections = (make(folder, ordered, slots) for kind, make in makers.items() if asked.get(kind))
    return [section for section in sections if section.table.rows]


def _shifted(
    folder: EvaluationFolder, systems: Sequence[SystemEntry], slots: Mapping[str, int]
) -> RobustnessSection:
    rows = []
    for system in systems:
        shifted = _found(folder, SHIFTED, system, f"*/{METRICS}")
        usual = _usual(folder, system, shifted)
        values = [_means(shifted, SUCCESS.key), _means(usual, SUCCESS.key)]
        if values[0] is None or values[1] is None:
            continue
        worst = min(m[SUCCESS.key] for some in shifted.values() for m in some)
        cells = [_cell(values[1], 3), _cell(values[0], 3), _cell(values[0] - values[1], 3, "+")]
        cells += [_cell(worst, 3), _cell(_mean_of_means(shifted, _held), 2)]
        cells.append(_count(shifted))
        rows.append(Row(system.label, slots.get(system.label), tuple(cells)))
    headers = (
        Header("usual start", "success AUC"),
        Header("other starts", "success AUC"),
        Header("change", "success AUC"),
        Header("worst run", "success AUC"),
        Header("on target", "share of runs", "Runs on target in most visible frames."),
        Header("runs"),
    )
    about = (
        "Started on the first true box moved by a tenth of its size in eight directions, and "
        "scaled to 0.8, 0.9, 1.1 and 1.2 (OTB's spatial robustness), with the first seed."
    )
    return RobustnessSection(
        "Shifted and scaled starts", about, PageTable((), headers, tuple(rows))
    )


def _frames(
    folder: EvaluationFolder, systems: Sequence[SystemEntry], slots: Mapping[str, int]
) -> RobustnessSection:
    found = [(s.label, _found(folder, FRAMES, s, f"*/{METRICS}")) for s in systems]
    rows = _mean_rows(found, slots, {SUCCESS.key: 3, "precision_20px": 3, "rmse_px": 1})
    headers = (
        Header("success AUC"),
        Header("precision at 20 px"),
        Header("RMSE", "px"),
        Header("runs"),
    )
    about = (
        "Started on the true box of later frames, and scored from there on (OTB's temporal "
        "robustness), with the first seed."
    )
    return RobustnessSection("Other first frames", about, PageTable((), headers, rows))


def _restarts(
    folder: EvaluationFolder, systems: Sequence[SystemEntry], slots: Mapping[str, int]
) -> RobustnessSection:
    found = [(s.label, _found(folder, RESTARTS, s, _RESTARTS_FILE)) for s in systems]
    rows = _mean_rows(found, slots, {"failures": 2, "accuracy": 3, "robustness": 3})
    headers = (
        Header(
            "failures", "per run", "Times that the estimate lost all overlap and was restarted."
        ),
        Header("accuracy", "mean overlap", "While it was tracked, from ten frames after a start."),
        Header(
            "robustness", "", "The chance to live through 30 frames: exp(-30 failures / frames)."
        ),
        Header("runs"),
    )
    about = (
        "In the manner of VOT: a track without overlap with the visible vehicle has failed, and is "
        "started anew on the truth five frames later, once the vehicle is in full view."
    )
    return RobustnessSection("Failures and re-starts", about, PageTable((), headers, rows))


def _mean_rows(
    found: Sequence[tuple[str, Documents]], slots: Mapping[str, int], decimals: Mapping[str, int]
) -> tuple[Row, ...]:
    """Give each system with results its means, and how many runs they are of."""
    return tuple(
        Row(
            label,
            slots.get(label),
            (*(_cell(_means(of, key), places) for key, places in decimals.items()), _count(of)),
        )
        for label, of in found
        if of
    )


def _found(
    folder: EvaluationFolder, kind: str, system: SystemEntry, pattern: str
) -> dict[str, list[Document]]:
    found = {}
    for entry in folder.recordings:
        root = folder.path / "robustness" / kind / entry.name / safe_name(system.label)
        documents = list(_read(root, f"seed-*/{pattern}"))
        if documents:
            found[entry.name] = documents
    return found


def _usual(
    folder: EvaluationFolder, system: SystemEntry, recordings: Mapping[str, object]
) -> dict[str, list[Document]]:
    seed = folder.seeds_of(system)[0]
    found = {}
    for name in recordings:
        root = folder.path / "cells" / name / safe_name(system.label) / f"seed-{seed}"
        documents = list(_read(root, METRICS))
        if documents:
            found[name] = documents
    return found


def _read(root: Path, pattern: str) -> Iterator[Document]:
    for path in sorted(root.glob(pattern)):
        with suppress(InputError):  # a cell that is being written
            if not damage(path.parent):
                yield read_document(path)


def _held(document: Document) -> float | None:
    share = document.get("on_target")
    return None if share is None else float(share > 0.5)


def _means(found: Documents, key: str) -> float | None:
    return _mean_of_means(found, lambda document: document.get(key))


def _mean_of_means(found: Documents, value: Callable[[Document], float | None]) -> float | None:
    """Return the mean over recordings of the means over their runs."""
    means = []
    for documents in found.values():
        known = [number for number in map(value, documents) if number is not None]
        if known:
            means.append(statistics.fmean(known))
    return statistics.fmean(means) if means else None


def _cell(value: float | None, decimals: int, sign: str = "") -> TableCell:
    text = number_text(value, decimals) if not sign or value is None else f"{value:+.{decimals}f}"
    return TableCell(text, value)


def _count(found: Documents) -> TableCell:
    count = sum(map(len, found.values()))
    return TableCell(str(count), count)
