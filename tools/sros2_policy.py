# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The SROS 2 access-control policy: one enclave per variant."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT, Variant

_Permissions = Mapping[str, tuple[str, ...]]

PERMISSIONS: _Permissions = {
    'topics publish="ALLOW"': (
        "~/box",
        "~/detection",
        "~/mode",
        "~/overlay",
        "~/particles",
        "~/pose_with_covariance",
        "~/position",
        "~/road_position",
        "~/road_velocity",
        "~/transition_event",
        "~/velocity",
        "/diagnostics",
        "/parameter_events",
        "/rosout",
    ),
    'topics subscribe="ALLOW"': (
        "~/clicked_point",
        "~/set_box",
        "~/set_detection",
        "~/set_target",
        "/clock",
        "/tf",
        "/tf_static",
        "camera_info",
        "image",
        "image/compressed",
    ),
    'services reply="ALLOW"': (
        "~/change_state",
        "~/describe_parameters",
        "~/get_available_states",
        "~/get_available_transitions",
        "~/get_parameter_types",
        "~/get_parameters",
        "~/get_state",
        "~/get_transition_graph",
        "~/get_type_description",
        "~/list_parameters",
        "~/reset",
        "~/set_parameters",
        "~/set_parameters_atomically",
        "~/snapshot",
    ),
}
"""Everything that a tracker node has; a test compares it with the ROS graph of running nodes."""

_PUBLISHED, _HEARD, _ANSWERED = PERMISSIONS
"""The three kinds of permission."""

TRAFFIC_PERMISSIONS: _Permissions = {
    _PUBLISHED: (
        "~/box",
        "~/counts",
        "~/detections",
        "~/markers",
        "~/mode",
        "~/modes",
        "~/overlay",
        "~/position",
        "~/tracks",
        "~/transition_event",
        "~/velocity",
        "/diagnostics",
        "/parameter_events",
        "/rosout",
    ),
    _HEARD: (
        "~/add_target",
        "~/clicked_point",
        "~/select",
        "/clock",
        "detections",
        "image",
        "image/compressed",
    ),
    _ANSWERED: tuple(sorted([*PERMISSIONS[_ANSWERED], "~/remove_selected"])),
}
"""Everything that the node of many vehicles has."""

# Files of SROS 2: the policy, and in it the part of a node.
_POLICY = """<?xml version="1.0" encoding="UTF-8"?>
<!-- Permissions that each node needs under SROS 2, and no more; docs/ros_running.md explains its
     use. Give remapped topics by their new names. `make config` writes this file. -->
<policy version="0.2.0">
  <enclaves>
{enclaves}  </enclaves>
</policy>
"""
_ENCLAVE = """    <enclave path="/vehicle_pf_tracker/{name}">
      <profiles>
        <profile ns="/" node="{node}">
{groups}        </profile>
      </profiles>
    </enclave>
"""


def policy(variants: Iterable[Variant]) -> str:
    """Write the policy of the nodes of `variants`."""
    return _POLICY.format(enclaves="".join(map(_enclave, variants)))


def _enclave(variant: Variant) -> str:
    permissions = TRAFFIC_PERMISSIONS if variant is TRAFFIC_VARIANT else PERMISSIONS
    groups = "".join(_group(permission, names) for permission, names in permissions.items())
    return _ENCLAVE.format(name=variant.name, node=variant.executable, groups=groups)


def _group(permission: str, names: Iterable[str]) -> str:
    plural = permission.partition(" ")[0]
    entry = plural.removesuffix("s")
    lines = "".join(f"            <{entry}>{name}</{entry}>\n" for name in names)
    return f"          <{permission}>\n{lines}          </{plural}>\n"
