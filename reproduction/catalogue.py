# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The experiments by name, in the order of the papers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from reproduction import (
    apf_fig1,
    apf_fig2,
    apf_fig3,
    apf_fig4,
    apf_fig5,
    apf_fig6,
    apf_fig7,
    apf_systems,
    apf_table1,
    apf_table2,
    apf_timing,
    mfpf_errors,
    mfpf_fig2,
    mfpf_frames,
    mfpf_histograms,
    mfpf_similarities,
    mfpf_systems,
    mfpf_table1,
    mfpf_table2,
    mfpf_table3,
    mfpf_timing,
    resampling_cost,
    resampling_fig4,
    resampling_fig5,
    resampling_frames,
    resampling_systems,
)
from reproduction.experiment import Experiment
from vehicle_pf_tracker.core.errors import InputError

_APF = (
    apf_fig1, apf_fig2, apf_fig3, apf_fig4, apf_fig5, apf_fig6, apf_fig7, apf_table1, apf_table2,
    apf_timing,
)  # fmt: skip
_MFPF = (
    mfpf_table1, mfpf_table2, mfpf_table3, mfpf_similarities, mfpf_errors, mfpf_frames,
    mfpf_histograms, mfpf_fig2, mfpf_timing,
)  # fmt: skip
_RESAMPLING = resampling_fig4, resampling_fig5, resampling_frames, resampling_cost


@dataclass(frozen=True, slots=True)
class Paper:
    """A paper and its experiments.

    Attributes
    ----------
    title : str
        Authors, year and method.
    method : str
        Short name of what the paper proposes.
    gist : str
        What came of its main claims, in words; to be read again whenever verdicts change.
    settings : str
        Settings of the runs, and each interpretation that the paper's claims are judged under.
    experiments : tuple of Experiment
        In the paper's order.
    """

    title: str
    method: str
    gist: str
    settings: str
    experiments: tuple[Experiment, ...]


PAPERS = (
    Paper(
        "Scharcanski et al. 2011: APF",
        "APF",
        "The main claim holds: over the twenty videos it has the smallest mean error of the six "
        "trackers, and it comes through most total occlusions, at which its rivals lose the "
        "vehicle. It does not lead on every video, and the best spread of the particles is not "
        "half the speed. As printed it loses the vehicle.",
        apf_systems.SIGMA_RULE,
        tuple(module.EXPERIMENT for module in _APF),
    ),
    Paper(
        "Abdulla et al. 2022: MFPF",
        "MFPF",
        "The main claim holds only in part: three features have the least error in some of the "
        "six cases. Over all cases and ten seeds the colour filter with the same values is ahead. "
        "MFPF is ahead of single-feature filters that lack what the paper's section IV adds.",
        mfpf_systems.INTERPRETATIONS_NOTE,
        tuple(module.EXPERIMENT for module in _MFPF),
    ),
    Paper(
        "Khong et al.: adaptive resampling",
        "Adaptive resampling",
        "The saving is confirmed: it takes fewer passes, resamples fewer particles and needs less "
        "time. That it finds the vehicle again where the conventional filter has lost it is not: "
        "both mostly do.",
        resampling_systems.INTERPRETATIONS_NOTE,
        tuple(module.EXPERIMENT for module in _RESAMPLING),
    ),
)
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
