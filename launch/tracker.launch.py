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

"""One tracker node on a camera: `ros2 launch vehicle_pf_tracker tracker.launch.py variant:=apf`."""

import sys
from pathlib import Path

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import DeclareLaunchArgument, OpaqueFunction, SetEnvironmentVariable
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import Parameter
from launch_ros.substitutions import FindPackageShare

from vehicle_pf_tracker.ros.launching import parameter_file
from vehicle_pf_tracker.ros.transport import PROFILE_VARIABLES

# Defaults are constants: a default made of another argument would stay for the next inclusion.
ARGUMENTS = {
    "variant": ("apf", "Tracker to run"),
    "params_file": ("", "Parameter YAML; empty takes that of the variant"),
    "image_topic": ("/camera/image_raw", "Images; compressed ones are below it, in /compressed"),
    "image_transport": ("", "raw or compressed; empty leaves it to the parameter file"),
    "detections_topic": (
        "", "For traffic: detections (vision_msgs/Detection2DArray) to follow; empty leaves the "
        "detector to the parameter file",
    ),
    "lines": (
        "", "For traffic: YAML of lines and zones to count at; empty leaves it to the parameter "
        "file",
    ),
    "namespace": ("", "Of the node"),
    "name": ("", "Of the node; empty takes VARIANT_tracker"),
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
    return LaunchDescription([*declared, OpaqueFunction(function=start)])


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    given = {name: context.launch_configurations[name] for name in ARGUMENTS}
    share = FindPackageShare("vehicle_pf_tracker").perform(context)
    executable = f"{given['variant']}_tracker"
    # Not a dictionary: launch_ros writes one to a file that it never removes.
    own = [Parameter("use_sim_time", is_true(given["use_sim_time"]))]
    if given["image_transport"]:
        own.append(Parameter("image_transport", given["image_transport"]))
    if given["detections_topic"]:
        own.append(Parameter("detector.kind", "topic"))
    if given["lines"]:
        own.append(Parameter("lines", given["lines"]))
    node = Node(
        package="vehicle_pf_tracker",
        executable=executable,
        name=given["name"] or executable,
        namespace=given["namespace"],
        parameters=[parameter_file(given["params_file"], given["variant"], share), *own],
        remappings=[
            ("image", given["image_topic"]),
            ("image/compressed", f"{given['image_topic']}/compressed"),
            *([("detections", topic)] if (topic := given["detections_topic"]) else []),
        ],
        ros_arguments=["--log-level", given["log_level"]],
        respawn=is_true(given["respawn"]),
        respawn_delay=2.0,
        output="screen",
        emulate_tty=sys.stdout.isatty(),
    )
    if not is_true(given["large_images"]):
        return [node]
    path = str(Path(share, "config", "large_images.xml"))
    return [*(SetEnvironmentVariable(name, path) for name in PROFILE_VARIABLES), node]


def is_true(word: str) -> bool:
    return word.lower() in {"true", "1"}
