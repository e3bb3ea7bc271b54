# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Settings of `fusion`: drawn around its defaults, and the mean of the best of them."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence

import numpy as np

from vehicle_pf_tracker.parameters.table import ParameterSpec, specs
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters

SPREAD = 0.25
"""Standard deviation of the draws, of the logarithm of a parameter: a factor of 1.3."""
ELITE = 4
"""One setting in so many counts as good; their mean varies less than the best one."""

Setting = Mapping[str, float]
"""Values of the tuned parameters, by name."""


def tuned_parameters() -> dict[str, ParameterSpec]:
    """Every number of `fusion` that is fitted, with its range."""
    table = specs(FusionParameters)
    return {name: spec for name, spec in table.items() if isinstance(spec.tuned, tuple)}


def draw_settings(budget: int, seed: int) -> list[Setting]:
    """Draw settings around the defaults, which are the first."""
    rng = np.random.default_rng(seed)
    table = tuned_parameters()
    # The defaults take part as one of the settings.
    settings: list[Setting] = [{name: float(spec.default) for name, spec in table.items()}]
    for _ in range(budget - 1):
        # Factors: parameters are rates and scales, of which half and double are equally far.
        factors = np.exp(SPREAD * rng.normal(size=len(table)))
        drawn = {}
        for (name, spec), factor in zip(table.items(), factors, strict=True):
            assert isinstance(spec.tuned, tuple)
            # The table's range holds for the fit, too.
            drawn[name] = float(np.clip(float(spec.default) * factor, *spec.tuned))
        settings.append(drawn)
    return settings


def fitted(
    settings: Sequence[Setting], by_camera: Sequence[Mapping[str, float]], without: str = ""
) -> Setting:
    """Average the best quarter of the settings, geometrically, by all cameras but one."""
    means = [
        statistics.fmean(value for camera, value in scores.items() if camera != without)
        for scores in by_camera
    ]
    order = sorted(range(len(settings)), key=lambda index: -means[index])
    # One setting at least, also of a small budget.
    best = [settings[index] for index in order[: max(len(settings) // ELITE, 1)]]
    return {name: _geometric_mean([setting[name] for setting in best]) for name in settings[0]}


def _geometric_mean(values: Sequence[float]) -> float:
    # A 0 has no logarithm.
    if min(values) <= 0:
        return statistics.fmean(values)
    return float(f"{math.exp(statistics.fmean(map(math.log, values))):.3g}")
