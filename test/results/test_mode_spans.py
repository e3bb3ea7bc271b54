# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Modes as stretches of time."""

import pytest

from vehicle_pf_tracker.results.estimates import EstimateRow, clock_words, start_of_clock, summary


def rows(modes, period=100_000_000):
    letters = {"T": "TRACKING", "O": "OCCLUDED", "L": "LOST", "W": "WAITING"}
    return [
        EstimateRow.without(number, 5 * 10**9 + (number - 1) * period, letters[letter])
        for number, letter in enumerate(modes, start=1)
    ]


@pytest.mark.parametrize(
    ("modes", "words"),
    [
        ("TTT", "TRACKING 0:00.0-0:00.2; 3 of 3 frames tracked"),
        ("WTO", "WAITING 0:00.0-0:00.0, TRACKING 0:00.1-0:00.1, OCCLUDED 0:00.2-0:00.2; 1 of 3"),
        ("TLL", "TRACKING 0:00.0-0:00.0, LOST from 0:00.1; 1 of 3 frames tracked"),
        ("TLT", "LOST 0:00.1-0:00.1, TRACKING 0:00.2-0:00.2; 2 of 3 frames tracked"),
        ("TO" * 10, "and 8 more changes of the mode; 10 of 20 frames tracked"),
        ("", "no frames"),
    ],
)
def test_a_summary_in_one_sentence(modes, words):
    assert words in summary(rows(modes))


@pytest.mark.parametrize(
    ("nanoseconds", "words"),
    [
        (0, "0:00.0"),
        (59_960_000_000, "1:00.0"),
        (67_540_000_000, "1:07.5"),
        (36 * 10**11, "60:00.0"),
    ],
)
def test_clock_words(nanoseconds, words):
    assert clock_words(nanoseconds) == words


def test_times_begin_when_the_camera_has_a_clock():
    first = [EstimateRow.without(number, 0, "TRACKING") for number in (1, 2)]
    start = 1_700_000_000 * 10**9
    later = [EstimateRow.without(number, start + number * 10**8, "LOST") for number in (3, 4)]
    words = summary([*first, *later])
    assert words == "TRACKING 0:00.0-0:00.0, LOST from 0:00.0; 2 of 4 frames tracked"


def test_a_pause_of_hours_is_no_other_clock():
    assert start_of_clock(5, 5 + 3600 * 10**9) == 5
    assert start_of_clock(None, 7) == 7


@pytest.mark.parametrize(
    ("box", "size", "words"),
    [
        ((300.0, 100.0, 30.0, 20.0), (320, 240), "LEFT the image at 0:00.2"),
        ((-1.0, 100.0, 30.0, 20.0), (320, 240), "LEFT the image at 0:00.2"),
        ((100.0, 225.0, 30.0, 20.0), (320, 240), "LEFT the image at 0:00.2"),
        ((100.0, 100.0, 30.0, 20.0), (320, 240), "LOST from 0:00.2"),
        ((300.0, 100.0, 30.0, 20.0), None, "LOST from 0:00.2"),
    ],
)
def test_a_vehicle_lost_at_the_border_has_left(box, size, words):
    centre = box[0] + box[2] / 2, box[1] + box[3] / 2
    seen = [
        EstimateRow(n, n * 10**8, *centre, *box[2:], "TRACKING", 0.9, 1.0, 1.0) for n in range(2)
    ]
    lost = [EstimateRow(n, n * 10**8, *centre, *box[2:], "LOST", 0.0, 1.0, 1.0) for n in (2, 3)]
    assert words in summary([*seen, *lost], size)
