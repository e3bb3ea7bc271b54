# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Report of a comparison in Markdown, CSV and JSON."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.evaluation.tables import NO_SCORE, Rows, markdown
from vehicle_pf_tracker.evaluation.traffic.comparison import TrafficResult
from vehicle_pf_tracker.results.output_files import make_folder, write_csv, write_json, write_text
from vehicle_pf_tracker.results.run_folder import versions

NAME = "traffic"
"""Name of the files without their suffix."""
COLUMNS: Mapping[str, tuple[str, int]] = {
    "HOTA": ("HOTA", 1),
    "DetA": ("DetA", 1),
    "AssA": ("AssA", 1),
    "IDF1": ("IDF1", 1),
    "MOTA": ("MOTA", 1),
    "IDSW": ("switches", 1),
    "Frag": ("fragm.", 1),
    "kept": ("identity kept", 0),
    "count_error": ("count error", 1),
    "never_found": ("never found", 1),
    "false_numbers": ("false numbers", 1),
    "held": ("held", 0),
    "width": ("width", 1),
    "step_ms": ("ms", 1),
}
"""Measures, with their headings and decimals."""
# Words below the table.
RULES = """\
HOTA, DetA, AssA, IDF1 and MOTA (percent), identity switches and fragmentations are TrackEval's, at
an overlap of a half where they need one; means over seeds. Totally hidden vehicles are not scored.
*Identity kept*: share of total occlusions after which a vehicle has the identity it had before.
*Count error*: crossings of a line through the middle of the image, against the true ones. *Never
found*: vehicles that no box fitted in any image. *False numbers*: those of whose boxes less than
30 % fitted a vehicle. *Held*: percent of the 90 % intervals at 16 lines that hold the true count,
where anything crossed, and *width*, their mean width in vehicles. *ms* is processor time per frame:
of `traffic` with its work on pixels, of the baselines for boxes alone.
"-low" are baselines with thresholds lowered by hand for CenterNet's scores.
"""


def means(results: Sequence[TrafficResult]) -> list[TrafficResult]:
    """Average the seeds of every system in every case, in the order of the results."""
    groups: dict[tuple[str, str, str], list[TrafficResult]] = {}
    for result in results:
        key = result.scene, result.source, result.system
        groups.setdefault(key, []).append(result)
    return [
        replace(
            runs[0],
            seed=None,
            values={
                name: statistics.fmean(run.values[name] for run in runs)
                for name in COLUMNS
                if name in runs[0].values
            },
            runs=len(runs),
        )
        for runs in groups.values()
    ]


def write_traffic_report(
    results: Sequence[TrafficResult], folder: Path, options: Mapping[str, Any]
) -> dict[str, tuple[list[str], Rows]]:
    """Write the three files, and return headings and rows by case.

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
    lines = means(results)
    cases: dict[str, list[TrafficResult]] = {}
    for line in lines:
        cases.setdefault(f"{line.scene}, {line.source}", []).append(line)
    shown = {title: _table(group) for title, group in cases.items()}
    parts = [f"## {title}\n\n{markdown(*table)}" for title, table in shown.items()]
    rows = [
        [
            line.scene,
            line.source,
            line.system,
            line.runs,
            *(line.values.get(name) for name in COLUMNS),
            line.occlusions,
            line.true,
            line.vehicles,
        ]
        for line in lines
    ]
    header = ["scene", "detections", "system", "runs", *COLUMNS, "occlusions", "true", "vehicles"]
    write_text(folder / f"{NAME}.md", "\n".join(["# Many vehicles\n", RULES, *parts]))
    write_csv(folder / f"{NAME}.csv", header, rows)
    document = {
        "options": dict(options),
        "versions": versions(),
        "lines": [asdict(line) for line in lines],
        "results": [asdict(result) for result in results],
    }
    write_json(folder / f"{NAME}.json", document)
    return shown


def _table(lines: Sequence[TrafficResult]) -> tuple[list[str], Rows]:
    names = [name for name in COLUMNS if any(name in line.values for line in lines)]
    rows = [[line.system, *(_text(line, name) for name in names)] for line in lines]
    return ["system", *(COLUMNS[name][0] for name in names)], rows


def _text(line: TrafficResult, name: str) -> str:
    value = line.values.get(name)
    decimals = COLUMNS[name][1]
    if value is None:
        return NO_SCORE
    if name == "kept":
        return f"{value:.{decimals}f} % of {line.occlusions}"
    if name == "count_error":
        return f"{value:+.{decimals}f} % of {line.true}"
    is_count = name in {"IDSW", "Frag", "never_found", "false_numbers"} and value == int(value)
    text = str(int(value)) if is_count else f"{value:.{decimals}f}"
    return f"{text} of {line.vehicles}" if name == "never_found" else text
