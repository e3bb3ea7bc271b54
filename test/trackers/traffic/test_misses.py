# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence against vehicles that a detector misses."""

import numpy as np
import pytest
from traffic_samples import changed, step_of, together, track

from vehicle_pf_tracker.detection.detections import Detections
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode
from vehicle_pf_tracker.trackers.traffic.misses import count_misses
from vehicle_pf_tracker.trackers.traffic.state import Experience, State
from vehicle_pf_tracker.trackers.traffic.tracker import MultiVehicleTracker

SIZE = (320, 240)
STEP = step_of(SIZE)


def missed(undetected, *, seen=()):
    """Evidence that confirmed vehicles in sight lose in a frame, undetected for so long."""
    tracks = together(
        *(
            track(
                identity,
                60.0 * identity,
                confirmed=True,
                log_odds=5.0,
                undetected=0.0 if identity in seen else periods,
            )
            for identity, periods in enumerate(undetected, start=1)
        )
    )
    state = count_misses(State(tracks, Experience()), STEP)
    return (5.0 - state.tracks.beliefs.log_odds).tolist()


def test_a_vehicle_that_alone_is_missed_is_doubted():
    assert missed([3.0])[0] > 0
    lost = missed([3.0, 3.0], seen=(2,))
    assert lost[0] > 0
    assert lost[1] == 0


def test_a_detector_that_misses_all_vehicles_at_once_has_failed():
    assert missed([3.0, 3.0]) == [0, 0]


def test_vehicles_that_were_missed_one_after_the_other_do_not_excuse_each_other():
    assert min(missed([3.0, 5.0])) > 0


def test_vehicles_that_no_detector_sees_for_long_are_doubted_all():
    assert min(missed([200.0, 200.0])) > 0


@pytest.mark.parametrize(
    ("rate", "every", "price"),
    [
        (30.0, 1, 0.3),
        (24.0, 1, 0.3),
        (12.0, 1, 0.6),
        (30.0, 3, 0.72),
        # A detector of which nothing is known finds one in two.
        (3.0, 1, -np.log(0.5)),
    ],
)
def test_a_miss_counts_by_the_time_that_it_stands_for_until_it_is_independent(rate, every, price):
    one = track(1, 100.0, confirmed=True, log_odds=5.0, undetected=every * 2.0, searched=1)
    step = step_of(SIZE, period=1 / rate)
    state = count_misses(State(one, Experience()), step)
    lost = 5.0 - float(state.tracks.beliefs.log_odds[0])
    assert lost == pytest.approx(min(price, -np.log(0.5)), rel=0.01)


def test_a_detector_that_finds_one_vehicle_in_three_is_known_to():
    experience = Experience()
    one, other = track(1, 100.0, confirmed=True, has_driven=True), track(2, 200.0, confirmed=True)
    for frame in range(300):
        missed = changed(one, undetected=float(frame % 3 > 0))
        count_misses(State(together(missed, other), experience), STEP)
    assert experience.rate.share == pytest.approx(1 / 3, abs=0.05)


def test_what_pixels_hold_on_empty_road_at_the_border_is_soon_lost():
    rng = np.random.default_rng(0)
    road = rng.integers(0, 256, (SIZE[1], SIZE[0], 3)).astype(np.uint8)
    paint = rng.integers(0, 256, (40, 60, 3)).astype(np.uint8)
    tracker = MultiVehicleTracker()
    modes = []
    for index in range(140):
        frame = road.copy()
        # It leaves over the left border, ever slower, until most of it is outside.
        left = 140 * 0.9**index - 36
        boxes = [(max(left, 0), 100, 60 + min(left, 0), 40)]
        if index < 50:
            hidden = max(-round(left), 0)
            frame[100:140, hidden + round(left) : round(left) + 60] = paint[:, hidden:]
        detections = Detections.make(boxes if index < 50 else np.empty((0, 4)))
        modes.append([one.mode for one in tracker.step(frame, detections) if one.identity])
    assert modes[49] == [TrackMode.TRACKING]
    assert TrackMode.TRACKING not in modes[90]
