# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A paper, what came of it, and its experiments."""

from __future__ import annotations

from dataclasses import dataclass

from reproduction.experiment import Experiment


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
