# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""README's table of results, from one command.

    python -m laboratory.readme_table SEQUENCES FURTHER --budget 12 --cases 2 --hard 2 -o OUT

The rows are of ``SEQUENCES``. The first has what `laboratory.fusion.fit` reaches there with the
same options and two seeds, fitted on ``FURTHER``, too. CSRT and NanoTrack were measured beside the
sequences: ``SEQUENCES/baselines.csv``. What ``OUT`` has is not run again; `laboratory.fusion.fit`
may have written it.
"""

from __future__ import annotations

import argparse
import csv
import statistics
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from laboratory.fusion.case_lists import listed_cases
from laboratory.fusion.fit import fit, judge
from laboratory.fusion.options import NUMBERS, make_parser, parsed, report_progress
from laboratory.stress import Case, Result, run_battery, variant_system
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.results.output_files import write_text

HEAD = ("tracker", "visible frames on target", "mean IoU", "total occlusions recovered from")
VARIANTS = {
    "fusion": "`fusion` as it ships",
    "apf": "`apf` (Scharcanski et al. 2011)",
    "pf": "`pf` (Perez et al. 2002)",
}
BASELINES = {"nanotrack_v2": "NanoTrack v2 (a neural network)", "csrt": "OpenCV's CSRT"}
FITTED = "`fusion`, fitted on the 18 *other* cameras"
FITTED_SEEDS = 2
"""Seeds of the first row: each camera has parameters of its own, which takes long."""

Row = tuple[float, float, int, int]
"""On target, IoU, occlusions recovered from and judged."""


def cells(name: str, rows: Iterable[Row]) -> list[str]:
    """Mean shares, and summed occlusions."""
    on_target, iou, recovered, judged = zip(*rows, strict=True)
    shares = (f"{statistics.fmean(values):.3f}".removeprefix("0") for values in (on_target, iou))
    return [name, *shares, f"{sum(recovered)} of {sum(judged)}"]


def of_results(results: Iterable[Result], cases: Sequence[Case]) -> list[Row]:
    """Take the runs of these cases."""
    return [
        (score.on_target or 0.0, score.mean_iou or 0.0, score.recovered, score.judged)
        for case, _, _, score in results
        if case in cases
    ]


def of_baselines(table: Path) -> dict[str, list[Row]]:
    """Read the rows of each baseline; none where there is no table."""
    rows: dict[str, list[Row]] = {name: [] for name in BASELINES}
    for each in csv.DictReader(table.read_text().splitlines()) if table.exists() else ():
        shares = float(each["on_target"]), float(each["mean_iou"])
        rows[each["baseline"]].append((*shares, int(each["recovered"]), int(each["judged"])))
    return rows


def _on_target(row: list[str]) -> float:
    return float(row[1])


def main() -> int:
    """Run what is missing, and print the table."""
    options = parsed(make_parser(__doc__, *NUMBERS))
    folder = options.sequences[0].resolve()
    # Fitted on all, shown on the first folder alone, whose sequences the baselines were run on.
    cases = [
        case
        for case in listed_cases(options, "plain_cases", ("plain",))
        if folder in Path(case.origin.source.path).resolve().parents
    ]
    # Fewer seeds for the fits; see `FITTED_SEEDS`.
    few = argparse.Namespace(**vars(options) | {"seeds": min(options.seeds, FITTED_SEEDS)})
    rows = {FITTED: of_results(judge(few, fit(few)), cases)}
    results = run_battery(
        cases, [variant_system(name) for name in VARIANTS],
        seeds=range(options.seeds), workers=options.workers, store=options.output / "readme.jsonl",
        on_progress=report_progress,
    )  # fmt: skip
    for name, shown in VARIANTS.items():
        rows[shown] = of_results((result for result in results if result.system == name), cases)
    for name, own in of_baselines(folder / "baselines.csv").items():
        rows[BASELINES[name]] = own
    # Best last, and then turned round: the table begins with the best.
    table = sorted((cells(name, own) for name, own in rows.items() if own), key=_on_target)
    text = markdown(HEAD, table[::-1])
    write_text(options.output / "readme.md", text)
    print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.readme_table"))
