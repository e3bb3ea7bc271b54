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

"""The files of a comparison on many vehicles: traffic.md, traffic.csv, traffic.json."""

from __future__ import annotations

import csv
import io
import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from pathlib import Path
from types import MappingProxyType
from typing import Any

from vehicle_pf_tracker.evaluation.tables import NOTHING, markdown
from vehicle_pf_tracker.evaluation.traffic.comparison import UNCHANGED, TrafficResult
from vehicle_pf_tracker.offline.output_files import make_folder, write_json, write_text
from vehicle_pf_tracker.offline.run_folder import versions

CSV, JSON, MARKDOWN = "traffic.csv", "traffic.json", "traffic.md"

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
SHORT = ("HOTA", "IDF1", "IDSW")
"""Measures that are shown of every perturbation."""

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
    scene, source, perturbation, system : str
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
    perturbation: str
    system: str
    runs: int
    values: dict[str, float]
    occlusions: int
    true: int


def summarise(results: Sequence[TrafficResult]) -> list[Line]:
    """Average the seeds of every system in every case, in the order of the results."""
    groups: dict[tuple[str, str, str, str], list[TrafficResult]] = {}
    for one in results:
        key = one.scene, one.source, one.perturbation, one.system
        groups.setdefault(key, []).append(one)
    return [_line(group) for group in groups.values()]


def _line(runs: Sequence[TrafficResult]) -> Line:
    first = runs[0]
    values = {
        name: statistics.fmean(run.scores[name] for run in runs)
        for name in COLUMNS
        if name in first.scores
    }
    if first.occlusions:
        values["kept"] = 100 * statistics.fmean(run.kept / run.occlusions for run in runs)
    if first.true:
        values["count_error"] = 100 * statistics.fmean(run.counted / run.true - 1 for run in runs)
    values["step_ms"] = statistics.fmean(run.step_ms for run in runs)
    return Line(
        first.scene, first.source, first.perturbation, first.system, len(runs), values,
        first.occlusions, first.true,
    )  # fmt: skip


def write_traffic_report(
    results: Sequence[TrafficResult], folder: Path, options: Mapping[str, Any]
) -> list[Line]:
    """Write the three files, and return the lines of their tables.

    Parameters
    ----------
    results : sequence of TrafficResult
        Of all systems.
    folder : Path
        Made where it is missing.
    options : mapping
        Plain values that say how the comparison was made.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    make_folder(folder)
    lines = summarise(results)
    write_text(folder / MARKDOWN, _markdown(lines))
    write_text(folder / CSV, _csv(lines))
    document = {
        "options": dict(options),
        "versions": versions(),
        "lines": [asdict(line) for line in lines],
        "results": [asdict(result) for result in results],
    }
    write_json(folder / JSON, document)
    return lines


def by_case(lines: Sequence[Line]) -> Iterator[tuple[str, list[Line]]]:
    """Group lines by scene and source of detections, with a title for each."""
    for (scene, source), group in groupby(lines, lambda line: (line.scene, line.source)):
        yield f"{scene}, {source}", list(group)


def main_table(lines: Sequence[Line]) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of all measures on unchanged detections."""
    own = [line for line in lines if line.perturbation == UNCHANGED]
    names = [name for name in COLUMNS if any(name in line.values for line in own)]
    header = ["system", *(COLUMNS[name][0] for name in names)]
    return header, [[f"`{line.system}`", *(cell(line, name) for name in names)] for line in own]


def perturbed_table(lines: Sequence[Line]) -> tuple[list[str], list[list[str]]]:
    """Return headings and rows of `SHORT` on unchanged and perturbed detections."""
    kinds = list(dict.fromkeys(line.perturbation for line in lines))
    found = {(line.system, line.perturbation): line for line in lines}
    systems = dict.fromkeys(line.system for line in lines)
    rows = [
        [f"`{system}`", *(_short(found.get((system, kind))) for kind in kinds)]
        for system in systems
    ]
    return ["HOTA / IDF1 / switches", *kinds], rows


def cell(line: Line, name: str) -> str:
    """Return the text of one measure."""
    value = line.values.get(name)
    if value is None:
        return NOTHING
    decimals = COLUMNS[name][1]
    if name == "kept":
        return f"{value:.{decimals}f} % of {line.occlusions}"
    if name == "count_error":
        return f"{value:+.{decimals}f} % of {line.true}"
    if name in {"IDSW", "Frag"} and value == int(value):
        return str(int(value))
    return f"{value:.{decimals}f}"


def _short(line: Line | None) -> str:
    return NOTHING if line is None else " / ".join(cell(line, name) for name in SHORT)


def _markdown(lines: Sequence[Line]) -> str:
    parts = ["# Many vehicles\n", RULES]
    for title, group in by_case(lines):
        parts += [f"## {title}\n", markdown(*main_table(group))]
        if any(line.perturbation != UNCHANGED for line in group):
            parts.append(markdown(*perturbed_table(group)))
    return "\n".join(parts)


def _csv(lines: Sequence[Line]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(
        ["scene", "detections", "perturbation", "system", "runs", *COLUMNS, "occlusions", "true"]
    )
    for line in lines:
        values = [line.values.get(name, "") for name in COLUMNS]
        case = line.scene, line.source, line.perturbation, line.system, line.runs
        writer.writerow([*case, *values, line.occlusions, line.true])
    return text.getvalue()
