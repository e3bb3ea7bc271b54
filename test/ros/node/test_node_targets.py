# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Targets given while the node runs: set, click, reset, and what is refused."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from geometry_msgs.msg import Point32, PointStamped, PolygonStamped
from rcl_interfaces.srv import SetParametersAtomically
from sensor_msgs.msg import Image, RegionOfInterest
from std_srvs.srv import Trigger
from tracker_rig import TARGET, Rig, header, on_target, overrides, road, values_of
from traffic_rig import hear_notices

pytestmark = pytest.mark.ros


def region(x: int, y: int, width: int, height: int) -> RegionOfInterest:
    return RegionOfInterest(x_offset=x, y_offset=y, width=width, height=height)


def polygon(*corners, frame_id: str = "") -> PolygonStamped:
    message = PolygonStamped()
    message.header.frame_id = frame_id
    message.polygon.points = [Point32(x=float(x), y=float(y)) for x, y in corners]
    return message


def point(x: float, y: float, frame_id: str = "") -> PointStamped:
    message = PointStamped()
    message.header.frame_id = frame_id
    message.point.x, message.point.y = float(x), float(y)
    return message


class Targets:
    """Sends targets and waits until the node has them."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        publish = rig.bench.publisher
        self.topics = {
            RegionOfInterest: publish(RegionOfInterest, f"{rig.name}/set_target"),
            PolygonStamped: publish(PolygonStamped, f"{rig.name}/set_box"),
            PointStamped: publish(PointStamped, f"{rig.name}/clicked_point"),
        }

    def give(self, message) -> None:
        stream, health = self.rig.node.feed, self.rig.node.diagnostics.health
        before = stream.asked, health.refusals.count
        self.topics[type(message)].publish(message)
        self.rig.bench.wait_for(lambda: (stream.asked, health.refusals.count) != before)

    @property
    def last_refusal(self) -> str:
        return self.rig.node.diagnostics.health.refusals.last


@pytest.fixture
def waiting(bench):
    rig = Rig(bench)
    return rig, Targets(rig)


@pytest.fixture
def tracking(bench):
    rig = Rig(bench, on_target())
    rig.play(road(3))
    return rig, Targets(rig)


def box_of(answer) -> tuple[float, ...]:
    values = values_of(answer)
    width, height = float(values["width"]), float(values["height"])
    return float(values["x"]) - width / 2, float(values["y"]) - height / 2, width, height


def test_a_waiting_node_starts_on_the_next_image(waiting):
    rig, targets = waiting
    rig.show_frame(road(1)[0], 0)
    targets.give(region(*TARGET))
    answer = rig.show_frame(road(1)[0], 1)
    assert answer.status[0].message == "TRACKING"
    assert box_of(answer) == TARGET


def test_a_box_has_sub_pixel_corners(waiting):
    rig, targets = waiting
    targets.give(polygon((20.25, 50.5), (44.5, 50.5), (44.5, 68.75), (20.25, 68.75)))
    assert box_of(rig.show_frame(road(1)[0], 0)) == (20.25, 50.5, 24.25, 18.25)


def test_a_click_takes_the_present_size(tracking):
    rig, targets = tracking
    targets.give(point(80.5, 60.0, "camera"))
    answer = rig.show_frame(road(4)[3], 3)
    assert values_of(answer)["regime"] == "start"
    assert box_of(answer) == (80.5 - 12, 60.0 - 9, 24, 18)


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (region(20, 50, 0, 0), "smaller than one pixel"),
        (region(2**32 - 1, 50, 20, 20), "outside the image"),
        (region(150, 115, 40, 40), "outside the image of 160x120"),
        (polygon((-1e30, 0), (1e30, 20)), "larger than the image"),
        (polygon((math.nan, 1), (5, 5)), "not finite"),
        (polygon((1, 1), (math.inf, 5)), "not finite"),
        (polygon((20, 50), (math.nan, 50), (44, 68)), "not finite"),  # which min() may overlook
        (polygon(), "0 corners"),
        (polygon((10, 10), (20, 20), frame_id="map"), "frame 'map'"),
        (point(math.nan, 1), "not finite"),
        (point(500, 10), "outside the image of 160x120"),
        (point(10, 10, "base_link"), "frame 'base_link'"),
    ],
)
def test_a_target_that_cannot_be_is_refused_and_the_track_kept(tracking, message, words):
    rig, targets = tracking
    refused = rig.node.diagnostics.health.refusals.count
    targets.give(message)
    answer = rig.show_frame(road(4)[3], 3)
    assert rig.node.diagnostics.health.refusals.count == refused + 1
    assert words in targets.last_refusal
    assert "target refused: " in values_of(answer)["event"]
    assert words in values_of(answer)["event"]
    assert "event" not in values_of(rig.show_frame(road(5)[4], 4))  # once
    assert values_of(answer)["regime"] != "start"
    assert answer.status[0].message == "TRACKING"


def test_a_click_needs_a_size(waiting):
    _, targets = waiting
    targets.give(point(10, 10))
    assert "no box size" in targets.last_refusal


def test_reset_goes_back_to_the_configured_target(tracking):
    rig, targets = tracking
    targets.give(region(100, 20, 30, 30))
    assert box_of(rig.show_frame(road(4)[3], 3)) == (100, 20, 30, 30)
    response = rig.bench.call(Trigger, f"{rig.name}/reset", Trigger.Request())
    assert response.success
    assert response.message == "following 20,50,24,18"
    answer = rig.show_frame(road(1)[0], 4)
    assert values_of(answer)["regime"] == "start"
    assert box_of(answer) == TARGET


MISSES = [
    ({"x": -50.0}, "outside every image"),
    ({"y": -50.0}, "outside every image"),
    ({"x": 150.0}, "outside the image of 160x120"),
    ({"y": 115.0}, "outside the image of 160x120"),
    ({"x": 90_000.0}, "outside the image of 160x120"),
    ({"width": 700.0}, "far larger than the image"),
    ({"height": 500.0}, "far larger than the image"),
    ({"width": 300.0}, "outside the image of 160x120"),
    ({"x": 300.0, "y": 300.0, "width": 20.0, "height": 20.0}, "outside the image of 160x120"),
]


@pytest.mark.parametrize(("changes", "words"), MISSES)
def test_a_target_that_misses_the_image_is_refused_when_it_is_set(tracking, changes, words):
    rig, _ = tracking
    wanted = overrides(**{f"target__{name}": value for name, value in changes.items()})
    request = SetParametersAtomically.Request(parameters=[one.to_parameter_msg() for one in wanted])
    result = rig.bench.call(
        SetParametersAtomically, f"{rig.name}/set_parameters_atomically", request
    ).result
    assert not result.successful
    assert words in result.reason
    assert rig.bench.call(Trigger, f"{rig.name}/reset", Trigger.Request()).success
    assert box_of(rig.show_frame(road(1)[0], 4)) == TARGET


def test_a_target_set_before_the_images_that_it_misses_is_waited_for(bench):
    rig = Rig(bench, overrides(target__x=300.0, target__width=20.0, target__height=20.0))
    targets = Targets(rig)
    frames = road(4)
    for index in (0, 1):
        answer = rig.show_frame(frames[index], index)
        assert answer.status[0].message == "WAITING"
        assert "outside the image of 160x120" in values_of(answer)["reason"]
    response = rig.bench.call(Trigger, f"{rig.name}/reset", Trigger.Request())
    assert not response.success
    assert response.message.endswith("waiting for a target")
    answer = rig.show_frame(frames[2], 2)
    assert answer.status[0].message == "WAITING"
    assert "outside the image of 160x120" in values_of(answer)["reason"]
    targets.give(region(*TARGET))
    answer = rig.show_frame(frames[0], 3)
    assert answer.status[0].message == "TRACKING"
    assert "reason" not in values_of(answer)


def test_a_larger_stream_may_have_the_target_after_all(bench):
    rig = Rig(bench, overrides(target__x=300.0, target__width=20.0, target__height=20.0))
    assert rig.play(road(2)) == ["WAITING"] * 2
    assert not rig.bench.call(Trigger, f"{rig.name}/reset", Trigger.Request()).success
    assert rig.play(road(2, 640, 480), first=2) == ["TRACKING"] * 2


def test_a_camera_that_shows_a_thumbnail_for_a_while_costs_the_target_nothing(tracking):
    rig, _ = tracking
    assert rig.play(road(3, 16, 12), first=3) == ["REJECTED", "WAITING", "WAITING"]
    assert rig.play(road(3), first=6) == ["REJECTED", "TRACKING", "TRACKING"]
    assert box_of(rig.show_frame(road(4)[3], 9))[0] == pytest.approx(TARGET[0] + 6, abs=3)


def test_reset_goes_back_to_waiting(waiting):
    rig, targets = waiting
    targets.give(region(*TARGET))
    assert rig.play(road(2)) == ["TRACKING"] * 2
    rig.bench.call(Trigger, f"{rig.name}/reset", Trigger.Request())
    assert rig.play(road(1), first=2) == ["WAITING"]


def test_reset_forgets_a_target_that_was_not_yet_used(waiting):
    rig, targets = waiting
    targets.give(region(*TARGET))
    rig.bench.call(Trigger, f"{rig.name}/reset", Trigger.Request())
    assert rig.play(road(1)) == ["WAITING"]


def test_a_target_is_neither_judged_by_a_stray_nor_lost_to_it(waiting):
    rig, targets = waiting
    frames = road(3)
    rig.show_frame(frames[0], 0)
    targets.give(polygon((100, 60), (120, 80)))
    stray = Image(encoding="rgb8", width=4, height=4, step=12, data=bytes(48), header=header(1))
    stray.header.frame_id = "elsewhere"
    answer = rig.show(stray)
    assert answer.status[0].message == "REJECTED"
    assert "rejected unless the next image agrees with it" in values_of(answer)["reason"]
    answer = rig.show_frame(frames[1], 1)
    assert values_of(answer)["x"] == "110.0"
    assert rig.show(stray).status[0].message == "REJECTED"
    targets.give(polygon((20, 50), (44, 68), frame_id="camera"))  # that of the images
    assert values_of(rig.show_frame(frames[2], 2))["x"] == "32.0"


def test_a_doubtful_target_is_followed_with_a_warning(waiting):
    rig, targets = waiting
    frame = road(1)[0]
    frame[80:115, 100:150] = 110  # nothing stands out there
    targets.give(region(110, 85, 30, 20))
    answer = rig.show_frame(frame, 0)
    assert answer.status[0].message == "TRACKING"
    assert "the target is doubtful: nothing in it stands out" in values_of(answer)["event"]


def test_a_doubtful_target_with_each_image_is_logged_now_and_then(bench, monkeypatch):
    said = hear_notices(monkeypatch)
    rig = Rig(bench)
    targets = Targets(rig)
    frame = road(1)[0]
    frame[80:115, 100:150] = 110
    for index in range(3):
        targets.give(region(110 - index, 85, 30, 20))
        assert "doubtful" in values_of(rig.show_frame(frame, index))["event"]
    assert sum("the target is doubtful" in line for line in said) == 1


@pytest.mark.parametrize("drives", [False, True])
def test_a_target_that_stands_while_others_drive_is_warned_of(bench, drives, capfd):
    x, y, width, height = map(float, TARGET if drives else (100, 15, 30, 20))
    target = overrides(target__x=x, target__y=y, target__width=width, target__height=height)
    rig = Rig(bench, target)
    answers = []
    for index, frame in enumerate(road(16)):
        frame[15:35, 100:130] = (40, 160, 60)  # a sign
        frame[20:25, 105:125] = (220, 220, 220)
        answers.append(rig.show_frame(frame, 10 * index))  # 0.4 s later
    assert {answer.status[0].message for answer in answers} == {"TRACKING"}
    levels = [answer.status[0].level for answer in answers]
    events = [values_of(answer).get("event", "") for answer in answers]
    if drives:
        assert set(levels) == {b"\x00"}
        assert not any(events)
    else:
        assert levels == [b"\x00"] * 13 + [b"\x01"] * 3
        assert "the target has not moved for 5 s while other things did" in events[13]
        assert not events[14]
        assert capfd.readouterr().err.count("has not moved for 5 s") == 1
