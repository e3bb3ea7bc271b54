# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The long runs of test/robustness/, kept short."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from built_messages import missing

pytestmark = [pytest.mark.ros, pytest.mark.slow]

ROBUSTNESS = Path(__file__).resolve().parents[1] / "robustness"


def run(start_process, script: str, *words: str, timeout: float = 120.0) -> str:
    process = start_process(str(ROBUSTNESS / script), *words)
    status = process.wait(timeout)
    assert status == 0, process.output
    return process.output


def test_fuzzed_messages_cost_no_good_image_its_estimate(start_process):
    told = run(start_process, "fuzz_node.py", "--messages", "300", "--seed", "5")
    assert "faulty: REJECTED" in told
    assert "targets " in told


def test_fuzzed_files_end_in_a_sentence_or_in_the_truth(start_process):
    told = run(start_process, "fuzz_files.py", "--parameters", "60", "--recordings", "60")
    assert "parameters: 60 files" in told
    assert "recordings: 60 files" in told


def test_a_short_soak(start_process):
    told = run(start_process, "soak.py", "--minutes", "0.05")
    assert "good images without an answer: 0" in told
    assert "MB at most" in told


@pytest.mark.parametrize("detector", ["topic", "motion"])
def test_a_few_vehicles_come_and_go_before_the_node(start_process, detector):
    if detector == "topic" and find_spec("vision_msgs") is None and (reason := missing()):
        pytest.skip(f"vision_msgs is not installed, and cannot be built: {reason}")
    told = run(
        start_process, "traffic_node_soak.py", "--vehicles", "60", "--minutes", "0.4",
        "--detector", detector,
    )  # fmt: skip
    assert "images without an answer: 0" in told
    assert "; twice: 0" in told
    assert "MB at most" in told


def test_each_fault_of_a_detector_in_turn(start_process):
    if find_spec("vision_msgs") is None and (reason := missing()):
        pytest.skip(f"vision_msgs is not installed, and cannot be built: {reason}")
    told = run(start_process, "traffic_faults.py", "--seconds", "4", timeout=500)
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
