# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The replay that a launch file starts beside its node: in lock-step, or in real time.

On a busy machine a node misses images that are played in real time; in lock-step it cannot.
"""

from __future__ import annotations

from collections.abc import Mapping

from vehicle_pf_tracker.ros.launching import is_true
from vehicle_pf_tracker.ros.replay.publishing import RecordedImages

REPLAY_ARGUMENTS = {
    "topic": ("", "Image topic of the recording, if it has several"),
    "target": ("", "Box to start on, x,y,w,h in px; empty takes the first true box"),
    "rate": ("1.0", "Speed of the replay"),
    "loop": ("false", "Begin again at the end"),
    "lockstep": (
        "true",
        "Play an image only when the node has answered the one before, later than `rate` says on a "
        "busy machine; false plays in real time, where such a machine loses images",
    ),
}
"""Default and description of each argument of ``replay.launch.py`` that is the replay's own."""

_TIMEOUT = "60"
"""Seconds to wait for the node, as a slow start takes."""
_QUEUE_DEPTH = "30"
"""Images that wait for the node in real time: a second at 30 Hz; of 1080p they are 190 MB."""


def replay_words(given: Mapping[str, str], images: RecordedImages) -> list[str]:
    """Return the command line of the replay for the arguments `given`."""
    name = given["name"] or f"{given['variant']}_tracker"
    words = [given["recording"], "--topic", images.topic, "--rate", given["rate"]]
    words += ["--node", f"{given['namespace'].strip('/')}/{name}", "--timeout", _TIMEOUT]
    if images.published != images.topic:
        words += ["--remap", f"{images.topic}:={images.published}"]
    if given["target"]:
        words += ["--target", given["target"]]
    elif given["variant"] == "traffic":  # it finds its vehicles itself
        words.append("--no-target")
    words += [f"--{switch}" for switch in ("loop", "lockstep") if is_true(given[switch])]
    if is_true(given["use_sim_time"]):
        words += ["--clock", "100"]
    return words


def queue_depth(given: Mapping[str, str]) -> str:
    """Return the node's `queue_depth`; empty, which leaves it to the file, in lock-step."""
    return "" if is_true(given["lockstep"]) else _QUEUE_DEPTH
