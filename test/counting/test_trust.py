# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Intervals of the true count, by distributions that are known, and the signs they are made of."""

from collections import Counter as Tally
from dataclasses import replace

import numpy as np
import pytest
from traffic_samples import MODES, vehicle

from vehicle_pf_tracker.counting.count_signs import Sign
from vehicle_pf_tracker.counting.counter import Counter
from vehicle_pf_tracker.counting.trust import OF_BLOBS, OF_BOXES, Trust
from vehicle_pf_tracker.parameters.counting_plan import CountingLine, CountingPlan

NOTHING = 1e-12
ACROSS = CountingLine("across", (0.0, 100.0), (320.0, 100.0))
PERIOD_NS = 40_000_000


def trust(true=0.5, missed=0.0, unseen=NOTHING, spread=0.5):
    return Trust({Sign.SEEN: true}, {Sign.BROKEN: missed}, unseen, spread)


def test_two_crossings_that_are_true_by_half_are_one_most_likely():
    first, likely = trust().distribution({Sign.SEEN: 2})
    assert first == 0
    assert likely[:3] == pytest.approx([0.25, 0.5, 0.25])
    assert trust().interval({Sign.SEEN: 2}, mass=0.4) == (1, 1)
    assert trust().interval({Sign.SEEN: 2}, mass=0.9) == (0, 2)


def test_what_was_missed_has_the_mean_and_variance_of_its_rate():
    _, likely = trust(missed=1.5, spread=0.4).distribution({Sign.BROKEN: 4})
    numbers = np.arange(len(likely))
    mean = likely @ numbers
    assert mean == pytest.approx(6.0)
    assert likely @ (numbers - mean) ** 2 == pytest.approx(6.0 + 0.4 * 6.0**2, rel=1e-3)


def test_an_interval_holds_what_is_drawn_from_its_own_model():
    rng = np.random.default_rng(5)
    own = trust(true=0.9, missed=0.6, unseen=0.1, spread=0.3)
    low, high = own.interval({Sign.SEEN: 12, Sign.BROKEN: 3}, mass=0.9)
    rates = 1.9 * rng.gamma(1 / 0.3, 0.3, 20_000)
    drawn = rng.binomial(12, 0.9, 20_000) + rng.poisson(rates)
    assert 0.9 <= np.mean((low <= drawn) & (drawn <= high)) < 0.96


def test_a_count_of_a_month_is_as_exact_as_its_share():
    low, high = trust(true=0.9).interval({Sign.SEEN: 1_000_000}, mass=0.9)
    deviation = 300.0  # the square root of a million times .9 times .1
    assert (low, high) == pytest.approx(
        (900_000 - 1.645 * deviation, 900_000 + 1.645 * deviation), abs=2
    )


def test_numbers_are_told_apart_within_eight_deviations_of_what_is_true():
    # 90 of 100 with a deviation of 3: from 90 - 1 - 24 to 100. Nothing missed goes up to 12 + 1.
    first, likely = trust(true=0.9).distribution({Sign.SEEN: 100})
    assert (first, len(likely)) == (65, 36 + 13)
    # Both ends: 50 with a deviation of 5, 41 to each side.
    first, likely = trust(true=0.5).distribution({Sign.SEEN: 100})
    assert (first, len(likely)) == (9, 83 + 13)
    assert likely[41] == pytest.approx(0.0795892, abs=1e-6)  # 100! / 50!² / 2^100


def test_numbers_missed_are_told_apart_within_twelve_deviations():
    # A mean of 6 and a variance of 6 + 0.4 * 36 = 20.4: 6 + 12 * (1 + 4.5166) = 72.2.
    _, likely = trust(missed=6.0, spread=0.4).distribution({Sign.BROKEN: 1})
    assert len(likely) == 74
    assert likely[0] == pytest.approx((1 + 0.4 * 6) ** (-1 / 0.4))
    assert likely[1] / likely[0] == pytest.approx(6 / (1 + 0.4 * 6))


def test_a_thousand_missed_are_as_likely_as_a_poisson_number():
    # The likeliest is e^996 times as likely as none, which no float can hold squared.
    _, likely = trust(missed=1000.0, spread=1e-6).distribution({Sign.BROKEN: 1})
    assert likely @ np.arange(len(likely)) == pytest.approx(1000.0)


def test_where_nothing_was_seen_nothing_crossed():
    assert OF_BOXES.interval({}) == (0, 0)


def counted(*drives, ambiguous=None, counter=None):
    """Counter after drives, (first image, lower edges, modes) of vehicles 1, 2, …"""
    counter = counter or Counter(CountingPlan(lines=(ACROSS,)))
    for index in range(max(first + len(bottoms) for first, bottoms, _ in drives) + 2):
        estimates = [
            replace(
                vehicle(
                    number, 100.0 * number, bottoms[index - first], MODES[modes[index - first]]
                ),
                score=0.9,
            )
            for number, (first, bottoms, modes) in enumerate(drives, start=1)
            if 0 <= index - first < len(bottoms) and modes[index - first] != "-"
        ]
        counter.update(estimates, index * PERIOD_NS, ambiguous=ambiguous)
    return counter


def signs(*drives, **kwargs):
    return counted(*drives, **kwargs).signs("across", "in")


WHOLE = (0, range(40, 160, 4), "T" * 30)
BEFORE = range(40, 96, 4)  # ends 8 px before the line, less than a vehicle
BEHIND = range(108, 160, 4)


def test_a_crossing_in_sight_speaks_for_the_count():
    assert signs(WHOLE) == {Sign.SEEN: 1}
    assert signs(WHOLE, ambiguous=2) == {Sign.SEEN: 1, Sign.JOINED: 1}


def test_a_predicted_crossing_is_vague():
    assert signs((0, range(40, 160, 4), "T" * 12 + "O" * 10 + "T" * 8)) == {Sign.VAGUE: 1}


@pytest.mark.parametrize("bottoms", [BEFORE, BEHIND])
def test_a_track_that_ends_or_begins_at_the_line_may_have_crossed_it(bottoms):
    drive = (0, bottoms, "T" * len(bottoms))
    assert signs(drive) == {Sign.BROKEN: 1}
    assert counted(drive).signs("across", "out") == Tally()
    low, high = counted(drive).interval("across", "in")
    assert low == 0 < high


def test_one_that_ends_far_from_the_line_says_nothing():
    assert signs((0, range(20, 72, 4), "T" * 13)) == Tally()


def test_one_that_comes_back_and_crosses_has_not_been_missed():
    there = (0, range(40, 160, 4), "T" * 13 + "-" * 3 + "T" * 14)
    assert Sign.BROKEN not in signs(there)
    assert sum(signs(there).values()) == 1


def test_what_drove_over_the_line_unconfirmed_may_be_a_vehicle():
    assert signs((0, range(60, 140, 4), "t" * 20)) == {Sign.UNCONFIRMED: 1}
    assert signs((0, range(60, 140, 40), "t" * 2)) == Tally()


def test_a_recording_that_begins_again_keeps_its_signs_and_a_reset_does_not():
    counter = counted(WHOLE, (0, BEFORE, "T" * len(BEFORE)))
    before = counter.signs("across", "in")
    counter.update([], 0)
    assert counter.signs("across", "in") == before == {Sign.SEEN: 1, Sign.BROKEN: 1}
    counter.reset()
    assert counter.signs("across", "in") == Tally()


def test_a_reset_discards_that_detections_were_blobs():
    likely = {Sign.BROKEN: 3}
    assert OF_BLOBS.interval(likely) != OF_BOXES.interval(likely)
    drives = [(0, BEFORE, "T" * len(BEFORE))] * 3
    counter = counted(*drives, ambiguous=0)
    assert counter.interval("across", "in") == OF_BLOBS.interval(likely)
    counter.reset()
    assert counted(*drives, counter=counter).interval("across", "in") == OF_BOXES.interval(likely)


def test_vehicles_that_are_followed_when_a_recording_begins_again_have_ended():
    counter = Counter(CountingPlan(lines=(ACROSS,)))
    for index, bottom in enumerate(BEFORE):
        counter.update([replace(vehicle(1, 100.0, bottom), score=0.9)], index * PERIOD_NS)
    assert counter.signs("across", "in") == Tally()  # it may cross yet
    counter.forget_vehicles()
    assert counter.signs("across", "in") == {Sign.BROKEN: 1}
    # The next one with this number is another vehicle, and takes nothing back.
    counter.update([replace(vehicle(1, 100.0, 40.0), score=0.9)], 0)
    assert counter.signs("across", "in") == {Sign.BROKEN: 1}


def test_what_began_behind_the_line_has_been_missed_before_it_ends():
    counter = Counter(CountingPlan(lines=(ACROSS,)))
    for index, bottom in enumerate(BEHIND):
        counter.update([replace(vehicle(1, 100.0, bottom), score=0.9)], index * PERIOD_NS)
    assert counter.signs("across", "in") == {Sign.BROKEN: 1}


def mixed(ambiguous=None):
    """Counter of 20 cars, 3 buses and 2 walkers, who are no vehicles; each crosses in."""
    counter = Counter(CountingPlan(lines=(ACROSS,)), apart={"walker"})
    labels = ["car"] * 20 + ["bus"] * 3 + ["walker"] * 2
    for number, label in enumerate(labels, start=1):
        for index, bottom in enumerate((80, 90, 110, 120)):
            one = replace(vehicle(number, 100.0, bottom, label=label), score=0.9)
            counter.update([one], (1000 * number + index) * PERIOD_NS, ambiguous=ambiguous)
    return counter


def test_classes_apart_are_in_no_total_of_vehicles():
    counter = mixed()
    assert counter.by_class("across", "in") == {"car": 20, "bus": 3, "walker": 2}
    assert counter.count("across", "in") == 23
    assert counter.count("across", "out") == 0
    assert counter.signs("across", "in") == {Sign.SEEN: 23}
    assert counter.signs("across", "in", "bus") == {Sign.SEEN: 3}
    assert counter.signs("across", "in", "walker") == {Sign.SEEN: 2}


def test_intervals_are_those_of_boxes_until_there_were_blobs():
    boxes, blobs = mixed(), mixed(ambiguous=0)
    assert boxes.interval("across", "in") == OF_BOXES.interval({Sign.SEEN: 23})
    assert blobs.interval("across", "in") == OF_BLOBS.interval({Sign.SEEN: 23})
    assert boxes.interval("across", "in") != blobs.interval("across", "in")
    assert boxes.interval("across", "in", "car") == OF_BOXES.interval({Sign.SEEN: 20})
    assert boxes.interval("across", "in", "bus") == OF_BOXES.interval({Sign.SEEN: 3})
    blobs.update([], 10**15)  # once blobs, always blobs
    assert blobs.interval("across", "in") == OF_BLOBS.interval({Sign.SEEN: 23})
