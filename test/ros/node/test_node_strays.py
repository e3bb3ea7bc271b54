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

"""Images that do not continue their stream: one alone is left out, a second one is believed."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from sensor_msgs.msg import CompressedImage, Image
from test_node_targets import Targets, polygon
from tracker_rig import (
    FIRST_NS,
    PERIOD_NS,
    Rig,
    header,
    header_at,
    on_target,
    overrides,
    road,
    values_of,
)

from vehicle_pf_tracker.ros.messages import image_message

pytestmark = pytest.mark.ros

DAY_NS = 86_400_000_000_000
MARK = "rejected unless the next image agrees with it"


@pytest.fixture
def rig(bench):
    return Rig(bench, on_target())


def scalars(answer) -> dict[str, str]:
    return {name: value for name, value in values_of(answer).items() if name != "step_ms"}


def mode(answer) -> str:
    return answer.status[0].message


def undisturbed(bench, frames) -> list[dict[str, str]]:
    """What a fresh node says of the same frames with nothing among them."""
    rig = Rig(bench, on_target(), variant="pf")
    return [scalars(rig.show_frame(frame, index)) for index, frame in enumerate(frames)]


@pytest.mark.parametrize(
    ("stamp", "words"),
    [
        (0, "goes back by 1.160 s"),
        (FIRST_NS + 2 * PERIOD_NS, "goes back by 0.080 s"),
        (FIRST_NS - DAY_NS, "goes back by 864"),
        (FIRST_NS + DAY_NS, "leaps ahead by 863"),
    ],
    ids=["zero", "back", "a day back", "a day ahead"],
)
def test_a_stray_stamp_is_rejected_and_costs_the_track_nothing(bench, stamp, words):
    frames = road(9)
    disturbed = Rig(bench, on_target(), variant="pf")
    answers = [scalars(disturbed.show_frame(frame, i)) for i, frame in enumerate(frames[:5])]
    stray = disturbed.show(image_message(header_at(stamp), frames[4]))
    assert mode(stray) == "REJECTED"
    assert words in values_of(stray)["reason"]
    assert MARK in values_of(stray)["reason"]
    answers += [
        scalars(disturbed.show_frame(frame, i)) for i, frame in enumerate(frames[5:], start=5)
    ]
    bench.remove(disturbed.node)
    assert answers == undisturbed(bench, frames)


def test_a_compressed_stray_is_not_decoded(bench, monkeypatch):
    """28 kB may claim 25 megapixels in a stream of small images."""
    rig = Rig(
        bench,
        [*on_target(), *overrides(image_transport="compressed")],
        kind=CompressedImage,
        topic="image/compressed",
    )

    def show(index, frame):
        data = cv2.imencode(".jpg", frame)[1].tobytes()
        return rig.show(CompressedImage(header=header(index), format="jpeg", data=data))

    frames = road(6)
    assert [mode(show(i, frame)) for i, frame in enumerate(frames[:3])] == ["TRACKING"] * 3
    huge = np.zeros((5000, 5000, 3), np.uint8)
    with monkeypatch.context() as patch:
        patch.setattr(cv2, "imdecode", lambda *_: pytest.fail("decoded"))
        answer = show(3, huge)
    assert mode(answer) == "REJECTED"
    assert "5000x5000 px among images of 160x120 px" in values_of(answer)["reason"]
    assert mode(show(4, frames[4])) == "TRACKING"
    assert mode(show(5, huge)) == "REJECTED"
    answer = show(6, huge)  # two that agree are a change of the stream
    assert mode(answer) == "TRACKING"
    assert "image size changed from 160x120 to 5000x5000" in values_of(answer)["event"]


def test_a_stray_size_is_rejected_and_costs_the_track_nothing(bench):
    frames = road(9)
    disturbed = Rig(bench, on_target(), variant="pf")
    answers = []
    for index, frame in enumerate(frames):
        if index:
            small = np.zeros((10 + index, 10, 3), np.uint8)
            stray = disturbed.show(image_message(header(index), small))
            assert mode(stray) == "REJECTED"
            assert "among images of 160x120 px" in values_of(stray)["reason"]
        answers.append(scalars(disturbed.show_frame(frame, index)))
    bench.remove(disturbed.node)
    assert answers == undisturbed(bench, frames)


def test_a_loop_starts_again(rig):
    frames = road(12)
    first = [scalars(rig.show_frame(frame, i)) for i, frame in enumerate(frames)]
    assert mode(rig.show_frame(frames[0], 0)) == "REJECTED"
    again = [scalars(rig.show_frame(frame, i)) for i, frame in enumerate(frames[1:], start=1)]
    assert again[0].pop("event") == "time jumped back"
    assert again == first[1:]


def test_a_loop_may_be_ridden_over(bench):
    rig = Rig(bench, on_target(reset_on_time_jump=False))
    for index, frame in enumerate(road(8)):
        answer = rig.show_frame(frame, index if index < 4 else index - 4)
        assert mode(answer) == ("REJECTED" if index == 4 else "TRACKING")
    x = float(values_of(answer)["x"])
    assert x == pytest.approx(20 + 12 + 14, abs=4)


def test_a_new_image_size_is_announced_and_starts_again(rig):
    rig.play(road(3))
    wide = road(3, width=200)
    assert mode(rig.show_frame(wide[0], 3)) == "REJECTED"
    answer = rig.show_frame(wide[1], 4)
    assert "160x120 to 200x120" in values_of(answer)["event"]
    assert mode(answer) == "TRACKING"
    assert "event" not in values_of(rig.show_frame(wide[2], 5))


@pytest.mark.parametrize(
    ("stamps", "event"),
    [([0] * 8, "repeated stamp"), ([10**12 - i * 10**10 for i in range(16)], "unusable stamps")],
    ids=["all zero", "backwards"],
)
def test_a_camera_without_a_clock_is_followed(rig, stamps, event):
    frames = road(len(stamps))
    answers = [
        rig.show(image_message(header_at(stamp), frame))
        for stamp, frame in zip(stamps, frames, strict=True)
    ]
    assert mode(answers[-1]) == "TRACKING"
    assert event in values_of(answers[-1])["event"]
    expected = 20 + 12 + 2 * (len(stamps) - 1)
    assert float(values_of(answers[-1])["x"]) == pytest.approx(expected, abs=6)


def test_a_target_is_neither_judged_by_a_stray_nor_lost_to_it(bench):
    rig = Rig(bench)
    targets = Targets(rig)
    frames = road(3)
    rig.show_frame(frames[0], 0)
    targets.give(polygon((100, 60), (120, 80)))
    stray = Image(encoding="rgb8", width=4, height=4, step=12, data=bytes(48), header=header(1))
    stray.header.frame_id = "elsewhere"
    assert mode(rig.show(stray)) == "REJECTED"
    answer = rig.show_frame(frames[1], 1)
    assert values_of(answer)["x"] == "110.0"
    assert mode(rig.show(stray)) == "REJECTED"
    targets.give(polygon((20, 50), (44, 68), frame_id="camera"))  # that of the images
    assert values_of(rig.show_frame(frames[2], 2))["x"] == "32.0"
