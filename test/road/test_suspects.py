# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pairs that were misread, exchanged or put in line, and those that are only read with an error."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_pf_tracker.road.lens import Lens
from vehicle_pf_tracker.road.plane import Pair, RoadPlane, residuals
from vehicle_pf_tracker.road.suspects import disagreement

# A road of 8 m x 40 m seen from above it: metres to px by a homography worked out by hand, with
# u = (320 + 40 x) / w, v = (480 - 2 y) / w and w = 1 + y / 20.
ROAD = [(0, 0), (8, 0), (0, 10), (8, 10), (0, 20), (8, 20), (4, 30), (0, 40), (8, 40)]


def pixel_of(x, y):
    w = 1 + y / 20
    return ((320 + 40 * x) / w, (480 - 2 * y) / w)


PAIRS = [Pair(pixel_of(*road), road) for road in ROAD]


def moved(pairs, place, du, dv):
    pixel = pairs[place].pixel
    changed = list(pairs)
    changed[place] = replace(pairs[place], pixel=(pixel[0] + du, pixel[1] + dv))
    return changed


def exchanged(pairs, one, other):
    changed = list(pairs)
    changed[one] = replace(pairs[one], road=pairs[other].road)
    changed[other] = replace(pairs[other], road=pairs[one].road)
    return changed


def name(pair):
    return f"{pair.pixel[0]:g},{pair.pixel[1]:g}={pair.road[0]:g},{pair.road[1]:g}"


@pytest.mark.parametrize(("count", "place"), [(n, place) for n in (6, 9) for place in range(n)])
def test_the_pair_that_was_misread_is_named_alone(count, place):
    pairs = moved(PAIRS[:count], place, 30, -12)
    said = disagreement(pairs, None)
    assert said.startswith(f"read again: {name(pairs[place])} is ")
    assert said.count("=") == 1


def test_how_far_it_is_off_is_said():
    pairs = moved(PAIRS, 4, 30, -40)  # 50 px
    expected = f"read again: {name(pairs[4])} is 50 px from where the others put it"
    assert disagreement(pairs, None) == expected


@pytest.mark.parametrize(("one", "other"), [(0, 1), (2, 5), (7, 8)])
def test_two_pairs_that_were_exchanged_are_named(one, other):
    pairs = exchanged(PAIRS, one, other)
    said = disagreement(pairs, None)
    off = r"\S+( is \d+ px from where the others put it)?"  # nothing to say of impossible ones
    assert re.fullmatch(f"read again: {off}, {off}", said)
    assert {one, other} == {n for n, pair in enumerate(pairs) if name(pair) in said}


def test_of_five_pairs_the_worst_is_named_with_what_would_tell():
    pairs = moved(PAIRS[:5], 3, 40, 0)
    plane = RoadPlane.of_pairs(pairs, None, margin=0.0, coarsest=np.inf)
    in_image, on_road = residuals(plane, pairs)
    # Far away many metres are few pixels.
    assert in_image.argmax() != on_road.argmax()
    worst = re.escape(name(pairs[in_image.argmax()]))
    more = "a sixth pair would tell which"
    assert re.fullmatch(
        rf"the pairs disagree by \d+ px, {worst} most; {more}", disagreement(pairs, None)
    )


def test_of_three_misread_pairs_none_is_named():
    pairs = moved(moved(moved(PAIRS, 0, 60, 0), 4, -50, 40), 8, 0, 45)
    assert re.fullmatch(r"the pairs disagree by \d+ px, \S+ most", disagreement(pairs, None))


def test_of_four_pairs_in_a_wrong_order_the_exchanges_are_named():
    pairs = exchanged(PAIRS[:4], 2, 3)
    said = disagreement(pairs, None)
    assert f"{name(pairs[2])} and {name(pairs[3])}" in said
    assert re.fullmatch(r"read again \S+ and \S+(, or \S+ and \S+)*", said)


@pytest.mark.parametrize(
    ("place", "pixel"), [(2, (480, 480)), (3, (320, 480))], ids=["in line", "the same point"]
)
def test_points_in_line_are_named(place, pixel):
    pairs = list(PAIRS[:4])
    pairs[place] = replace(pairs[place], pixel=pixel)
    said = disagreement(pairs, None)
    one = "[0-9.,=]+"
    names = f"{one}, {one}, {one}"
    assert re.fullmatch(
        f"read again or replace one of {names}, which are on one line or the same point", said
    )
    assert name(pairs[place]) in said


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(4, 9))
def test_pairs_that_are_read_with_care_are_not_doubted(seed, count):
    noise = np.random.default_rng(seed).normal(0, 0.7, (count, 2))
    pairs = [replace(pair, pixel=(pair.pixel[0] + du, pair.pixel[1] + dv))
             for pair, (du, dv) in zip(PAIRS, noise, strict=False)]  # fmt: skip
    assert disagreement(pairs, None) == ""


BENT = Lens((600, 600), (320, 240), "plumb_bob", (-0.35, 0.0, 0.0, 0.0))


def bent_pairs():
    pixels = BENT.to_pixels(np.array([pair.pixel for pair in PAIRS]))
    return [replace(pair, pixel=tuple(map(float, pixel)))
            for pair, pixel in zip(PAIRS, pixels, strict=True)]  # fmt: skip


def test_a_lens_is_taken_into_account():
    pairs = bent_pairs()
    assert disagreement(pairs, BENT) == ""
    assert disagreement(pairs, None) != ""
    misread = moved(pairs, 4, 30, -12)
    assert disagreement(misread, BENT).startswith(f"read again: {name(misread[4])} is ")


def test_a_pixel_that_the_lens_cannot_show_is_named():
    # r (1 - 0.35 r^2) is at most 0.65 focal lengths, 390 px.
    pairs = bent_pairs()
    pairs[5] = replace(pairs[5], pixel=(920.0, 240.0))
    assert disagreement(pairs, BENT) == f"read again: {name(pairs[5])}"
