# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every vehicle before a camera: `ros2 launch vehicle_pf_tracker traffic.launch.py`."""

from launch import LaunchDescription
from launch.substitutions import LaunchConfiguration

from vehicle_pf_tracker.ros.launching import TRACKER_ARGUMENTS, declared, included_tracker


def generate_launch_description() -> LaunchDescription:
    own = {name: words for name, words in TRACKER_ARGUMENTS.items() if name != "variant"}
    passed_on = {name: LaunchConfiguration(name) for name in own}
    return LaunchDescription(
        [*declared(own), included_tracker({"variant": "traffic", **passed_on})]
    )
