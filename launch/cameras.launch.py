# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""A tracker for each camera of a file: `ros2 launch … cameras.launch.py cameras:=FILE`."""

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import DeclareLaunchArgument, GroupAction, OpaqueFunction
from launch_ros.parameter_descriptions import Parameter
from launch_ros.substitutions import FindPackageShare

from vehicle_pf_tracker.ros.camera_file import read_cameras
from vehicle_pf_tracker.ros.launching import (
    TRACKER_ARGUMENTS,
    declared,
    included_tracker,
    is_true,
    started,
)

# Arguments that are the same for all cameras.
FOR_ALL = {
    **{name: TRACKER_ARGUMENTS[name] for name in ("use_sim_time", "log_level", "large_images")},
    "respawn": ("true", "Start a node again when it ends"),
}
# In turns they share what libraries keep in memory, and one failure ends all.
CONTAINER = {"container": ("false", "Run all nodes in one process, in turns")}


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            DeclareLaunchArgument("cameras", description="YAML of cameras by name"),
            *declared({**FOR_ALL, **CONTAINER}),
            OpaqueFunction(function=start),
        ]
    )


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    given = context.launch_configurations
    cameras = read_cameras(given["cameras"])
    if is_true(given["container"]):
        return started(
            given,
            FindPackageShare("vehicle_pf_tracker").perform(context),
            executable="vehicle_tracker",
            arguments=["--cameras", given["cameras"]],
            parameters=[Parameter("use_sim_time", is_true(given["use_sim_time"]))],
        )
    groups = []
    for camera in cameras:
        arguments = {
            "variant": camera.variant,
            "params_file": camera.write_parameters(),
            "image_topic": camera.topic,
            "namespace": camera.name,
            **{name: given[name] for name in FOR_ALL},
        }
        groups.append(GroupAction([included_tracker(arguments)], scoped=True))
    return groups
