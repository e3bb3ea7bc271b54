# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The files of a battery's results: stress.csv, stress.json and stress.md."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from laboratory.stress.running import Result
from laboratory.stress.summary import ALL_CASES, CASE_MEASURES, Group, faults, groups
from vehicle_pf_tracker.evaluation.statistics import Summary
from vehicle_pf_tracker.evaluation.tables import NO_SCORE, markdown
from vehicle_pf_tracker.results.output_files import make_folder, write_json, write_text
from vehicle_pf_tracker.results.run_folder import versions

CSV, JSON, MARKDOWN = "stress.csv", "stress.json", "stress.md"
_TITLES = {
    ALL_CASES: "All cases",
    "kind": "Kinds of cases",
    "path": "Painted total occlusions, by the vehicle's path",
    "course": "Painted total occlusions, by the vehicle's course",
    "occlusion": "Painted total occlusions, by occluder",
    "camera": "Cameras",
}
_RULES = """\
Means with 95 % bootstrap intervals: over the means of the cameras, in the table of cameras over its
cases. *on target*, *IoU* and *RMSE* are those of visible frames; *lost* is the share of cases with
less than 0.9 on target; *doubted* the share of visible frames with the mode OCCLUDED or LOST, *in
full view* the same of frames in which nothing is hidden; *claimed hidden* the share of totally
hidden frames with the mode TRACKING; *false TRACKING* the longest run of frames, per case, with the
mode TRACKING and an error above the true box's diagonal. ECE is pooled over all visible frames.
"""


def write_report(
    results: Sequence[Result], folder: Path, options: dict[str, Any] | None = None
) -> list[Group]:
    """Write the three files, and return the groups of results that their tables show.

    Parameters
    ----------
    results : sequence of Result
        Results of all systems.
    folder : Path
        Folder of the report; made where it is missing.
    options : dict or None
        Plain values that say how the battery was chosen, for `JSON`.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    make_folder(folder)
    compared = groups(results)
    write_text(folder / MARKDOWN, _markdown(compared, list(faults(results))))
    write_text(folder / CSV, _csv(compared))
    write_json(folder / JSON, _json(results, compared, options or {}))
    return compared


def _markdown(compared: Sequence[Group], broken: Sequence[str]) -> str:
    parts = ["# Stress battery\n", _RULES]
    for by, title in _TITLES.items():
        own = [group for group in compared if group.by == by]
        if own:
            parts += [f"## {title}\n", markdown(*table_rows(own))]
    if broken:
        parts += ["## Runs that did not come to their end\n", "".join(f"- {b}\n" for b in broken)]
    return "\n".join(parts)


def table_rows(
    compared: Sequence[Group], *, intervals: bool = True
) -> tuple[list[str], list[list[str]]]:
    """Return the headings and the rows of a table of groups, a line for each."""
    is_named = compared[0].by != ALL_CASES
    names = [name for name in CASE_MEASURES if any(group.summary(name) for group in compared)]
    titles = [CASE_MEASURES[name].title for name in names]
    header = [*([compared[0].by] if is_named else []), "system", "cases", *titles, "ECE"]
    rows = []
    # Systems below each other for every group: they are what is compared.
    for group in sorted(compared, key=lambda each: [f.name for f in compared].index(each.name)):
        cells = [_cell(group, name, intervals) for name in names]
        error = group.reliability().calibration_error
        start = [group.name] if is_named else []
        rows.append([*start, f"`{group.system}`", f"{group.cases}", *cells, _number(error)])
    return header, rows


def _cell(group: Group, measure: str, intervals: bool) -> str:
    summary = group.summary(measure)
    if summary is None:
        return NO_SCORE
    decimals = 1 if CASE_MEASURES[measure].unit else 3
    text = _number(summary.mean, decimals)
    if intervals and summary.low is not None and summary.high is not None:
        text += f" ({_number(summary.low, decimals)}–{_number(summary.high, decimals)})"
    # The mean alone does not say of how many.
    if measure == "recovered":
        recovered, judged = group.recoveries
        text += f", {recovered} of {judged}"
    return text


def _number(value: float | None, decimals: int = 3) -> str:
    return NO_SCORE if value is None else f"{value:.{decimals}f}"


def _csv(compared: Sequence[Group]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["by", "name", "system", "measure", "unit", *_SUMMARY])
    for group in compared:
        for measure, summary in _summaries(group):
            unit = CASE_MEASURES[measure].unit
            values = [getattr(summary, name) for name in _SUMMARY]
            writer.writerow([group.by, group.name, group.system, measure, unit, *values])
    return text.getvalue()


# Fields of `Summary`, in the order of the columns.
_SUMMARY = ("count", "mean", "spread", "low", "high")


def _summaries(group: Group) -> Iterator[tuple[str, Summary]]:
    for measure in CASE_MEASURES:
        summary = group.summary(measure)
        if summary is not None:
            yield measure, summary


def _json(
    results: Sequence[Result], compared: Sequence[Group], options: dict[str, Any]
) -> dict[str, Any]:
    return {
        "options": options,
        "versions": versions(),
        "groups": [_group(group) for group in compared],
        "results": [
            {
                "case": result.case.name,
                "sequence": result.case.sequence,
                "camera": result.case.camera,
                "kind": result.case.kind,
                "labels": dict(result.case.labels),
                "system": result.system,
                "seed": result.seed,
                **result.score.to_json(),
            }
            for result in results
        ],
    }


def _group(group: Group) -> dict[str, Any]:
    recovered, judged = group.recoveries
    visible = group.reliability()
    hidden = group.reliability(hidden=True)
    return {
        "by": group.by,
        "name": group.name,
        "system": group.system,
        "cases": group.cases,
        "recovered": recovered,
        "judged": judged,
        "measures": {name: asdict(summary) for name, summary in _summaries(group)},
        "calibration_error": visible.calibration_error,
        "reliability_visible": visible.diagram(),
        "calibration_error_hidden": hidden.calibration_error,
        "reliability_hidden": hidden.diagram(),
    }
