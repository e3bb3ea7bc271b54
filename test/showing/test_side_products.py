# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Products that fail cost themselves alone."""

from contextlib import contextmanager

import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.showing.side_products import SideProducts


class LibraryError(Exception):
    """An error with no base but `Exception`."""


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (InputError("cannot write a.png: no space"), "cannot write a.png: no space"),
        (OSError(28, "No space left on device"), "cannot make a.png: No space left on device"),
        (LibraryError("(-215)\n  assertion failed"), "cannot make a.png: (-215) assertion failed"),
        (MemoryError(), "cannot make a.png: MemoryError"),
        (ZeroDivisionError("by zero"), "cannot make a.png: by zero"),
    ],
)
def test_an_error_is_one_sentence(error, sentence):
    side = SideProducts()
    with side.attempt("a.png"):
        raise error
    with side.attempt("b.png"):
        pass
    assert side.failed("a.png") and not side.failed("b.png")
    assert side.notices == [f"{sentence}; all else is written"]


def test_a_product_that_failed_often_is_told_once():
    side = SideProducts()
    for number in range(3):
        with side.attempt("a.png"):
            raise ValueError(number)
    assert len(side.notices) == 1 and ": 0;" in side.notices[0]


@pytest.mark.parametrize("leaving", [KeyboardInterrupt, SystemExit])
def test_a_signal_goes_on(leaving):
    with pytest.raises(leaving), SideProducts().attempt("a.png"):
        raise leaving


def growing(ends, *, begin=None, finish=None):
    """A product that is complete or discarded, as `ends` tells."""

    @contextmanager
    def making():
        if begin:
            raise begin
        try:
            yield lambda number: 1 / number
        except BaseException:
            ends.append("discarded")
            raise
        if finish:
            raise finish
        ends.append("complete")

    return making()


@pytest.mark.parametrize(
    ("numbers", "errors", "expected"),
    [
        ([1, 2], {}, ["complete"]),
        ([1, 0, 2, 0], {}, ["discarded"]),
        ([1], {"begin": OSError(13, "Permission denied")}, []),
        ([1], {"finish": OSError(28, "No space left on device")}, []),
    ],
)
def test_a_product_that_grows_is_complete_or_not_there(numbers, errors, expected):
    side, ends = SideProducts(), []
    with side.growing("a.mp4", growing(ends, **errors)) as add:
        for number in numbers:
            add(number)
    assert ends == expected
    assert len(side.notices) == (expected != ["complete"])


def test_a_run_that_ends_by_an_error_completes_no_product():
    ends = []
    with pytest.raises(InputError), SideProducts().growing("a.mp4", growing(ends)) as add:
        add(1)
        raise InputError("the target is outside")
    assert ends == ["discarded"]
