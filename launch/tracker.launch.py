# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One tracker node on a camera: `ros2 launch vehicle_pf_tracker tracker.launch.py variant:=apf`."""

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import LogInfo, OpaqueFunction
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import Parameter
from launch_ros.substitutions import FindPackageShare

from vehicle_pf_tracker.ros.launching import (
    TRACKER_ARGUMENTS,
    declared,
    image_remappings,
    is_true,
    layout_for,
    parameter_file,
    program,
    started,
)


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription([*declared(TRACKER_ARGUMENTS), OpaqueFunction(function=start)])


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    given = {name: context.launch_configurations[name] for name in TRACKER_ARGUMENTS}
    share = FindPackageShare("vehicle_pf_tracker").perform(context)
    executable, words = program(given["variant"])
    name = given["name"] or f"{given['variant']}_tracker"
    # Not a dictionary: launch_ros writes one to a file that it never removes.
    own = [Parameter("use_sim_time", is_true(given["use_sim_time"]))]
    if given["image_transport"]:
        own.append(Parameter("image_transport", given["image_transport"]))
    if given["queue_depth"]:
        own.append(Parameter("queue_depth", int(given["queue_depth"])))
    if given["detections_topic"]:
        own.append(Parameter("detector.kind", "topic"))
    if given["lines"]:
        own.append(Parameter("lines", given["lines"]))
    path = parameter_file(given["params_file"], given["variant"], share)
    node = started(
        given,
        share,
        executable=executable,
        arguments=words,
        name=name,
        namespace=given["namespace"],
        parameters=[*([path] if path else []), *own],
        remappings=[
            *image_remappings(given["image_topic"]),
            *([("detections", topic)] if (topic := given["detections_topic"]) else []),
        ],
    )
    full_name = "/".join(["", *filter(None, [given["namespace"].strip("/"), name])])
    return [*node, *viewers(given, full_name, share)]


def viewers(given: dict[str, str], node: str, share: str) -> list[LaunchDescriptionEntity]:
    found: list[LaunchDescriptionEntity] = []
    if is_true(given["rviz"]):
        words = ["-d", layout_for(node, "tracker.rviz", share)]
        found.append(Node(package="rviz2", executable="rviz2", arguments=words))
    if is_true(given["foxglove"]):
        path = layout_for(node, "foxglove_live.json", share)
        told = f"in Foxglove: open the connection ws://localhost:8765, and import the layout {path}"
        found.append(Node(package="foxglove_bridge", executable="foxglove_bridge"))
        found.append(LogInfo(msg=told))
    return found
