# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""File of cameras: a node for each, with its topic, its variant and its parameters."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml
from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.files import flatten, read_yaml, read_yaml_file
from vehicle_pf_tracker.parameters.table import unknown_name
from vehicle_pf_tracker.ros.launching import image_remappings, scratch_folder
from vehicle_pf_tracker.trackers.registry import find_node

_KEYS = ("topic", "variant", "transport", "target", "params_file", "parameters")
"""Keys that a camera may have in a file of cameras."""
_TARGET = ("x", "y", "width", "height")
"""Parameters below `target` that the four numbers of a camera's target are."""


@dataclass(frozen=True, slots=True)
class CameraEntry:
    """A camera of such a file.

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


def read_cameras(path: str) -> list[CameraEntry]:
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


def _named_camera(path: str, name: str, entry: Any, folder: Path) -> CameraEntry:
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
        validate_topic_name(topic := str(entry["topic"]))
        # Only this refuses two slashes side by side.
        validate_full_topic_name(expand_topic_name(topic, "node", "/"))
    except InvalidTopicNameException:  # ROS's own words are of a remap rule, from each respawn
        raise InputError(f"its topic {entry['topic']!r} is not a topic name") from None
    if not name.replace("_", "a").isalnum() or name[0].isdigit():
        raise InputError("its name cannot name a namespace: use letters, digits and _")


def _camera(name: str, entry: dict[str, Any], folder: Path) -> CameraEntry:
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
    return CameraEntry(name, str(entry["topic"]), variant, {key: checked[key] for key in values})


def _target(numbers: Any) -> dict[str, object]:
    if not isinstance(numbers, list) or len(numbers) != len(_TARGET):
        raise InputError("target is not [x, y, width, height] in px")
    return {f"target.{key}": number for key, number in zip(_TARGET, numbers, strict=True)}
