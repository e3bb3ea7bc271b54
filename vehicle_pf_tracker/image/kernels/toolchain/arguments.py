# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Check of the arrays that a kernel is given: linked code trusts their types and layouts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np


class ArrayForm(NamedTuple):
    """Form of an array that a kernel takes; Python checks numbers when they are converted.

    Attributes
    ----------
    argument : int
        Number of the argument, from 0.
    member : int or None
        Number in it where that is a tuple.
    dtype : dtype
        Type of its elements.
    ndim : int
        Number of its axes.
    is_packed : bool
        True where rows have to follow each other in memory (layout "C").
    is_written : bool
        True where the array has to be writable.
    """

    argument: int
    member: int | None
    dtype: np.dtype[Any]
    ndim: int
    is_packed: bool
    is_written: bool


def form_from_json(value: Sequence[Any]) -> ArrayForm:
    """Read a form that JSON has as a list, and its type as numpy writes it ("<f8")."""
    argument, member, dtype, *others = value
    return ArrayForm(argument, member, np.dtype(dtype), *others)


def check(forms: Sequence[ArrayForm], arguments: Sequence[Any]) -> None:
    """Raise an error where an array has not its form.

    Raises
    ------
    TypeError
        If an array has other elements, axes or strides than the kernel was compiled for.
    """
    for argument, member, dtype, ndim, is_packed, is_written in forms:
        value = arguments[argument] if member is None else arguments[argument][member]
        if (
            value.dtype != dtype
            or value.ndim != ndim
            or (is_packed and not value.flags.c_contiguous)
            or (is_written and not value.flags.writeable)
        ):
            wanted = ArrayForm(argument, member, dtype, ndim, is_packed, is_written)
            raise TypeError(
                f"a kernel takes an array as {wanted}, not of {value.dtype}, {value.ndim} axes, "
                f"packed: {value.flags.c_contiguous}, writable: {value.flags.writeable}"
            )
