# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The experiments by name, in the order of the papers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from reproduction.apf import paper as apf
from reproduction.experiment import Experiment
from reproduction.mfpf import paper as mfpf
from reproduction.resampling import paper as resampling
from vehicle_pf_tracker.core.errors import InputError

PAPERS = apf.PAPER, mfpf.PAPER, resampling.PAPER
EXPERIMENTS: Mapping[str, Experiment] = MappingProxyType(
    {experiment.name: experiment for paper in PAPERS for experiment in paper.experiments}
)
"""Experiments by name."""
ALL = "all"
"""Word for all experiments on the command line."""


def find_experiments(names: Sequence[str]) -> list[Experiment]:
    """Look up experiments, each once and in the catalogue's order; `ALL` stands for all.

    Raises
    ------
    InputError
        If there is none of a name.
    """
    unknown = [name for name in names if name not in EXPERIMENTS and name != ALL]
    if unknown:
        raise InputError(
            f"there is no experiment {', '.join(map(repr, unknown))}; "
            f"choose {ALL} or some of {', '.join(EXPERIMENTS)}"
        )
    return [e for e in EXPERIMENTS.values() if ALL in names or e.name in names]
