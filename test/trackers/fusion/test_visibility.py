# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Evidence on visibility, by hand: the surface's share, and the states whole and partial."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from fusion_samples import fusion
from hypothesis import given
from hypothesis import strategies as st
from street import HEIGHT, SIZE, WIDTH, Street, follow

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.fusion.flow_evidence import points_evidence
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters
from vehicle_pf_tracker.trackers.fusion.step import Step
from vehicle_pf_tracker.trackers.fusion.visibility import wholeness


def visibility(**values):
    prefixed = {f"visibility.{name}": value for name, value in values.items()}
    return from_mapping(FusionParameters, prefixed).visibility


ROUND = visibility(points_slope=4.0, partial_slope=8.0, partial_middle=0.7)


def test_the_surface_s_share_speaks_for_a_visible_vehicle_above_the_middle():
    """Slope 4, middle 0.5; more than the usual share tells no more."""
    assert points_evidence(0.75, ROUND) == pytest.approx(1.0)
    assert points_evidence(0.25, ROUND) == pytest.approx(-1.0)
    assert points_evidence(1.3, ROUND) == points_evidence(1.0, ROUND) == pytest.approx(2.0)


def test_a_share_at_the_middle_leaves_the_chain_to_itself():
    """Rates of 0.02 and 0.05: 0.5 * 0.98 + 0.5 * 0.05."""
    for elapsed in (1.0, 2.0):
        expected = 0.5 * 0.98**elapsed + 0.5 * (1 - 0.95**elapsed)
        assert wholeness(0.5, 0.7, elapsed, ROUND) == pytest.approx(expected)


@pytest.mark.parametrize(("share", "ratio"), [(0.5, -1.6), (0.0, -3.0)])
def test_the_share_changes_the_odds_by_its_ratio_up_to_twenty_to_one(share, ratio):
    """Slope 8: 0.2 below the middle is a ratio of -1.6, and no share at all would be -5.6."""
    whole = wholeness(0.5, share, 1.0, ROUND)
    odds = whole / (1 - whole)
    assert odds == pytest.approx(0.515 / 0.485 * math.exp(ratio))


def test_half_a_vehicle_is_partial_within_three_frames_and_whole_again_as_fast():
    whole = 0.99
    for share, likely in ((0.4, False), (1.0, True)):
        for _ in range(3):
            whole = wholeness(whole, share, 1.0, ROUND)
        assert (whole > 0.5) == likely


@given(
    st.lists(st.tuples(st.floats(0, 1), st.floats(0, 30)), max_size=30), st.floats(0, 50),
    st.floats(0, 1),
)  # fmt: skip
def test_the_probability_stays_one(frames, slope, middle):
    whole, options = 0.99, visibility(partial_slope=slope, partial_middle=middle)
    for share, elapsed in frames:
        whole = wholeness(whole, share, elapsed, options)
        assert 0 <= whole <= 1


@pytest.mark.parametrize(
    ("position", "share"), [((100.0, 60.0), 1.0), ((0.0, 60.0), 0.5), ((0.0, 120.0), 0.25)]
)
def test_the_share_of_a_box_inside_the_image(position, share):
    step = SimpleNamespace(frame=np.zeros((HEIGHT, WIDTH, 3), np.uint8))
    assert Step.share_inside(step, np.array(position), np.array(SIZE)) == pytest.approx(share)


class Leaves(Street):
    """It stops when half of it has left the image."""

    def box(self, time):
        return Box(min(super().box(time).x, WIDTH - SIZE[0] / 2), 50, *SIZE)


@pytest.mark.parametrize("seed", range(3))
def test_a_vehicle_half_outside_the_image_is_partly_hidden(seed):
    estimates = follow(fusion(seed=seed), Leaves(seed=seed), range(80))
    whole = [estimate.similarities["whole"] for estimate in estimates[1:]]
    assert min(whole[5:40]) > 0.9
    assert max(whole[60:]) < 0.5
