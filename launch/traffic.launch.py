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

"""Every vehicle before a camera: `ros2 launch vehicle_pf_tracker traffic.launch.py`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

# Defaults are constants: a default made of another argument would stay for the next inclusion.
ARGUMENTS = {
    "image_topic": ("/camera/image_raw", "Images; compressed ones are below it, in /compressed"),
    "image_transport": ("", "raw or compressed; empty leaves it to the parameter file"),
    "detections_topic": (
        "", "Detections (vision_msgs/Detection2DArray) to follow; empty leaves the detector to the "
        "parameter file, whose default is what moves before a standing camera",
    ),
    "lines": ("", "YAML of lines and zones to count at; empty leaves it to the parameter file"),
    "params_file": ("", "Parameter YAML; empty takes config/traffic.yaml"),
    "namespace": ("", "Of the node"),
    "name": ("", "Of the node; empty takes traffic_tracker"),
    "use_sim_time": ("false", "Follow /clock"),
    "log_level": ("info", "Least severity to log: debug, info, warn, error or fatal"),
    "respawn": ("false", "Start the node again when it ends"),
    "large_images": (
        "false", "Give what starts from here on shared memory for large images, in Fast DDS",
    ),
}  # fmt: skip


def generate_launch_description() -> LaunchDescription:
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=words)
        for name, (default, words) in ARGUMENTS.items()
    ]
    tracker = PathJoinSubstitution(
        [FindPackageShare("vehicle_pf_tracker"), "launch", "tracker.launch.py"]
    )
    passed_on = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    include = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(tracker),
        launch_arguments={"variant": "traffic", **passed_on}.items(),
    )
    return LaunchDescription([*declared, include])
