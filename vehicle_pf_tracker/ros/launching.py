# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Arguments, nodes and files that the launch files share.

`launch`, which is not on PyPI, is imported where it is used.
"""

from __future__ import annotations

import atexit
import shutil
import sys
import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.parameters.files import read_yaml_file
from vehicle_pf_tracker.ros.transport import PROFILE_VARIABLES
from vehicle_pf_tracker.trackers.registry import find_node

# Defaults are constants: a default made of another argument would stay for the next inclusion.
TRACKER_ARGUMENTS = {
    "variant": ("apf", "Tracker to run"),
    "params_file": ("", "Parameter YAML; empty takes that of the variant"),
    "image_topic": ("/camera/image_raw", "Images; compressed ones are below it, in /compressed"),
    "image_transport": ("", "raw or compressed; empty leaves it to the parameter file"),
    "queue_depth": ("", "Images that may wait; empty leaves it to the parameter file"),
    "detections_topic": (
        "", "For traffic: detections (vision_msgs/Detection2DArray) to follow; empty leaves the "
        "detector to the parameter file, whose default is what moves before a standing camera",
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
    "rviz": ("false", "Open RViz on what the node sees"),
    "foxglove": ("false", "Start Foxglove's bridge, and write a layout for the node"),
}  # fmt: skip
"""Default and description of each argument of ``tracker.launch.py``."""


def declared(arguments: Mapping[str, tuple[str, str]]) -> list[Any]:
    """Declare arguments of a launch file, from their defaults and descriptions."""
    from launch.actions import DeclareLaunchArgument  # noqa: PLC0415

    return [
        DeclareLaunchArgument(name, default_value=default, description=words)
        for name, (default, words) in arguments.items()
    ]


def included_tracker(given: Mapping[str, Any]) -> Any:
    """Include ``tracker.launch.py``; arguments that are not given have their defaults."""
    from launch.actions import IncludeLaunchDescription  # noqa: PLC0415
    from launch.launch_description_sources import (  # noqa: PLC0415
        PythonLaunchDescriptionSource,
    )
    from launch.substitutions import PathJoinSubstitution  # noqa: PLC0415
    from launch_ros.substitutions import FindPackageShare  # noqa: PLC0415

    path = [FindPackageShare("vehicle_pf_tracker"), "launch", "tracker.launch.py"]
    arguments = {**{name: default for name, (default, _) in TRACKER_ARGUMENTS.items()}, **given}
    return IncludeLaunchDescription(
        PythonLaunchDescriptionSource(PathJoinSubstitution(path)),
        launch_arguments=arguments.items(),
    )


def started(given: Mapping[str, str], share: str, **options: Any) -> list[Any]:
    """Start an executable of ours with the arguments `given`, and `options` of launch_ros."""
    from launch.actions import SetEnvironmentVariable  # noqa: PLC0415
    from launch_ros.actions import Node  # noqa: PLC0415

    node = Node(
        package="vehicle_pf_tracker",
        ros_arguments=["--log-level", given["log_level"]],
        respawn=is_true(given["respawn"]),
        respawn_delay=2.0,
        output="screen",
        emulate_tty=sys.stdout.isatty(),
        **options,
    )
    if not is_true(given["large_images"]):
        return [node]
    path = str(Path(share, "config", "large_images.xml"))
    return [*(SetEnvironmentVariable(name, path) for name in PROFILE_VARIABLES), node]


def is_true(word: str) -> bool:
    """Return whether an argument is switched on."""
    return word.lower() in {"true", "1"}


def program(variant: str) -> tuple[str, list[str]]:
    """Return the executable of a variant's node and its words: a plug-in has none of its own."""
    found = find_node(variant)
    return (
        ("vehicle_tracker", ["--variant", variant]) if found.is_plug_in else (found.executable, [])
    )


def layout_for(node: str, name: str, share: str) -> str:
    """Write the layout `name` of the viewers anew for the node of this full name; its path."""
    text = Path(share, "viewers", name).read_text(encoding="utf-8")
    path = Path(tempfile.mkdtemp(dir=scratch_folder()), name)
    path.write_text(text.replace("/fusion_tracker", node), encoding="utf-8")
    return str(path)


def parameter_file(given: str, variant: str, share: str) -> str:
    """Return the parameter file `given`, or that of the variant in the folder `share`.

    Empty for a plug-in without one, which runs with its defaults.

    Raises
    ------
    InputError
        If there is no such file or variant, or a key is twice in the file.
    """
    if not given and find_node(variant).is_plug_in:
        return ""
    path = Path(given) if given else Path(share, "config", f"{find_node(variant).name}.yaml")
    read_yaml_file(path, "parameter file")
    return str(path)


@cache
def scratch_folder() -> Path:
    """Return this process's folder for files that its nodes read.

    It is removed when the process ends, and a launch ends after its nodes: one that respawns
    reads its file again.
    """
    folder = tempfile.mkdtemp(prefix="vehicle_pf_tracker_")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def image_remappings(topic: str) -> list[tuple[str, str]]:
    """Return the remappings of a node that takes its images from `topic`."""
    return [("image", topic), ("image/compressed", f"{topic}/compressed")]
