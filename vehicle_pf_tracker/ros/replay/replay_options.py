# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Options of a replay, flat as those of the rosbag2 player, whose names and meanings they have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vehicle_pf_tracker.core.box import Box


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
