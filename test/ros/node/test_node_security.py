# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The access-control policy names what the nodes have, and the code evaluates nothing."""

from __future__ import annotations

import ast
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from rclpy.parameter import Parameter
from tracker_rig import SOME_FAST, TrackerNode, overrides

from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.ros.messages import detections_type
from vehicle_pf_tracker.ros.traffic.traffic_node import TrafficNode
from vehicle_pf_tracker.trackers.registry import NODES, find_variant

pytestmark = pytest.mark.ros

ROOT = Path(__file__).resolve().parents[3]
FUNCTIONS = {"eval", "exec", "compile", "__import__"}
OPTIONAL = {
    "vision_msgs": {"~/detection", "~/set_detection"},
    "tf2_msgs": {"/tf", "/tf_static"},
}
MISSING = {
    topic for package, topics in OPTIONAL.items() if not find_spec(package) for topic in topics
}
"""Topics of messages that are not installed here."""
AT_START_UP = {"lines", "detector.model"}
"""Parameters that name files, which whoever starts the node chooses."""
METHODS = {"system", "popen", "unsafe_load", "full_load", "Unpickler"}


def allowed(profile, kind: str, access: str) -> set[str]:
    return {one.text for group in profile.iter(kind) if group.get(access) for one in group}


def absolute(name: str, node: str) -> str:
    return "/" + name.replace("~", node).lstrip("/")


@pytest.mark.parametrize("variant", SOME_FAST)
@pytest.mark.parametrize("transport", ["raw", "compressed"])
def test_the_policy_allows_what_a_node_has_and_no_more(bench, variant, transport):
    policy = ElementTree.parse(ROOT / "config" / "sros2_policy.xml").getroot()
    (profile,) = policy.findall(f".//enclave[@path='/vehicle_pf_tracker/{variant}']//profile")
    node = bench.add(
        TrackerNode(
            find_variant(variant),
            context=bench.context,
            parameter_overrides=[
                *overrides(image_transport=transport),
                *overrides(road__from_camera_info=True, road__from_tf=True, incident_memory=1),
                Parameter("use_sim_time", value=True),
            ],
        )
    )
    own = node.get_name()
    assert (profile.get("ns"), profile.get("node")) == ("/", own)
    image = "image" if transport == "raw" else "image/compressed"
    other = ({"image", "image/compressed"} - {image}).pop()
    for kind, access, found, besides in (
        ("topics", "publish", node.get_publisher_names_and_types_by_node, set(MISSING)),
        ("topics", "subscribe", node.get_subscriber_names_and_types_by_node, {other, *MISSING}),
        ("services", "reply", node.get_service_names_and_types_by_node, set()),
    ):
        names = {absolute(one, own) for one in allowed(profile, kind, access) - besides}
        bench.wait_for(lambda: {one for one, _ in found(own, "/")} == names)  # noqa: B023
    assert node.get_client_names_and_types_by_node(own, "/") == []


def test_the_policy_allows_what_the_node_of_many_vehicles_has_and_no_more(bench):
    policy = ElementTree.parse(ROOT / "config" / "sros2_policy.xml").getroot()
    (profile,) = policy.findall(".//enclave[@path='/vehicle_pf_tracker/traffic']//profile")
    node = bench.add(
        TrafficNode(
            context=bench.context,
            parameter_overrides=[
                Parameter("use_sim_time", value=True),
                *overrides(incident_memory=1),
            ],
        )
    )
    own = node.get_name()
    assert (profile.get("ns"), profile.get("node")) == ("/", own)
    # As the node sees it: tests of the optional messages build them for themselves.
    without = {"~/detections"} if detections_type() is None else set()
    for kind, access, found, besides in (
        ("topics", "publish", node.get_publisher_names_and_types_by_node, without),
        # `detections` are listened to with `detector.kind: topic` only.
        (
            "topics", "subscribe", node.get_subscriber_names_and_types_by_node,
            {"image/compressed", "detections"},
        ),
        ("services", "reply", node.get_service_names_and_types_by_node, set()),
    ):  # fmt: skip
        names = {absolute(one, own) for one in allowed(profile, kind, access) - besides}
        bench.wait_for(lambda: {one for one, _ in found(own, "/")} == names)  # noqa: B023


def test_nothing_evaluates_input():
    calls = []
    for path in sorted((ROOT / "vehicle_pf_tracker").rglob("*.py")):
        for found in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(found, ast.Call):
                function = getattr(found.func, "id", "") in FUNCTIONS
                method = getattr(found.func, "attr", "") in METHODS
                shell = any(word.arg == "shell" for word in found.keywords)
                if function or method or shell:
                    calls.append(f"{path.name}:{found.lineno}")
    assert calls == []


def test_no_parameter_is_a_path():
    """What may be set over the network neither opens nor writes files."""
    for variant in NODES.values():
        for name, spec in Configuration.of(variant).specs().items():
            assert spec.read_only or name not in AT_START_UP
            assert not any(word in name for word in ("path", "file", "folder", "directory"))
