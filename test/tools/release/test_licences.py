# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import sys
from pathlib import Path

import pytest

from tools.release.commands import ReleaseError
from tools.release.licences import Licence, check_licences, licences_in


def test_a_distribution_without_a_licence_is_named():
    good = [Licence("a", "1", "MIT", 0), Licence("b", "1", "", 2)]
    assert check_licences(good) == "a 1: MIT; b 1: see its file"
    of_ros = Licence("std_srvs", "1", "", 0), Licence("ros-rclpy", "1", "", 0)
    assert check_licences([*good, *of_ros]) == "a 1: MIT; b 1: see its file"
    with pytest.raises(ReleaseError, match=r"no licence: c$"):
        check_licences([*good, Licence("c", "1", "", 0)])


def test_those_of_this_environment_are_read():
    licences = {licence.name: licence for licence in licences_in(Path(sys.executable))}
    assert licences["pytest"].words == "MIT"
    assert licences["pytest"].files >= 1
