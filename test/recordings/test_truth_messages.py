# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Truth that is missing, empty or broken."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from recording_samples import frame_of, stamp_of, truth_of

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.recordings.bags import messages
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.truth_messages import (
    TRUTH_BOX_TOPIC,
    TRUTH_MODE_TOPIC,
    TRUTH_POSITION_TOPIC,
    TRUTH_TYPES,
    truth_from_messages,
    truth_to_messages,
)
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter

px = st.floats(-5000, 5000)
size = st.floats(0.5, 5000)


@given(
    stamp=st.integers(0, 2**31 * 10**9 - 1),
    corner=st.tuples(px, px),
    extent=st.tuples(size, size),
    occlusion=st.sampled_from(Occlusion),
    visible=st.none() | st.floats(0, 1),
)
def test_truth_survives_its_messages(stamp, corner, extent, occlusion, visible):
    truth = Truth(stamp, Box(*corner, *extent), occlusion, visible)
    (found,) = truth_from_messages(truth_to_messages(truth).items())
    assert (found.stamp_ns, found.occlusion) == (stamp, occlusion)
    assert found.visible_fraction == visible
    assert found.box.centre == pytest.approx(truth.box.centre, abs=1e-9)
    assert found.box.width == pytest.approx(extent[0], abs=2e-3)  # float32 at 10,000 px
    assert found.box.height == pytest.approx(extent[1], abs=2e-3)


def test_the_box_alone_is_truth_without_occlusion():
    box = messages.polygon_stamped(5, Box(1, 2, 3, 4).corners)
    (found,) = truth_from_messages([(TRUTH_BOX_TOPIC, box)])
    assert found == Truth(5, Box(1, 2, 3, 4), Occlusion.NONE, None)


def test_level_warns_only_while_totally_occluded():
    levels = [
        truth_to_messages(Truth(0, Box(0, 0, 1, 1), occlusion))[TRUTH_MODE_TOPIC].status[0].level
        for occlusion in Occlusion
    ]
    assert levels == [messages.OK, messages.OK, messages.WARN]


def replaced(topic, message):
    return {**truth_to_messages(truth_of(1)), topic: message}


def without_box():
    found = truth_to_messages(truth_of(1))
    del found[TRUTH_BOX_TOPIC]
    return found


STAMP = stamp_of(1)


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        (without_box(), "has no box"),
        (
            replaced(TRUTH_BOX_TOPIC, messages.polygon_stamped(STAMP, [])),
            "not a polygon",
        ),
        (
            replaced(TRUTH_BOX_TOPIC, messages.polygon_stamped(STAMP, [(math.nan, 0)] * 4)),
            "not a polygon of corners within",
        ),
        (
            replaced(TRUTH_BOX_TOPIC, messages.polygon_stamped(STAMP, [(5, 5)] * 4)),
            "no area",
        ),
        (
            replaced(TRUTH_POSITION_TOPIC, messages.point_stamped(STAMP, math.nan, 0)),
            "position .* not within",
        ),
        (
            replaced(
                TRUTH_MODE_TOPIC,
                messages.diagnostic_array(STAMP, "t", 0, "", {"occlusion": "a bit"}),
            ),
            "none, partial or total",
        ),
    ],
)
def test_broken_truth_is_named(tmp_path, broken, said):
    with RecordingWriter(tmp_path / "bag") as writer:
        writer.write_image(stamp_of(0), frame_of(0))
        writer.write_truth(truth_of(0))
        for topic, message in broken.items():
            writer.write(topic, TRUTH_TYPES[topic], STAMP, message)
    with pytest.raises(InputError, match=f"truth of .* is broken: .*{said}"):
        Recording(tmp_path / "bag").truth()


def test_the_first_truth_waits_for_topics_that_are_recorded_later(bare_mcap):
    bag = bare_mcap()
    bag.image(bag.channel(messages.IMAGE_TOPIC, messages.IMAGE), 0)
    channels = {topic: bag.channel(topic, kind) for topic, kind in TRUTH_TYPES.items()}
    for index in range(20):
        for delay, (topic, message) in enumerate(truth_to_messages(truth_of(index)).items()):
            bag.add(
                channels[topic], stamp_of(index) + delay * 60_000_000, message, TRUTH_TYPES[topic]
            )
    recording = Recording(bag.close())
    assert recording.first_truth() == recording.truth()[0]


def test_truth_topics_without_messages_are_empty_truth(bare_mcap):
    bag = bare_mcap()
    bag.image(bag.channel(messages.IMAGE_TOPIC, messages.IMAGE), 0)
    bag.channel(TRUTH_BOX_TOPIC, messages.POLYGON_STAMPED)
    with pytest.raises(InputError, match=r"truth topics .* are empty"):
        Recording(bag.close()).truth()


def test_truth_of_another_type_is_refused(bare_mcap):
    bag = bare_mcap()
    bag.image(bag.channel(messages.IMAGE_TOPIC, messages.IMAGE), 0)
    point = messages.point_stamped(1, 2, 3)
    box = bag.channel(TRUTH_BOX_TOPIC, messages.POINT_STAMPED)
    bag.add(box, 1, point, messages.POINT_STAMPED)
    recording = Recording(bag.close())
    with pytest.raises(InputError, match="carries geometry_msgs/msg/PointStamped, not"):
        recording.truth()
    with pytest.raises(InputError, match="carries"):
        recording.first_truth()
