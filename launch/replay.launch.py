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

"""A recording played to one tracker node: `ros2 launch … replay.launch.py recording:=FOLDER`."""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    tracker = PathJoinSubstitution(
        [FindPackageShare("vehicle_pf_tracker"), "launch", "tracker.launch.py"]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("recording", description="rosbag2 folder, or bare .mcap file"),
            DeclareLaunchArgument(
                "target",
                default_value="",
                description="Box to start on, x,y,w,h in px; empty takes the first true box",
            ),
            DeclareLaunchArgument("rate", default_value="1.0", description="Speed of the replay"),
            DeclareLaunchArgument("loop", default_value="false", description="Begin again"),
            # The arguments of tracker.launch.py are declared there, and hold here too.
            IncludeLaunchDescription(PythonLaunchDescriptionSource(tracker)),
            OpaqueFunction(function=replay),
        ]
    )


def replay(context: LaunchContext) -> list[Node]:
    def given(name: str) -> str:
        return LaunchConfiguration(name).perform(context)

    # Raw images, since that is what the tracker listens for unless its parameters say else.
    arguments = [given("recording"), "--rate", given("rate"), "--wait-for-subscribers"]
    # A node's first start compiles its kernels, for longer than the replay would wait.
    arguments += ["--timeout", "60", "--decompress"]
    if given("target"):
        arguments += ["--target", given("target")]
    if given("loop").lower() in {"true", "1"}:
        arguments.append("--loop")
    return [
        Node(
            package="vehicle_pf_tracker",
            executable="bag_replay",
            arguments=arguments,
            output="screen",
            emulate_tty=True,
        )
    ]
