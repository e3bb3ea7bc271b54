# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Search space of a tuning, derived from the parameter table, and what it can improve."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.table import ParameterSpec, Value, specs, unknown_name
from vehicle_pf_tracker.trackers.registry import Variant

FACTOR = 4.0
"""A positive parameter is searched from its default over this to its default times this."""
_DIGITS = 4


@dataclass(frozen=True, slots=True)
class Objective:
    """A metric of `evaluation.metrics` to maximise or minimise."""

    metric: str
    description: str
    maximise: bool = True


OBJECTIVES: Mapping[str, Objective] = {
    objective.metric: objective
    for objective in (
        Objective("success_auc", "area under the success curve"),
        Objective("precision_auc", "area under the precision curve"),
        Objective("on_target", "share of visible frames with an error below half the diagonal"),
        Objective("p_error_lt_15px", "share of frames with an error below 15 px"),
        Objective("rmse_px", "RMSE in px", maximise=False),
    )
}
"""Objectives by the name of the metric."""


@dataclass(frozen=True, slots=True)
class Dimension:
    """A parameter that is searched.

    Attributes
    ----------
    name : str
        Name of the parameter.
    kind : type
        `bool`, `int`, `float` or `str`.
    low, high : float
        Least and largest value of a number.
    logarithmic : bool
        True if the scale is logarithmic.
    choices : tuple of bool or str
        Values of a parameter that is not a number.
    """

    name: str
    kind: type[Value]
    low: float = 0.0
    high: float = 0.0
    logarithmic: bool = False
    choices: tuple[bool | str, ...] = ()

    def covers(self, value: Value) -> bool:
        """Return whether `value` is in the range."""
        if self.choices:
            return value in self.choices
        return self.low <= float(value) <= self.high

    def tidy(self, value: Value) -> Value:
        """Return `value` with few digits, as it is run and written."""
        if self.kind is not float:
            return value
        rounded = float(f"{float(value):.{_DIGITS}g}")
        return min(max(rounded, self.low), self.high)

    def distribution(self) -> Any:
        """Return the distribution that Optuna draws from."""
        from optuna import distributions  # noqa: PLC0415 - an extra

        if self.choices:
            return distributions.CategoricalDistribution(self.choices)
        if self.kind is int:
            low, high = int(self.low), int(self.high)
            return distributions.IntDistribution(low, high, log=self.logarithmic)
        return distributions.FloatDistribution(self.low, self.high, log=self.logarithmic)

    def __str__(self) -> str:
        if self.choices:
            return f"{self.name}: {', '.join(map(str, self.choices))}"
        scale = ", logarithmic" if self.logarithmic else ""
        return f"{self.name}: {self.low:g} to {self.high:g}{scale}"


def search_space(
    variant: Variant, values: Mapping[str, Value], words: Sequence[str]
) -> list[Dimension]:
    """Return what is searched.

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
    space = [_dimension(table, values, word) for word in chosen]
    names = [dimension.name for dimension in space]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"--search names {twice} twice")
    return space


def default_search(variant: Variant) -> list[str]:
    """Return the parameters of `variant` marked as tuned, as `search_space` takes them."""
    return [_word(spec) for spec in specs(variant.parameters).values() if spec.tuned]


def _word(spec: ParameterSpec) -> str:
    if isinstance(spec.tuned, tuple):
        low, high = spec.tuned
        return f"{spec.name}={low:g}:{high:g}"
    return spec.name


def _dimension(
    table: Mapping[str, ParameterSpec], values: Mapping[str, Value], word: str
) -> Dimension:
    name, equals, span = word.partition("=")
    if name not in table:
        raise InputError(unknown_name(name, table))
    return _given(table[name], span) if equals else _derived(table[name], values[name])


def _given(spec: ParameterSpec, span: str) -> Dimension:
    low_text, colon, high_text = span.partition(":")
    if not colon or spec.kind not in {int, float}:
        raise InputError(
            f"--search wants NAME or, for a number, NAME=LOW:HIGH, got {spec.name}={span}"
        )
    low, high = (float(spec.parse(text)) for text in (low_text, high_text))
    if low >= high:
        raise InputError(f"the range of {spec.name} is empty: {span}")
    return Dimension(spec.name, spec.kind, low, high, low > 0 and high / low >= FACTOR)


def _derived(spec: ParameterSpec, value: Value) -> Dimension:
    if spec.kind is bool:
        return Dimension(spec.name, bool, choices=(False, True))
    if isinstance(value, str):
        if not spec.choices:
            raise InputError(f"{spec.name} can be any word, and so not be searched")
        return Dimension(spec.name, str, choices=spec.choices)
    least, most = spec.bounds or (-math.inf, math.inf)
    if most - least <= 1:  # a share
        return Dimension(spec.name, spec.kind, least, most)
    if value <= 0:
        raise InputError(
            f"{spec.name} is {value}, which gives no range: --search {spec.name}=LOW:HIGH"
        )
    low, high = max(value / FACTOR, least), min(value * FACTOR, most)
    if spec.kind is int:
        low, high = max(float(round(low)), 1.0), float(round(high))
    return Dimension(spec.name, spec.kind, low, high, logarithmic=True)
