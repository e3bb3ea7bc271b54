# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Contribution of each part of `fusion`: one change each, on the same cases, with intervals.

The intervals are over cameras.

    python -m laboratory.fusion.ablation SEQUENCES -o results/fusion_ablation

Every system is the default with one parameter changed. The table has its means and, as differences
to the default, 95 % bootstrap intervals over cameras (`laboratory.stress.difference`).
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Mapping, Sequence

from laboratory.fusion.case_lists import listed_cases
from laboratory.fusion.options import make_parser, parsed, report_progress
from laboratory.stress import Case, Result, StressSystem, difference, run_battery
from laboratory.stress.systems import variant_system
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.evaluation.statistics import Summary
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.parameters.table import Value
from vehicle_pf_tracker.results.output_files import write_text

DEFAULT = "default"
# One change a row: what a mechanism is worth shows where it alone is off.
CHANGES: Mapping[str, Mapping[str, Value]] = {
    DEFAULT: {},
    "no camera motion": {"motion.camera": False},
    "hidden before a moving camera as before a standing one": {"motion.camera_velocity_sigma": 0.0},
    "no points": {"visibility.points_slope": 0.0},
    "no partial state": {"visibility.partial_slope": 0.0},
    "first size kept": {"size.step": 0.0},
    "10 particles": {"num_particles": 10},
    "30 particles": {"num_particles": 30},
    "100 particles": {"num_particles": 100},
    "200 particles": {"num_particles": 200},
}
FRAMES = 110
"""Frames of a case at most: nearly four seconds, which hold an occlusion and what follows it."""
KINDS = {"plain": 1, "shifted_box": 1, "wall": 1, "lorry": 1}
"""Cases of each kind from a sequence: one, as every system runs all of them."""
MEASURES = ("on_target", "mean_iou", "recovered")


def ablation_cases(options: argparse.Namespace) -> list[Case]:
    """Plain sequences, shifted boxes and painted occluders."""
    return [
        case
        for kind, count in KINDS.items()
        for case in listed_cases(
            options, f"ablation_{kind}", (kind,), per_sequence=count, max_frames=FRAMES
        )
    ]


def row(name: str, results: Sequence[Result]) -> list[str]:
    """Means of one system, and its differences to the default."""
    scores = [result.score for result in results if result.system == name]
    recovered = sum(s.recovered for s in scores)
    judged = sum(s.judged for s in scores)
    cells = [
        name, f"{statistics.fmean(s.on_target or 0.0 for s in scores):.3f}",
        f"{statistics.fmean(s.mean_iou or 0.0 for s in scores):.3f}", f"{recovered} of {judged}",
    ]  # fmt: skip
    for measure in MEASURES:
        # Paired by case: what makes a case hard is in both.
        found = difference(results, name, DEFAULT, measure) if name != DEFAULT else None
        cells.append(_interval(found) if found else "–")
    return cells


def _interval(found: Summary) -> str:
    if found.low is None:
        return f"{found.mean:+.3f}"
    return f"{found.mean:+.3f} ({found.low:+.3f} {found.high:+.3f})"


def table(results: Sequence[Result]) -> str:
    """Markdown table of all systems."""
    header = ("change", "on target", "IoU", "recovered", "Δ on target", "Δ IoU", "Δ recovered")
    names = dict.fromkeys(result.system for result in results)
    return markdown(header, [row(name, results) for name in names])


def compare(
    name: str,
    cases: Sequence[Case],
    systems: Sequence[StressSystem],
    seeds: Sequence[int],
    options: argparse.Namespace,
) -> None:
    """Run all systems over all cases; write and print the table, and keep scores, as `name`."""
    results = run_battery(
        cases,
        systems,
        seeds=seeds,
        workers=options.workers,
        store=options.output / f"{name}.jsonl",
        on_progress=report_progress,
    )
    text = table(results)
    write_text(options.output / f"{name}.md", text)
    print(text, end="")


def main() -> int:
    """Run all systems over all cases."""
    parser = make_parser(__doc__)
    parser.add_argument("--changes", nargs="+", default=list(CHANGES), choices=list(CHANGES))
    options = parsed(parser)
    # The default always runs: everything is compared with it.
    names = dict.fromkeys([DEFAULT, *options.changes])
    systems = [variant_system("fusion", CHANGES[name], name) for name in names]
    compare("ablation", ablation_cases(options), systems, (options.seed,), options)
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.fusion.ablation"))
