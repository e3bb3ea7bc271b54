# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A recording played to one tracker node: `ros2 launch … replay.launch.py recording:=FOLDER`."""

import sys
from pathlib import Path

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch_ros.actions import Node

from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.ros.launching import TRACKER_ARGUMENTS, declared, included_tracker
from vehicle_pf_tracker.ros.replay.launched_replay import (
    REPLAY_ARGUMENTS,
    queue_depth,
    replay_words,
)
from vehicle_pf_tracker.ros.replay.publishing import recorded_images

_NAMES = ("variant", "params_file", "namespace", "name", "log_level", "rviz", "foxglove")
# Arguments that go on to the tracker's own launch file.
PASSED_ON = {
    **{name: TRACKER_ARGUMENTS[name] for name in _NAMES},
    "use_sim_time": ("false", "Follow /clock, which the replay then publishes"),
}


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            DeclareLaunchArgument("recording", description="rosbag2 folder, or bare .mcap file"),
            *declared({**REPLAY_ARGUMENTS, **PASSED_ON}),
            OpaqueFunction(function=start),
        ]
    )


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    names = "recording", *REPLAY_ARGUMENTS, *PASSED_ON
    given = {name: context.launch_configurations[name] for name in names}
    images = recorded_images(Recording(Path(given["recording"]), given["topic"] or None))
    of_node = {
        **{name: given[name] for name in PASSED_ON},
        "image_topic": images.base,
        "image_transport": images.transport,
        "queue_depth": queue_depth(given),
    }
    return [
        included_tracker(of_node),
        Node(
            package="vehicle_pf_tracker",
            executable="bag_replay",
            arguments=replay_words(given, images),
            output="screen",
            emulate_tty=sys.stdout.isatty(),
            on_exit=Shutdown(reason="the replay has ended"),
        ),
    ]
