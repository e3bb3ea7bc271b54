# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Quality of service with which a recorded topic is published again."""

from __future__ import annotations

import re

from rclpy.qos import DurabilityPolicy, QoSProfile


def recorded_qos(offered: str, depth: int) -> QoSProfile:
    """Return the QoS to publish a recorded topic with: reliable, and latched if it was.

    Reliable publishers suit best-effort subscriptions too, and lock-step needs them.

    Parameters
    ----------
    offered : str
        The recorded profiles as the recording's YAML text; may be empty or damaged.
    depth : int
        Number of messages to keep.
    """
    durabilities = set(re.findall(r"\bdurability\W+(\w+)", offered))
    # rosbag2 writes names since Jazzy, and the numbers of rmw before.
    if durabilities and durabilities <= {"transient_local", "1"}:
        return QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    return QoSProfile(depth=depth)
