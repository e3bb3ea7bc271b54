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

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import EnvironmentVariable, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

# Keeps the memory of received images instead of giving it back after each one, which halves the
# cost of receiving them. What the user has set stays.
ALLOCATOR = {
    "MALLOC_MMAP_THRESHOLD_": "1073741824",
    "MALLOC_TRIM_THRESHOLD_": "1073741824",
    "MALLOC_TOP_PAD_": "67108864",
}


def generate_launch_description() -> LaunchDescription:
    variant = LaunchConfiguration("variant")
    image_topic = LaunchConfiguration("image_topic")
    default_params = [FindPackageShare("vehicle_pf_tracker"), "/config/", variant, ".yaml"]
    return LaunchDescription(
        [
            DeclareLaunchArgument("variant", default_value="apf", description="Tracker to run"),
            DeclareLaunchArgument(
                "params_file", default_value=default_params, description="Parameter YAML"
            ),
            DeclareLaunchArgument(
                "image_topic",
                default_value="/camera/image_raw",
                description="Images to track in; compressed ones are below it, in /compressed",
            ),
            DeclareLaunchArgument("namespace", default_value="", description="Of the node"),
            DeclareLaunchArgument(
                "use_sim_time", default_value="false", description="Follow /clock"
            ),
            Node(
                package="vehicle_pf_tracker",
                executable=[variant, "_tracker"],
                name=[variant, "_tracker"],
                namespace=LaunchConfiguration("namespace"),
                parameters=[
                    LaunchConfiguration("params_file"),
                    {
                        "use_sim_time": ParameterValue(
                            LaunchConfiguration("use_sim_time"), value_type=bool
                        )
                    },
                ],
                remappings=[
                    ("image", image_topic),
                    ("image/compressed", [image_topic, "/compressed"]),
                ],
                additional_env={
                    name: EnvironmentVariable(name, default_value=value)
                    for name, value in ALLOCATOR.items()
                },
                output="screen",
                emulate_tty=True,
            ),
        ]
    )
