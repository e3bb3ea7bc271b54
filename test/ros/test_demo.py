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

"""The whole chain of the demo on a short scene: recording, node, lock-step replay, scores."""

import csv
import json
import re

import cv2
import pytest

pytest.importorskip("rclpy")

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.recordings.reader import Recording
from vehicle_pf_tracker.ros.replay.discovery import tracker_process

pytestmark = pytest.mark.ros


# A process of its own, as Fast DDS makes room for images only with the first participant of one.
SHORT_DEMO = """
import sys
from vehicle_pf_tracker.cli import demo
from vehicle_pf_tracker.cli.main import main
demo.SCENE = "bar"
demo.CONTESTANTS = {"apf": {"motion.sigma_w": 5.0}, "pf": {"sigma": 2.0}}
sys.exit(main(["demo", "-o", sys.argv[1]]))
"""


@pytest.mark.slow
def test_the_chain_ends_with_scores_pictures_and_a_recording(tmp_path, start_process):
    process = start_process("-c", SHORT_DEMO, str(tmp_path))
    assert process.wait(600) == 0, process.output
    frames = Recording(tmp_path / "recording").frame_count
    for name in ("apf", "pf"):
        with (tmp_path / name / "estimates.csv").open() as file:
            rows = list(csv.DictReader(file))
        assert [int(row["frame"]) for row in rows] == list(range(1, frames + 1))
    metrics = json.loads((tmp_path / "apf" / "metrics.json").read_text())
    assert metrics["frames_scored"] == frames
    assert metrics["rmse_px"] < 15
    assert json.loads((tmp_path / "apf" / "run.json").read_text())["variant"] == "apf"
    assert (tmp_path / "demo.png").stat().st_size > 10_000
    assert cv2.VideoCapture(str(tmp_path / "demo.mp4")).get(cv2.CAP_PROP_FRAME_COUNT) == frames
    topics = {info.name for info in Recording(tmp_path / "with_estimates").topics}
    assert {"/camera/image_raw", "/ground_truth/position", "/pf_tracker/position"} <= topics
    told = process.output
    assert "error, RMSE" in told
    assert f"/apf_tracker: {frames} frames out, {frames} estimates in" in told
    assert f"/pf_tracker: {frames} frames out, {frames} estimates in" in told
    assert re.search(r"same numbers offline +│ +yes │ +yes", told)


def test_a_node_that_fails_is_told(tmp_path, capfd):
    with (
        pytest.raises(InputError, match="apf_tracker ended with status 1"),
        tracker_process("apf", {"motion.sigma_w": -1.0}, "/nobody") as node,
    ):
        node.process.wait(60)
        with pytest.raises(InputError, match="apf_tracker has ended"):
            node.check()
    assert "motion.sigma_w" in capfd.readouterr().err


def test_the_node_is_ended_with_the_block():
    with tracker_process("pf", {}, "/nobody") as node:
        node.check()
    assert node.process.returncode is not None
