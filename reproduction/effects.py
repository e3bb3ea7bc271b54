# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Effects of interpretations that have no experiment of their own: RMSE with a switch either way.

`python -m reproduction.effects` prints the table of docs/interpretations.md. Its seeds are none
of the verdicts'.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

from reproduction.apf import systems as apf
from reproduction.experiment import PAPER_RULE, DataTable, Entry
from reproduction.mfpf import systems as mfpf
from reproduction.resampling import systems as resampling
from reproduction.runs.cells import RunCell, SceneChoice, System
from reproduction.runs.running import run_together
from vehicle_pf_tracker.parameters.table import Value

SEEDS = (100,)
"""Seeds of scene and tracker: one, since every switch of MFPF takes six runs a seed."""


@dataclass(frozen=True, slots=True)
class Effect:
    """One switch, and the runs that show what it does.

    Attributes
    ----------
    number : int
        Number of the interpretation in docs/interpretations.md.
    system : System
        Filter by the paper's rule.
    settings : mapping
        The other side of the switch.
    scenes : sequence of str
        Scenes that both run on.
    """

    number: int
    system: System
    settings: Mapping[str, Value]
    scenes: Sequence[str]

    def cells(self, settings: Mapping[str, Value]) -> list[RunCell]:
        """Make the runs of one side of the switch."""
        return [
            RunCell(SceneChoice.of(scene).seeded(seed), self.system.but(settings), seed, ())
            for scene in self.scenes
            for seed in SEEDS
        ]


_APF = apf.with_sigma(apf.APF, apf.LARGEST_SIGMA)
_MFPF = mfpf.read_as(mfpf.MFPF, PAPER_RULE)
_ADAPTIVE = resampling.VIEWS[PAPER_RULE].adaptive
_VIDEOS = "video03", "video12"
"""Scenes for switches of P1: one with partial and total occlusions, one with partial ones."""
_SCENES = "overlap", "phases"
"""Scenes for switches of P3: both that its experiments run on."""
_RADIUS = float(_MFPF.parameters(0).dispersion.radius)
"""The nominal radius; half of it where the radius that is named is the doubled one."""
EFFECTS = (
    Effect(33, _APF, {"reference.alpha": 1.0}, _VIDEOS),
    Effect(34, _MFPF, {"delayed_reference": True}, mfpf.CASES),
    Effect(35, _MFPF, {"weight_recursion": False}, mfpf.CASES),
    Effect(36, _MFPF, {"dispersion.radius": _RADIUS / 2}, mfpf.CASES),
    Effect(39, _APF, {"window.width": 61.0, "window.height": 41.0}, _VIDEOS),
    Effect(40, _ADAPTIVE, {"weight_recursion": True}, _SCENES),
    # No frame has a pass, so that no measurement counts at all: a filter that does not look.
    Effect(40, _ADAPTIVE, {"most_passes": 0}, _SCENES),
)


def table(effects: Sequence[Effect] = EFFECTS) -> DataTable:
    """Run both sides of each switch, those on one scene together, and average over the runs."""
    sides = [(effect, settings) for effect in effects for settings in ({}, effect.settings)]
    by_scene: dict[SceneChoice, list[RunCell]] = {}
    for effect, settings in sides:
        for cell in effect.cells(settings):
            by_scene.setdefault(cell.scene, []).append(cell)
    errors: dict[RunCell, float] = {}
    for cells in by_scene.values():
        batch = tuple(dict.fromkeys(cells))
        for cell, result in zip(batch, run_together(batch), strict=True):
            errors[cell] = result["metrics"]["rmse_px"]

    def mean(effect: Effect, settings: Mapping[str, Value]) -> float:
        return fmean(errors[cell] for cell in effect.cells(settings))

    rows: list[tuple[Entry, ...]] = [
        (
            str(effect.number),
            ", ".join(f"`{name}: {_parsed(value)}`" for name, value in effect.settings.items()),
            f"`{effect.system.variant}` on {', '.join(effect.scenes)}",
            mean(effect, {}),
            mean(effect, effect.settings),
        )
        for effect in effects
    ]
    columns = ("", "switched to", "runs", "RMSE as it is, px", "switched, px")
    return DataTable(columns, tuple(rows))


def _parsed(value: Value) -> str:
    """Write a value as a parameter file has it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


if __name__ == "__main__":
    sys.stdout.write(table().to_markdown())
