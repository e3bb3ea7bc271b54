# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`fusion` with another network for the sides: one that has not learnt from the camera."""

from __future__ import annotations

import functools
import hashlib
from dataclasses import replace
from pathlib import Path

from laboratory.stress.systems import StressSystem
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.systems import System
from vehicle_pf_tracker.image.patches.side_network import SideNetwork
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.tracker import FusionTracker


class _OtherNetwork(FusionTracker):
    """Tracker whose memory has another network."""

    def __init__(self, parameters: FusionParameters, network: SideNetwork) -> None:
        super().__init__(parameters)
        self._network = network

    def _learn(self) -> None:
        super()._learn()
        _, memory = self._track
        self.memory = replace(memory, network=self._network)


def with_network(system: System, file: Path) -> StressSystem:
    """Put `fusion` to the test with the network of a file.

    Raises
    ------
    InputError
        If the file is not there, or is not a network.
    """
    try:
        SideNetwork.read(file)
        digest = hashlib.sha256(file.read_bytes()).hexdigest()
    except (OSError, ValueError, KeyError) as error:
        raise InputError(
            f"{file} is not a network for the sides: `laboratory.train_sides` writes them"
        ) from error
    own = StressSystem.of(system)
    facts = {**own.facts, "side network": digest}
    return replace(own, make=functools.partial(_make, system, file), facts=facts)


def _make(system: System, file: Path, seed: int) -> FusionTracker:
    parameters = system.tracker_parameters(seed)
    assert isinstance(parameters, FusionParameters)
    return _OtherNetwork(parameters, SideNetwork.read(file))
