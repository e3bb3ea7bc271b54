# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""One answer per image, through Fast DDS: the numbers of an offline run, and what is refused."""

from __future__ import annotations

import array

import cv2
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from rclpy.serialization import serialize_message
from sensor_msgs.msg import CompressedImage, Image
from tracker_rig import FIRST_NS, PERIOD_NS, TARGET, Rig, header, on_target, road, values_of

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.image.formats.compressed_image import decode_compressed
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.trackers.registry import find_variant
from vehicle_pf_tracker.trackers.session import Session

pytestmark = pytest.mark.ros

TIMED = {"step_ms"}


def offline(variant: str, frames, **settings) -> list[dict[str, str]]:
    """The scalars of an offline run, as text."""
    chosen = find_variant(variant)
    session = Session(chosen, chosen.parameters(**settings))
    session.set_target(Box(*map(float, TARGET)))
    rows = []
    for index, frame in enumerate(frames):
        estimate = session.feed(frame, FIRST_NS + index * PERIOD_NS)
        rows.append(
            {
                name: repr(float(value)) if isinstance(value, float) else str(value)
                for name, value in estimate.scalars().items()
                if name not in TIMED
            }
        )
    return rows


def without_times(answer) -> dict[str, str]:
    return {name: value for name, value in values_of(answer).items() if name not in TIMED}


@pytest.mark.parametrize("variant", ["apf", "pf"])
def test_numbers_are_those_of_an_offline_run(bench, variant):
    frames = road(20)
    rig = Rig(bench, on_target(seed=3), variant)
    answers = [rig.show_frame(frame, index) for index, frame in enumerate(frames)]
    assert [without_times(answer) for answer in answers] == offline(variant, frames, seed=3)


def test_position_has_the_images_header_and_every_digit(bench):
    rig = Rig(bench, on_target())
    frames = road(3)
    for index, frame in enumerate(frames):
        answer = rig.show(image_message(header(index, frame_id="mast_left"), frame))
        position = rig.position_at(answer)
        assert position.header == answer.header
        assert position.header.frame_id == "mast_left"
        assert repr(position.point.x) == values_of(answer)["x"]
        assert repr(position.point.y) == values_of(answer)["y"]
        assert position.point.z == 0.0


def test_waiting_is_answered_too(bench):
    rig = Rig(bench)
    answer = rig.show_frame(road(1)[0], 0)
    status = answer.status[0]
    assert (status.message, status.level) == ("WAITING", b"\x00")
    assert (status.name, status.hardware_id) == ("apf_tracker: target", "/image")
    assert values_of(answer) == {"mode": "WAITING"}
    assert rig.positions == []


def compressed_rig(bench) -> Rig:
    values = on_target(image_transport="compressed")
    return Rig(bench, values, kind=CompressedImage, topic="image/compressed")


def test_compressed_images_give_the_numbers_of_their_decoded_frames(bench):
    coded = []
    for frame in road(10):
        _, jpeg = cv2.imencode(".jpg", cv2.cvtColor(frame, cv2.COLOR_RGB2BGR))
        coded.append(array.array("B", jpeg.tobytes()))
    rig = compressed_rig(bench)
    answers = [
        rig.show(CompressedImage(header=header(index), format="jpeg", data=data))
        for index, data in enumerate(coded)
    ]
    decoded = [decode_compressed("jpeg", data) for data in coded]
    assert [without_times(answer) for answer in answers] == offline("apf", decoded)


def test_a_compressed_image_that_claims_gigabytes_is_answered_and_the_track_kept(bench):
    frames = [cv2.imencode(".png", frame[..., ::-1])[1].tobytes() for frame in road(5)]
    size = (30_000).to_bytes(4, "big")
    bomb = frames[3][:16] + size + size + frames[3][24:]
    rig = compressed_rig(bench)
    answers = [
        rig.show(CompressedImage(header=header(index), format="png", data=array.array("B", data)))
        for index, data in enumerate([*frames[:3], bomb, frames[4]])
    ]
    modes = [answer.status[0].message for answer in answers]
    assert modes == ["TRACKING"] * 3 + ["REJECTED", "TRACKING"]
    assert "claims 30000x30000 px" in values_of(answers[3])["reason"]


def test_messages_that_are_no_images_are_left_out_and_counted(bench):
    rig = Rig(bench, on_target())
    frames = road(5)
    rig.play(frames[:2])
    rejections = rig.node.diagnostics.health.rejections
    whole = serialize_message(image_message(header(2), frames[2]))
    for count in range(1, 26):  # more than the failures that end a node
        rig.camera.publish(whole[: 30 + count])
        bench.wait_for(lambda: rejections.count == count)  # noqa: B023 - called at once
    assert "bytes came that are not of the type Image: they are cut off" in rejections.last
    assert rig.play(frames[2:], 2) == ["TRACKING"] * 3


def test_a_format_that_is_a_long_text_holds_nobody_up(bench):
    rig = compressed_rig(bench)
    data = array.array("B", b"abc")
    answer = rig.show(CompressedImage(header=header(0), format="f" * 200_000, data=data))
    assert answer.status[0].message == "REJECTED"
    assert len(values_of(answer)["reason"]) < 200


def broken(index: int, **changes) -> Image:
    message = image_message(header(index), road(1)[0])
    for name, value in changes.items():
        setattr(message, name, value)
    return message


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"encoding": "rgb888"}, "'rgb888' is unknown"),
        ({"encoding": "r" * 200_000}, "rrr' is unknown"),
        ({"data": array.array("B", b"abc")}, "but has 3"),
        ({"data": array.array("B")}, "but has 0"),
        ({"height": 0}, "no pixels"),
        ({"step": 3}, "shorter than one row"),
        ({"width": 2**31, "step": 2**32 - 1}, "larger than"),
    ],
)
def test_an_unusable_image_is_answered_and_the_track_kept(bench, changes, words):
    rig = Rig(bench, on_target())
    frames = road(6)
    rig.play(frames[:3])
    answer = rig.show(broken(3, **changes))
    assert (answer.status[0].message, answer.status[0].level) == ("REJECTED", b"\x02")
    assert words in values_of(answer)["reason"]
    assert len(values_of(answer)["reason"]) < 500
    # As if the bad one had never been there: the clock does not see its stamp either.
    last = rig.show_frame(frames[3], 3)
    assert without_times(last) == offline("apf", frames[:4])[3]
