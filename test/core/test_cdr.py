# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Stamps of serialized messages."""

import pytest

from vehicle_pf_tracker.core.cdr import header_stamp_ns


@pytest.mark.parametrize("length", [0, 4, 8, 11])
def test_a_message_too_short_for_a_header_has_no_stamp(length):
    assert header_stamp_ns(memoryview(bytes(length))) is None


@pytest.mark.parametrize(("order", "encapsulation"), [("little", 1), ("big", 0)])
def test_a_header_begins_with_its_stamp_in_either_byte_order(order, encapsulation):
    stamp = (-2).to_bytes(4, order, signed=True) + (7).to_bytes(4, order)
    assert header_stamp_ns(bytes([0, encapsulation, 0, 0]) + stamp) == -1_999_999_993
