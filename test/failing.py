# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Functions that fail on chosen calls."""

import itertools

ERROR = "unexpected ZeroDivisionError: of a test"
"""Sentence about such a failure, as messages have it."""


def failing(good, at, reason=ZeroDivisionError):
    """Return `good`, but that it raises in the calls of these numbers, from 0."""
    calls = itertools.count()

    def call(*arguments):
        if next(calls) in at:
            raise reason("of a test")
        return good(*arguments)

    return call
