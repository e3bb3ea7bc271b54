# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Re-identification of vehicles that reappear away from their prediction."""

import numpy as np
import pytest
from traffic_samples import track

from vehicle_pf_tracker.trackers.traffic.association import former
from vehicle_pf_tracker.trackers.traffic.colours import BINS

RED, BLUE = np.eye(BINS)[:2]


def confirmed(number, left, colours=RED, **facts):
    return track(number, left, colours=colours, confirmed=True, **facts)


def test_a_vehicle_that_reappears_a_little_off_is_the_hidden_one():
    hidden, new = confirmed(1, 100.0, undetected=20.0), confirmed(2, 130.0)
    new.detection = new.state.edges
    assert former(new, [hidden, new]) is hidden
    hidden.resume(new)
    assert hidden.detection[0] == pytest.approx(130)
    assert hidden.identity == 1
    assert hidden.state.edges[0] == pytest.approx(130)
    assert hidden.undetected == 0


@pytest.mark.parametrize(
    "other",
    [
        confirmed(1, 100.0, undetected=2.0),
        confirmed(1, 300.0, undetected=20.0),
        confirmed(1, 100.0, BLUE, undetected=20.0),
        confirmed(1, 100.0, undetected=20.0, visible=0.2),
    ],
    ids=["just seen", "far away", "of another colour", "still behind another"],
)
def test_others_are_not_taken_for_it(other):
    new = confirmed(2, 130.0)
    assert former(new, [other, new]) is None


def test_a_vehicle_confirmed_a_second_time_is_the_first_unless_there_were_two():
    ghost, born = confirmed(1, 100.0, undetected=20.0), confirmed(2, 115.0, age=12.0)
    assert former(born, [ghost, born]) is ghost
    assert former(confirmed(2, 115.0, age=21.0), [ghost]) is None  # detected beside it
    assert former(confirmed(2, 140.0, age=12.0), [ghost]) is None  # near, not beside it
    ghost.resume(born)
    assert (ghost.estimate().identity, ghost.estimate().joined) == (1, 2)
