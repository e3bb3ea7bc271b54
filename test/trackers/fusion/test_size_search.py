# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Following the size, on responses of known shape."""

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.fusion.parameters import SizeParameters
from vehicle_pf_tracker.trackers.fusion.size_search import believed_stretch, searched_size

STEP = np.log(1.03)
SIZE = np.array([40.0, 20.0])


def parameters(**values):
    return SizeParameters(**{"step": 0.03, "gain": 0.7, **values})


def response(best):
    """Responses that fall with the square of the log distance from the best size."""
    return at_each(lambda size: 1 - float((np.log(size / best) ** 2).sum()))


def at_each(peak):
    return lambda sizes: [peak(size) for size in sizes]


@pytest.mark.parametrize("turn", [0, 2, 4])
def test_both_sides_go_to_the_vertex_by_hand(turn):
    """The best size is half a step off: the vertex is there, and the gain takes 0.7 of it."""
    peaks = response(SIZE * np.exp(0.5 * STEP))
    found = searched_size(SIZE, turn, peaks, parameters())
    assert found == pytest.approx(SIZE * 1.03 ** (0.7 * 0.5))


@pytest.mark.parametrize(("turn", "axis"), [(1, 0), (3, 1), (5, 0)])
def test_one_side_goes_alone_in_every_second_turn(turn, axis):
    best = SIZE * np.exp([0.4 * STEP, -0.3 * STEP])
    peaks = response(best)
    found = searched_size(SIZE, turn, peaks, parameters())
    expected = SIZE.copy()
    expected[axis] *= 1.03 ** (0.7 * (0.4, -0.3)[axis])
    assert found == pytest.approx(expected)


@pytest.mark.parametrize("factor", [1.3, 0.8])
def test_far_off_it_goes_a_step_at_most(factor):
    peaks = response(SIZE * factor)
    found = searched_size(SIZE, 0, peaks, parameters())
    assert found == pytest.approx(SIZE * 1.03 ** (0.7 * np.sign(factor - 1)))


def test_a_valley_is_left_towards_the_higher_side():
    def left(size):
        return 0.5 if size is SIZE else 0.6 + 0.001 * size[0]

    found = searched_size(SIZE, 0, at_each(left), parameters())
    assert found == pytest.approx(SIZE * 1.03**0.7)


def test_where_nothing_differs_the_size_stays():
    peaks = at_each(lambda _: 0.8)
    assert searched_size(SIZE, 0, peaks, parameters()) == pytest.approx(SIZE)


@pytest.mark.parametrize(
    ("stretch", "share", "believed"),
    [
        ([0.02, 0.03], 0.9, [0.02, 0.025]),  # spread along both: nothing that hides does that
        ([-0.1, -0.06], 0.9, [-0.08, -0.06]),  # faster than 0.7 steps of 3 %
        ([-0.1, -0.02], 0.9, [-0.05, -0.01]),  # as an occluder drags points along
        ([0.1, -0.1], 0.9, [0.05, -0.05]),
        ([-0.1, -0.06], 0.7, [-0.06, -0.06]),  # a part of the surface tells no aspect
        ([-0.1, -0.02], 0.7, [0.0, 0.0]),
        ([0.1, 0.1], 0.4, [0.0, 0.0]),  # more is hidden than seen
    ],
)
def test_points_tell_wholly_what_no_occluder_does(stretch, share, believed):
    found = believed_stretch(np.array(stretch), share, SIZE, parameters())
    assert found == pytest.approx(believed)


def test_points_on_a_vehicle_of_a_few_px_tell_half():
    found = believed_stretch(np.array([0.1, 0.1]), 0.9, SIZE / 2, parameters())
    assert found == pytest.approx([0.05, 0.05])


def test_repeated_it_converges_on_the_right_aspect():
    best, size = np.array([46.0, 18.0]), SIZE
    peaks = response(best)
    for turn in range(40):
        size = searched_size(size, turn, peaks, parameters())
    assert size == pytest.approx(best, rel=0.01)


@pytest.mark.parametrize("off", ["step", "gain"])
def test_what_is_switched_off_is_not_even_measured(off):
    def peaks(sizes):
        raise AssertionError(sizes)

    assert searched_size(SIZE, 1, peaks, parameters(**{off: 0.0})) is SIZE
