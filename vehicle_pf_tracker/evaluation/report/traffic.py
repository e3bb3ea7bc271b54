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

"""Sections on many vehicles: of the report page, and of a page of their own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import read_document
from vehicle_pf_tracker.evaluation.report.page_tables import Header, PageTable, Row, TableCell
from vehicle_pf_tracker.evaluation.traffic.comparison import UNCHANGED
from vehicle_pf_tracker.evaluation.traffic.comparison_report import (
    COLUMNS,
    JSON,
    RULES,
    SHORT,
    Line,
    by_case,
    cell,
)

_LOWER_IS_BETTER = ("IDSW", "Frag", "step_ms")


@dataclass(frozen=True, slots=True)
class TrafficSection:
    """Tables of one scene with one source of detections."""

    title: str
    tables: tuple[tuple[str, PageTable], ...]


def traffic_page(lines: Sequence[Line], command: str) -> str:
    """Return the text of a page that has nothing else."""
    environment = Environment(
        loader=PackageLoader("vehicle_pf_tracker.evaluation.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    template = environment.get_template("traffic.html")
    return template.render(sections=traffic_sections(lines), about=RULES, command=command)


def stored_sections(folder: Path) -> list[TrafficSection]:
    """Read the comparison in an evaluation folder; none where there is none.

    Raises
    ------
    InputError
        If its file is damaged.
    """
    path = folder / JSON
    if not path.is_file():
        return []
    document: Mapping[str, Any] = read_document(path)
    try:
        lines = [Line(**line) for line in document["lines"]]
    except (KeyError, TypeError):
        raise InputError(f"{path} is not the result of evaluate --traffic") from None
    return traffic_sections(lines)


def traffic_sections(lines: Sequence[Line]) -> list[TrafficSection]:
    """Make the sections, one for each scene and source of detections."""
    sections = []
    for title, group in by_case(lines):
        tables = [("All measures, on the detections as they are.", _main(group))]
        if any(line.perturbation != UNCHANGED for line in group):
            tables.append(("The same on detections that were made worse.", _perturbed(group)))
        sections.append(TrafficSection(title, tuple(tables)))
    return sections


def _main(lines: Sequence[Line]) -> PageTable:
    own = [line for line in lines if line.perturbation == UNCHANGED]
    names = [name for name in COLUMNS if any(name in line.values for line in own)]
    best = {name: _best([line.values[name] for line in own if name in line.values], name)
            for name in names}  # fmt: skip
    rows = tuple(
        Row(line.system, None, tuple(_cell(line, name, best[name]) for name in names))
        for line in own
    )
    return PageTable((), tuple(Header(COLUMNS[name][0]) for name in names), rows)


def _perturbed(lines: Sequence[Line]) -> PageTable:
    kinds = list(dict.fromkeys(line.perturbation for line in lines))
    systems = dict.fromkeys(line.system for line in lines)
    found = {(line.system, line.perturbation): line for line in lines}
    headers = tuple(Header(COLUMNS[name][0]) for _ in kinds for name in SHORT)
    groups = tuple(Header(kind, span=len(SHORT)) for kind in kinds)
    best = {
        (kind, name): _best(
            [line.values[name] for line in lines if line.perturbation == kind], name
        )
        for kind in kinds
        for name in SHORT
    }
    rows = tuple(
        Row(
            system,
            None,
            tuple(
                _cell(found[system, kind], name, best[kind, name])
                if (system, kind) in found
                else TableCell("–")
                for kind in kinds
                for name in SHORT
            ),
        )
        for system in systems
    )
    return PageTable(groups, headers, rows)


def _cell(line: Line, name: str, best: float) -> TableCell:
    value = line.values.get(name)
    is_best = value is not None and _rated(value, name) == best
    return TableCell(cell(line, name), value, best=is_best)


def _best(values: Sequence[float], name: str) -> float:
    return max(_rated(value, name) for value in values)


def _rated(value: float, name: str) -> float:
    """Return a number that is larger where the value is better."""
    if name == "count_error":
        return -abs(value)
    return -value if name in _LOWER_IS_BETTER else value
