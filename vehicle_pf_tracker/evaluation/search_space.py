# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Space of a search: the parameters that are tuned, and the range of each."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from optuna.distributions import (
    BaseDistribution,
    CategoricalDistribution,
    FloatDistribution,
    IntDistribution,
)

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.tuning_aims import default_search
from vehicle_pf_tracker.parameters.table import ParameterSpec, Value, specs, unknown_name
from vehicle_pf_tracker.trackers.registry import Variant

FACTOR = 4.0
"""A number without a range is searched from its value divided by this to its value times this: a
third of random trials is then within a factor of 1.6 of it."""

Space = Mapping[str, BaseDistribution]
"""Distribution that Optuna draws from, by the name of the parameter."""


def search_space(variant: Variant, values: Mapping[str, Value], words: Sequence[str]) -> Space:
    """Return the space of a search.

    Parameters
    ----------
    variant : Variant
        Entry of the registry.
    values : mapping of str to Value
        Initial values; ranges are derived from these.
    words : sequence of str
        Each ``name`` or ``name=low:high``; none takes the parameters marked as tuned.

    Raises
    ------
    InputError
        If there is no such parameter, or a range is none or not within the parameter's bounds.
    """
    table = {name: spec for name, spec in specs(variant.parameters).items() if name != "seed"}
    chosen = words or default_search(variant)
    if not chosen:
        raise InputError(
            f"no parameter of {variant.name} is marked as tuned; name some with --search"
        )
    space = {}
    for word in chosen:
        name, equals, span = word.partition("=")
        if name not in table:
            raise InputError(unknown_name(name, table))
        space[name] = _given(table[name], span) if equals else _derived(table[name], values[name])
    return space


def _given(spec: ParameterSpec, span: str) -> BaseDistribution:
    low_text, colon, high_text = span.partition(":")
    if not colon or spec.kind not in {int, float}:
        raise InputError(
            f"--search wants NAME or, for a number, NAME=LOW:HIGH, got {spec.name}={span}"
        )
    low, high = (float(spec.parse(text)) for text in (low_text, high_text))
    if low >= high:
        raise InputError(f"the range of {spec.name} is empty: {span}")
    # A range that spans a factor is searched by ratios, as a derived one is.
    return _between(spec, low, high, is_logarithmic=low > 0 and high / low >= FACTOR)


def _derived(spec: ParameterSpec, value: Value) -> BaseDistribution:
    if spec.kind is bool:
        return CategoricalDistribution((False, True))
    if isinstance(value, str):
        if not spec.choices:
            raise InputError(f"{spec.name} can be any word, and so not be searched")
        return CategoricalDistribution(spec.choices)
    # Bounds of 0 to 1 are searched wholly, and evenly: ratios would crowd at 0.
    least, most = spec.bounds or (-math.inf, math.inf)
    if most - least <= 1:  # a share
        return _between(spec, least, most)
    if value <= 0:
        raise InputError(
            f"{spec.name} is {value}, which gives no range: --search {spec.name}=LOW:HIGH"
        )
    low = max(value / FACTOR, least)
    high = min(value * FACTOR, most)
    return _between(spec, low, high, is_logarithmic=True)


def _between(
    spec: ParameterSpec, low: float, high: float, *, is_logarithmic: bool = False
) -> BaseDistribution:
    if spec.kind is float:
        return FloatDistribution(low, high, log=is_logarithmic)
    # Optuna takes logarithms of integers from 1 on only.
    low = max(low, 1.0) if is_logarithmic else low
    return IntDistribution(round(low), round(high), log=is_logarithmic)
