# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Evidence that tracks are vehicles."""

import numpy as np
import pytest
from traffic_samples import track

from vehicle_pf_tracker.trackers.traffic.detections import DetectionEvidence
from vehicle_pf_tracker.trackers.traffic.existence import Existence
from vehicle_pf_tracker.trackers.traffic.parameters import TrafficParameters

SIZE = (320, 240)
SCORE = 0.8


def ended_unconfirmed(places):
    """Return the log odds of a detection after ten tracks that were detected at these places."""
    evidence = DetectionEvidence()
    existence = Existence(TrafficParameters(), evidence)
    for _ in range(10):
        one = track(1, 0.0)
        for frame, (left, top) in enumerate(places):
            one.state, one.age = track(1, left, top).state, float(frame)
            edges = one.state.edges
            existence.detected(one, edges, evidence.sample(edges, SCORE, SIZE), 0.0)
        assert not one.confirmed
        one.undetected = 100.0
        assert existence.survivors([one], SIZE, 1 / 30) == []
    elsewhere = evidence.sample(np.array([200.0, 180.0, 240.0, 210.0]), SCORE, SIZE)
    return float(evidence.log_odds([elsewhere])[0])


def test_what_flickered_in_one_place_speaks_against_its_scores():
    jitter = np.random.default_rng(4).normal(0, 3, (8, 2))
    assert ended_unconfirmed(100 + jitter) < -1


def test_what_drove_and_ended_unconfirmed_tells_nothing_about_its_scores():
    assert ended_unconfirmed([(20 + 4 * frame, 100) for frame in range(8)]) == pytest.approx(0)


def test_what_was_seen_a_few_times_speaks_against_its_scores():
    assert ended_unconfirmed([(20 + 4 * frame, 100) for frame in range(3)]) < -1


def missed(undetected, *, seen=()):
    """Evidence that confirmed vehicles in sight lose in a frame, undetected for so long."""
    tracks = [
        track(
            identity,
            60.0 * identity,
            confirmed=True,
            log_odds=5.0,
            undetected=0.0 if identity in seen else periods,
        )
        for identity, periods in enumerate(undetected, start=1)
    ]
    Existence(TrafficParameters(), DetectionEvidence()).fade(tracks, 1.0)
    return [5.0 - one.log_odds for one in tracks]


def test_a_vehicle_that_alone_is_missed_is_doubted():
    assert missed([3.0])[0] > 0
    lost = missed([3.0, 3.0], seen=(2,))
    assert lost[0] > 0
    assert lost[1] == 0


def test_a_detector_that_misses_all_vehicles_at_once_has_failed():
    assert missed([3.0, 3.0]) == [0, 0]


def test_vehicles_that_no_detector_sees_for_long_are_doubted_all():
    assert min(missed([200.0, 200.0])) > 0
