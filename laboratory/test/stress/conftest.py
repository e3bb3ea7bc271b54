# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest
from stress_samples import write_sequence

from laboratory.stress import find_sequences, full_battery


@pytest.fixture(scope="session")
def drive(tmp_path_factory):
    """A still camera, a straight course."""
    folder = tmp_path_factory.mktemp("stress")
    write_sequence(folder / "still" / "drive")
    return find_sequences(folder)[0]


@pytest.fixture(scope="session")
def battery(drive):
    """All its cases."""
    return full_battery([drive])
