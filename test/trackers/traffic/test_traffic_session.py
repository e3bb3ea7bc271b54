# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Elapsed time, restarts and detections of a stream of many vehicles."""

from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import vehicle

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.detection.motion_detector import MotionDetector
from vehicle_pf_tracker.parameters.counting_plan import Region
from vehicle_pf_tracker.trackers.continuity import StrayImageError
from vehicle_pf_tracker.trackers.traffic.session import TrafficSession

PERIOD_NS = 40_000_000
FRAME = np.zeros((48, 64, 3), np.uint8)


class Steps:
    """Tracker that writes down what it is given."""

    def __init__(self):
        self.frame_period = 0.0
        self.elapsed, self.seen, self.resets = [], [], 0

    def step(self, frame, detections=None, elapsed=1.0):
        self.elapsed.append(elapsed)
        self.seen.append(detections)
        return (vehicle(len(self.elapsed), 30, 20),)

    def reset(self):
        self.resets += 1


class Eye:
    """Detector that writes down the tracks it is given."""

    made = 0

    def __init__(self):
        Eye.made += 1
        self.disturbed = self.is_blind = False
        self.tracks = []

    def detect(self, frame, tracks=(), period=0.0):
        self.tracks.append([one.identity for one in tracks])
        return Detections.make([[1, 2, 3, 4]])


def feed_all(session, stamps, frame=FRAME):
    for stamp in stamps:
        session.feed(frame, stamp)


def test_elapsed_is_in_nominal_periods():
    session = TrafficSession(Steps())
    regular = [k * PERIOD_NS for k in range(12)]
    feed_all(session, [*regular, regular[-1] + 3 * PERIOD_NS])
    assert session.tracker.elapsed == pytest.approx([1.0] * 12 + [3.0])
    assert session.tracker.frame_period == pytest.approx(0.04)


def test_the_detector_is_given_the_tracks_of_the_image_before():
    session = TrafficSession(Steps(), Eye)
    feed_all(session, [0, PERIOD_NS, 2 * PERIOD_NS])
    assert session.detector.tracks == [[], [1], [2]]
    assert [len(found) for found in session.tracker.seen] == [1, 1, 1]


def test_detections_from_outside_go_before_the_detector():
    session = TrafficSession(Steps(), Eye)
    session.feed(FRAME, 0, Detections.none())
    assert session.detector.tracks == []
    assert len(session.tracker.seen[0]) == 0
    assert TrafficSession(Steps()).detector is None


def test_what_a_blind_detector_does_not_see_is_not_missed():
    session = TrafficSession(Steps(), Eye)
    session.detector.is_blind = True
    session.feed(FRAME, 0)
    session.detector.disturbed = True
    session.feed(FRAME, PERIOD_NS)
    assert session.tracker.seen == [None, None]
    assert "the camera moves, or the light" in session.events[0]


def test_a_camera_that_moves_blinds_the_motion_detector_until_it_has_learnt():
    detector, rng = MotionDetector(), np.random.default_rng(0)
    still, other = rng.integers(0, 256, (2, 48, 64, 3), np.uint8)
    blind, disturbed = [], []
    for frame in [still] * 40 + [other] * 40:
        detector.detect(frame)
        blind.append(detector.is_blind)
        disturbed.append(detector.disturbed)
    learnt = blind.index(False)
    assert 0 < learnt < 39
    assert blind[learnt:] == [False] * (40 - learnt) + [True] * (learnt + 1) + [False] * (
        39 - learnt
    )
    assert [index for index, is_so in enumerate(disturbed) if is_so] == [40]


def test_a_reset_forgets_vehicles_size_and_time():
    session = TrafficSession(Steps(), Eye)
    feed_all(session, [10**12, 10**12 + PERIOD_NS])
    session.reset()
    assert (session.size, session.estimates, session.restarts) == (None, (), 1)
    session.feed(np.zeros((10, 20, 3), np.uint8), 0)
    assert (session.size, session.events) == ((20, 10), [])


def test_a_rate_may_be_set_meanwhile():
    session = TrafficSession(Steps())
    feed_all(session, [0, PERIOD_NS])
    session.reconfigure(frame_rate=50.0, reset_on_time_jump=True)
    session.feed(FRAME, 2 * PERIOD_NS)
    assert session.tracker.elapsed[-1] == pytest.approx(2.0)


def test_a_size_that_stays_begins_anew():
    session = TrafficSession(Steps(), Eye)
    feed_all(session, [0, PERIOD_NS])
    first, other = session.detector, np.zeros((10, 20, 3), np.uint8)
    with pytest.raises(StrayImageError):
        session.feed(other, 2 * PERIOD_NS)
    session.feed(other, 3 * PERIOD_NS)
    assert (session.tracker.resets, session.restarts) == (1, 1)
    assert session.detector is not first
    assert session.detector.tracks == [[], [3]]
    assert "20x10" in session.events[0]


def test_a_rejected_image_that_is_confirmed_is_tracked_in_with_its_own_detections():
    session = TrafficSession(Steps())
    feed_all(session, [0, PERIOD_NS])
    first, second = Detections.make([[1, 2, 3, 4]]), Detections.make([[2, 2, 3, 4]])
    other = np.zeros((10, 20, 3), np.uint8)
    with pytest.raises(StrayImageError):
        session.feed(other, 2 * PERIOD_NS, first)
    session.feed(other, 3 * PERIOD_NS, second)
    assert session.tracker.seen == [None, None, first, second]


@pytest.mark.parametrize(("resets", "expected"), [(True, 1), (False, 0)])
def test_time_that_goes_back_and_stays_there_begins_anew(resets, expected):
    session = TrafficSession(Steps(), reset_on_time_jump=resets)
    late = 10**12
    feed_all(session, [late, late + PERIOD_NS])
    with pytest.raises(StrayImageError):
        session.feed(FRAME, 0)
    session.feed(FRAME, PERIOD_NS)
    assert session.tracker.resets == expected
    assert "time jumped back" in session.events


def test_detections_count_in_inner_regions_and_in_no_outer_one():
    left, top, hole = (
        Region(tuple(map(tuple, corners)), is_inside)
        for corners, is_inside in (
            ([[0, 0], [20, 0], [20, 30], [0, 30]], True),
            ([[0, 0], [40, 0], [40, 10], [0, 10]], True),
            ([[0, 0], [10, 0], [10, 10], [0, 10]], False),
        )
    )
    # Centres: in `hole`, in `left`, in `top`, in none.
    boxes = np.array([[1, 1, 8, 8], [12, 18, 8, 8], [30, 1, 8, 8], [28, 18, 8, 8]], float)
    for regions, kept in (((left, top, hole), [1, 2]), ((hole,), [1, 2, 3]), ((top,), [0, 2])):
        session = TrafficSession(Steps(), regions=regions)
        session.feed(FRAME, 0, Detections.make(boxes))
        assert session.tracker.seen[-1].boxes.tolist() == boxes[kept].tolist()


def test_images_with_ambiguous_blobs_are_counted():
    session = TrafficSession(Steps(), frame_rate=25.0)
    for index, ambiguous in enumerate((0, 2, 1)):
        detections = replace(Detections.none(), are_shapes=True, ambiguous=ambiguous)
        session.feed(FRAME, index * PERIOD_NS, detections)
        assert session.ambiguous == ambiguous
    assert (session.detected.images, session.detected.ambiguous) == (3, 2)
    session.feed(FRAME, 3 * PERIOD_NS, Detections.none())
    assert session.ambiguous is None


def test_vehicles_in_joined_blobs_are_summed_where_sizes_are_known_and_within_regions():
    right = Region(((20, 0), (40, 0), (40, 30), (20, 30)), True)
    session = TrafficSession(Steps(), frame_rate=25.0, regions=(right,))
    assert session.detected.mean_unresolved is None
    # Centres at 8 and 28 px across: the first is outside the region.
    both = np.array([[0.0, 0, 16, 16, 3.5], [20, 0, 16, 16, 1.5]])
    for index, joined in enumerate((None, both, both[:0])):
        detections = replace(Detections.none(), are_shapes=True, joined=joined)
        session.feed(FRAME, index * PERIOD_NS, detections)
        expected = (None, 1.5, 0.0)[index]
        assert session.detected.latest_unresolved == expected
    assert (session.detected.sized, session.detected.mean_unresolved) == (2, 0.75)
