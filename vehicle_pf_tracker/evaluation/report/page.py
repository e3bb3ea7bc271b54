# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`report.html`: one file that needs nothing else, made from the template beside it."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Sequence
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from vehicle_pf_tracker.evaluation import tables
from vehicle_pf_tracker.evaluation.columns import COMPARED_METRICS, METRIC_COLUMNS, ONCE
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder, Source, safe_name
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates
from vehicle_pf_tracker.evaluation.report.figures import (
    ERRORS_PREFIX,
    draw_all,
    styled,
    svg_element,
)
from vehicle_pf_tracker.evaluation.report.scored_runs import FailedCell, ScoredEvaluation
from vehicle_pf_tracker.evaluation.report.stills import embedded_stills


def make_page(evaluation: ScoredEvaluation, aggregates: Aggregates) -> str:
    """Return the text of the page that shows an evaluation and its summaries."""
    figures = {
        name: {"svg": svg_element(drawn, number), "caption": drawn.caption}
        for number, (name, drawn) in enumerate(draw_all(evaluation, aggregates).items(), start=1)
    }
    folder = evaluation.folder
    templates = Environment(
        loader=PackageLoader("vehicle_pf_tracker.evaluation.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return templates.get_template("report.html").render(
        title=title(evaluation),
        facts=_facts(folder),
        notes=evaluation.notes,
        slots=styled(aggregates),
        overall=tables.overall_table(aggregates, ONCE),
        restarts=tables.restarts_table(aggregates),
        figures=figures,
        behind=tables.behind_table(aggregates),
        pairs=tables.pairs_table(aggregates),
        ordered_by=COMPARED_METRICS[0].label,
        stills=embedded_stills(evaluation, aggregates),
        curves=[name for name in figures if not name.startswith(ERRORS_PREFIX)],
        recordings=[_section(evaluation, aggregates, entry) for entry in folder.recordings],
        systems=folder.systems,
        sources=folder.recordings,
        seeds=folder.seeds,
        # A plan of an older version may lack either.
        plan={"versions": {}, "options": {}, **folder.plan},
        command=shlex.join(map(str, folder.plan.get("command", []))),
        failed=_failed_groups(evaluation.failed),
    )


def title(evaluation: ScoredEvaluation) -> str:
    """Return the title of the report."""
    return f"Trackers compared: {evaluation.folder.path.resolve().name}"


def _facts(folder: EvaluationFolder) -> str:
    counts = {"recording": folder.recordings, "system": folder.systems, "seed": folder.seeds}
    return " × ".join(tables.counted(len(some), noun) for noun, some in counts.items())


def _section(evaluation: ScoredEvaluation, aggregates: Aggregates, entry: Source) -> dict[str, Any]:
    """Return the values of a recording's section of the template."""
    truths = evaluation.truths[entry.name]
    kinds = Counter(truth.occlusion.name.lower() for truth in truths.values())
    facts = [tables.counted(entry.frames, "frame"), f"{entry.width} × {entry.height} px"]
    facts += [f"{len(truths)} with truth"] if len(truths) != entry.frames else []
    facts += [f"{kinds['partial']} partly occluded"] if kinds["partial"] else []
    facts += [f"{kinds['total']} totally occluded"] if kinds["total"] else []
    runs = evaluation.by_system(entry.name, aggregates.order)
    shown = [column for column in METRIC_COLUMNS if column.by_recording]
    return {
        "name": entry.name,
        "facts": ", ".join(facts),
        "table": tables.recording_table(aggregates, entry.name, shown),
        "occlusions": tables.occlusions_table(runs),
        "figure": ERRORS_PREFIX + safe_name(entry.name),
    }


def _failed_groups(failed: Sequence[FailedCell]) -> list[tuple[str, str, str]]:
    """Return system, reason and cells of those that failed for the same reason."""
    groups: dict[tuple[str, str], dict[str, list[str]]] = {}
    for cell in failed:
        by_recording = groups.setdefault((cell.system, cell.reason), {})
        by_recording.setdefault(cell.recording, []).append(str(cell.seed))
    return [
        (*key, "; ".join(f"{name}: seed {', '.join(seeds)}" for name, seeds in cells.items()))
        for key, cells in groups.items()
    ]
