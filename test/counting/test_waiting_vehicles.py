# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles that wait on a counting line or at a zone's edge count once, in the way they drive."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from traffic_samples import vehicle

from vehicle_pf_tracker import TrafficTracker
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.parameters.counting_plan import (
    CountingLine,
    CountingPlan,
    CountingZone,
    read_counting_plan,
)
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

WIDTH, HEIGHT = 40.0, 24.0  # of the vehicle, px
ALONG = 300.0  # row of its lower edge


@dataclass(frozen=True)
class Drive:
    """A drive from the left to the right that stops for a while, as a poor detector sees it."""

    rate: float
    noise: float
    missing: float
    stop_at: float
    seconds: float
    speed: float
    seed: int

    def path(self, before=250.0, after=330.0):
        """Middle of the lower edge, image by image, px: it brakes and starts at 150 px/s²."""
        at, way = -before, []
        while self.stop_at - at > 0.5:
            way.append(at)
            speed = min(self.speed, math.sqrt(300 * (self.stop_at - at)))
            at = min(self.stop_at, at + max(speed / self.rate, 0.3))
        way += [self.stop_at] * round(self.seconds * self.rate)
        speed = 0.0
        while at < after:
            speed = min(self.speed, speed + 150 / self.rate)
            at += speed / self.rate
            way.append(at)
        return way

    def boxes(self):
        """Left, top, width and height of each image's detection; None where it is missing."""
        rng = np.random.default_rng(self.seed)
        for x in self.path():
            size = np.array([WIDTH, HEIGHT, WIDTH, HEIGHT])
            true = np.array([x - WIDTH / 2, ALONG - HEIGHT, WIDTH, HEIGHT])
            box = true + self.noise * size * rng.normal(0, 1, 4)
            yield None if rng.random() < self.missing else [*box[:2], *np.maximum(box[2:], 3.0)]

    def is_seen_beside(self, reach):
        """Tell whether it is detected more than `reach` px before and behind the middle.

        At two images a second of which half are missing it may not be, and then nothing says that
        it has crossed anything.
        """
        seen = [x for x, box in zip(self.path(), self.boxes(), strict=True) if box is not None]
        return bool(seen) and seen[0] < -reach and seen[-1] > reach


def drives(most_noise=0.25, slowest=2.0):
    return st.builds(
        Drive,
        rate=st.floats(slowest, 60.0),
        noise=st.floats(0.0, most_noise),
        missing=st.floats(0.0, 0.5),
        stop_at=st.floats(-40.0, 40.0),
        seconds=st.floats(1.0, 8.0),
        speed=st.floats(60.0, 300.0),
        seed=st.integers(0, 10**6),
    )


def crossings(plan, drive):
    """Feed a drive as estimates; an image without a detection has the box before."""
    counter, estimate, found = Counter(plan), None, []
    for index, box in enumerate(drive.boxes()):
        if box is not None:
            left, top, width, height = box
            point = left + width / 2, top + height
            estimate = vehicle(1, *point, size=(width, height))
        elif estimate is not None:
            estimate = vehicle(
                1, *point, TrackMode.OCCLUDED, size=(estimate.box.width, estimate.box.height)
            )
        estimates = [] if estimate is None else [estimate]
        found += counter.update(estimates, 10**9 + round(index * 1e9 / drive.rate))
    return [one.direction for one in found]


def line(angle=math.pi / 2, at=0.0, name="line"):
    """A long line through (at, ALONG) at an angle to the drive, "back" and "on"."""
    along = 2000 * math.cos(angle), 2000 * math.sin(angle)
    begin, end = (at - along[0], ALONG - along[1]), (at + along[0], ALONG + along[1])
    return CountingLine(name, begin, end, ("back", "on"))


@settings(max_examples=30)
@given(drive=drives(), angle=st.floats(0.35, math.pi - 0.35))
def test_a_stop_anywhere_is_one_crossing_in_the_way_it_drove(drive, angle):
    assume(drive.is_seen_beside(WIDTH / math.sin(angle)))
    assert crossings(CountingPlan(lines=(line(angle),)), drive) == ["on"]


@settings(max_examples=20)
@given(drive=drives())
def test_lines_close_together_count_once_each(drive):
    assume(drive.is_seen_beside(3 + WIDTH))
    plan = CountingPlan(lines=(line(at=-3, name="a"), line(at=0, name="b"), line(at=3, name="c")))
    assert crossings(plan, drive) == ["on", "on", "on"]


@settings(max_examples=20)
@given(drive=drives(slowest=5.0))
def test_a_stop_at_either_edge_of_a_zone_enters_and_leaves_once(drive):
    # Rarer images than five a second see too little of a drive away to be sure of it within 8 m.
    for left in (0.0, -100.0):
        corners = ((left, 0.0), (left + 100, 0.0), (left + 100, 600.0), (left, 600.0))
        plan = CountingPlan(zones=(CountingZone("zone", corners),))
        assert crossings(plan, drive) == ["entry", "exit"]


@settings(max_examples=20)
@given(rate=st.floats(2.0, 60.0), speed=st.floats(100.0, 600.0), left=st.floats(-20.0, 20.0))
def test_a_zone_smaller_than_a_vehicle_is_passed_also_between_two_images(rate, speed, left):
    zone = CountingZone(
        "z", tuple((left + x, ALONG + y) for x, y in [(0, -8), (9, -8), (9, 8), (0, 8)])
    )
    counter = Counter(CountingPlan(zones=(zone,)))
    found = []
    for index in range(math.ceil(800 / speed * rate) + 1):
        estimate = vehicle(1, -400 + index * speed / rate, ALONG, size=(WIDTH, HEIGHT))
        found += counter.update([estimate], round(index * 1e9 / rate))
    assert [one.direction for one in found] == ["entry", "exit"]
    assert found[0].stamp_ns < found[1].stamp_ns


def turning(rate, deepest):
    """Drive over the line, turn where it is `deepest` px behind it, and drive back."""
    there = np.arange(-200, deepest, 120 / rate)
    return [*there, *there[::-1]]


@pytest.mark.parametrize("rate", [2, 5, 12, 30, 60])
@pytest.mark.parametrize("noise", [0.0, 0.03, 0.08])
def test_a_u_turn_counts_both_ways(rate, noise):
    rng = np.random.default_rng(3)
    counter, found = Counter(CountingPlan(lines=(line(),))), []
    for index, x in enumerate(turning(rate, 120)):
        dx, dy = noise * rng.normal(0, 1, 2) * (WIDTH, HEIGHT)
        estimate = vehicle(1, x + dx, ALONG + dy, size=(WIDTH, HEIGHT))
        found += counter.update([estimate], round(index * 1e9 / rate))
    assert [one.direction for one in found] == ["on", "back"]


@pytest.mark.parametrize("rate", [2, 10, 30])
@pytest.mark.parametrize(("way", "expected"), [(1, "on"), (-1, "back")])
def test_a_vehicle_that_begins_on_the_line_never_counts_the_other_way(rate, way, expected):
    for seed in range(12):
        rng = np.random.default_rng(seed)
        counter, found = Counter(CountingPlan(lines=(line(),))), []
        drive = [*[0.0] * (6 * rate), *way * np.arange(0, 200, 100 / rate)]
        for index, x in enumerate(drive):
            dx, dy = 0.15 * rng.normal(0, 1, 2) * (WIDTH, HEIGHT)
            estimate = vehicle(1, x + dx, ALONG + dy, size=(WIDTH, HEIGHT))
            found += counter.update([estimate], round(index * 1e9 / rate))
        assert [one.direction for one in found] in ([], [expected])


def test_presence_in_a_zone_does_not_flicker_at_its_edge():
    zone = CountingZone("z", ((0, 0), (400, 0), (400, 600), (0, 600)))
    counter, there = Counter(CountingPlan(zones=(zone,))), []
    drive = Drive(25.0, 0.2, 0.0, 0.0, 8.0, 150.0, 7)
    for index, box in enumerate(drive.boxes()):
        left, top, width, height = box
        estimate = vehicle(1, left + width / 2, top + height, size=(width, height))
        counter.update([estimate], round(index * 1e9 / drive.rate))
        there.append(counter.occupancy["z"])
    assert (there[0], there[-1]) == (0, 1)
    assert np.abs(np.diff(there)).sum() == 1


# Through the tracker. What the counter is given is one track only where the tracker keeps one, so
# that the noise here is a detector's, and not the quarter of a box above.
ROAD = np.full((120, 480, 3), 110, np.uint8)
ROAD += cv2.resize(np.random.default_rng(1).integers(0, 40, (15, 60, 3), np.uint8), (480, 120))
CAR = np.random.default_rng(2).integers(0, 255, (24, 40, 3), np.uint8)
PLAN = """
lines: {stop: {from: [240, 5], to: [240, 115], directions: [back, onwards]}}
zones: {queue: [[240, 0], [700, 0], [700, 120], [240, 120]]}
"""


def images(drive):
    """Images of a road of 480 x 120 px with the vehicle, and its detection, (0 or 1, 4)."""
    for x, box in zip(drive.path(), drive.boxes(), strict=True):
        left = round(x + 240 - WIDTH / 2)
        if not 0 <= left + WIDTH / 2 <= 470:
            continue
        image = ROAD.copy()
        begin, end = max(left, 0), min(left + 40, 480)
        image[60:84, begin:end] = CAR[:, begin - left : end - left]
        moved = [] if box is None else [[box[0] + 240, box[1] - ALONG + 84, *box[2:]]]
        yield image, np.array(moved).reshape(-1, 4)


DETECTED = [
    Drive(rate, noise, missing, stop_at, 6.0, 100.0, seed)
    for seed, (rate, noise, missing, stop_at) in enumerate(
        [
            (25, 0.05, 0, 0),
            (25, 0.05, 0.3, 0),
            (10, 0.05, 0.2, 1),
            (60, 0.04, 0.5, -1),
            (6, 0.03, 0, 2),
        ]
    )
]


@pytest.mark.parametrize("drive", DETECTED)
def test_through_the_python_tracker(drive, tmp_path):
    (tmp_path / "lines.yaml").write_text(PLAN)
    tracker, found = TrafficTracker(drive.rate, lines=tmp_path / "lines.yaml"), []
    for image, boxes in images(drive):
        tracker.update(image, boxes, [0.9] * len(boxes))
        found += [one for one in tracker.crossings if not one.doubt]
    assert sorted((one.place, one.direction) for one in found) == [
        ("queue", "entry"),
        ("stop", "onwards"),
    ]


@pytest.mark.parametrize("drive", DETECTED[:2])
def test_through_a_session(drive, tmp_path):
    (tmp_path / "lines.yaml").write_text(PLAN)
    session = TrafficSession(MultiVehicleTracker(TrafficParameters()), frame_rate=drive.rate)
    counter = Counter(read_counting_plan(tmp_path / "lines.yaml"))
    for index, (image, boxes) in enumerate(images(drive)):
        stamp_ns = 10**18 + round(index * 1e9 / drive.rate)
        session.feed(image, stamp_ns, Detections.make(boxes, [0.9] * len(boxes)))
        counter.update(session.estimates, stamp_ns)
    assert (counter.count("stop", "onwards"), counter.count("stop", "back")) == (1, 0)
    assert (counter.count("queue", "entry"), counter.count("queue", "exit")) == (1, 0)
