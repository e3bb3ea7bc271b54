# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rows of vehicles: taken, replaced and appended, without a write to those of before."""

from dataclasses import dataclass

import numpy as np
import pytest

from vehicle_pf_tracker.trackers.traffic.rows import Objects, Rows, columns, filled, objects


@dataclass(frozen=True, slots=True, eq=False)
class Inner(Rows):
    size: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Outer(Rows):
    number: np.ndarray
    inner: Inner
    votes: Objects


def rows_of(*numbers):
    count = len(numbers)
    return Outer(np.array(numbers), Inner(np.array(numbers) * 10.0), filled(count, ()))


def values(rows):
    assert rows.inner.size.tolist() == [10 * number for number in rows.number.tolist()]
    return rows.number.tolist()


def test_rows_are_taken_in_the_order_asked_for_or_by_a_mask():
    rows = rows_of(1, 2, 3)
    assert len(rows) == 3
    assert values(rows.take(np.array([2, 0]))) == [3, 1]
    assert values(rows.take(np.array([False, True, True]))) == [2, 3]
    assert values(rows.take(np.array([], np.intp))) == []


@pytest.mark.parametrize("every", [np.arange(3), np.ones(3, np.bool_)])
def test_all_rows_in_their_order_are_not_copied(every):
    rows, others = rows_of(1, 2, 3), rows_of(4, 5, 6)
    assert rows.take(every) is rows
    assert rows.put(every, others) is others


def test_replaced_rows_leave_those_of_before_as_they_were():
    before = rows_of(1, 2, 3)
    after = before.put(np.array([0, 2]), rows_of(7, 9))
    assert values(after) == [7, 2, 9]
    assert values(before) == [1, 2, 3]


def test_rows_are_appended_in_each_field():
    assert values(rows_of(1).extended(rows_of(2, 3))) == [1, 2, 3]


def test_objects_of_equal_length_stay_objects():
    assert objects([(1, 2), (3, 4)]).tolist() == [(1, 2), (3, 4)]
    assert objects([(1, 2), (3, 4)]).shape == (2,)


def test_columns_are_beside_each_other():
    table = columns(np.array([1.0, 2.0]), np.array([3.0, 4.0]))
    assert table.tolist() == [[1, 3], [2, 4]]
