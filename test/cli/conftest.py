# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A Python that commands are forked from, where their start is not what is tested."""

import pytest
from loaded_python import LoadedPython
from unmeasured import unmeasured_environment

LOADED = (
    *(f"vehicle_pf_tracker.cli.{verb}" for verb in ("main", "import_footage", "synth")),
    *(f"vehicle_pf_tracker.cli.{verb}" for verb in ("run", "traffic", "evaluate")),
    "vehicle_pf_tracker.trackers.fusion.tracker",
    "scipy.optimize",
)


@pytest.fixture(scope="session")
def unmeasured_python():
    """It has loaded the command with most of its verbs, and coverage does not follow it."""
    python = LoadedPython(LOADED, unmeasured_environment())
    yield python
    python.close()
