# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Write the page of all variants on real sequences from the folder of an evaluation.

python -m reproduction.sequences results/evaluation -o docs/sequences.md
"""

from __future__ import annotations

import argparse
import math
import statistics
from collections.abc import Mapping, Sequence
from pathlib import Path

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.metrics import Metrics, measure
from vehicle_pf_tracker.evaluation.scores import score_frames

INTRODUCTION = """# The variants on real sequences

Nineteen recordings with truth, default parameters, the first true box, no restarts; means over the seeds (least–largest).
`fusion` was developed on all of them, `apf` and `mfpf` were tuned on nine: [fusion.md](fusion.md) has held-out results.

    for s in SEQUENCES/*/*/; do vehicle-pf-tracker import $s results/sequences/$(basename $s); done
    vehicle-pf-tracker evaluate results/sequences --variants all,baselines --seeds 5 -o results/evaluation
"""  # noqa: E501
ON_TARGET = (
    "Share of visible frames with an error below half the true box's diagonal (where a baseline "
    "gives a frame up, its last box is scored):"
)
RMSE = "RMSE of the centre in visible frames, px:"
RECOVERED = "Total occlusions recovered from, of those judged, over all seeds:"

Table = Mapping[str, Mapping[str, Sequence[Metrics]]]
"""Metrics of each seed, by recording and system."""


def main() -> None:
    """Read, score and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    args = parser.parse_args()
    args.output.write_text(page(EvaluationFolder(args.folder)), encoding="utf-8")


def page(evaluation: EvaluationFolder) -> str:
    """Write the page as Markdown."""
    table, missing = _measured(evaluation)
    parts = [
        INTRODUCTION,
        f"{ON_TARGET}\n\n{_markdown(table, _on_target, 3)}",
        f"{RMSE}\n\n{_markdown(table, _rmse, 1)}",
        f"{RECOVERED}\n\n{_recoveries(table)}",
    ]
    if missing:
        parts.append("Not run:\n\n" + "\n".join(f"- {line}" for line in missing))
    return "\n\n".join(part.strip("\n") for part in parts) + "\n"


def _measured(evaluation: EvaluationFolder) -> tuple[Table, list[str]]:
    table: dict[str, dict[str, list[Metrics]]] = {}
    missing = []
    for recording in evaluation.recordings:
        truth = evaluation.truth(recording.name)
        row = table.setdefault(recording.name, {})
        for system in evaluation.systems:
            for seed in system.seeds(evaluation.seeds):
                runs = row.setdefault(system.label, [])
                try:
                    rows, _ = evaluation.cell(recording.name, system.label, seed)
                except InputError as error:
                    missing.append(f"{recording.name}, {system.label}: {error}")
                else:
                    runs.append(measure(score_frames(rows, list(truth.values()))))
    return table, list(dict.fromkeys(missing))


def _on_target(metrics: Metrics) -> float:
    return math.nan if metrics.on_target is None else metrics.on_target


def _rmse(metrics: Metrics) -> float:
    return math.nan if metrics.rmse_visible_px is None else metrics.rmse_visible_px


def _markdown(table: Table, value: object, digits: int) -> str:
    assert callable(value)
    numbers = {
        name: {system: [value(run) for run in runs] for system, runs in row.items()}
        for name, row in table.items()
    }
    systems = list(next(iter(numbers.values())))
    lines = [_line(["system", *numbers, "mean"]), _line(["---", *["---:"] * (len(numbers) + 1)])]
    for system in systems:
        runs = [row[system] for row in numbers.values()]
        means = [statistics.fmean(run) for run in runs if run]
        mean = f"**{statistics.fmean(means):.{digits}f}**" if means else "–"
        lines.append(_line([f"`{system}`", *(_cell(run, digits) for run in runs), mean]))
    return "\n".join(lines)


def _recoveries(table: Table) -> str:
    hidden = [name for name, row in table.items() if any(_judged(runs) for runs in row.values())]
    lines = [_line(["system", *hidden]), _line(["---", *["---:"] * len(hidden)])]
    for system in next(iter(table.values())):
        counts = [_judged(table[name][system]) for name in hidden]
        lines.append(_line([f"`{system}`", *(f"{sum(count)} of {len(count)}" for count in counts)]))
    return "\n".join(lines)


def _judged(runs: Sequence[Metrics]) -> list[bool]:
    verdicts = [occlusion.recovered for run in runs for occlusion in run.occlusions]
    return [verdict for verdict in verdicts if verdict is not None]


def _cell(values: Sequence[float], digits: int) -> str:
    if not values:
        return "–"
    mean, low, high = statistics.fmean(values), min(values), max(values)
    if high - low < 0.5 * 10**-digits:
        return f"{mean:.{digits}f}"
    return f"{mean:.{digits}f} ({low:.{digits}f}–{high:.{digits}f})"


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
