# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Images in CDR read in place, against rclpy's own reading of the same bytes."""

from __future__ import annotations

import array
import struct

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.node.image_input import read_image
from vehicle_pf_tracker.ros.serialized_image import SerializedImage, read_serialized_image

FIELDS = ("header", "height", "width", "encoding", "is_bigendian", "step")


def image(frame_id="camera", encoding="rgb8", rows=2):
    return Image(
        header=Header(stamp=Time(sec=-3, nanosec=999_999_999), frame_id=frame_id),
        height=rows, width=3, encoding=encoding, is_bigendian=1, step=9,
        data=array.array("B", range(9 * rows)),
    )  # fmt: skip


# Names of all lengths: what comes after them is aligned to four bytes.
@pytest.mark.parametrize("frame_id", ["", "a", "ab", "abc", "abcd", "mast/ü"])
@pytest.mark.parametrize("encoding", ["rgb8", "mono8", "bgra16", "16UC1_x"])
def test_every_field_is_that_of_the_message(frame_id, encoding):
    message = image(frame_id, encoding)
    read = read_serialized_image(serialize_message(message))
    assert isinstance(read, SerializedImage)
    for field in FIELDS:
        assert getattr(read, field) == getattr(message, field)
    assert read.data.tolist() == message.data.tolist()


def test_pixels_are_a_view_of_what_came():
    serialized = serialize_message(image())
    frame = read_image(read_serialized_image(serialized))
    assert frame[1, 2].tolist() == [15, 16, 17]
    assert np.shares_memory(frame, np.frombuffer(serialized, np.uint8))
    assert not frame.flags.writeable


def test_no_pixels_are_no_data():
    read = read_serialized_image(serialize_message(image(rows=0)))
    assert (read.height, len(read.data)) == (0, 0)


def test_the_other_order_of_bytes_is_left_to_rclpy():
    numbers = struct.pack(">iII", 5, 6, 2) + b"c\0\0\0" + struct.pack(">III", 1, 2, 5) + b"rgb8\0"
    serialized = b"\0\0\0\0" + numbers + b"\0\0\0" + struct.pack(">II", 6, 6) + bytes(range(6))
    read = read_serialized_image(serialized)
    assert isinstance(read, Image)
    assert (read.header.stamp.sec, read.header.frame_id, read.height, read.width) == (5, "c", 1, 2)
    assert (read.encoding, read.step, read.data.tolist()) == ("rgb8", 6, [0, 1, 2, 3, 4, 5])


@pytest.mark.parametrize("length", [2, 14, 30, 50, 60])
def test_bytes_that_are_cut_off_are_no_image(length):
    with pytest.raises(InputError, match=f"{length} bytes came that are not of the type Image"):
        read_serialized_image(serialize_message(image())[:length])
