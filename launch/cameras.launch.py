# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A tracker for each camera of a file: `ros2 launch … cameras.launch.py cameras:=FILE`."""

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import (
    DeclareLaunchArgument,
    GroupAction,
    IncludeLaunchDescription,
    OpaqueFunction,
)
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

from vehicle_pf_tracker.ros.launching import read_cameras

FOR_ALL = {
    "use_sim_time": ("false", "Follow /clock"),
    "log_level": ("info", "Least severity to log: debug, info, warn, error or fatal"),
    "respawn": ("true", "Start a node again when it ends"),
    "large_images": ("false", "Shared memory for large images, in Fast DDS"),
}


def generate_launch_description() -> LaunchDescription:
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=words)
        for name, (default, words) in FOR_ALL.items()
    ]
    return LaunchDescription(
        [
            DeclareLaunchArgument("cameras", description="YAML of cameras by name"),
            *declared,
            OpaqueFunction(function=start),
        ]
    )


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    given = context.launch_configurations
    tracker = PathJoinSubstitution(
        [FindPackageShare("vehicle_pf_tracker"), "launch", "tracker.launch.py"]
    )
    groups = []
    for camera in read_cameras(given["cameras"]):
        arguments = {
            "variant": camera.variant,
            "params_file": camera.write_parameters(),
            "image_topic": camera.topic,
            "image_transport": "",
            "detections_topic": "",
            "lines": "",
            "namespace": camera.name,
            "name": "",
            **{name: given[name] for name in FOR_ALL},
        }
        include = IncludeLaunchDescription(
            PythonLaunchDescriptionSource(tracker), launch_arguments=arguments.items()
        )
        groups.append(GroupAction([include], scoped=True))
    return groups
