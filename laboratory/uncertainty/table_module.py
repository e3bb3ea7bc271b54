# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The module with the calibration of every variant, which the package reads, as it is written."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path

from laboratory.uncertainty.fit import fit
from laboratory.uncertainty.runs import Runs, runs_of
from vehicle_pf_tracker.trackers.uncertainty import Spread

TABLE = Path(__file__).parents[2] / "vehicle_pf_tracker" / "trackers" / "uncertainty_table.py"
"""File that holds it in the package."""
_TEXT = (
    '''"""Calibration of covariances, written by `python -m laboratory.uncertainty fit`."""

from __future__ import annotations

from collections.abc import Mapping

from vehicle_pf_tracker.trackers.uncertainty import Calibration, Spread

_SPREADS: Mapping[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
''',
    '''}
"""`Spread` while visible and otherwise, by variant; `*` serves those that are not in it."""

CALIBRATIONS: Mapping[str, Calibration] = {
    name: Calibration(Spread(*visible), Spread(*hidden))
    for name, (visible, hidden) in _SPREADS.items()
}
''',
)
"""Its text before the rows of variants, and after them."""


def licence_comment() -> str:
    """Return the comment that the package's modules begin with."""
    lines = TABLE.with_name("estimate.py").read_text(encoding="utf-8").splitlines(keepends=True)
    return "".join(line for line in lines[:14] if line.startswith("#"))


def fitted_table(folder: Path, licence: str) -> str:
    """Write the module with the calibration of every variant, and of all together."""
    paths = runs_of(folder)
    everything = [path for group in paths.values() for path in group]
    fits = {name: fit(Runs(group)) for name, group in [("*", everything), *paths.items()]}
    rows = [
        f'    "{name}": ({_source(found.visible)}, {_source(found.hidden)}),\n'
        for name, found in fits.items()
    ]
    return f"{licence}{_TEXT[0]}{''.join(rows)}{_TEXT[1]}"


def _source(spread: Spread) -> str:
    numbers = astuple(spread)
    used = numbers if any(numbers[4:]) else numbers[:4]
    return f"({', '.join(f'{number:g}' for number in used)})"
