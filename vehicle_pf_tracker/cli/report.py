# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`report`: write the report of an evaluation anew."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle_pf_tracker.cli.console import stages, tell_notices
from vehicle_pf_tracker.cli.option_values import names_in
from vehicle_pf_tracker.cli.requests import VerbRequest, option, positional
from vehicle_pf_tracker.core.outputs import Products, claimed

if TYPE_CHECKING:
    from vehicle_pf_tracker.evaluation.report.writing import Report


@dataclass(frozen=True, kw_only=True)
class ReportParts(VerbRequest):
    """Parts of a report."""

    figures: tuple[str, ...] = option(
        type=partial(names_in, known=("pdf", "svg", "png"), what="a format"),
        default=(), metavar="FORMATS",
        help="write every figure to DIR/figures, sized for a paper of two columns; FORMATS are "
        "pdf, svg or png, several with commas",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Request(ReportParts):
    """Request of `report`."""

    folder: Path = positional(metavar="DIR", help="evaluation folder; its report is replaced")


def run(request: Request) -> int:
    """Write the report, and print its path."""
    # A folder that is not there is not made, and `write` says so.
    outputs = [Products(request.folder)] if request.folder.is_dir() else []
    with claimed(outputs, [], overwrite=True):
        return int(bool(write(request.folder, request).failures))


def write(folder: Path, request: ReportParts) -> Report:
    """Write the report of `folder` with the parts that are asked for."""
    from vehicle_pf_tracker.evaluation.report.writing import write_report

    with stages("report") as on_stage:
        report = write_report(folder, figures=request.figures, on_stage=on_stage)
    tell_notices([*report.evaluation.mixed_versions, *report.failures])
    if report.page.exists():
        print(f"the report is {report.page}")
    return report
