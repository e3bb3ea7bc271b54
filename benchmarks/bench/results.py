# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`bench.json`: what was measured, where, and by which command."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from benchmarks.bench.case import Case
from benchmarks.bench.delivery import Delivery
from benchmarks.bench.memory import MemoryCase


@dataclass
class Results:
    """Results of one run.

    Attributes
    ----------
    environment : mapping
        Machine and versions.
    commands : list of str
        Commands that repeat the measurement.
    cases : list of Case
        CPU times and their ratios.
    memory : list of MemoryCase
        Resident memory.
    deliveries : list of Delivery
        Images sent to many nodes at once, and lost.
    on_target : dict of str to float
        Share of frames on the vehicle of each timed tracker.
    """

    environment: Mapping[str, Any]
    commands: list[str]
    cases: list[Case] = field(default_factory=list)
    memory: list[MemoryCase] = field(default_factory=list)
    deliveries: list[Delivery] = field(default_factory=list)
    on_target: dict[str, float] = field(default_factory=dict)

    def case(self, name: str) -> Case | None:
        """Find a case; None if it was not measured."""
        return next((case for case in self.cases if case.name == name), None)

    def save(self, path: Path) -> None:
        """Write the file, and its folder."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(asdict(self), indent=1) + "\n", encoding="utf-8")

    @classmethod
    def load(cls, path: Path) -> Results:
        """Read what `save` wrote."""
        content = json.loads(path.read_text(encoding="utf-8"))
        return cls(
            environment=content["environment"],
            commands=content["commands"],
            cases=[Case(**case) for case in content["cases"]],
            memory=[MemoryCase(**case) for case in content["memory"]],
            deliveries=[Delivery(**one) for one in content["deliveries"]],
            on_target=content["on_target"],
        )
