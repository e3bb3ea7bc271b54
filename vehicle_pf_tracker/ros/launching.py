# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Arguments, nodes and files that the launch files share; files of cameras.

`launch`, which is not on PyPI, is imported where it is used.
"""

from __future__ import annotations

import atexit
import shutil
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import yaml
from rclpy.exceptions import InvalidTopicNameException
from rclpy.validate_topic_name import validate_topic_name

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import flatten, read_yaml, read_yaml_file
from vehicle_pf_tracker.parameters.table import unknown_name
from vehicle_pf_tracker.ros.transport import PROFILE_VARIABLES
from vehicle_pf_tracker.trackers.registry import find_node

# Defaults are constants: a default made of another argument would stay for the next inclusion.
ARGUMENTS = {
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

_KEYS = ("topic", "variant", "transport", "target", "params_file", "parameters")
"""Keys that a camera may have in a file of cameras."""
_TARGET = ("x", "y", "width", "height")
"""Parameters below `target` that the four numbers of a camera's target are."""


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
    arguments = {**{name: default for name, (default, _) in ARGUMENTS.items()}, **given}
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


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera of a file of cameras.

    Attributes
    ----------
    name : str
        Also the namespace of its node.
    topic : str
        Its raw images; compressed ones are in ``/compressed`` below.
    variant : str
        Tracker to run.
    values : mapping
        Parameters of the node.
    """

    name: str
    topic: str
    variant: str
    values: Mapping[str, object] = field(default_factory=dict)

    def write_parameters(self) -> str:
        """Write the parameters to a file of their own; returns its path."""
        # A folder each: two files of cameras in one launch may use the same names.
        path = Path(tempfile.mkdtemp(dir=scratch_folder()), f"{self.name}.yaml")
        document = {"/**": {"ros__parameters": dict(self.values)}}
        path.write_text(yaml.safe_dump(document), encoding="utf-8")
        return str(path)

    def arguments(self) -> list[str]:
        """Return the words that its node takes where several share a process."""
        pairs = image_remappings(self.topic)
        remappings = (word for old, new in pairs for word in ("-r", f"{old}:={new}"))
        return ["--ros-args", "--params-file", self.write_parameters(), *remappings]


def read_cameras(path: str) -> list[Camera]:
    """Read a file of cameras.

    Raises
    ------
    InputError
        Naming the camera and what does not fit.
    """
    document = read_yaml_file(Path(path), "file of cameras")
    cameras = document.get("cameras") if isinstance(document, dict) else None
    if not isinstance(cameras, dict) or not cameras:
        raise InputError(f"the file of cameras {path} has no section `cameras` with one by name")
    folder = Path(path).parent
    return [_named_camera(path, str(name), entry, folder) for name, entry in cameras.items()]


def _named_camera(path: str, name: str, entry: Any, folder: Path) -> Camera:
    try:
        _check_entry(name, entry)
        return _camera(name, entry, folder)
    except InputError as error:
        raise InputError(f"the camera {name} in {path}: {error}") from None


def _check_entry(name: str, entry: Any) -> None:
    if not isinstance(entry, dict) or "topic" not in entry:
        raise InputError(f"it needs a topic; it may have {', '.join(_KEYS)}")
    for key in entry:
        if key not in _KEYS:
            raise InputError(unknown_name(str(key), _KEYS))
    try:
        validate_topic_name(str(entry["topic"]))
    except InvalidTopicNameException:  # ROS's own words are of a remap rule, from each respawn
        raise InputError(f"its topic {entry['topic']!r} is not a topic name") from None
    if not name.replace("_", "a").isalnum() or name[0].isdigit():
        raise InputError("its name is no name of a namespace: letters, digits and _ are")


def _camera(name: str, entry: dict[str, Any], folder: Path) -> Camera:
    variant = str(entry.get("variant", "fusion"))
    configuration = Configuration.of(find_node(variant))
    known = configuration.specs()
    values: dict[str, object] = {}
    if "params_file" in entry:
        values |= read_yaml(folder / str(entry["params_file"]), f"{variant}_tracker")
    given = entry.get("parameters") or {}
    if not isinstance(given, dict):
        raise InputError("parameters are not names with values")
    values |= flatten(given)
    if "transport" in entry:
        values["image_transport"] = entry["transport"]
    if "target" in entry:
        values |= _target(entry["target"])
    unknown = [unknown_name(key, known) for key in values if key not in known]
    if unknown:
        raise InputError("; ".join(unknown))
    # As they are declared: an integer for a double would end the node.
    checked = configuration.updated(values).to_mapping()
    return Camera(name, str(entry["topic"]), variant, {key: checked[key] for key in values})


def _target(numbers: Any) -> dict[str, object]:
    if not isinstance(numbers, list) or len(numbers) != len(_TARGET):
        raise InputError("target is not [x, y, width, height] in px")
    return {f"target.{key}": number for key, number in zip(_TARGET, numbers, strict=True)}
