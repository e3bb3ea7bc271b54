# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Layouts for Foxglove and rqt: whole, and of topics and fields that exist."""

import ast
import json
import re
from pathlib import Path

import pytest
import yaml

from vehicle_pf_tracker.recordings.bags.messages import IMAGE_ANNOTATIONS, message_class
from vehicle_pf_tracker.trackers.registry import find_variant

VIEWERS = Path(__file__).parents[2] / "viewers"
LAYOUTS = sorted(VIEWERS.glob("*.json"))
NODE = f"/{find_variant('fusion').executable}"

TYPES = {
    "/camera/image_raw/compressed": "sensor_msgs/msg/CompressedImage",
    f"{NODE}/annotations": IMAGE_ANNOTATIONS,
    f"{NODE}/overlay": "sensor_msgs/msg/Image",
    f"{NODE}/mode": "diagnostic_msgs/msg/DiagnosticArray",
    f"{NODE}/position": "geometry_msgs/msg/PointStamped",
    f"{NODE}/velocity": "geometry_msgs/msg/Vector3Stamped",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
}
"""Types by topic, as docs/ros_interface.md and showing/estimates_recording.py have them."""


def topics_and_fields(path: str) -> tuple[str, list[str]]:
    """Split ``/topic.field[0].field`` of Foxglove."""
    topic, *fields = path.split(".")
    return topic, [re.sub(r"\[\d+\]", "", field) for field in fields]


def assert_is_number_or_word(topic: str, fields: list[str]) -> None:
    """Follow `fields` through the definition of the topic's type to a plain value."""
    kind = TYPES[topic]
    for field in fields:
        annotation = str(message_class(kind).__annotations__[field])
        found = re.search(r"\w+__msg__\w+", annotation)
        kind = found[0].replace("__", "/") if found else annotation
    assert kind in {"float", "str", "int"}, (topic, fields, kind)


def leaves(node) -> list[str]:
    """Return the panels of a layout's tree, whose inner nodes must be splits."""
    if isinstance(node, str):
        return [node]
    assert node["direction"] in {"row", "column"}
    assert 0 < node["splitPercentage"] < 100
    return [*leaves(node["first"]), *leaves(node["second"])]


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.stem)
def test_a_layout_shows_each_of_its_panels_once(path):
    layout = json.loads(path.read_text())
    keys = {"configById", "globalVariables", "userNodes", "playbackConfig", "layout"}
    assert layout.keys() == keys
    assert sorted(leaves(layout["layout"])) == sorted(layout["configById"])
    kinds = {"Image", "StateTransitions", "Plot", "DiagnosticSummary"}
    assert {name.partition("!")[0] for name in layout["configById"]} <= kinds


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.stem)
def test_a_layout_names_topics_and_fields_that_exist(path):
    for panel in json.loads(path.read_text())["configById"].values():
        for line in panel.get("paths", []):
            assert_is_number_or_word(*topics_and_fields(line["value"]))
        image = panel.get("imageMode", {})
        for topic in [*image.get("annotations", {}), image.get("imageTopic")]:
            assert topic is None or topic in TYPES
        assert panel.get("topicToRender", "/diagnostics") in TYPES


def test_there_is_a_layout_for_recordings_and_one_for_nodes():
    assert [path.stem for path in LAYOUTS] == ["foxglove_live", "foxglove_recording"]
    panel = json.loads(LAYOUTS[1].read_text())["configById"]["Image!annotated"]["imageMode"]
    assert panel["annotations"] == {f"{NODE}/annotations": {"visible": True}}


def values(group) -> dict[str, object]:
    """Return the values of a group of a perspective as rqt evaluates them."""
    assert all(value["type"] == "repr" for value in group["keys"].values())
    return {key: ast.literal_eval(value["repr"]) for key, value in group["keys"].items()}


def test_the_perspective_configures_plugins_that_it_starts():
    perspective = json.loads((VIEWERS / "fusion.perspective").read_text())
    plugins = perspective["groups"]["pluginmanager"]
    running = values(plugins)["running-plugins"]
    names = {
        f"plugin__{name.replace('/', '__')}__{number}"
        for name, numbers in running.items()
        for number in numbers
    }
    assert plugins["groups"].keys() <= names
    image, plot = (
        values(plugins["groups"][f"plugin__{name}__1"]["groups"]["plugin"])
        for name in ("rqt_image_view__ImageView", "rqt_plot__Plot")
    )
    assert image["topic"] in TYPES
    for path in plot["topics"]:
        topic = "/".join(path.split("/")[:3])
        assert_is_number_or_word(topic, path.split("/")[3:])


def test_rviz_shows_topics_that_exist():
    config = yaml.safe_load((VIEWERS / "tracker.rviz").read_text())
    displays = {
        one["Class"].rpartition("/")[2]: one["Topic"]["Value"]
        for one in config["Visualization Manager"]["Displays"]
    }
    assert displays == {"Image": f"{NODE}/overlay", "MarkerArray": f"{NODE}/markers"}
