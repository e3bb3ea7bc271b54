# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The three textures that the second paper tried, in the filters that have one: part of table I."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean

from reproduction.experiment import PAPER_RULE, Claim, DataTable, Finding, Holds, Results, Size
from reproduction.mfpf import systems as mfpf
from reproduction.mfpf.systems import MFPF, TEXTURE
from reproduction.numbers import mean_and_spread, seed_means
from reproduction.runs.cells import RunCell, System

_KEPT = "glcm"
"""The texture that the paper kept."""
_LEFT = {
    name: (
        MFPF.but({"texture": name}),
        System.of(f"Texture by {name}", "sfpf_texture", {"texture": name}),
    )
    for name in ("lbp", "haralick")
}
"""The textures that the paper tried and left, in both filters that have one."""
_USED = {_KEPT: (MFPF, TEXTURE)} | _LEFT


def cells(size: Size) -> list[RunCell]:
    """Run both filters with the textures that were left; those with the other run anyway."""
    return [
        mfpf.cell(case, system, seed)
        for case in mfpf.cases(size)
        for pair in _LEFT.values()
        for system in pair
        for seed in size.seeds
    ]


def rows(results: Results, size: Size) -> Iterator[tuple[str, str, str, int, float]]:
    """Give texture, case, filter, seed and RMS of those runs."""
    for texture, pair in _LEFT.items():
        for case in mfpf.cases(size):
            for system in pair:
                values = _rms(results, size, case, system)
                for seed, rms in zip(size.seeds, values, strict=True):
                    yield texture, case, system.label, seed, rms


def table(results: Results, size: Size) -> DataTable:
    """Put the RMS of all textures below each other, by case and over all."""
    made = []
    for texture, systems in _USED.items():
        for name, system in zip(("MFPF", "texture alone"), systems, strict=True):
            values = [_rms(results, size, case, system) for case in mfpf.cases(size)]
            parts = map(mean_and_spread, [*values, _over_cases(results, size, system)])
            made.append((f"{name}, {texture}", *parts))
    return DataTable(("filter", *mfpf.cases(size), "all"), tuple(made))


def claim(results: Results, size: Size) -> Claim:
    """Judge which texture is the best."""
    by_texture = {
        texture: [_over_cases(results, size, system) for system in systems]
        for texture, systems in _USED.items()
    }
    return Claim(
        "of the three textures the elements of the co-occurrence matrix are the most successful",
        "section III-D",
        (_finding(by_texture),),
        "yes: by the mean RMS over all cases, in MFPF and alone; partly: in one of them",
    )


def _finding(by_texture: Mapping[str, Sequence[Sequence[float]]]) -> Finding:
    """Judge each texture's RMS of every seed, in MFPF and alone."""
    first = [
        min(by_texture, key=lambda texture: fmean(by_texture[texture][which])) == _KEPT
        for which in (0, 1)
    ]
    parts = "; ".join(
        f"{texture} {mean_and_spread(joint)} px in MFPF, {mean_and_spread(alone)} px alone"
        for texture, (joint, alone) in by_texture.items()
    )
    return Finding(
        PAPER_RULE, Holds.of(all(first), any(first)), f"mean RMS over all cases: {parts}"
    )


def _rms(results: Results, size: Size, case: str, system: System) -> list[float]:
    return mfpf.per_seed(results, size, case, system, PAPER_RULE, "rmse_px")


def _over_cases(results: Results, size: Size, system: System) -> list[float]:
    """Mean RMS over the cases, for each seed."""
    return seed_means(_rms(results, size, case, system) for case in mfpf.cases(size))
