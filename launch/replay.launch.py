# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A recording played to one tracker node: `ros2 launch … replay.launch.py recording:=FOLDER`."""

import sys
from pathlib import Path

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch_ros.actions import Node

from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.ros.launching import ARGUMENTS, declared, included_tracker, is_true
from vehicle_pf_tracker.ros.replay.publishing import RecordedImages, recorded_images

OWN = {
    "topic": ("", "Image topic of the recording, if it has several"),
    "target": ("", "Box to start on, x,y,w,h in px; empty takes the first true box"),
    "rate": ("1.0", "Speed of the replay"),
    "loop": ("false", "Begin again at the end"),
}
_NAMES = ("variant", "params_file", "namespace", "name", "log_level", "rviz", "foxglove")
PASSED_ON = {
    **{name: ARGUMENTS[name] for name in _NAMES},
    "use_sim_time": ("false", "Follow /clock, which the replay then publishes"),
}


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            DeclareLaunchArgument("recording", description="rosbag2 folder, or bare .mcap file"),
            *declared({**OWN, **PASSED_ON}),
            OpaqueFunction(function=start),
        ]
    )


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    given = {name: context.launch_configurations[name] for name in ("recording", *OWN, *PASSED_ON)}
    images = recorded_images(Recording(Path(given["recording"]), given["topic"] or None))
    found = {"image_topic": images.base, "image_transport": images.transport}
    return [
        included_tracker({**{name: given[name] for name in PASSED_ON}, **found}),
        Node(
            package="vehicle_pf_tracker",
            executable="bag_replay",
            arguments=words(given, images),
            output="screen",
            emulate_tty=sys.stdout.isatty(),
            on_exit=Shutdown(reason="the replay has ended"),
        ),
    ]


def words(given: dict[str, str], images: RecordedImages) -> list[str]:
    """Command line of the replay; the search for the node lasts as long as a slow start."""
    name = given["name"] or f"{given['variant']}_tracker"
    chosen = [given["recording"], "--topic", images.topic, "--rate", given["rate"]]
    chosen += ["--node", f"{given['namespace'].strip('/')}/{name}", "--timeout", "60"]
    if images.published != images.topic:
        chosen += ["--remap", f"{images.topic}:={images.published}"]
    if given["target"]:
        chosen += ["--target", given["target"]]
    elif given["variant"] == "traffic":  # it finds its vehicles itself
        chosen.append("--no-target")
    if is_true(given["loop"]):
        chosen.append("--loop")
    if is_true(given["use_sim_time"]):
        chosen += ["--clock", "100"]
    return chosen
