# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Table of what runs of `fusion` reach, by sequence and by kind of case."""

from __future__ import annotations

import statistics
from collections.abc import Sequence

from laboratory.fusion.case_lists import HARD_KINDS
from laboratory.stress import Result


def score_table(results: Sequence[Result]) -> str:
    """Tabulate what was reached, by plain sequence and by kind of hard case."""
    head = (
        "| | runs | on target | IoU | runs below .9 | recovered | RMSE visible, px | doubted | "
        "claimed hidden | longest false run | ECE |\n|---|" + "---:|" * 10
    )
    plain = [result for result in results if result.case.kind == "plain"]
    sequences = dict.fromkeys(result.case.sequence for result in plain)
    rows = [
        _row(name, [result for result in plain if result.case.sequence == name])
        for name in sequences
    ]
    rows.append(_row("**all sequences**", plain))
    for kind in HARD_KINDS:
        own = [result for result in results if result.case.kind == kind]
        for path in dict.fromkeys(result.case.label("path") for result in own):
            part = [result for result in own if result.case.label("path") == path]
            rows.append(_row(" ".join(filter(None, (kind, path))), part))
    return "\n".join([head, *rows]) + "\n"


def _row(name: str, results: Sequence[Result]) -> str:
    scores = [result.score for result in results]

    def mean(values: Sequence[float | None]) -> str:
        known = [value for value in values if value is not None]
        return f"{statistics.fmean(known):.3f}" if known else "–"

    recovered = sum(s.recovered for s in scores)
    judged = sum(s.judged for s in scores)
    cells = [
        name, f"{len(scores)}", mean([s.on_target for s in scores]),
        mean([s.mean_iou for s in scores]), f"{sum(bool(s.lost) for s in scores)}",
        f"{recovered} of {judged}" if judged else "–",
        mean([s.rmse_visible_px for s in scores]), mean([s.doubted for s in scores]),
        mean([s.claimed_hidden for s in scores]),
        f"{max(s.longest_false_tracking for s in scores)}",
        mean([s.reliability_visible.calibration_error for s in scores]),
    ]  # fmt: skip
    return "| " + " | ".join(cells) + " |"
