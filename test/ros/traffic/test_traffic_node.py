# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The node that follows many vehicles, through real Fast DDS."""

from __future__ import annotations

import threading
from importlib.util import find_spec
from urllib.error import URLError
from urllib.request import ProxyHandler, build_opener

import numpy as np
import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, PolygonStamped, Vector3Stamped
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from page_visitors import when_one_waits
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image, RegionOfInterest
from std_msgs.msg import Int64
from std_srvs.srv import Trigger
from tracker_rig import PERIOD_NS, diagnostics_of, header, overrides, values_of
from traffic_rig import NODE, WARM_UP, TrafficRig, boxes, hear_notices, lanes
from visualization_msgs.msg import Marker, MarkerArray

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.following.detectors import detector_maker
from vehicle_pf_tracker.parameters.configuration import Configuration
from vehicle_pf_tracker.parameters.counting_plan import read_counting_plan
from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.traffic.messages import MODE_CODES
from vehicle_pf_tracker.trackers.registry import TRAFFIC_VARIANT
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

pytestmark = pytest.mark.ros

COUNT = WARM_UP + 28
BEST_EFFORT = QoSProfile(depth=50, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture
def rig(bench):
    return TrafficRig(bench)


def offline(frames):
    """Return the answers of a session to the same frames without ROS."""
    parameters = TRAFFIC_VARIANT.parameters()
    session = TrafficSession(MultiVehicleTracker(parameters), detector_maker(parameters.detector))
    return [session.feed(frame, i * PERIOD_NS + 10**9) for i, frame in enumerate(frames)]


def points(cloud):
    kinds = {6: "<u4", 2: "u1", 7: "<f4"}
    layout = {
        "names": [field.name for field in cloud.fields],
        "formats": [kinds[field.datatype] for field in cloud.fields],
        "offsets": [field.offset for field in cloud.fields],
        "itemsize": cloud.point_step,
    }
    return np.frombuffer(bytes(cloud.data), np.dtype(layout))


def nearest(said, box):
    x, y = box[0] + box[2] / 2, box[1] + box[3] / 2
    return min(
        said, key=lambda one: abs(float(said[one]["x"]) - x) + abs(float(said[one]["y"]) - y)
    )


def test_the_node_says_what_the_session_says_without_ros(rig):
    frames = lanes(COUNT)
    rig.play(frames)
    for index, estimates in enumerate(offline(frames)):
        said = rig.said(index)
        confirmed = [one for one in estimates if one.identity]
        assert [number for number in said if number] == [one.identity for one in confirmed]
        for one in confirmed:
            values = said[one.identity]
            found = tuple(float(values[name]) for name in ("x", "y", "width", "height"))
            assert found == (*one.position, one.box.width, one.box.height)
            assert values["mode"] == one.mode.value
            assert float(values["confidence"]) == one.confidence


def test_tracks_have_a_point_for_each_vehicle(rig):
    frames = lanes(COUNT)
    rig.play(frames)
    rig.bench.wait_for(lambda: len(rig.tracks) == COUNT)
    cloud, estimates = rig.tracks[-1], offline(frames)[-1]
    names = ["id", "x", "y", "width", "height", "vx", "vy", "mode", "confidence"]
    assert [field.name for field in cloud.fields] == names
    assert (cloud.header, cloud.height, cloud.is_dense) == (header(COUNT - 1), 1, True)
    found = points(cloud)
    assert len(found) == cloud.width == len(estimates) >= 2
    for point, one in zip(found, estimates, strict=True):
        assert (point["id"], point["mode"]) == (one.identity, MODE_CODES[one.mode])
        assert point["x"] == np.float32(one.position[0])
        assert point["height"] == np.float32(one.box.height)
        assert point["vx"] == pytest.approx(one.velocity[0] / (PERIOD_NS * 1e-9), rel=1e-5)
    assert MODE_CODES == {
        TrackMode.TENTATIVE: 0, TrackMode.TRACKING: 1, TrackMode.OCCLUDED: 2, TrackMode.LOST: 3,
    }  # fmt: skip


def test_without_a_selection_each_image_has_a_summary(rig):
    answer = rig.play(lanes(COUNT))[-1]
    assert answer.status[0].message == "WAITING"
    values = values_of(answer)
    assert values["reason"] == "none is selected"
    assert int(values["vehicles"]) == len(rig.said(COUNT - 1))
    assert int(values["vehicles TRACKING"]) >= 2
    assert int(values["dropped for a bad state"]) == 0
    told = diagnostics_of(rig.bench, "traffic_tracker", lambda table: table["images"] == str(COUNT))
    assert int(told["detections of the last image"]) > 0
    assert float(told["detector's latency (ms)"]) > 0
    assert float(told["places with false alarms"]) >= 0
    # Each drives on a lane of its own, and ten boxes have told their size.
    assert told["blobs of the last image that may hold several"] == "0"
    assert told["vehicles in them without a number"] == "0.0"


def test_markers_and_overlay_show_every_vehicle(rig):
    markers = rig.bench.collect(MarkerArray, f"{NODE}/markers", 50)
    pictures = rig.bench.collect(Image, f"{NODE}/overlay", BEST_EFFORT)
    frames = lanes(COUNT)
    rig.play(frames)
    said = rig.said(COUNT - 1)
    rig.bench.wait_for(lambda: len(markers) == COUNT)
    first, *others = markers[-1].markers
    assert first.action == Marker.DELETEALL
    assert {(one.ns, one.id) for one in others} == {
        (name, number) for name in ("box", "number") for number in said
    }
    assert all(len(one.points) == 5 for one in others if one.ns == "box")
    found = rig.bench.wait_for(
        lambda: next((one for one in pictures if one.header == header(COUNT - 1)), None)
    )
    assert bytes(found.data) != frames[-1].tobytes()


@pytest.mark.parametrize("by", ["number", "click"])
def test_the_selected_vehicle_is_reported_like_a_single_one(rig, by):
    frames = lanes(COUNT)
    rig.play(frames[:-1])
    number = nearest(rig.said(COUNT - 2), boxes(COUNT - 2)[1])
    if by == "number":
        chooser = rig.bench.publisher(Int64, f"{NODE}/select")
        chooser.publish(Int64(data=number))
    else:
        x, y, width, height = boxes(COUNT - 2)[1]
        click = PointStamped()
        click.point.x, click.point.y = x + width / 2 + 3.0, y + height / 2 - 2.0
        rig.bench.publisher(PointStamped, f"{NODE}/clicked_point").publish(click)
    rig.bench.wait_for(lambda: rig.vehicles.selection.identity == number)
    positions = rig.bench.collect(PointStamped, f"{NODE}/position")
    outlines = rig.bench.collect(PolygonStamped, f"{NODE}/box")
    velocities = rig.bench.collect(Vector3Stamped, f"{NODE}/velocity")
    answer = rig.show_frame(frames[-1], COUNT - 1)
    values = rig.said(COUNT - 1)[number]
    rig.bench.wait_for(lambda: positions and outlines and velocities)
    assert answer.status[0].message == "TRACKING"
    assert values_of(answer)["id"] == str(number)
    assert values_of(answer)["x"] == values["x"]
    assert (positions[0].header, repr(positions[0].point.x)) == (header(COUNT - 1), values["x"])
    assert len(outlines[0].polygon.points) == 4
    seconds = PERIOD_NS * 1e-9
    assert velocities[0].vector.x == pytest.approx(float(values["velocity_x"]) / seconds)


def test_a_selection_that_cannot_be_is_refused_and_the_old_one_stays(bench, monkeypatch):
    said = hear_notices(monkeypatch)
    rig = TrafficRig(bench)
    rig.play(lanes(COUNT))
    number = next(iter(rig.said(COUNT - 1)))
    chooser = rig.bench.publisher(Int64, f"{NODE}/select")
    chooser.publish(Int64(data=number))
    rig.bench.wait_for(lambda: rig.vehicles.selection.identity == number)
    clicks = rig.bench.publisher(PointStamped, f"{NODE}/clicked_point")
    elsewhere = PointStamped()
    elsewhere.header.frame_id = "map"
    bad = PointStamped()
    bad.point.x = float("nan")
    refused = rig.node.diagnostics.health.refusals
    for count, (publisher, message) in enumerate(
        [
            (chooser, Int64(data=-1)),
            (chooser, Int64(data=2**62)),
            (clicks, elsewhere),
            (clicks, bad),
            (clicks, PointStamped()),
        ],
        start=1,
    ):
        publisher.publish(message)
        rig.bench.wait_for(lambda: refused.count == count)  # noqa: B023
    assert rig.vehicles.selection.identity == number
    assert len(said) == 1
    assert said[0].startswith("selection refused: no vehicle has the number -1; there are ")
    chooser.publish(Int64(data=0))
    rig.bench.wait_for(lambda: rig.vehicles.selection.identity == 0)


def test_targets_given_by_hand_are_followed_without_a_detector(bench):
    rig = TrafficRig(bench, overrides(detector__kind="none"))
    frames = lanes(COUNT)
    rig.play(frames[: WARM_UP + 8])
    assert rig.said(WARM_UP + 7) == {}
    targets = bench.publisher(RegionOfInterest, f"{NODE}/add_target")
    for count, (x, y, width, height) in enumerate(boxes(WARM_UP + 7), start=1):
        targets.publish(RegionOfInterest(x_offset=x, y_offset=y, width=width, height=height))
        bench.wait_for(lambda: rig.vehicles.session.tracker.last_identity == count)  # noqa: B023
    targets.publish(RegionOfInterest(x_offset=5000, y_offset=0, width=20, height=20))
    bench.wait_for(lambda: rig.node.diagnostics.health.refusals.count == 1)
    rig.play(frames[WARM_UP + 8 :], WARM_UP + 8)
    end = rig.said(COUNT - 1)
    assert list(end) == [1, 2]
    for number, box in zip((1, 2), boxes(COUNT - 1), strict=True):
        assert float(end[number]["x"]) == pytest.approx(box[0] + box[2] / 2, abs=box[2] / 3)


def test_a_target_before_the_first_image_waits_for_it(bench):
    rig = TrafficRig(bench, overrides(detector__kind="none"))
    targets = bench.publisher(RegionOfInterest, f"{NODE}/add_target")
    targets.publish(RegionOfInterest(x_offset=20, y_offset=30, width=28, height=18))
    bench.wait_for(lambda: len(rig.vehicles.waiting) == 1)
    frames = lanes(WARM_UP + 12)[WARM_UP + 10 :]
    rig.play(frames)
    assert list(rig.said(1)) == [1]


def test_a_flood_of_targets_is_refused(bench):
    rig = TrafficRig(bench, overrides(detector__kind="none"))
    vehicles, box = rig.vehicles, Box(20, 30, 28, 18)
    for _ in range(2):  # before the first image, and after it
        for _ in range(100):
            vehicles.add(box)
        with pytest.raises(InputError, match="100 targets came without an image between them"):
            vehicles.add(box)
        rig.play(lanes(1), len(rig.modes))
    rig.play(lanes(1), 2)
    assert list(rig.said(2)) == list(range(1, 201))


def test_the_configured_target_is_selected(bench):
    x, y, width, height = map(float, boxes(WARM_UP + 10)[0])
    target = overrides(target__x=x, target__y=y, target__width=width, target__height=height)
    rig = TrafficRig(bench, [*target, *overrides(detector__kind="none")])
    frames = lanes(COUNT)[WARM_UP + 10 :]
    answers = rig.play(frames)
    messages = [one.status[0].message for one in answers]
    assert messages == ["WAITING"] + ["TRACKING"] * (len(frames) - 1)
    assert values_of(answers[0])["reason"] == "vehicle 1 is followed from the next image on"
    assert {values_of(one)["id"] for one in answers[1:]} == {"1"}
    request = Trigger.Request()
    assert rig.bench.call(Trigger, f"{NODE}/reset", request).success
    again = rig.play(frames)  # stamps go back, which a reset allows
    assert [one.status[0].message for one in again] == messages
    assert {values_of(one)["id"] for one in again[1:]} == {"2"}


def test_the_selected_vehicle_can_be_removed(rig):
    request = Trigger.Request()
    answer = rig.bench.call(Trigger, f"{NODE}/remove_selected", request)
    assert (answer.success, answer.message) == (False, "no vehicle is selected")
    frames = lanes(COUNT)
    rig.play(frames[:-1])
    number = nearest(rig.said(COUNT - 2), boxes(COUNT - 2)[0])
    rig.bench.publisher(Int64, f"{NODE}/select").publish(Int64(data=number))
    rig.bench.wait_for(lambda: rig.vehicles.selection.identity == number)
    answer = rig.bench.call(Trigger, f"{NODE}/remove_selected", request)
    assert (answer.success, answer.message) == (True, f"vehicle {number} is forgotten")
    assert values_of(rig.show_frame(frames[-1], COUNT - 1))["reason"] == "none is selected"
    assert number not in rig.said(COUNT - 1)


def test_a_stream_that_begins_again_forgets_vehicles_but_uses_no_number_twice(rig):
    frames = lanes(COUNT)
    rig.play(frames)
    before = set(rig.said(COUNT - 1))
    assert rig.show_frame(frames[0], 0).status[0].message == "REJECTED"
    rig.statuses.clear()
    answers = rig.play(frames[1:], 1)
    assert "time jumped back" in values_of(answers[0])["event"]
    after = set(rig.said(COUNT - 1))
    assert len(after) >= 2
    assert not before & after


def test_a_target_set_by_parameters_is_followed_and_selected(rig):
    frames = lanes(COUNT)
    rig.play(frames[: WARM_UP + 8])
    x, y, width, height = map(float, boxes(WARM_UP + 8)[0])
    wrong = rig.node.set_parameters_atomically(
        overrides(target__x=5000.0, target__y=0.0, target__width=20.0, target__height=10.0)
    )
    assert not wrong.successful
    assert "outside the image of 160x120 px" in wrong.reason
    target = overrides(target__x=x, target__y=y, target__width=width, target__height=height)
    assert rig.node.set_parameters_atomically(target).successful
    answers = rig.play(frames[WARM_UP + 8 :], WARM_UP + 8)
    assert [one.status[0].message for one in answers[:2]] == ["WAITING", "TRACKING"]
    assert rig.vehicles.selection.identity == int(values_of(answers[1])["id"])


def test_a_road_gives_counts_in_kmh_and_may_change_without_losing_them(bench, tmp_path):
    path = tmp_path / "lines.yaml"
    path.write_text("lines: {middle: {from: [80, 0], to: [80, 120]}}\n")
    pairs = "0,0=0,0; 160,0=16,0; 160,120=16,12; 0,120=0,12"
    rig = TrafficRig(bench, overrides(lines=str(path), road__pairs=pairs))
    counts = bench.collect(DiagnosticArray, f"{NODE}/counts", 200)
    count = WARM_UP + 45
    rig.play(lanes(count))
    bench.wait_for(lambda: len(counts) == count)
    values = {pair.key: pair.value for pair in counts[-1].status[0].values}
    speed = float(values["last speed (px/s)"]) / 10 * 3.6  # 10 px are a metre
    assert float(values["last speed (km/h)"]) == pytest.approx(speed, rel=0.01)
    totals = dict(rig.vehicles.counter.totals)
    before = rig.vehicles.counter.plane
    assert rig.node.set_parameters_atomically(overrides(road__margin=1.0)).successful
    assert rig.vehicles.counter.plane is not before
    assert dict(rig.vehicles.counter.totals) == totals


def test_a_page_shows_picture_and_counts_until_the_node_is_cleaned_up(
    bench, tmp_path, monkeypatch, capfd
):
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    rig, answers = TrafficRig(bench, overrides(page_port=0)), []
    url, get = rig.node.outputs.page.url, build_opener(ProxyHandler({})).open
    waits = when_one_waits(monkeypatch)

    def ask():
        answers.append(get(f"{url}picture.jpg").read())

    asking = threading.Thread(target=ask)
    asking.start()
    assert waits.wait(30)
    rig.play(lanes(3))
    asking.join()
    assert answers[0].startswith(b"\xff\xd8")
    assert b'"vehicles"' in get(f"{url}counts.json").read()
    # Its address is for the user alone: not in the log, which others read, nor on /rosout.
    assert url not in capfd.readouterr().err
    (file,) = tmp_path.glob("**/*.url")
    assert file.read_text().strip() == url and file.stat().st_mode & 0o777 == 0o600
    rig.node.cleanup()
    with pytest.raises(URLError):
        get(url)


def test_pixels_may_have_a_frame_of_their_own(bench):
    rig = TrafficRig(bench, overrides(output_frame_suffix="_px"))
    markers = bench.collect(MarkerArray, f"{NODE}/markers", 50)
    rig.play(lanes(2))
    bench.wait_for(lambda: len(rig.tracks) == len(markers) == 2)
    assert rig.tracks[0].header.frame_id == "camera_px"
    assert markers[0].markers[0].header.frame_id == "camera_px"
    assert rig.modes[0].header.frame_id == rig.statuses[0].header.frame_id == "camera"


def test_every_parameter_of_its_tables_is_declared(rig):
    for name, spec in Configuration.of(TRAFFIC_VARIANT).specs().items():
        if name == "queue_depth":  # the rig's
            continue
        found = rig.node.get_parameter(name).value
        assert (found, type(found)) == (spec.default, spec.kind), name


def test_lines_are_counted(bench, tmp_path):
    path = tmp_path / "lines.yaml"
    path.write_text(
        "lines:\n  middle: {from: [80, 0], to: [80, 120], directions: [left, right]}\n"
        "zones:\n  all: [[0, 0], [159, 0], [159, 119], [0, 119]]\n"
    )
    rig = TrafficRig(bench, overrides(lines=str(path)))
    counts = bench.collect(DiagnosticArray, f"{NODE}/counts", 200)
    count = WARM_UP + 45
    frames = lanes(count)
    rig.play(frames)
    bench.wait_for(lambda: len(counts) == count)
    expected, crossings, inside = Counter(read_counting_plan(path)), [], []
    for index, estimates in enumerate(offline(frames)):
        crossings += expected.update(estimates, 10**9 + index * PERIOD_NS)
        inside.append(expected.occupancy["all"])
    line, zone = counts[-1].status
    left, right = (expected.count("middle", way) for way in ("left", "right"))
    assert min(left, right) >= 1
    assert (line.name, line.message) == ("traffic_tracker: middle", f"left {left}, right {right}")
    values = {pair.key: pair.value for pair in line.values}
    assert (values["left"], values["right"]) == (str(left), str(right))
    last = [one for one in crossings if one.place == "middle"][-1]
    assert (values["last id"], values["last direction"]) == (str(last.identity), last.direction)
    assert values["last speed (px/s)"] == repr(last.speed_px)
    assert zone.name == "traffic_tracker: all"
    assert [int(one.status[1].message.partition(" ")[0]) for one in counts] == inside
    assert max(inside) >= 2
    bench.call(Trigger, f"{NODE}/reset", Trigger.Request())
    rig.show_frame(lanes(1)[0], count)
    bench.wait_for(lambda: len(counts) == count + 1)
    assert counts[-1].status[0].message == "left 0, right 0"


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"lines": "/nowhere.yaml"}, "/nowhere.yaml"),
        ({"detector__kind": "model"}, "detector.model names no .onnx file"),
        ({"road__from_tf": True, "road__intrinsics": "1,1,1,1"}, "are for nodes of one"),
        ({"num_particles": 1}, "num_particles must be from 10 to 10000"),
    ],
)
def test_a_users_mistake_is_one_sentence(bench, values, sentence):
    with pytest.raises(InputError, match=sentence):
        TrafficRig(bench, overrides(**values))


def test_the_node_can_be_deactivated_and_cleaned_up(rig):
    frames = lanes(3)
    rig.play(frames)
    for transition in (
        Transition.TRANSITION_DEACTIVATE,
        Transition.TRANSITION_CLEANUP,
        Transition.TRANSITION_CONFIGURE,
        Transition.TRANSITION_ACTIVATE,
    ):
        request = ChangeState.Request(transition=Transition(id=transition))
        assert rig.bench.call(ChangeState, f"{NODE}/change_state", request).success
    rig.bench.wait_until_matched(rig.camera)
    rig.bench.wait_for(lambda: rig.node.count_subscribers(f"{NODE}/mode") == 1)
    rig.bench.publish_until(
        lambda: len(rig.modes) > 3, rig.camera, image_message(header(3), frames[0])
    )


@pytest.mark.skipif(find_spec("vision_msgs") is not None, reason="vision_msgs is installed")
def test_a_detector_on_a_topic_needs_vision_msgs(bench):
    with pytest.raises(InputError, match="vision_msgs, which detections come in, is not installed"):
        TrafficRig(bench, overrides(detector__kind="topic"))
