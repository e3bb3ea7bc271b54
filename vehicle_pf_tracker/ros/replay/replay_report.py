# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Report of a replay: what was played, and what each node answered."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vehicle_pf_tracker.results.estimates import EstimateRow


@dataclass(frozen=True, slots=True)
class NodeReport:
    """Answers of one node to the images.

    Attributes
    ----------
    name : str
        Its full name.
    answered : int
        Number of images answered, in all passes of a loop.
    rows : tuple of EstimateRow
        One for each image of the last pass, in order; mode `DROPPED` where no answer came.
    road : mapping of str to list of float or None
        Columns beside the rows, where the node has a road.
    """

    name: str
    answered: int
    rows: tuple[EstimateRow, ...]
    road: Mapping[str, list[float | None]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ReplayReport:
    """Summary of a replay.

    Attributes
    ----------
    frames : int
        Images published, in all passes of a loop.
    seconds : float
        Time from the first message to the last answer.
    nodes : tuple of NodeReport
        The tracker nodes that took part.
    notices : tuple of str
        Irregularities, a sentence each.
    interrupted : bool
        True if the user ended it.
    """

    frames: int
    seconds: float
    nodes: tuple[NodeReport, ...]
    notices: tuple[str, ...] = ()
    interrupted: bool = False
