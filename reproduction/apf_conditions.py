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

"""Scenes in which nothing hides the vehicle, beside table II of the first paper.

The paper has two such videos and says nothing about what happens in them; a tracker that is made
for occlusions must not pay for it where there are none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import TypeAlias

from reproduction.apf_systems import (
    COMPARISONS,
    INTERPRETATIONS,
    OWN_LIKELIHOOD,
    RIVALS,
    Comparison,
)
from reproduction.cells import SceneChoice
from reproduction.experiment import Claim, DataTable, Entry, Finding, Holds
from vehicle_pf_tracker.parameters.table import Value

FACTOR = 1.5
"""Factor of the best rival's median error that still counts as equal."""
_FAST = 15.0
_SCENES: dict[str, tuple[str, dict[str, Value]]] = {
    "clear": ("clear", {}),
    "shadows": ("shadows", {}),
    "acceleration": ("acceleration", {}),
    "turn": ("turn", {}),
    "illumination": ("illumination", {}),
    "scale": ("scale", {}),
    f"{_FAST:g} px/frame": ("clear", {"speed": _FAST}),
}

CONDITIONS: dict[str, SceneChoice] = {
    **{name: SceneChoice.of(scene, settings) for name, (scene, settings) in _SCENES.items()},
    **{
        f"rough, {name}": SceneChoice.of(scene, {**settings, "disturbance": "rough"})
        for name, (scene, settings) in _SCENES.items()
    },
}
"""Conditions by name: each with a clean camera, and with one that shakes, flickers and is noisy."""

_JUDGED = COMPARISONS[:4]
"""The interpretations, and the rivals with their own likelihood."""

Errors: TypeAlias = Mapping[str, Mapping[str, Sequence[float]]]


def condition_table(conditions: Errors) -> DataTable:
    """Put the medians side by side, and how far APF is behind the best rival."""
    apf = [system.label for system in INTERPRETATIONS.values()]
    labels = [*(rival.label for rival in (*RIVALS, *OWN_LIKELIHOOD)), *apf]
    rows: list[tuple[Entry, ...]] = [
        (name, *(median(errors[label]) for label in labels),
         *(f"{_ratio(errors, one):.2f}" for one in _JUDGED))
        for name, errors in conditions.items()
    ]  # fmt: skip
    heads = (f"APF / best rival, {one.name}" for one in _JUDGED)
    return DataTable(("condition", *labels, *heads), tuple(rows))


def condition_claims(conditions: Errors) -> tuple[Claim, ...]:
    """Judge every interpretation in all conditions."""
    return (
        Claim(
            f"(assumed by the paper) without occlusion APF's median RMSE "
            f"is at most {FACTOR:g} times the best rival's, in each condition",
            "unoccluded conditions",
            tuple(_finding(conditions, one) for one in _JUDGED),
        ),
    )


def _finding(conditions: Errors, one: Comparison) -> Finding:
    ratios = {name: _ratio(errors, one) for name, errors in conditions.items()}
    behind = {name: ratio for name, ratio in ratios.items() if ratio > FACTOR}
    parts = "; ".join(f"{name} {ratio:.2f}" for name, ratio in behind.items())
    return Finding(
        one.name,
        Holds.share(1 - len(behind) / len(ratios), yes=1.0),
        f"within {FACTOR:g} times in {len(ratios) - len(behind)} of {len(ratios)} conditions"
        + (f"; beyond it: {parts} times" if behind else ""),
    )


def _ratio(errors: Mapping[str, Sequence[float]], one: Comparison) -> float:
    best = min(median(errors[label]) for label in one.rival_labels)
    return median(errors[one.apf.label]) / best
