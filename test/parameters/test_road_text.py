# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.road import (
    RoadParameters,
    format_pairs,
    parse_numbers,
    parse_pairs,
)
from vehicle_pf_tracker.road.plane import Pair

numbers = st.floats(-1e6, 1e6)


@given(st.lists(st.tuples(numbers, numbers, numbers, numbers), max_size=6))
def test_pairs_are_read_back_to_the_last_digit(rows):
    pairs = tuple(Pair((u, v), (x, y)) for u, v, x, y in rows)
    assert parse_pairs(format_pairs(pairs)) == pairs


def test_pairs_apart_by_semicolons_or_lines():
    two = (Pair((1.0, 2.0), (3.0, 4.5)), Pair((5.0, 6.0), (7.0, -8.0)))
    assert parse_pairs("1,2=3,4.5; 5,6=7,-8") == two
    assert parse_pairs("1,2=3,4.5\n5,6=7,-8;") == two
    assert parse_pairs(" ") == ()


@pytest.mark.parametrize(
    "text", ["1,2", "1,2=3", "1,2,3=4,5", "1,2=3,x", "1,2=nan,3", "1,2=3,1e30"]
)
def test_what_is_no_pair(text):
    with pytest.raises(InputError, match="road"):
        parse_pairs(text)


def test_lens_and_pose():
    given = RoadParameters(
        intrinsics="800,810,320,240", distortion_model="plumb_bob", distortion="-0.3,0.1,0,0,0",
        camera_pose="0,0,8,0,0,0,1",
    )  # fmt: skip
    assert (given.lens.focal, given.lens.centre) == ((800.0, 810.0), (320.0, 240.0))
    assert given.pose.position.tolist() == [0, 0, 8]
    assert RoadParameters().lens is RoadParameters().pose is None
    assert parse_numbers("", "x") == ()


@pytest.mark.parametrize(
    "read",
    [
        lambda: RoadParameters(intrinsics="800,810,320").lens,
        lambda: RoadParameters(distortion_model="plumb_bob", distortion="0.1,0,0,0").lens,
        lambda: RoadParameters(camera_pose="0,0,8").pose,
    ],
)
def test_incomplete_cameras(read):
    with pytest.raises(InputError, match="road"):
        read()
