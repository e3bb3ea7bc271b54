# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""`/diagnostics`: what is counted, and why nothing arrives."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not installed")

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CompressedImage, Image
from tracker_rig import Rig, header, on_target, road

from vehicle_pf_tracker.ros.messages import image_message
from vehicle_pf_tracker.ros.node import diagnostics
from vehicle_pf_tracker.ros.node.health import Health

pytestmark = pytest.mark.ros


class Reports:
    def __init__(self, bench) -> None:
        self.bench = bench
        self.received = bench.collect(DiagnosticArray, "/diagnostics")

    def next(self, accept=lambda status: True):
        """The next report that `accept` takes."""
        seen = len(self.received)

        def found():
            return next((m.status[0] for m in self.received[seen:] if accept(m.status[0])), None)

        return self.bench.wait_for(found)


def table(status) -> dict[str, str]:
    return {item.key: item.value for item in status.values}


def test_a_report_tells_counts_rates_and_mode(bench):
    rig = Rig(bench, on_target(seed=5, kernels="opencv"))
    rig.play(road(5))
    rig.show(Image(header=header(5), encoding="rgb8"))
    status = Reports(bench).next()
    told = table(status)
    assert (status.level, status.message) == (b"\x02", "REJECTED")
    assert status.name == "apf_tracker: tracker"
    assert status.hardware_id == "/image"
    assert (told["images"], told["rejected"], told["dropped"]) == ("6", "1", "0")
    assert "no pixels" in told["last rejection"]
    assert told["matched publishers"] == "1"
    assert (told["mode"], told["variant"], told["seed"]) == ("REJECTED", "apf", "5")
    assert told["kernels"] == "opencv"
    assert float(told["step time (ms)"]) > 0
    assert float(told["age of frames (ms)"]) > 0


def answered(rig, index) -> bool:
    """Publish one image; a best-effort one may be lost on its way."""
    rig.camera.publish(image_message(header(index), road(1)[0]))
    try:
        return rig.bench.wait_for(lambda: rig.modes[-1].header == header(index), 5.0)
    except AssertionError:
        return False


def test_images_that_were_overwritten_are_counted(bench):
    rig = Rig(bench, on_target())
    rig.play(road(1))
    rig.bench.executor.remove_node(rig.node)  # a node that is too busy to take its images
    for index in range(1, 61):
        rig.camera.publish(image_message(header(index), road(1)[0]))
    rig.bench.executor.add_node(rig.node)
    bench.wait_for(lambda: len(rig.modes) > 1)
    last = next(index for index in range(61, 70) if answered(rig, index))
    told = table(Reports(bench).next())
    assert int(told["images"]) + int(told["dropped"]) == last + 1
    assert int(told["dropped"]) >= 10


def test_a_quiet_topic_is_named_with_its_publishers_qos(bench, monkeypatch):
    monkeypatch.setattr(diagnostics, "SILENCE", 0.5)
    Rig(bench)
    status = Reports(bench).next(lambda status: status.level == b"\x01")
    assert "no image for 0.5 s on /image: /tester (reliable, volatile) fits" in status.message


def silent_node(bench, monkeypatch, **options):
    monkeypatch.setattr(diagnostics, "SILENCE", 0.5)
    rig = Rig(bench, **options)
    bench.node.destroy_publisher(rig.camera)
    bench.wait_for(lambda: rig.node.count_publishers("/image") == 0)
    return rig


def warning(bench, words: str) -> str:
    return Reports(bench).next(lambda status: words in status.message).message


@pytest.mark.parametrize(
    ("kind", "topic", "mark", "words"),
    [
        (None, "", "nobody", "no image for 0.5 s on /image: nobody publishes on it"),
        (
            CompressedImage, "image", "CompressedImage",
            "publishes sensor_msgs/msg/CompressedImage, not sensor_msgs/msg/Image",
        ),
        (CompressedImage, "image/compressed", "compressed", "set image_transport to compressed"),
        (
            Image, "/camera/image_raw", "remap",
            "images are on /camera/image_raw: remap image to one of them",
        ),
    ],
)  # fmt: skip
def test_where_images_are_instead_is_named(
    bench, other_bench, monkeypatch, kind, topic, mark, words
):
    silent_node(bench, monkeypatch)
    if kind is not None:
        other_bench.node.create_publisher(kind, topic, 1)
    found = warning(bench, mark)
    assert words in found
    assert "overlay" not in found


def test_overlays_of_tracker_nodes_are_not_proposed(bench, other_bench, monkeypatch):
    silent_node(bench, monkeypatch)
    other_bench.node.create_publisher(Image, "/left/pf_tracker/overlay", 1)
    other_bench.node.create_publisher(Image, "/front/camera", 1)
    words = warning(bench, "/front/camera")
    assert words.endswith("images are on /front/camera: remap image to one of them")


def test_qos_that_does_not_fit_is_named(bench, monkeypatch):
    silent_node(
        bench,
        monkeypatch,
        parameters=on_target(**{"qos_overrides./image.subscription.reliability": "reliable"}),
    )
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    bench.node.create_publisher(Image, "image", best_effort)
    words = warning(bench, "does not fit")
    assert "/tester (best_effort, volatile) does not fit this node's QoS" in words
    assert "reliable" in words.lower()


def test_an_inactive_node_is_not_blamed(bench):
    rig = Rig(bench)
    rig.node.trigger_deactivate()
    status = Reports(bench).next(lambda status: status.message == "not active")
    assert status.level == b"\x00"


# The counters by hand, on a clock of our own.


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


def numbered(number) -> dict[str, object]:
    return {"publication_sequence_number": number}


@pytest.mark.parametrize(
    ("numbers", "publishers", "dropped"),
    [
        ([7, 8, 11, 12], 1, 2),  # what came before the first is not known
        ([900, 1, 2], 1, 0),
        ([1, 500, 2, 501], 2, 0),
        ([None, 5, None], 1, 0),
    ],
    ids=["gaps", "a restarted publisher", "two publishers", "missing numbers"],
)
def test_gaps_in_the_numbers_of_one_publisher_are_dropped_images(numbers, publishers, dropped):
    health = Health(Clock())
    for number in numbers:
        health.arrivals.add(numbered(number), 0.0, lambda: publishers)
    assert (health.arrivals.images, health.arrivals.dropped) == (len(numbers), dropped)


def test_images_missed_while_not_listening_are_not_dropped():
    health = Health(Clock())
    health.arrivals.add(numbered(1), 0.0, lambda: 1)
    health.arrivals.listen()
    health.arrivals.add(numbered(50), 0.0, lambda: 1)
    assert health.arrivals.dropped == 0


def test_rates_are_those_since_the_last_report():
    clock = Clock()
    health = Health(clock)
    for number in range(1, 11):
        health.arrivals.add(numbered(number), 0.25, lambda: 1)
    clock.now += 2.0
    health.answered("TRACKING", 1.25)
    clock.now += 2.0
    told = health.report()
    assert told["input rate (Hz)"] == 2.5
    assert told["time in mode (s)"] == 2.0
    assert told["age of frames (ms)"] == 250.0
    assert told["time since last image (s)"] == 4.0
    clock.now += 1.0
    assert health.report()["input rate (Hz)"] == 0.0
