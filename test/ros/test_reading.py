# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bytes of other programs that are messages, or are none."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from rclpy.serialization import serialize_message
from sensor_msgs.msg import CompressedImage

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.reading import read_message
from vehicle_pf_tracker.ros.replay.publishing import decompressed

MESSAGE = CompressedImage(format="png", data=b"abc")


def test_a_message_comes_back():
    assert read_message(serialize_message(MESSAGE), CompressedImage) == MESSAGE


@pytest.mark.parametrize("read", [lambda data: read_message(data, CompressedImage), decompressed])
@pytest.mark.parametrize("length", [0, 3, 20, 26])
def test_what_is_cut_off_is_a_mistake_of_whoever_sent_it(read, length):
    with pytest.raises(
        InputError, match=f"^{length} bytes came that are not of the type CompressedImage"
    ):
        read(serialize_message(MESSAGE)[:length])
