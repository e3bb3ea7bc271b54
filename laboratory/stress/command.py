# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`python -m laboratory stress`: options and run of the stress battery."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from laboratory.stress import (
    Case,
    Result,
    StressSystem,
    find_sequences,
    list_cases,
    run_battery,
)
from laboratory.stress.battery import QUICK_FRAMES, QUICK_PER_SEQUENCE
from laboratory.stress.other_network import with_network
from laboratory.stress.report import MARKDOWN, table_rows, write_report
from vehicle_pf_tracker.cli.console import counting, print_rows, tell_notices
from vehicle_pf_tracker.cli.option_values import positive
from vehicle_pf_tracker.cli.requests import option
from vehicle_pf_tracker.cli.system_options import FEW_SEEDS, EvaluationRequest, asked_systems

STORE = "scores.jsonl"


@dataclass(frozen=True, kw_only=True)
class Request(EvaluationRequest):
    """Request of the battery."""

    battery: str = option(
        choices=("quick", "full"), default="quick",
        help="cases made of each recording or frame folder REC: quick (default), 8 short ones; "
        "full, about 55; see laboratory/notes/stress.md",
    )  # fmt: skip
    kinds: str | None = option(metavar="NAME,…", help="only cases of these kinds")
    per_sequence: int | None = option(
        type=positive, metavar="N", help="at most N cases of each sequence, of all groups in turns"
    )
    limit: int | None = option(type=positive, metavar="N", help="at most N cases, evenly spread")
    max_frames: int | None = option(
        type=positive, metavar="N", help="at most N frames of each case"
    )
    side_network: Path | None = option(
        type=Path, metavar="FILE",
        help="network that sees the sides in `fusion`, one of laboratory.train_sides --parts: for "
        "sequences from which the package's own has learnt",
    )  # fmt: skip
    cameras: Path | None = option(
        type=Path, metavar="FILE",
        help="table sequence,camera (default: cameras.csv in a folder REC; else each its own)",
    )  # fmt: skip


def run(request: Request) -> int:
    """Run the missing cases of the battery, write its report, and print its tables."""
    systems = _systems(request)
    cases = _cases(request)
    # Few unless asked for: a battery has many cases, and its intervals are over cameras.
    count = request.seeds or FEW_SEEDS
    seeds = range(request.first_seed, request.first_seed + count)
    tell_notices([f"{len(cases)} cases of {len({case.sequence for case in cases})} sequences"])
    with counting("tracked", "runs") as on_progress:
        results = run_battery(
            cases, systems, seeds=seeds, workers=request.workers, store=request.output / STORE,
            on_progress=on_progress,
        )  # fmt: skip
    compared = write_report(results, request.output, _options(request, results))
    for by in ("(all)", "kind"):
        groups = [group for group in compared if group.by == by]
        print_rows(*table_rows(groups, intervals=False))
    print(f"the report is {request.output / MARKDOWN}")
    return 0


def _systems(request: Request) -> list[StressSystem]:
    systems, notes = asked_systems(request)
    tell_notices(notes)
    file = request.side_network
    return [
        with_network(system, file)
        if file is not None and system.kind == "fusion"
        else StressSystem.of(system)
        for system in systems
    ]


def _cases(request: Request) -> list[Case]:
    is_quick = request.battery == "quick"
    return list_cases(
        find_sequences([Path(source) for source in request.sources], request.cameras),
        kinds=request.kinds.split(",") if request.kinds else None,
        # A number that was given is stronger than the battery's.
        per_sequence=request.per_sequence or (QUICK_PER_SEQUENCE if is_quick else None),
        limit=request.limit,
        max_frames=request.max_frames or (QUICK_FRAMES if is_quick else None),
    )


def _options(request: Request, results: Sequence[Result]) -> dict[str, object]:
    return {
        "command": request.command,
        "battery": request.battery,
        "runs": len(results),
        "seeds": sorted({result.seed for result in results}),
    }
