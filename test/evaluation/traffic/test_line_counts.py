# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Counts at many lines of a scene with truth, and the share of intervals that hold it."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from traffic_samples import vehicle

from vehicle_pf_tracker.evaluation.traffic.line_counts import LineCounts, held_and_width
from vehicle_pf_tracker.evaluation.traffic.sequence import TrafficSequence

BOTTOMS = range(20, 240, 5)  # of a vehicle that drives down through an image of 320 x 240 px
LEFT, WIDTH, HEIGHT = 65.0, 30.0, 20.0


def scene(ignored=()):
    truth = [
        [number, 1, LEFT, bottom - HEIGHT, WIDTH, HEIGHT]
        for number, bottom in enumerate(BOTTOMS, start=1)
    ]
    rows = np.array(truth, float)
    hidden = np.zeros(len(rows), np.bool_)
    regions = np.array(ignored, float).reshape(-1, 5)
    return TrafficSequence(
        Path("scene"), len(rows), 25.0, (320, 240), rows, hidden, regions, detections={}
    )


def counts(sequence, seen=lambda number: True, first=1):
    lines = LineCounts(sequence)
    for number, bottom in enumerate(BOTTOMS, start=1):
        estimates = [vehicle(1, LEFT + WIDTH / 2, bottom)] if seen(number) else []
        detected = SimpleNamespace(images=int(number >= first))
        session = SimpleNamespace(detected=detected, estimates=estimates, ambiguous=None)
        lines.add(number, round(number * 1e9 / 25), session)
    return lines.results()


def test_who_follows_the_truth_counts_it_at_every_line():
    found = counts(scene())
    # Heights of a fifth to four fifths: five lines across, and four across the left half.
    assert [one.true for one in found if one.is_judged] == [1] * 9
    assert all(one.true == one.counted for one in found)
    assert held_and_width(found)[0] == 100.0


def test_a_vehicle_that_nobody_followed_is_held_by_no_interval():
    found = counts(scene(), seen=lambda number: False)
    assert [one.counted for one in found if one.true] == [0] * 9
    assert held_and_width(found) == (0.0, 0.0)


def test_there_is_no_truth_before_the_detector_looked():
    late = counts(scene(), first=len(BOTTOMS) // 2)
    assert sum(one.true for one in late) == 4  # at and below .65 and .6 of the height
    assert held_and_width(counts(scene(), first=10**6)[:0]) is None


@pytest.mark.parametrize(("top", "true"), [(0.0, 9), (300.0, 9)])
def test_vehicles_in_regions_without_truth_do_not_count(top, true):
    found = counts(scene([[0, 0.0, top, 320.0, 240.0]]))
    assert sum(one.true for one in found) == true
    assert sum(one.counted for one in found) == (0 if top == 0 else 9)
