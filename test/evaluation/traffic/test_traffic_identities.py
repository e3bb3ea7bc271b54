# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Identities kept, and vehicles counted."""

import numpy as np
import pytest
from scored_scenes import scene

from vehicle_pf_tracker.evaluation.traffic.identities import kept_identities
from vehicle_pf_tracker.evaluation.traffic.middle_line import middle_crossings

FRAMES = 100


def drive(hidden=(), size=(600, 100)):
    """One vehicle that drives to the right, totally hidden in these frames."""
    truth = [[f, 7, 4.0 * (f - 1), 40, 20, 12] for f in range(1, FRAMES + 1)]
    return scene(truth, size, np.isin(range(1, FRAMES + 1), list(hidden)))


def tracks(*spans):
    """The true boxes as tracks, each span (first, last, identity)."""
    rows = [
        [f, identity, 4.0 * (f - 1), 40, 20, 12]
        for first, last, identity in spans
        for f in range(first, last + 1)
    ]
    return np.array(rows, dtype=float).reshape(-1, 6)


BRIDGE = range(41, 61)


@pytest.mark.parametrize(
    ("spans", "kept"),
    [
        ([(1, 40, 1), (61, 100, 1)], 1),
        ([(1, 100, 1)], 1),  # predicted meanwhile
        ([(1, 40, 1), (61, 100, 2)], 0),
        ([(1, 40, 1), (61, 63, 2), (64, 100, 1)], 1),  # soon right again
        ([(1, 20, 3), (21, 40, 1), (61, 100, 1)], 1),  # the last one before counts
        ([(1, 38, 1), (39, 40, 2), (61, 100, 1)], 0),
        ([(1, 5, 1), (61, 100, 1)], 0),  # lost long before
        ([(1, 40, 1)], 0),
        ([], 0),
    ],
)
def test_an_identity_is_kept_if_it_is_the_same_before_and_after(spans, kept):
    assert kept_identities(drive(BRIDGE), tracks(*spans)) == (kept, 1)


def test_glimpses_do_not_divide_an_occlusion():
    glimpse = set(BRIDGE) - {50, 51, 52}
    assert kept_identities(drive(glimpse), tracks((1, 100, 1))) == (1, 1)
    twice = set(BRIDGE) - set(range(48, 54))
    assert kept_identities(drive(twice), tracks((1, 100, 1)))[1] == 1  # 6 frames are too few before


def test_who_is_seen_for_too_short_before_is_not_judged():
    assert kept_identities(drive(range(8, 30)), tracks((1, 100, 1))) == (0, 0)
    assert kept_identities(drive(range(60, 101)), tracks((1, 100, 1))) == (0, 0)


def test_crossings_of_the_middle_are_counted_once_per_identity():
    assert middle_crossings(drive(), tracks((1, 100, 1))) == (1, 1)
    assert middle_crossings(drive(), tracks((1, 40, 1))) == (0, 1)
    both = np.vstack([tracks((1, 100, 1)), tracks((1, 100, 2))])
    assert middle_crossings(drive(), both) == (2, 1)


def test_who_crosses_in_the_first_two_seconds_is_not_counted():
    assert middle_crossings(drive(size=(400, 100)), tracks((1, 100, 1))) == (0, 0)


def test_traffic_that_goes_down_is_counted_at_a_level_line():
    turned = drive().truth[:, [0, 1, 3, 2, 5, 4]]
    down = scene(turned, (100, 600))
    assert middle_crossings(down, turned) == (1, 1)
    assert middle_crossings(down, tracks((1, 100, 1))) == (0, 1)
