# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Counting at lines and in zones, with paths whose crossings are known."""

import math
from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import MODES, vehicle

from laboratory.scenes.road import RoadSceneParameters, camera_of, road
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingPlan, CountingZone
from vehicle_pf_tracker.road.plane import Pair, RoadPlane
from vehicle_pf_tracker.trackers.traffic.estimate import TrackMode

ACROSS = CountingLine("across", (0.0, 100.0), (320.0, 100.0))
ZONE = CountingZone("queue", ((50.0, 50.0), (150.0, 50.0), (150.0, 150.0), (50.0, 150.0)))
PERIOD_NS = 40_000_000
LATE = 1_700_000_000_000_000_000  # stamps of today have no digits left for ns in a float


def drive(counter, bottoms, modes=None, *, identity=1, x=100.0, label="car"):
    """Feed one vehicle's lower edges; return all crossings."""
    modes = modes or "T" * len(bottoms)
    found = []
    for index, (bottom, mode) in enumerate(zip(bottoms, modes, strict=True)):
        estimates = [] if mode == "-" else [vehicle(identity, x, bottom, MODES[mode], label=label)]
        found += counter.update(estimates, LATE + index * PERIOD_NS)
    return found


def line_counter(**kwargs):
    return Counter(CountingPlan(lines=(ACROSS,)), **kwargs)


def test_downwards_over_a_line_from_left_to_right_is_the_first_direction():
    (crossing,) = drive(line_counter(), [80, 90, 96, 104, 112])
    assert (crossing.place, crossing.direction) == ("across", "in")
    (crossing,) = drive(line_counter(), [120, 110, 90, 80])
    assert crossing.direction == "out"


def test_turning_the_line_round_turns_its_directions():
    counter = Counter(CountingPlan(lines=(CountingLine("l", (320, 100), (0, 100), ("a", "b")),)))
    (crossing,) = drive(counter, [80, 90, 110, 120])
    assert crossing.direction == "b"


def test_time_of_a_crossing_lies_between_the_images():
    # From 96 to 104: the line is half way between images 2 and 3.
    (crossing,) = drive(line_counter(), [80, 88, 96, 104, 112])
    assert crossing.stamp_ns == LATE + 2 * PERIOD_NS + PERIOD_NS // 2


def test_each_direction_counts_once_for_a_vehicle():
    there_and_back = [*range(40, 164, 4), *range(160, 36, -4)] * 2
    assert [c.direction for c in drive(line_counter(), there_and_back)] == ["in", "out"]


def test_a_path_past_the_end_of_a_line_does_not_cross_it():
    short = Counter(CountingPlan(lines=(CountingLine("l", (200, 100), (300, 100)),)))
    assert drive(short, [80, 90, 110, 120], x=150.0) == []
    assert len(drive(short, [80, 90, 110, 120], x=250.0, identity=2)) == 1


def test_a_vehicle_that_passes_the_end_and_comes_back_through_counts_once():
    line = CountingLine("l", (200, 100), (300, 100))
    counter = Counter(CountingPlan(lines=(line,)))
    found = []
    down, up = range(60, 144, 4), range(140, 56, -4)
    across = range(150, 254, 4)
    path = [(150, y) for y in down] + [(x, 140) for x in across] + [(250, y) for y in up]
    for index, (x, bottom) in enumerate(path):
        found += counter.update([vehicle(1, x, bottom)], index * PERIOD_NS)
    assert [c.direction for c in found] == ["out"]


def test_an_occluded_vehicle_counts_once_at_the_predicted_time():
    crossings = drive(line_counter(), [80, 88, 96, 104, 112, 120], "TTOOOT")
    (crossing,) = crossings
    assert crossing.stamp_ns == LATE + 2 * PERIOD_NS + PERIOD_NS // 2
    assert crossing.mode is TrackMode.OCCLUDED


def test_an_early_forecast_counts_once_and_nothing_back():
    # Predicted behind the line, seen before it again, and then across it.
    crossings = drive(line_counter(), [80, 90, 110, 120, 90, 95, 110, 120], "TTOOTTTT")
    assert [c.direction for c in crossings] == ["in"]
    assert crossings[0].stamp_ns < LATE + 3 * PERIOD_NS


def test_a_vehicle_seen_before_the_line_again_can_still_turn_back_later():
    path = [*range(60, 96, 4), 110, *range(90, 144, 4), *range(140, 56, -4)]
    modes = "".join(
        "O" if bottom == 110 and index == 9 else "T" for index, bottom in enumerate(path)
    )
    assert [c.direction for c in drive(line_counter(), path, modes)] == ["in", "out"]


@pytest.mark.parametrize("modes", ["TTLLLT", "TT---T"])
def test_a_lost_vehicle_that_comes_back_behind_the_line_counts_once(modes):
    (crossing,) = drive(line_counter(), [80, 90, 0, 0, 0, 110], modes)
    assert crossing.mode is TrackMode.LOST
    assert crossing.stamp_ns == LATE + 3 * PERIOD_NS  # half way from image 1 to image 5
    assert crossing.speed_px is None


def test_a_tentative_vehicle_counts_late_with_its_own_time():
    counter = line_counter()
    assert drive(counter, [80, 96, 104, 110], "tttt") == []
    assert not counter.totals
    (crossing,) = counter.update([vehicle(1, 100, 116, label="bus")], LATE + 4 * PERIOD_NS)
    assert crossing.stamp_ns == LATE + PERIOD_NS + PERIOD_NS // 2
    assert crossing.mode is TrackMode.TENTATIVE
    assert crossing.label == "bus"  # what is known when it counts
    assert counter.update([vehicle(1, 100, 120)], LATE + 5 * PERIOD_NS) == ()


def test_a_tentative_vehicle_that_vanishes_does_not_count():
    counter = line_counter()
    assert drive(counter, [80, 96, 104, 110, 0, 0], "tttt--") == []
    assert counter.count("across", "in") == 0


def test_a_vehicle_first_seen_on_the_line_does_not_count():
    assert drive(line_counter(), [99, 101, 110, 130]) == []


def test_totals_are_kept_by_direction_and_class():
    counter = line_counter()
    for identity, label in enumerate(["car", "bus", "car"], start=1):
        counter.forget_vehicles()
        drive(counter, [80, 90, 110], identity=identity, label=label)
    counter.forget_vehicles()
    drive(counter, [120, 110, 80], identity=4)
    assert counter.totals == {
        ("across", "in", "car"): 2,
        ("across", "in", "bus"): 1,
        ("across", "out", "car"): 1,
    }
    assert counter.count("across", "in") == 3
    counter.reset()
    assert counter.count("across", "in") == 0


def test_time_that_goes_back_begins_all_paths_anew():
    counter = line_counter()
    counter.update([vehicle(1, 100, 80)], LATE)
    assert counter.update([vehicle(1, 100, 120)], LATE - PERIOD_NS) == ()


def test_time_that_stands_still_goes_on_with_the_paths():
    counter = line_counter()
    counter.update([vehicle(1, 100, 80)], LATE)
    counter.update([vehicle(1, 100, 99)], LATE)  # on no clear side, was it all that is known
    assert len(counter.update([vehicle(1, 100, 120)], LATE + PERIOD_NS)) == 1


def test_a_lost_vehicle_is_remembered_for_ten_minutes():
    counter = line_counter()
    counter.update([vehicle(1, 100, 80)], 0)
    counter.update([], 600 * 10**9)
    assert list(counter.vehicles) == [1]
    counter.update([], 600 * 10**9 + 1)
    assert not counter.vehicles


def test_memory_does_not_grow_with_vehicles_that_are_gone():
    counter = line_counter()
    for identity in range(1, 3001):  # one a second
        counter.update([vehicle(identity, 100, 80)], identity * 10**9)
    assert len(counter.vehicles) <= 601


def test_memory_does_not_grow_where_stamps_stand_still():
    counter = line_counter()
    for identity in range(1, 5101):
        counter.update([vehicle(identity, 100, 80)], LATE)
    assert len(counter.vehicles) == 5000
    # Those that came last: one that is in view is among them.
    assert list(counter.vehicles)[-1] == 5100
    assert counter.update([vehicle(5100, 100, 120)], LATE)


def test_speed_in_pixels_is_that_of_the_path():
    (crossing,) = drive(line_counter(), [40 + 4.0 * k for k in range(20)])
    assert crossing.speed_px == pytest.approx(4.0 / 0.04)  # px per period of 0.04 s
    assert crossing.speed_kmh is None


def test_speed_on_the_road_is_exact_in_perspective():
    pairs = [
        Pair((100.0, 50.0), (0.0, 60.0)),
        Pair((220.0, 50.0), (8.0, 60.0)),
        Pair((20.0, 200.0), (0.0, 0.0)),
        Pair((300.0, 200.0), (8.0, 0.0)),
    ]
    plane = RoadPlane.of_pairs(pairs, None, margin=0.1, coarsest=5.0)
    counter = line_counter(plane=plane)
    metres_per_s = 72 / 3.6
    found = []
    for index in range(50):
        y = 45.0 - metres_per_s * 0.04 * index
        x, bottom = plane.to_image(np.array([3.0, y]))
        if bottom < 200:
            found += counter.update([vehicle(1, x, bottom)], LATE + index * PERIOD_NS)
    (crossing,) = found
    assert crossing.speed_kmh == pytest.approx(72.0, rel=1e-6)
    assert counter.speed_kmh(1) == pytest.approx(72.0, rel=1e-6)
    assert counter.speed_kmh(2) is None  # nobody has this number


@pytest.mark.parametrize(("speed", "heading"), [(70.0, "coming"), (120.0, "going")])
def test_speed_on_a_rendered_road_is_that_of_the_scene(speed, heading):
    """With the true boxes; they are as tight as the picture, not as the vehicle's wheels."""
    parameters = RoadSceneParameters(speed=speed, heading=heading)
    scene, plane = road(parameters, 0), camera_of(parameters, 0).plane
    level = plane.to_image(np.array([[-3.0, 30.0], [3.0, 30.0]]))[:, 1].mean()
    line = CountingLine("line", (0.0, level), (float(scene.width), level))
    counter = Counter(CountingPlan(lines=(line,)), plane)
    found = []
    for index, truth in enumerate(scene.truths()):
        x, y, size = truth.box.x, truth.box.y, (truth.box.width, truth.box.height)
        estimate = vehicle(1, x + size[0] / 2, y + size[1], size=size)
        found += counter.update([estimate], scene.stamp_ns(index))
    (crossing,) = found
    assert crossing.direction == ("in" if heading == "coming" else "out")
    assert crossing.speed_kmh == pytest.approx(speed, rel=0.01)


def test_speed_outside_the_calibrated_area_is_not_given():
    pairs = [
        Pair((0.0, 150.0), (0.0, 10.0)),
        Pair((320.0, 150.0), (8.0, 10.0)),
        Pair((0.0, 200.0), (0.0, 0.0)),
        Pair((320.0, 200.0), (8.0, 0.0)),
    ]
    plane = RoadPlane.of_pairs(pairs, None, margin=0.0, coarsest=5.0)
    (crossing,) = drive(line_counter(plane=plane), [80, 90, 110, 120])
    assert crossing.speed_kmh is None
    assert crossing.speed_px is not None


def zone_counter():
    return Counter(CountingPlan(zones=(ZONE,)))


def test_a_zone_counts_entry_and_exit_and_its_occupancy():
    counter = zone_counter()
    occupancy, found = [], []
    for index, bottom in enumerate([20, 40, 60, 80, 100, 120, 140, 160, 180]):
        found += counter.update([vehicle(1, 100, bottom)], LATE + index * PERIOD_NS)
        occupancy.append(counter.occupancy["queue"])
    assert [(c.place, c.direction) for c in found] == [("queue", "entry"), ("queue", "exit")]
    assert found[0].stamp_ns == LATE + PERIOD_NS + PERIOD_NS // 2  # from 40 to 60 across 50
    assert occupancy == [0, 0, 1, 1, 1, 1, 1, 0, 0]


def test_a_vehicle_that_shakes_on_the_edge_enters_and_leaves_once():
    shaking = [10, 20, 30, 40, 51, 49, 51, 49, 51, 49, 60, 70, 80]
    there = [c.direction for c in drive(zone_counter(), shaking)]
    assert there == ["entry"]
    out = [140, *[151, 148, 154, 147] * 6, 160, 170, 180, 190]
    whole = [c.direction for c in drive(zone_counter(), [*shaking, *range(90, 140, 10), *out])]
    assert whole == ["entry", "exit"]


def test_a_vehicle_first_seen_in_a_zone_is_there_without_an_entry():
    counter = zone_counter()
    assert drive(counter, [100, 100]) == []
    assert counter.occupancy == {"queue": 1}


@pytest.mark.parametrize(("mode", "there"), [("t", 0), ("T", 1), ("O", 1), ("L", 0)])
def test_only_confirmed_vehicles_with_a_position_are_in_a_zone(mode, there):
    counter = zone_counter()
    if mode != "t":
        drive(counter, [100])
    counter.update([vehicle(1, 100, 100, MODES[mode])], LATE + PERIOD_NS)
    assert counter.occupancy["queue"] == there


def test_occupancy_ends_with_the_vehicle():
    counter = zone_counter()
    drive(counter, [100, 100])
    counter.update([], LATE + 5 * PERIOD_NS)
    assert counter.occupancy["queue"] == 0


def test_small_boxes_have_a_margin_of_a_pixel():
    counter = line_counter()
    tiny = [(99.2, 0), (100.8, 0), (99.2, 0), (100.8, 1)]
    found = []
    found += counter.update([vehicle(1, 100, 90, size=(4, 2))], LATE)
    for index, (bottom, _) in enumerate(tiny, start=1):
        found += counter.update([vehicle(1, 100, bottom, size=(4, 2))], LATE + index * PERIOD_NS)
    assert found == []
    assert len(counter.update([vehicle(1, 100, 101.5, size=(4, 2))], LATE + 9 * PERIOD_NS)) == 1


def test_a_drive_across_counts_and_one_that_ends_before_the_line_does_not():
    rng = np.random.default_rng(5)
    for identity in range(1, 101):
        end = rng.choice([rng.uniform(60, 90), rng.uniform(115, 160)])
        path = np.linspace(20, end, 60) + rng.normal(0, 1.0, 60)
        crossings = [c.direction for c in drive(line_counter(), path, identity=identity)]
        assert crossings == (["in"] if end > 100 else [])


def passing(counter, first, paths, score=0.9):
    """Feed the paths (x, bottoms) of vehicles, numbered from `first`; return the doubts."""
    found = []
    for number, (x, bottoms) in enumerate(paths, start=first):
        for index, bottom in enumerate(bottoms):
            stamp_ns = LATE + (1000 * number + index) * PERIOD_NS
            found += counter.update([replace(vehicle(number, x, bottom), score=score)], stamp_ns)
    return [one.doubt for one in found]


DOWN, UP = [80, 88, 96, 104, 112, 120], [120, 112, 104, 96, 88, 80]


def test_a_crossing_far_faster_than_all_others_is_marked_and_not_counted():
    counter = line_counter()
    passing(counter, 1, [(100, DOWN)] * 5)
    assert passing(counter, 6, [(100, [0, 33, 66, 99, 132, 165])]) == ["faster"]
    assert passing(counter, 7, [(100, [70, 82, 94, 106, 118, 130])]) == [""]
    assert counter.count("across", "in") == 6
    assert passing(line_counter(), 1, [(100, [0, 33, 66, 99, 132, 165])]) == [""]  # nothing known


def test_a_crossing_against_all_others_counts_if_the_vehicle_was_detected():
    counter = line_counter()
    passing(counter, 1, [(100, DOWN)] * 5)
    assert passing(counter, 6, [(100, UP)]) == [""]  # a driver the wrong way is what one looks for
    assert passing(counter, 7, [(100, DOWN)] * 5) == [""] * 5
    counter = line_counter()
    passing(counter, 1, [(100, DOWN)] * 5)
    assert passing(counter, 6, [(100, UP)], score=math.nan) == ["against"]  # by its pixels
    assert passing(counter, 7, [(250, UP)], score=math.nan) == [""]  # in another lane
    assert counter.count("across", "out") == 1


def test_a_vehicle_born_again_beside_its_prediction_counts_once():
    counter = line_counter()
    doubts = []
    for index in range(8):
        known = vehicle(1, 100, 80 + 6 * index, MODES["T" if index < 2 else "O"])
        again = [vehicle(2, 104, 76 + 6 * index)] if index > 2 else []
        found = counter.update([known, *again], LATE + index * PERIOD_NS)
        doubts += [(one.identity, one.doubt) for one in found]
    assert doubts == [(1, ""), (2, "twice")]
    assert counter.count("across", "in") == 1


def test_a_hidden_vehicle_that_joins_a_track_goes_on_where_that_one_was():
    counter = line_counter()
    drive(counter, [60, 70, 75], "TTT")
    for index, bottom in enumerate([90, 96, 104, 112], start=3):  # a new one, not yet confirmed
        new = replace(vehicle(2, 100, bottom, MODES["t"]), identity=0)
        old = vehicle(1, 100, 76, MODES["O"])
        assert counter.update([old, new], LATE + index * PERIOD_NS) == ()
    (crossing,) = counter.update([replace(vehicle(1, 100, 118), joined=2)], LATE + 7 * PERIOD_NS)
    assert (crossing.identity, crossing.stamp_ns) == (1, LATE + 4 * PERIOD_NS + PERIOD_NS // 2)


def both_over(counter):
    """Let two tracks cross one after the other, which then turn out to be one vehicle."""
    found = []
    for index in range(8):
        cab = vehicle(1, 100, 80 + 6 * index)
        lorry = vehicle(2, 200, 68 + 6 * index, label="truck")
        found += counter.update([cab, lorry], LATE + index * PERIOD_NS)
    return found, replace(vehicle(1, 200, 116, label="truck"), joined=2)


def test_what_two_tracks_of_one_vehicle_have_counted_is_one_crossing():
    counter = line_counter()
    (first, second), one = both_over(counter)
    assert (first.identity, second.identity) == (1, 2)
    assert counter.count("across", "in") == 2
    assert counter.update([one], LATE + 8 * PERIOD_NS) == ()
    assert counter.withdrawn == (second,)
    assert counter.by_class("across", "in") == {"car": 1}
    assert counter.signs("across", "in").total() == 1
    assert counter.update([replace(one, joined=2)], LATE + 9 * PERIOD_NS) == ()
    assert counter.withdrawn == ()
    assert counter.count("across", "in") == 1


def test_a_vehicle_keeps_what_only_its_other_track_has_counted():
    counter = line_counter()
    for index in range(8):
        before = vehicle(1, 100, 20 + 2 * index)
        over = vehicle(2, 100, 80 + 6 * index)
        counter.update([before, over], LATE + index * PERIOD_NS)
    counter.update([replace(vehicle(1, 100, 128), joined=2)], LATE + 8 * PERIOD_NS)
    assert counter.withdrawn == ()
    assert counter.count("across", "in") == 1
    # Known to have counted, a third track of it that has counted, too, repeats it.
    for index in range(8):
        third = vehicle(3, 100, 80 + 6 * index)
        counter.update([vehicle(1, 100, 134), third], LATE + (9 + index) * PERIOD_NS)
    assert counter.count("across", "in") == 2
    counter.update([replace(vehicle(1, 100, 140), joined=3)], LATE + 17 * PERIOD_NS)
    assert counter.count("across", "in") == 1


def test_nothing_is_withdrawn_for_a_crossing_that_was_in_no_total():
    counter = line_counter()
    for index in range(8):
        known = vehicle(1, 100, 80 + 6 * index, MODES["T" if index < 2 else "O"])
        again = [vehicle(2, 104, 76 + 6 * index)] if index > 2 else []
        counter.update([known, *again], LATE + index * PERIOD_NS)
    assert counter.count("across", "in") == 1  # the second one is in doubt
    counter.update([replace(vehicle(1, 104, 124), joined=2)], LATE + 8 * PERIOD_NS)
    assert counter.withdrawn == ()
    assert counter.count("across", "in") == 1
