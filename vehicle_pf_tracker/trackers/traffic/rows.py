# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Values of several vehicles at once, one row for each."""

from __future__ import annotations

from typing import Any, ClassVar, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from vehicle_pf_tracker.core.array import Array

Bools: TypeAlias = npt.NDArray[np.bool_]
Integers: TypeAlias = npt.NDArray[np.intp]
Objects: TypeAlias = npt.NDArray[np.object_]
"""Rows of immutable values whose size differs."""
RowsT = TypeVar("RowsT", bound="Rows")


class Rows:
    """Base of frozen dataclasses whose fields are arrays (N, ...) or are `Rows` themselves."""

    __slots__ = ()
    __dataclass_fields__: ClassVar[dict[str, Any]]

    def __len__(self) -> int:
        return len(getattr(self, next(iter(self.__dataclass_fields__))))

    def take(self: RowsT, rows: Integers | Bools) -> RowsT:
        """Select those at `rows`, in this order."""
        # Values are frozen, so that all of them can be shared.
        return self if self._are_all(rows) else self._taken(_indices(rows))

    def put(self: RowsT, rows: Integers | Bools, others: RowsT) -> RowsT:
        """Replace those at `rows` by others; all rows."""
        return others if self._are_all(rows) else self._with(_indices(rows), others)

    def _are_all(self, rows: Integers | Bools) -> bool:
        """Test for all rows in their order: the usual case, in which no array has to be copied."""
        count = len(self)
        if len(rows) != count:
            return False
        return bool(rows.all() if rows.dtype == np.bool_ else (rows == np.arange(count)).all())

    def _taken(self: RowsT, rows: Integers) -> RowsT:
        taken = []
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            # `take`, as brackets cost three times as much for a few rows.
            is_array = type(value) is np.ndarray
            taken.append(value.take(rows, 0) if is_array else value._taken(rows))
        return type(self)(*taken)

    def _with(self: RowsT, rows: Integers, others: RowsT) -> RowsT:
        # A copy, as the old value is part of a state that somebody may still hold.
        replaced = []
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            new = getattr(others, name)
            if type(value) is np.ndarray:
                changed = value.copy()
                changed[rows] = new
            else:
                changed = value._with(rows, new)
            replaced.append(changed)
        return type(self)(*replaced)

    def extended(self: RowsT, others: RowsT) -> RowsT:
        """Append others."""
        joined = []
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            new = getattr(others, name)
            is_array = type(value) is np.ndarray
            joined.append(np.concatenate([value, new]) if is_array else value.extended(new))
        return type(self)(*joined)


def _indices(rows: Integers | Bools) -> Integers:
    """Find the indices of rows once, not anew for each field."""
    return rows.nonzero()[0] if rows.dtype == np.bool_ else np.asarray(rows, np.intp)


def columns(*values: Array) -> Array:
    """Put arrays (N,) beside each other: (N, K)."""
    table = np.empty((len(values[0]), len(values)))
    for index, value in enumerate(values):
        table[:, index] = value
    return table


def objects(values: list[Any]) -> Objects:
    """Make an array (N,) of values that may themselves be arrays or tuples."""
    # One by one: numpy would make a table of values of equal length.
    array = np.empty(len(values), np.object_)
    for index, value in enumerate(values):
        array[index] = value
    return array


def filled(count: int, value: object) -> Objects:
    """Make an array (N,) of one immutable value."""
    array = np.empty(count, np.object_)
    array.fill(value)
    return array
