# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Numbers beside the picture of a live page."""

import json
from dataclasses import replace

from traffic_samples import vehicle

from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.counting.crossing import Crossing
from vehicle_pf_tracker.following.live_facts import RecentCrossings, target_facts, traffic_facts
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingPlan
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

SECOND = 10**9


def crossing(seconds, direction="in", kmh=None, doubt=""):
    stamp_ns, mode = int(seconds * SECOND), TrackMode.TRACKING
    return Crossing(stamp_ns, "gate", direction, 1, "car", mode, None, kmh, (0, 0), doubt)


def test_the_last_minute_is_counted_by_direction():
    recent = RecentCrossings()
    for seconds, direction in ((0, "in"), (10, "in"), (55, "out"), (65, "in")):
        recent.add([crossing(seconds, direction)], int(seconds * SECOND))
    assert [len(recent.at("gate", to)) for to in ("in", "out")] == [2, 1]
    recent.add([], 130 * SECOND)
    assert not recent.at("gate", "in")


def test_a_doubtful_crossing_is_in_no_count():
    recent = RecentCrossings()
    recent.add([crossing(1, doubt="it turned")], SECOND)
    assert not recent.at("gate", "in")


def test_a_crossing_that_is_withdrawn_is_in_no_count():
    recent = RecentCrossings()
    first, second = crossing(1), crossing(2)
    recent.add([first, second], 2 * SECOND)
    recent.withdraw([second, crossing(0)])
    assert recent.at("gate", "in") == [first]


def test_stamps_that_jump_back_begin_anew():
    recent = RecentCrossings()
    recent.add([crossing(500)], 500 * SECOND)
    recent.add([], SECOND)
    assert not recent.at("gate", "in")


def test_lines_have_counts_per_minute_and_mean_speed():
    counter = Counter(CountingPlan((CountingLine("gate", (0.0, 0.0), (9.0, 0.0)),), ()))
    recent = RecentCrossings()
    recent.add([crossing(1, kmh=30.0), crossing(2, kmh=40.0), crossing(3)], 3 * SECOND)
    estimates = [vehicle(1, 50, 50), vehicle(2, 90, 90, TrackMode.OCCLUDED)]
    facts = traffic_facts(counter, recent, estimates, "0:03.0, frame 75")
    assert facts["summary"] == "0:03.0, frame 75, 2 vehicles in view, 1 hidden"
    (lines,) = [table for table in facts["tables"] if table["title"] == "lines"]
    assert lines["rows"][0] == ("gate", "in", 0, 3, "35", "0 to 0")
    assert lines["rows"][1] == ("gate", "out", 0, 0, None, "0 to 0")
    json.dumps(facts)


def test_two_wheelers_are_in_no_number_of_the_summary(monkeypatch):
    counter = Counter(CountingPlan(), apart=frozenset({"bicycle"}))
    speeds = {1: 60.0, 2: 20.0, 3: 10.0}
    monkeypatch.setattr(counter, "speed_kmh", speeds.get)
    estimates = [
        replace(vehicle(1, 50, 50), label="car", serial=1),
        replace(vehicle(2, 70, 50, TrackMode.OCCLUDED), label="bicycle", serial=2),
        replace(vehicle(3, 90, 50), label="bicycle", serial=3),
    ]
    facts = traffic_facts(counter, RecentCrossings(), estimates, "")
    assert facts["vehicles"] == 1
    assert facts["summary"] == "1 vehicle in view, mean 60 km/h"
    (classes,) = facts["tables"]
    assert classes["rows"] == [("bicycle", 2), ("car", 1)]


def test_targets_have_mode_and_position():
    rows = {"van": EstimateRow(7, 0, 10.04, 5.0, 4, 4, "TRACKING", 0.934, None, None)}
    facts = target_facts(rows, 1_500_000_000)
    assert facts["summary"] == "0:01.5, frame 7"
    assert facts["tables"][0]["rows"] == [("van", "TRACKING", "0.93", "10.0", "5.0")]
