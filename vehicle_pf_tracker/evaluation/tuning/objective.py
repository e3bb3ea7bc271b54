"""What a search makes as good as it can."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Objective:
    """A metric of `evaluation.metrics`, and which way is up."""

    metric: str
    told: str
    maximise: bool = True

    def better(self, one: float, other: float) -> bool:
        """Whether `one` is better than `other`."""
        return one > other if self.maximise else one < other


OBJECTIVES: Mapping[str, Objective] = MappingProxyType(
    {
        objective.metric: objective
        for objective in (
            Objective("success_auc", "area under the success curve"),
            Objective("precision_auc", "area under the precision curve"),
            Objective("on_target", "share of visible frames with an error below half the diagonal"),
            Objective("p_error_lt_15px", "share of frames with an error below 15 px"),
            Objective("rmse_px", "RMSE in px", maximise=False),
        )
    }
)
"""By the name of the metric."""


def mean_of_means(runs: Mapping[str, Sequence[float | None]]) -> float | None:
    """Return the mean over recordings of the mean over their runs; None if a run has no value."""
    means = []
    for values in runs.values():
        known = [value for value in values if value is not None]
        if len(known) < len(values) or not known:
            return None
        means.append(statistics.fmean(known))
    return statistics.fmean(means) if means else None
