# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`python -m laboratory faults`, kept short: what it gives, and that the nodes hold."""

from __future__ import annotations

import re
from importlib.util import find_spec

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from built_messages import missing

pytestmark = [pytest.mark.ros, pytest.mark.slow]

without_vision = find_spec("vision_msgs") is None and missing()
needs_vision = pytest.mark.skipif(
    bool(without_vision), reason=f"vision_msgs is not there and cannot be built: {without_vision}"
)


def give(start_process, *words: str, timeout: float = 300.0) -> str:
    process = start_process("-m", "laboratory", "faults", *words)
    status = process.wait(timeout)
    assert status == 0, process.output
    assert process.output.count("| yes |") == sum(word.isalpha() for word in words)
    return process.output


def test_messages_and_files_end_in_a_sentence_or_in_the_truth(start_process):
    told = give(start_process, "messages", "parameters", "recordings", "--count", "100")
    assert "faulty: REJECTED" in told
    assert "targets " in told
    assert "parameters: 100 files" in told
    assert "recordings: 100 files" in told


@needs_vision
def test_a_short_soak_of_two_nodes(start_process):
    told = give(start_process, "soak", "--minutes", "0.4")
    assert told.count("images answered, 0 lost in transit") == 2
    assert told.count("second answers: 0; wrong answers: 0") == 2
    assert "detector: 10 000 boxes, once a second 1" in told
    assert "; twice: 0" in told
    assert told.count("MB at most") == 2


def test_a_camera_that_moves_before_a_node_that_detects_motion(start_process):
    told = give(start_process, "detector", "--motion", "--seconds", "4")
    assert "the light was switched" in told


@needs_vision
def test_each_fault_of_a_detector_in_turn(start_process):
    told = give(start_process, "detector", "--seconds", "4", timeout=500)
    row = re.compile(r"^\| (.*?) \| \d+ of \d+ \| (\d+) of (\d+) \| (.*)", re.MULTILINE)
    rows = row.findall(told)
    told = {fault: sentences for fault, _, _, sentences in rows}
    unusable = "detections of an image cannot be used: not finite, without an area, outside"
    assert "MB that are read" in told.pop("10 000 boxes, once a second")
    assert "detections, of which the N of the highest" in told.pop("1 500 boxes, once a second")
    assert "waited in vain for detections" in told.pop("stamps that never match")
    assert "waited in vain for detections" in told.pop("no detections any more")
    assert "the light was switched" in told.pop("motion, the camera moves for a second")
    assert len(told) == 7
    assert all(unusable in sentences for sentences in told.values()), told
    # A flood, and a camera that moves, may cost a vehicle its number; what is left out does not.
    safe = [(int(kept), int(there)) for fault, kept, there, _ in rows if fault in told]
    assert all(kept >= there - 1 for kept, there in safe), rows
