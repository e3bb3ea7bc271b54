# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Modes as stretches of time."""

import pytest

from vehicle_pf_tracker.results.estimates import EstimateRow, clock_words, summary


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
