# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Interpreters of fresh environments; test/packaging/test_installs.py makes real ones."""

import sys
from pathlib import Path

import pytest

from tools.release.commands import ReleaseError
from tools.release.environment import interpreter


def test_the_interpreter_is_this_one_or_that_of_a_version_on_the_path():
    assert interpreter(None) == Path(sys.executable)
    with pytest.raises(ReleaseError, match=r"looked for 2\.5"):
        interpreter("2.5")
