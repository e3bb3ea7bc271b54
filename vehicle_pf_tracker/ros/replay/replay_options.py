# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Options of a replay, the quality of service of its publishers among them; and its report."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from rclpy.qos import DurabilityPolicy, QoSProfile

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.results.estimates import EstimateRow


@dataclass(frozen=True, slots=True)
class ReplayOptions:
    """How to play a recording; named as the rosbag2 player's options where it has them.

    Attributes
    ----------
    rate : float or None
        Speed, 1.0 is as recorded. None: as recorded, but in lock-step as fast as the nodes answer.
    start_offset, playback_duration : float, float or None
        Which part to play, in s of log time; None plays to the end.
    loop : bool
        Begin again at the end; stamps go back then.
    delay : float
        Wait so many seconds before the first message.
    topics : tuple of str
        Play these topics only; empty for all. The image topic is among them only if named.
    remap : mapping of str to str
        Recorded topic to the name it is published under.
    clock : float or None
        Publish `/clock` so many times a second.
    wait_for_subscribers : bool
        Begin when somebody subscribes to the images, however long that takes.
    lockstep : bool
        Publish an image only when every node has answered the one before.
    start_paused : bool
        Begin paused.
    decompress : bool
        Publish compressed images as raw ones.
    nodes : tuple of str
        Tracker nodes that take part; empty for all that are found.
    target : Box or None
        The box to start on; None takes the first true box.
    set_target : bool
        True to set the nodes' targets and reset them.
    timeout : float
        Longest wait for an answer, in s; the search for nodes lasts at least as long as discovery.
    ros_args : tuple of str
        Words after ``--ros-args`` on the command line.
    """

    rate: float | None = None
    start_offset: float = 0.0
    playback_duration: float | None = None
    loop: bool = False
    delay: float = 0.0
    topics: tuple[str, ...] = ()
    remap: Mapping[str, str] = field(default_factory=dict)
    clock: float | None = None
    wait_for_subscribers: bool = False
    lockstep: bool = False
    start_paused: bool = False
    decompress: bool = False
    nodes: tuple[str, ...] = ()
    target: Box | None = None
    set_target: bool = True
    timeout: float = 10.0
    ros_args: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class NodeReport:
    """Answers of one node to the images.

    Attributes
    ----------
    name : str
        Its full name.
    answered : int
        Number of images answered, in all passes of a loop.
    rows : tuple of EstimateRow
        One for each image of the last pass, in order; mode `DROPPED` where no answer came.
    road : mapping of str to list of float or None
        Columns beside the rows, where the node has a road.
    """

    name: str
    answered: int
    rows: tuple[EstimateRow, ...]
    road: Mapping[str, list[float | None]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ReplayReport:
    """Summary of a replay.

    Attributes
    ----------
    frames : int
        Images published, in all passes of a loop.
    seconds : float
        Time from the first message to the last answer.
    nodes : tuple of NodeReport
        The tracker nodes that took part.
    notices : tuple of str
        Irregularities, a sentence each.
    interrupted : bool
        True if the user ended it.
    """

    frames: int
    seconds: float
    nodes: tuple[NodeReport, ...]
    notices: tuple[str, ...] = ()
    interrupted: bool = False


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
