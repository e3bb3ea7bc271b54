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

"""The files of a comparison on many vehicles: a page, Markdown, CSV and JSON."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from vehicle_pf_tracker.evaluation.report.page import render
from vehicle_pf_tracker.evaluation.tables import (
    NOTHING,
    Header,
    Table,
    TableCell,
    csv_text,
    markdown,
)
from vehicle_pf_tracker.evaluation.traffic.comparison import TrafficResult
from vehicle_pf_tracker.offline.output_files import make_folder, write_json, write_text
from vehicle_pf_tracker.offline.run_folder import versions

NAME = "traffic"
"""Name of the files without their suffix."""

COLUMNS: Mapping[str, tuple[str, int]] = MappingProxyType(
    {
        "HOTA": ("HOTA", 1),
        "DetA": ("DetA", 1),
        "AssA": ("AssA", 1),
        "IDF1": ("IDF1", 1),
        "MOTA": ("MOTA", 1),
        "IDSW": ("switches", 1),
        "Frag": ("fragm.", 1),
        "kept": ("identity kept", 0),
        "count_error": ("count error", 1),
        "step_ms": ("ms", 1),
    }
)
"""Measures, with their headings and decimals."""
_LOWER_IS_BETTER = ("IDSW", "Frag", "step_ms")

RULES = """\
HOTA, DetA, AssA, IDF1 and MOTA (percent), identity switches and fragmentations are TrackEval's, at
an overlap of a half where they need one; means over seeds. Totally hidden vehicles are not scored.
*Identity kept*: share of total occlusions after which a vehicle has the identity it had before.
*Count error*: crossings of a line through the middle of the image, against the true ones. *ms* is
processor time per frame: of `traffic` with its work on pixels, of the baselines for boxes alone.
"-low" are baselines with thresholds lowered by hand for CenterNet's scores.
"""


@dataclass(frozen=True, slots=True)
class Line:
    """Summary of one system in one case.

    Attributes
    ----------
    scene, source, system : str
        The case and the system.
    runs : int
        Number of seeds.
    values : dict of str to float
        Means by the names of `COLUMNS`; what cannot be measured is left out.
    occlusions, true : int
        Total occlusions that are judged, and true crossings.
    """

    scene: str
    source: str
    system: str
    runs: int
    values: dict[str, float]
    occlusions: int
    true: int


def summarise(results: Sequence[TrafficResult]) -> list[Line]:
    """Average the seeds of every system in every case, in the order of the results."""
    groups: dict[tuple[str, str, str], list[TrafficResult]] = {}
    for one in results:
        groups.setdefault((one.scene, one.source, one.system), []).append(one)
    return [_line(*key, group) for key, group in groups.items()]


def _line(scene: str, source: str, system: str, runs: Sequence[TrafficResult]) -> Line:
    first = runs[0]
    values = {
        name: statistics.fmean(run.values[name] for run in runs)
        for name in COLUMNS
        if name in first.values
    }
    return Line(scene, source, system, len(runs), values, first.occlusions, first.true)


def write_traffic_report(
    results: Sequence[TrafficResult], folder: Path, options: Mapping[str, Any]
) -> dict[str, Table]:
    """Write the four files, and return their tables.

    Parameters
    ----------
    results : sequence of TrafficResult
        Results of all systems.
    folder : Path
        Made where it is missing.
    options : mapping
        Plain values that say how the comparison was made; ``command`` is its command line.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    make_folder(folder)
    lines = summarise(results)
    shown = tables(lines)
    page = render("traffic.html", tables=shown, about=RULES, command=" ".join(options["command"]))
    parts = [f"## {title}\n\n{markdown(*table.texts())}" for title, table in shown.items()]
    rows = [
        [line.scene, line.source, line.system, line.runs,
         *(line.values.get(name) for name in COLUMNS), line.occlusions, line.true]
        for line in lines
    ]  # fmt: skip
    header = ["scene", "detections", "system", "runs", *COLUMNS, "occlusions", "true"]
    texts = {
        "html": page,
        "md": "\n".join(["# Many vehicles\n", RULES, *parts]),
        "csv": csv_text(header, rows),
    }
    for suffix, text in texts.items():
        write_text(folder / f"{NAME}.{suffix}", text)
    document = {
        "options": dict(options),
        "versions": versions(),
        "lines": [asdict(line) for line in lines],
        "results": [asdict(result) for result in results],
    }
    write_json(folder / f"{NAME}.json", document)
    return shown


def tables(lines: Sequence[Line]) -> dict[str, Table]:
    """Make a table of each scene and source of detections, by their names."""
    cases: dict[str, list[Line]] = {}
    for line in lines:
        cases.setdefault(f"{line.scene}, {line.source}", []).append(line)
    return {title: _table(group) for title, group in cases.items()}


def _table(lines: Sequence[Line]) -> Table:
    names = [name for name in COLUMNS if any(name in line.values for line in lines)]
    best = {
        name: max(_rated(line.values[name], name) for line in lines if name in line.values)
        for name in names
    }
    rows = {line.system: [_cell(line, name, best[name]) for name in names] for line in lines}
    return Table([Header(COLUMNS[name][0]) for name in names], rows)


def _cell(line: Line, name: str, best: float) -> TableCell:
    value = line.values.get(name)
    if value is None:
        return TableCell(NOTHING)
    decimals = COLUMNS[name][1]
    text = f"{value:.{decimals}f}"
    if name == "kept":
        text += f" % of {line.occlusions}"
    elif name == "count_error":
        text = f"{value:+.{decimals}f} % of {line.true}"
    elif name in {"IDSW", "Frag"} and value == int(value):
        text = str(int(value))
    return TableCell(text, value, best=_rated(value, name) == best)


def _rated(value: float, name: str) -> float:
    """Return a number that is larger where the value is better."""
    if name == "count_error":
        return -abs(value)
    return -value if name in _LOWER_IS_BETTER else value
