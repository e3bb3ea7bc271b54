# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The files of a report: its page, tables and figures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, astuple
from pathlib import Path
from typing import Any, NamedTuple

from vehicle_pf_tracker.evaluation import tables
from vehicle_pf_tracker.evaluation.columns import (
    COMPARED_METRICS,
    LATEX_METRICS,
    METRIC_COLUMNS,
    NO_VALUE,
    ONCE,
    RESTARTS,
)
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.report.aggregates import Aggregates, aggregate
from vehicle_pf_tracker.evaluation.report.figures import write_figures
from vehicle_pf_tracker.evaluation.report.page import make_page, title
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, score_folder
from vehicle_pf_tracker.evaluation.report.stills import write_stills
from vehicle_pf_tracker.results.output_files import csv_text, write_json, write_text
from vehicle_pf_tracker.showing.side_products import SideProducts

ALL_RECORDINGS = "(all)"
"""Stands for the name of a recording where values are means over all of them."""
_LATEX = str.maketrans(
    {c: f"\\{c}" for c in "&%$#_{}"}
    | {"\u00a0": "~", "~": r"\textasciitilde{}", "\\": r"\textbackslash{}"}
)


def summary_markdown(evaluation: ScoredEvaluation, aggregates: Aggregates) -> str:
    """Return the notes, the means, the differences and each recording as Markdown."""
    parts = [f"# {title(evaluation)}\n"]
    parts.append("".join(f"- {line}\n" for line in evaluation.notes))
    shown = {
        "Means over recordings": tables.overall_table(aggregates, ONCE),
        "Differences to the first": tables.behind_table(aggregates),
    }
    if len(aggregates.order) > 2:  # of two systems the table above has the only difference
        pairs = tables.pairs_table(aggregates)
        shown[f"Differences of all pairs, {COMPARED_METRICS[0].label}"] = pairs
    if (restarts := tables.restarts_table(aggregates)) is not None:
        shown[RESTARTS] = restarts
    for entry in evaluation.folder.recordings:
        shown[entry.name] = tables.recording_table(aggregates, entry.name, METRIC_COLUMNS)
    for heading, table in shown.items():
        parts.append(f"## {heading}\n\n{tables.markdown(*table.texts())}")
    if evaluation.failed:
        cells = [[c.system, c.recording, str(c.seed), c.reason] for c in evaluation.failed]
        header = ["system", "recording", "seed", "reason"]
        parts.append("## Failed cells\n\n" + tables.markdown(header, cells))
    return "\n".join(parts)


def summary_csv(aggregates: Aggregates) -> str:
    """Return every mean with its spread and interval, a line each, with every digit."""
    means = {ALL_RECORDINGS: aggregates.overall, **aggregates.recordings}
    rows = [
        [recording, system, column.key, column.unit, *astuple(found)]
        for recording, by_system in means.items()
        for system, summaries in by_system.items()
        for column in METRIC_COLUMNS
        if (found := summaries.get(column.key)) is not None
    ]
    numbers = ("count", "mean", "spread", "low", "high")
    return csv_text(("recording", "system", "metric", "unit", *numbers), rows)


def summary_tex(aggregates: Aggregates) -> str:
    """Return the main means as a LaTeX table; the best are bold."""
    table = tables.overall_table(aggregates, [column.key for column in LATEX_METRICS])
    header, _ = table.texts()
    rows = [
        [_tex(label), *(rf"\textbf{{{_tex(c.text)}}}" if c.best else _tex(c.text) for c in cells)]
        for label, cells in table.rows.items()
    ]
    head, *body = (" & ".join(row) + " \\\\\n" for row in [map(_tex, header), *rows])
    return (
        "% Means over recordings; the best are bold. Needs the package booktabs.\n"
        f"\\begin{{tabular}}{{l{'r' * len(table.headers)}}}\n\\toprule\n"
        f"{head}\\midrule\n{''.join(body)}\\bottomrule\n\\end{{tabular}}\n"
    )


def _tex(text: str) -> str:
    return text.translate(_LATEX).replace(NO_VALUE, "--")


def summary_json(evaluation: ScoredEvaluation, aggregates: Aggregates) -> dict[str, Any]:
    """Return everything as plain values."""
    return {
        "format": 4,
        "metrics": {
            column.key: {
                "label": column.label,
                "unit": column.unit,
                "higher_is_better": column.higher_is_better,
                "about": column.help,
            }
            for column in METRIC_COLUMNS
        },
        "notes": evaluation.notes,
        "failed": [asdict(cell) for cell in evaluation.failed],
        **asdict(aggregates),
    }


class Report(NamedTuple):
    """A report that was written.

    Attributes
    ----------
    page : Path
        Page of the report.
    evaluation : ScoredEvaluation
        Results that it shows.
    aggregates : Aggregates
        Means of the results.
    failures : list of str
        Parts that could not be made, a sentence each; the results do not depend on them.
    """

    page: Path
    evaluation: ScoredEvaluation
    aggregates: Aggregates
    failures: list[str]


def write_report(
    folder: Path, *, figures: Sequence[str] = (), on_stage: Callable[[str], object] = lambda _: None
) -> Report:
    """Write the report of the evaluation in `folder` there.

    The same folder gives the same files.

    Parameters
    ----------
    folder : Path
        Folder of an evaluation.
    figures : sequence of str
        Formats of the figures in ``figures/``: ``pdf``, ``svg`` and ``png``.
    on_stage : callable
        Called with a few words when a part is begun.

    Raises
    ------
    InputError
        If it is not an evaluation folder.
    """
    on_stage("scoring the runs")
    evaluation = score_folder(EvaluationFolder(folder))
    aggregates = aggregate(evaluation)
    page = folder / "report.html"
    on_stage("drawing the page")
    # Made in the loop below: each part fails by itself, and the others are written.
    texts: dict[Path, Callable[[], str]] = {
        page: lambda: make_page(evaluation, aggregates),
        folder / "summary.md": lambda: summary_markdown(evaluation, aggregates),
        folder / "summary.csv": lambda: summary_csv(aggregates),
        folder / "summary.tex": lambda: summary_tex(aggregates),
    }
    side = SideProducts()
    with side.attempt("the stills"):
        write_stills(evaluation, aggregates)
    for path, text in texts.items():
        with side.attempt(str(path)):
            write_text(path, text())
    with side.attempt(str(folder / "summary.json")):
        write_json(folder / "summary.json", summary_json(evaluation, aggregates))
    if figures:
        on_stage("drawing the figures")
        with side.attempt("the figures"):
            write_figures(evaluation, aggregates, figures)
    return Report(page, evaluation, aggregates, side.notices)
