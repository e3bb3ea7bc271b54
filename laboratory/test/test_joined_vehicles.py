# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Vehicles without a number: what is said of them against the truth."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from laboratory.traffic.joined import Image, error, holds, row, without_number
from vehicle_pf_tracker.core.box import Box

TRUE = np.array([[0.0, 0, 10, 10], [20, 0, 10, 10], [40, 0, 10, 10]])


def followed(*boxes, is_followed=True):
    return [SimpleNamespace(box=Box(*box), is_followed=is_followed) for box in boxes]


def test_a_vehicle_has_a_number_if_one_that_is_followed_is_its_own():
    # The second box covers two vehicles, each by a third of both; it is one of them.
    both = followed((0, 0, 10, 10), (20, 0, 30, 10))
    assert without_number(TRUE, both) == 1
    assert without_number(TRUE, followed((0, 0, 10, 10), is_followed=False)) == 3
    # An overlap of 2/18 is none.
    assert without_number(TRUE[:1], followed((8, 0, 10, 10))) == 1
    assert without_number(TRUE[:0], both) == 0


def test_a_number_holds_within_a_factor_of_two():
    assert [holds(4.0, true) for true in (1, 2, 8, 9)] == [False, True, True, False]
    assert holds(0.0, 0)
    assert not holds(0.0, 1)


def test_a_row_compares_where_sizes_are_known():
    images = [Image(None, 5), Image(4.0, 3), Image(2.0, 5), Image(3.0, 3)]
    assert row("jam", images) == ["jam", "4", "75", "4.0", "3.0", "3.7", "67"]
    assert row("jam", images[:1]) == ["jam", "1", "0", "5.0", "–", "–", "–"]


def test_the_error_is_of_the_means():
    # Means of 1.7 and .7, and .3 more of both: a factor of two.
    assert error([Image(1.4, 0), Image(2.0, 1.4)]) == pytest.approx(math.log(2))
