# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`merge`: join the parts of an evaluation, and write its report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle_pf_tracker.cli.report import ReportParts, write
from vehicle_pf_tracker.cli.requests import option, positional
from vehicle_pf_tracker.core.outputs import Products, claimed
from vehicle_pf_tracker.evaluation.grid.merging import merge


@dataclass(frozen=True, kw_only=True)
class Request(ReportParts):
    """Request of `merge`."""

    parts: Sequence[Path] = positional(
        nargs="+", type=Path, metavar="DIR",
        help="folders that `evaluate --part` made, of one evaluation",
    )  # fmt: skip
    output: Path = option(
        "-o", required=True, metavar="DIR",
        help="evaluation folder; may be one of the parts, and what it has stays",
    )  # fmt: skip


def run(request: Request) -> int:
    """Join the parts, write the report, and print what is missing."""
    output = request.output.resolve()
    others = [part for part in request.parts if part.resolve() != output]
    with claimed([Products(request.output)], others, overwrite=True):
        cells = merge(request.parts, request.output)
        print(f"{cells} runs of {len(request.parts)} parts are in {request.output}")
        written = write(request.output, request)
    return int(bool(written.evaluation.failed))
