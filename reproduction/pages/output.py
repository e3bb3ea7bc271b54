# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Folder with the results of one experiment."""

from __future__ import annotations

from pathlib import Path

from laboratory.figure_files import save
from reproduction import experiment as ex
from reproduction.runs.running import code_digest
from vehicle_pf_tracker.results.output_files import make_folder, write_json, write_text
from vehicle_pf_tracker.results.run_folder import versions

DATA = "data.csv"
"""File with the values of all cells."""
FIGURE = "figure"
"""Stem of the figure's files, an SVG and a PNG."""
VERDICT = "verdict"
"""Stem of the verdict's files, JSON for the page and Markdown to read."""


def write_report(folder: Path, experiment: ex.Experiment, report: ex.Report, size: ex.Size) -> None:
    """Write data, figure and verdict of `experiment` into `folder`.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    make_folder(folder)
    write_text(folder / DATA, report.data.to_csv())
    for kind in ("svg", "png"):
        save(report.figure, folder / f"{FIGURE}.{kind}")
    facts = {
        "name": experiment.name,
        "title": experiment.title,
        "seeds": list(report.seeds or size.seeds),
        "command": _command(experiment, size),
        "code": code_digest(),
        "versions": versions(),
    }
    write_json(folder / f"{VERDICT}.json", {**facts, **report.verdict.to_json()})
    write_text(folder / f"{VERDICT}.md", _section(experiment, report, size))


def _section(experiment: ex.Experiment, report: ex.Report, size: ex.Size) -> str:
    tables = [f"{title}\n\n{table.to_markdown()}" for title, table in report.tables.items()]
    parts = [
        f"## {experiment.name}",
        f"{experiment.title}. Made by `{_command(experiment, size)}`.",
        f"![{experiment.title}]({FIGURE}.png)",
        *tables,
        report.verdict.to_markdown(),
    ]
    return "\n\n".join(part.rstrip() for part in parts) + "\n"


def _command(experiment: ex.Experiment, size: ex.Size) -> str:
    words = ["python -m reproduction", experiment.name]
    words += ["--quick"] if size.quick else []
    usual = size.of(ex.EXPERIMENT_SEEDS, ex.QUICK_SEEDS)
    words += [] if len(size.seeds) == usual else [f"--seeds {len(size.seeds)}"]
    words += [f"--first-seed {size.seeds.start}"] if size.seeds.start else []
    return " ".join(words)
