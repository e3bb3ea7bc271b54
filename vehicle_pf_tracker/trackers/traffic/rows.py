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
        return self if self._are_all(rows) else self._taken(rows)

    def put(self: RowsT, rows: Integers | Bools, others: RowsT) -> RowsT:
        """Replace those at `rows` by others; all rows."""
        return others if self._are_all(rows) else self._with(rows, others)

    def _are_all(self, rows: Integers | Bools) -> bool:
        """Test for all rows in their order: the usual case, in which no array has to be copied."""
        count = len(self)
        if len(rows) != count:
            return False
        return bool(rows.all() if rows.dtype == np.bool_ else (rows == np.arange(count)).all())

    def _taken(self: RowsT, rows: Integers | Bools) -> RowsT:
        values = [getattr(self, name) for name in self.__dataclass_fields__]
        return type(self)(
            *[value[rows] if type(value) is np.ndarray else value._taken(rows) for value in values]
        )

    def _with(self: RowsT, rows: Integers | Bools, others: RowsT) -> RowsT:
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
