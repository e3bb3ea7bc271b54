"""A recording played to one tracker node: `ros2 launch … replay.launch.py recording:=FOLDER`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
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
            DeclareLaunchArgument("rate", default_value="1.0", description="Speed of the replay"),
            DeclareLaunchArgument("loop", default_value="false", description="Begin again"),
            # The arguments of tracker.launch.py are declared there, and hold here too.
            IncludeLaunchDescription(PythonLaunchDescriptionSource(tracker)),
            replay(UnlessCondition(LaunchConfiguration("loop"))),
            replay(IfCondition(LaunchConfiguration("loop")), "--loop"),
        ]
    )


def replay(condition: IfCondition | UnlessCondition, *options: str) -> Node:
    return Node(
        package="vehicle_pf_tracker",
        executable="bag_replay",
        arguments=[
            LaunchConfiguration("recording"),
            "--rate",
            LaunchConfiguration("rate"),
            "--wait-for-subscribers",
            "--decompress",  # the tracker listens for raw images unless its parameters say else
            *options,
        ],
        condition=condition,
        output="screen",
        emulate_tty=True,
    )
