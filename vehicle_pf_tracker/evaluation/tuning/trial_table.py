"""All trials of a search as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

from vehicle_pf_tracker.evaluation.tuning.objective import Objective
from vehicle_pf_tracker.evaluation.tuning.searching import Trial


def to_csv(trials: Sequence[Trial], objective: Objective) -> str:
    """Write a line for each trial, in order; the first is what the search began with."""
    text = io.StringIO()
    names = list(trials[0].values) if trials else []
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["trial", objective.metric, *names])
    for trial in trials:
        score = "" if trial.score is None else repr(trial.score)
        writer.writerow([trial.number, score, *(trial.values[name] for name in names)])
    return text.getvalue()
