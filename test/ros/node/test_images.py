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

"""Serialized images, read in place, against what rclpy makes of them."""

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import Image

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.node.image_input import read_serialized

pytestmark = pytest.mark.ros

FIELDS = ("header", "height", "width", "encoding", "is_bigendian", "step")

texts = st.text(st.characters(blacklist_characters="\0", blacklist_categories=["Cs"]), max_size=9)


@given(
    seconds=st.integers(-(2**31), 2**31 - 1),
    nanoseconds=st.integers(0, 2**32 - 1),
    frame_id=texts,
    encoding=texts,
    is_bigendian=st.integers(0, 255),
    data=st.binary(max_size=40),
)
def test_fields_are_those_that_rclpy_reads(
    seconds, nanoseconds, frame_id, encoding, is_bigendian, data
):
    image = Image(height=3, width=70_000, encoding=encoding, is_bigendian=is_bigendian, step=7)
    image.header.stamp.sec, image.header.stamp.nanosec = seconds, nanoseconds
    image.header.frame_id, image.data = frame_id, data
    serialized = serialize_message(image)
    found, expected = read_serialized(serialized), deserialize_message(serialized, Image)
    for name in FIELDS:
        assert getattr(found, name) == getattr(expected, name)
    assert bytes(found.data) == bytes(expected.data)


def test_a_message_of_a_machine_with_the_other_byte_order_is_read():
    frame_id, encoding = b"\0\0\0\4cam\0", b"\0\0\0\6mono8\0"
    message = (
        b"\0\0\0\0" + b"\0\0\0\1\0\0\0\2" + frame_id + b"\0\0\0\1\0\0\0\3" + encoding
        + b"\1\0" + b"\0\0\0\3" + b"\0\0\0\3abc"
    )  # fmt: skip
    found = read_serialized(message)
    assert (found.header.stamp.sec, found.header.stamp.nanosec) == (1, 2)
    assert (found.header.frame_id, found.encoding) == ("cam", "mono8")
    assert (found.height, found.width, found.is_bigendian, found.step) == (1, 3, 1, 3)
    assert bytes(found.data) == b"abc"


def test_a_message_that_is_cut_off_is_refused():
    image = image_message(Image().header, np.zeros((2, 2, 3), np.uint8))
    serialized = serialize_message(image)
    for length in range(len(serialized) - 12):
        with pytest.raises(InputError, match="cut off"):
            read_serialized(serialized[:length])
