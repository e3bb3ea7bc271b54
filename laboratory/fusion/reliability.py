# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The shipped values of `fusion` on recordings with truth, and how far its confidence is right.

    python -m laboratory.fusion.reliability SEQUENCES -o results/fusion_reliability

``shipped.md`` is the table that `laboratory.fusion.fit` has, for the defaults;
``reliability.md`` the calibration error by kind of case; and ``reliability.png`` the reliability
diagram: visible frames by reported confidence, against the share of them that are on target.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from matplotlib.figure import Figure

from laboratory.figure_files import save
from laboratory.fusion.case_lists import HARD_KINDS, judged_cases
from laboratory.fusion.options import make_parser, parsed, report_progress
from laboratory.fusion.score_table import score_table
from laboratory.stress import Reliability, Result, run_battery, variant_system
from vehicle_pf_tracker.cli.main import exit_status
from vehicle_pf_tracker.evaluation.line_styles import LINE_STYLES
from vehicle_pf_tracker.evaluation.tables import markdown
from vehicle_pf_tracker.results.output_files import write_text


def shipped_results(options: argparse.Namespace) -> list[Result]:
    """Run the defaults over the cases that `laboratory.fusion.fit` judges settings on."""
    results: list[Result] = []
    for cases, seeds in judged_cases(options):
        results += run_battery(
            cases,
            [variant_system("fusion")],
            seeds=tuple(seeds),
            workers=options.workers,
            store=options.output / "shipped.jsonl",
            on_progress=report_progress,
        )
    return results


def pooled(results: Sequence[Result]) -> Reliability:
    """Confidences of the visible frames of all runs."""
    return Reliability.pooled(result.score.reliability_visible for result in results)


def reliability_table(results: Sequence[Result]) -> str:
    """Markdown table of the calibration error by kind of case, and without the worst sequence."""
    rows = []
    for kind in ("", "plain", *HARD_KINDS):
        own = [result for result in results if not kind or result.case.kind == kind]
        rows.append(_row(kind or "all", own))
    # Without the worst sequence: one that is lost with confidence outweighs all others.
    worst = max(
        dict.fromkeys(result.case.sequence for result in results),
        key=lambda name: (
            pooled([r for r in results if r.case.sequence == name]).calibration_error or 0.0
        ),
    )
    rest = [result for result in results if result.case.sequence != worst]
    rows.append(_row(f"all but {worst}", rest))
    return markdown(("cases", "visible frames", "calibration error"), rows)


def _row(name: str, results: Sequence[Result]) -> list[str]:
    reliability = pooled(results)
    error = reliability.calibration_error
    return [name, f"{reliability.frames}", "–" if error is None else f"{error:.3f}"]


def reliability_figure(results: Sequence[Result]) -> Figure:
    """Draw share on target by confidence for plain and for harder cases, over their frames."""
    figure = Figure(figsize=(6, 5.5), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    above.plot([0, 1], [0, 1], color="0.6", lw=0.8)
    parts = {
        "sequences": [result for result in results if result.case.kind == "plain"],
        "shifted boxes, painted occluders": [r for r in results if r.case.kind != "plain"],
    }
    # Two lines apart, as painted occluders are harder than what is filmed.
    for (name, part), style in zip(parts.items(), LINE_STYLES, strict=False):
        points = pooled(part).diagram()
        confidence = [point["confidence"] for point in points]
        on_target = [point["on_target"] for point in points]
        frames = [point["frames"] for point in points]
        looks = {"color": style.colour, "marker": style.marker, "linestyle": style.line}
        above.plot(confidence, on_target, label=name, **looks)
        below.plot(confidence, frames, **looks)
    above.set(ylabel="share on target", ylim=(-0.02, 1.02))
    above.legend(loc="lower right")
    below.set(xlabel="reported confidence", ylabel="frames", yscale="log")
    return figure


def main() -> int:
    """Run, and write tables and figure."""
    options = parsed(make_parser(__doc__, "seeds", "hard"))
    results = shipped_results(options)
    tables = {"shipped.md": score_table(results), "reliability.md": reliability_table(results)}
    for name, text in tables.items():
        write_text(options.output / name, text)
        print(text)
    save(reliability_figure(results), options.output / "reliability.png")
    return 0


if __name__ == "__main__":
    sys.exit(exit_status(main, "python -m laboratory.fusion.reliability"))
