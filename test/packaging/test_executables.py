# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every executable starts, wherever this package is installed: a smoke test of its own for each."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from vehicle_pf_tracker.trackers.registry import NODES

ROS_NODES = ["video_source", *(variant.executable for variant in NODES.values())]
FEW = ["video_source", "fusion_tracker", "traffic_tracker"]
"""One of each kind."""


def executable(name):
    """Where ``ros2 run`` would look, else where pip puts it."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    folders = [Path(prefix, "lib", "vehicle_pf_tracker") for prefix in prefixes if prefix]
    path = os.pathsep.join(map(str, [*folders, Path(sys.executable).parent]))
    found = shutil.which(name, path=path)
    if found is None:
        pytest.skip(f"{name} is not installed here")
    return found


def run(name, *words):
    command = [executable(name), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)


@pytest.mark.parametrize("name", ["vehicle-pf-tracker", "bag_replay"])
def test_a_command_says_how_it_is_used(name):
    done = run(name, "--help")
    assert done.returncode == 0, done.stderr
    assert "usage: vehicle-pf-tracker" in done.stdout


@pytest.mark.parametrize("name", ROS_NODES)
def test_every_executable_is_installed(name):
    assert executable(name)


@pytest.mark.parametrize("name", FEW)
def test_a_node_says_how_it_is_used(name):
    pytest.importorskip("rclpy", reason="ROS 2 is not installed")
    done = run(name, "--help")
    assert done.returncode == 0, done.stderr
    assert f"usage: {name}" in done.stdout
