# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Steps that became slower than the figures of the last page, as ratios over the same baselines."""

from __future__ import annotations

import re
import statistics

from benchmarks.bench.results import Results

SLOWER_RATIO = 1.1
"""A step that takes more than this many times as long is reported: less is within what two runs on
one idle machine differ by."""
_HEAD = "| step | ms | "
"""Beginning of the heading of the table of steps on the page."""
_RATIO = re.compile(r"([\d.e+]+) ± ")
"""A ratio in that table."""


def last_ratios(page: str) -> dict[str, float]:
    """Read the table of steps of a page: its ratios by case, as ``step/apf/csrt``."""
    lines = iter(page.splitlines())
    head = next((line for line in lines if line.startswith(_HEAD)), "")
    baselines = re.findall(r"over (\w+)", head)
    found = {}
    for line in lines:
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) < 3:  # the table has ended
            break
        # Behind the empty cell before the first bar come the name and the time.
        for baseline, cell in zip(baselines, cells[3:], strict=False):
            # Without its spread, which is not compared.
            if ratio := _RATIO.match(cell):
                found[f"step/{cells[1].strip('`')}/{baseline}"] = float(ratio[1])
    return found


def slower_steps(results: Results, page: str) -> dict[str, float]:
    """Find each variant whose step became more than a tenth slower than on `page`, and how much.

    The baselines ran in turns with the variant then and now, so that the machine cancels out. The
    median over the baselines is judged: one of them alone may have changed with OpenCV's version.
    """
    last = last_ratios(page)
    factors: dict[str, list[float]] = {}
    for case in results.cases:
        if case.name in last:
            # By the ratio and not by the time: another machine has other times.
            factors.setdefault(case.name.split("/")[1], []).append(last[case.name] / case.ratio)
    medians = {variant: statistics.median(values) for variant, values in factors.items()}
    return {variant: factor for variant, factor in medians.items() if factor > SLOWER_RATIO}
