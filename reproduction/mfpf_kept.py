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

"""Runs that never lost the vehicle apart from those that did: part of the second paper's table I.

An RMS over both says how often a filter loses the vehicle, not how exactly it follows.
"""

from __future__ import annotations

from statistics import fmean

from reproduction import mfpf_systems as mfpf
from reproduction.cells import System
from reproduction.experiment import Claim, DataTable, Finding, Holds, Results, Size
from reproduction.mfpf_systems import FOUR, INTERPRETATIONS, MFPF, SINGLES

_PLACE = "section V, table I"


def table(results: Results, size: Size) -> DataTable:
    """Give RMS and number of the runs of either kind, by case."""
    rows = tuple(
        (mfpf.read_label(system.label, interpretation),
         *(_entry(results, size, case, system, interpretation) for case in mfpf.cases(size)))
        for interpretation in INTERPRETATIONS
        for system in FOUR
    )  # fmt: skip
    return DataTable(("filter", *mfpf.cases(size)), rows)


def claim(results: Results, size: Size) -> Claim:
    """Judge how exactly MFPF follows where no filter loses the vehicle."""
    return Claim(
        "(not in the paper) with the seeds with which none of the four filters ever lost the "
        "vehicle, MFPF has the least RMS",
        _PLACE,
        tuple(_finding(results, size, interpretation) for interpretation in INTERPRETATIONS),
    )


def _kept(results: Results, case: str, system: System, seed: int, interpretation: str) -> bool:
    """Say whether every visible frame is on target: within half the box's diagonal."""
    return mfpf.metric(results, case, system, seed, interpretation, "on_target") >= 1.0


def _rms(results: Results, case: str, system: System, seed: int, interpretation: str) -> float:
    return mfpf.metric(results, case, system, seed, interpretation, "rmse_px")


def _entry(results: Results, size: Size, case: str, system: System, interpretation: str) -> str:
    parts = []
    for is_kept in (True, False):
        found = [
            _rms(results, case, system, seed, interpretation)
            for seed in size.seeds
            if _kept(results, case, system, seed, interpretation) is is_kept
        ]
        parts.append(f"{fmean(found):.1f} ({len(found)})" if found else "–")
    return " / ".join(parts)


def _finding(results: Results, size: Size, interpretation: str) -> Finding:
    ahead, parts = [], []
    for case in mfpf.cases(size):
        seeds = [
            seed
            for seed in size.seeds
            if all(_kept(results, case, system, seed, interpretation) for system in FOUR)
        ]
        if not seeds:
            continue
        means = {
            system.label: fmean(_rms(results, case, system, s, interpretation) for s in seeds)
            for system in FOUR
        }
        best = min((single.label for single in SINGLES), key=means.__getitem__)
        ahead.append(means[MFPF.label] <= means[best])
        parts.append(
            f"{case} {means[MFPF.label]:.1f} px against {means[best]:.1f} px of {best} "
            f"({len(seeds)} seeds)"
        )
    if not parts:
        return Finding(interpretation, Holds.NO, "in no case is there such a seed")
    return Finding(interpretation, Holds.of(all(ahead), any(ahead)), ", ".join(parts))
