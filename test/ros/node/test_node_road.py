# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Road, uncertainty, camera_info and marked frames, through a running node."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import (
    PointStamped,
    PolygonStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
)
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image
from tracker_rig import (
    FIRST_NS,
    HEIGHT,
    PERIOD_NS,
    SPEED,
    TARGET,
    WIDTH,
    Rig,
    on_target,
    road,
    values_of,
)

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker, with_target
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.road import RoadParameters
from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.ros.node import camera_inputs
from vehicle_pf_tracker.ros.node.camera_info import lens_of_info
from vehicle_pf_tracker.ros.replay.answers import Answers
from vehicle_pf_tracker.trackers.registry import find_variant

pytestmark = pytest.mark.ros

# Seen from above, 10 px to the metre.
PAIRS = "0,0=0,0; 160,0=16,0; 160,120=16,12; 0,120=0,12"
NODE = "/apf_tracker"
KMH = SPEED / 10 / (PERIOD_NS * 1e-9) * 3.6


@pytest.fixture
def rig(bench):
    return Rig(bench, on_target(road__pairs=PAIRS, road__frame_id="map"))


def collect_all(bench):
    kinds = {
        "road_position": PointStamped,
        "road_velocity": Vector3Stamped,
        "pose_with_covariance": PoseWithCovarianceStamped,
    }
    return {name: bench.collect(kind, f"{NODE}/{name}") for name, kind in kinds.items()}


def test_position_and_speed_on_the_road(bench, rig):
    found = collect_all(bench)
    for index, frame in enumerate(road(40)):
        answer = rig.show_frame(frame, index)
    values = values_of(answer)
    position = rig.position_at(answer)
    bench.wait_for(lambda: all(len(messages) == 40 for messages in found.values()))
    place, velocity, pose = (messages[-1] for messages in found.values())
    for message in (place, velocity, pose):
        assert message.header.frame_id == "map"
        assert message.header.stamp == answer.header.stamp
    # The lower edge of the box is half its height below the position in the image.
    expected = position.point.x / 10, (position.point.y + TARGET[3] / 2) / 10
    assert (place.point.x, place.point.y, place.point.z) == pytest.approx((*expected, 0.0))
    assert (pose.pose.pose.position.x, pose.pose.pose.position.y) == pytest.approx(expected)
    assert velocity.vector.x * 3.6 == pytest.approx(KMH, rel=0.1)
    assert float(values["speed_kmh"]) == pytest.approx(KMH, rel=0.1)
    assert float(values["road_x"]) == place.point.x
    assert float(values["speed_sd_kmh"]) > 0
    assert values["road"] == "ok"


def test_pose_is_in_pixels_without_a_road(bench):
    rig = Rig(bench, on_target())
    poses = bench.collect(PoseWithCovarianceStamped, f"{NODE}/pose_with_covariance")
    places = bench.collect(PointStamped, f"{NODE}/road_position")
    for index, frame in enumerate(road(5)):
        answer = rig.show_frame(frame, index)
    bench.wait_for(lambda: len(poses) == 5)
    point = rig.position_at(answer).point
    pose = poses[-1]
    assert pose.header == answer.header
    assert (pose.pose.pose.position.x, pose.pose.pose.position.y) == (point.x, point.y)
    matrix = np.array(pose.pose.covariance).reshape(6, 6)
    assert np.linalg.eigvalsh(matrix[:2, :2]).min() > 0
    assert matrix == pytest.approx(matrix.T)
    assert places == []
    assert "road" not in values_of(answer)


def test_covariance_grows_while_the_vehicle_is_hidden(bench):
    rig = Rig(bench, on_target())
    poses = bench.collect(PoseWithCovarianceStamped, f"{NODE}/pose_with_covariance")
    frames = road(8)
    empty = np.random.default_rng(3).integers(90, 130, (HEIGHT, WIDTH, 3), np.uint8)
    modes = rig.play([*frames, *[empty] * 12])
    assert modes[-1] == "OCCLUDED"
    bench.wait_for(lambda: len(poses) == 20)
    first = modes.index("OCCLUDED")
    areas = [np.linalg.det(np.reshape(p.pose.covariance, (6, 6))[:2, :2]) for p in poses]
    assert areas[-1] > 1.2 * areas[first] > 1.2 * areas[first - 2]


def test_outside_the_area_nothing_is_published_and_the_reason_said(bench):
    # Only the left half is calibrated.
    pairs = "0,0=0,0; 80,0=8,0; 80,120=8,12; 0,120=0,12"
    rig = Rig(bench, on_target(road__pairs=pairs, road__margin=0.0))
    places = bench.collect(PointStamped, f"{NODE}/road_position")
    reports = bench.collect(DiagnosticArray, "/diagnostics")
    answers = [rig.show_frame(frame, index) for index, frame in enumerate(road(40))]
    said = [values_of(answer)["road"] for answer in answers]
    assert said[0] == "ok"
    assert said[-1] == "outside the calibrated area"
    bench.wait_for(lambda: len(places) == said.count("ok"))
    reports.clear()
    bench.wait_for(lambda: reports)
    assert values_of(reports[-1])["road"] == "outside the calibrated area"


def test_the_overlay_has_the_speed(bench, rig):
    pictures = bench.collect(Image, f"{NODE}/overlay", qos_profile_sensor_data)
    frames = road(2)
    rig.play(frames)
    rig.node.set_parameters_atomically(on_target(road__pairs="", road__frame_id="map"))
    rig.play(frames[:1], first=2)
    bench.wait_for(lambda: len(pictures) >= 2)
    assert pictures[-1].data != pictures[0].data


def camera_info(width=WIDTH, height=HEIGHT, distortion=()):
    message = CameraInfo(width=width, height=height, distortion_model="plumb_bob")
    message.k = [100.0, 0.0, 79.5, 0.0, 100.0, 59.5, 0.0, 0.0, 1.0]
    message.d = list(distortion)
    return message


# 10 m above the road, looking straight down: 100 px of focal length make 10 px to the metre.
DOWN = "8,6,10,1,0,0,0"


def test_lens_from_camera_info(bench):
    rig = Rig(bench, on_target(road__camera_pose=DOWN, road__from_camera_info=True))
    assert values_of(rig.show_frame(road(1)[0], 0))["road"] == "no camera_info yet"
    publisher = bench.publisher(CameraInfo, "/camera_info")
    later = iter(range(1, 1000))
    frame = road(3)[2]

    def shown():
        return rig.show_frame(frame, next(later))

    answer = bench.publish_until(
        lambda: values_of(answer := shown())["road"] == "ok" and answer, publisher, camera_info()
    )
    values, point = values_of(answer), rig.position_at(answer).point
    assert values["road"] == "ok"
    assert float(values["road_x"]) == pytest.approx(8 + (point.x - 80) / 10)
    assert float(values["road_y"]) == pytest.approx(6 - (point.y + TARGET[3] / 2 - 60) / 10)

    def said():
        return values_of(shown())

    straight = float(said()["road_x"])
    bench.publish_until(
        lambda: float(said()["road_x"]) != pytest.approx(straight, abs=1e-3), publisher,
        camera_info(distortion=(-0.3, 0.0, 0.0, 0.0, 0.0)),
    )  # fmt: skip
    # Another size than the images have.
    words = "camera_info is for 320x240 px, the image has 160x120"
    bench.publish_until(lambda: said()["road"] == words, publisher, camera_info(320, 240))


def test_frames_of_pixel_outputs_can_be_marked(bench):
    rig = Rig(bench, on_target(output_frame_suffix="_px", road__pairs=PAIRS))
    boxes = bench.collect(PolygonStamped, f"{NODE}/box")
    places = bench.collect(PointStamped, f"{NODE}/road_position")
    answer = rig.show_frame(road(1)[0], 0)
    assert answer.header.frame_id == "camera"
    bench.wait_for(lambda: boxes and places)
    assert boxes[0].header.frame_id == "camera_px"
    assert rig.position_at(answer).header.frame_id == "camera_px"
    assert places[0].header.frame_id == "road"
    # What goes out may come back in.
    publisher = bench.publisher(PolygonStamped, f"{NODE}/set_box")
    health = rig.node.diagnostics.health
    publisher.publish(boxes[0])
    bench.wait_for(lambda: rig.node.feed.asked is not None)
    assert health.refusals.count == 0
    boxes[0].header.frame_id = "map"
    publisher.publish(boxes[0])
    bench.wait_for(lambda: health.refusals.count == 1)


def transform(parent, child, position, quaternion=(0.0, 0.0, 0.0, 1.0)):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    at, turn = message.transform.translation, message.transform.rotation
    at.x, at.y, at.z = position
    turn.x, turn.y, turn.z, turn.w = quaternion
    return message


def test_pose_from_tf(bench, monkeypatch):
    # tf2_msgs is no wheel: handed over here, sent in test_node_optional_messages.py.
    monkeypatch.setattr(camera_inputs, "TFMessage", Image)
    rig = Rig(
        bench,
        on_target(road__from_tf=True, road__intrinsics="100,100,79.5,59.5", road__frame_id="map"),
    )
    said = values_of(rig.show_frame(road(1)[0], 0))["road"]
    assert said == "no transform from map to the camera yet"
    transforms = [
        transform("map", "mast", (8.0, 6.0, 0.0)),
        transform("mast", "camera", (0.0, 0.0, 10.0), (1.0, 0.0, 0.0, 0.0)),
        transform("mast", "broken", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)),
    ]
    rig.callback("/tf")(SimpleNamespace(transforms=transforms))
    for index, frame in enumerate(road(3), 1):
        answer = rig.show_frame(frame, index)
    values, point = values_of(answer), rig.position_at(answer).point
    assert values["road"] == "ok"
    assert float(values["road_x"]) == pytest.approx(8 + (point.x - 80) / 10)


def test_camera_info_of_a_binned_part_of_the_image():
    message = CameraInfo(width=1280, height=960, binning_x=2, binning_y=2)
    message.k = [1000.0, 0.0, 639.5, 0.0, 1000.0, 479.5, 0.0, 0.0, 1.0]
    message.p = [900.0, 0.0, 630.5, 0.0, 0.0, 910.0, 470.5, 0.0, 0.0, 0.0, 1.0, 0.0]
    message.d, message.distortion_model = [-0.3, 0.1, 0.0, 0.0, 0.0], "plumb_bob"
    found = lens_of_info(message, rectified=False)
    # The middle of the sensor, at 640, 480 px from its corner, is at 320, 240 px of half as many.
    assert found.lens == Lens((500.0, 500.0), (319.5, 239.5), "plumb_bob", tuple(message.d))
    assert found.size == (640, 480)
    rectified = lens_of_info(message, rectified=True).lens
    assert rectified == Lens((450.0, 455.0), (315.0, 235.0))
    message.roi.x_offset, message.roi.y_offset = 100, 200
    message.roi.width, message.roi.height = 400, 300
    part = lens_of_info(message, rectified=False)
    assert part.lens.centre == (269.5, 139.5)
    assert part.size == (200, 150)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"k": [0.0] * 9}, "no calibration"),
        ({"distortion_model": "thin_prism", "d": [0.1]}, "not known"),
        ({"distortion_model": "rational_polynomial", "d": [0.1] * 12}, "must be 0"),
    ],
)
def test_camera_info_that_is_no_lens(changes, words):
    message = camera_info()
    for name, value in changes.items():
        setattr(message, name, value)
    with pytest.raises(InputError, match=words):
        lens_of_info(message, rectified=False)


def test_numbers_are_those_of_an_offline_run_and_of_a_replay(bench, rig):
    frames = road(12)
    answers, replayed = [], Answers()
    for index, frame in enumerate(frames):
        replayed.expect(index, FIRST_NS + index * PERIOD_NS)
        answers.append(rig.show_frame(frame, index))
        replayed.receive(answers[-1])
    settings = with_target(SessionParameters(road=RoadParameters(pairs=PAIRS)), Box(*TARGET))
    variant = find_variant("apf")
    tracker = OfflineTracker(variant, variant.parameters(), settings)
    list(tracker.rows((FIRST_NS + i * PERIOD_NS, frame) for i, frame in enumerate(frames)))
    columns = tracker.road_columns
    assert columns == replayed.road_columns()
    for name, numbers in columns.items():
        assert [float(values_of(answer)[name]) for answer in answers] == numbers
