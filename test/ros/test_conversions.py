# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages from estimates and frames, and back, without a node."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from geometry_msgs.msg import Point32, PointStamped, PolygonStamped
from hypothesis import given
from hypothesis import strategies as st
from sensor_msgs.msg import RegionOfInterest
from std_msgs.msg import Header

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.ros.messages import (
    LEVELS,
    REJECTED_MESSAGE,
    WAITING_MESSAGE,
    box_message,
    image_message,
    particles_message,
    point_message,
    stamp_ns,
    status,
    velocity_message,
)
from vehicle_pf_tracker.ros.node.image_input import read_image
from vehicle_pf_tracker.ros.target_messages import (
    box_of_detection,
    box_of_point,
    box_of_polygon,
    box_of_region,
)
from vehicle_pf_tracker.trackers.estimate import Estimate, Mode, read_only
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode


@pytest.fixture
def header():
    made = Header(frame_id="camera")
    made.stamp.sec, made.stamp.nanosec = 12, 34
    return made


@pytest.fixture
def estimate():
    return Estimate(
        position=(40.5, 31.0),
        box=Box(30.5, 21.0, 20.0, 20.0),
        velocity=(1.5, -0.5),
        mode=Mode.OCCLUDED,
        regime="occlusion",
        confidence=0.25,
        similarities={"pi": 0.5},
        effective_sample_size=1.5,
        resampling_passes=1,
        resampled_particles=2,
        particles=read_only(np.array([[40.0, 30.0], [41.0, 32.0]])),
        weights=read_only(np.array([0.25, 0.75])),
    )


def test_stamp_in_nanoseconds(header):
    assert stamp_ns(header) == 12_000_000_034


def written(value) -> str:
    return status(b"\0", "node", "words", "topic", {"x": value}).values[0].value


@given(st.floats(allow_nan=False))
def test_no_digit_of_a_number_is_lost(number):
    assert float(written(number)) == number


@pytest.mark.parametrize(
    ("value", "text"),
    [(np.float64(0.1), "0.1"), (3, "3"), (True, "True"), ("LOST", "LOST"), (math.inf, "inf")],
)
def test_values_are_written_plainly(value, text):
    assert written(value) == text


def test_every_mode_has_a_level():
    assert set(LEVELS) == {
        *(mode.value for mode in (*Mode, *TrackMode)),
        WAITING_MESSAGE,
        REJECTED_MESSAGE,
    }
    assert [LEVELS[mode.value] for mode in Mode] == [b"\x00", b"\x01", b"\x02"]


def test_a_status_holds_every_scalar(estimate):
    made = status(b"\x01", "node", "OCCLUDED", "/image", estimate.scalars())
    assert (made.level, made.name, made.message) == (b"\x01", "node", "OCCLUDED")
    assert made.hardware_id == "/image"
    assert [item.key for item in made.values] == list(estimate.scalars())


def test_position_box_and_velocity(header, estimate):
    point = point_message(header, estimate.position).point
    assert (point.x, point.y, point.z) == (40.5, 31.0, 0.0)
    corners = box_message(header, estimate.box).polygon.points
    assert [(p.x, p.y) for p in corners] == [(30.5, 21), (50.5, 21), (50.5, 41), (30.5, 41)]
    vector = velocity_message(header, estimate.velocity, 0.04).vector
    assert (vector.x, vector.y) == pytest.approx((37.5, -12.5))


def test_particles(header, estimate):
    message = particles_message(header, estimate)
    assert (message.width, message.height, message.point_step, message.row_step) == (2, 1, 16, 32)
    points = np.frombuffer(message.data, "<f4").reshape(2, 4)
    assert points.tolist() == [[40, 30, 0, 0.25], [41, 32, 0, 0.75]]


def test_an_image_comes_back_in_place(header):
    frame = np.arange(5 * 7 * 3, dtype=np.uint8).reshape(5, 7, 3)
    message = image_message(header, frame)
    assert (message.width, message.height, message.step) == (7, 5, 21)
    read = read_image(message)
    assert (read == frame).all()
    assert np.shares_memory(read, np.frombuffer(message.data, np.uint8))


# Targets


def polygon(*corners, frame_id=""):
    message = PolygonStamped(header=Header(frame_id=frame_id))
    message.polygon.points = [Point32(x=float(x), y=float(y)) for x, y in corners]
    return message


def point(x, y, frame_id=""):
    message = PointStamped(header=Header(frame_id=frame_id))
    message.point.x, message.point.y = float(x), float(y)
    return message


def test_a_region_is_a_box():
    region = RegionOfInterest(x_offset=3, y_offset=4, width=5, height=6)
    assert box_of_region(region) == Box(3.0, 4.0, 5.0, 6.0)


def test_a_box_message_comes_back(header, estimate):
    assert box_of_polygon(box_message(header, estimate.box)) == estimate.box


@given(st.permutations([(1, 2), (5, 2), (5, 9), (1, 9)]))
def test_corners_may_come_in_any_order(corners):
    assert box_of_polygon(polygon(*corners)) == Box(1, 2, 4, 7)


def test_a_point_centres_the_present_box():
    assert box_of_point(point(50, 40), Box(0, 0, 20, 10)) == Box(40, 35, 20, 10)


def detection(x=40.0, theta=0.0):
    """Make the fields of a vision_msgs/Detection2D, which is no wheel, that are looked at."""
    centre = SimpleNamespace(position=SimpleNamespace(x=x, y=60.0), theta=theta)
    return SimpleNamespace(bbox=SimpleNamespace(center=centre, size_x=24.0, size_y=18.0))


def test_a_detection_names_a_target():
    assert box_of_detection(detection()) == Box(28.0, 51.0, 24.0, 18.0)


@pytest.mark.parametrize(
    "make",
    [
        lambda: box_of_polygon(polygon((1, 1))),
        lambda: box_of_polygon(polygon((1, math.nan), (2, 2))),
        lambda: box_of_point(point(-math.inf, 1), Box(0, 0, 2, 2)),
        lambda: box_of_point(point(1, 1), None),
        lambda: box_of_detection(detection(x=math.nan)),
        lambda: box_of_detection(detection(theta=0.3)),
    ],
)
def test_what_is_no_target_is_said_in_one_sentence(make):
    with pytest.raises(InputError) as caught:
        make()
    assert str(caught.value).startswith("~/")
    assert "\n" not in str(caught.value)
