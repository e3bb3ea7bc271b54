# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of a node's memory."""

from benchmarks import memory_parts


def test_what_a_load_keeps_stands_in_its_own_row():
    kept = []
    size = 64_000_000
    loads = [("nothing", lambda: None), ("bytes", lambda: kept.append(bytearray(b"x") * size))]
    start, nothing, grown, total = memory_parts.rows(loads)
    assert abs(int(nothing[2])) <= 2
    assert 62 <= int(grown[2]) <= 66
    assert abs(int(start[2]) + int(nothing[2]) + int(grown[2]) - int(total[2])) <= 2


def test_modules_that_are_not_installed_are_left_out():
    assert memory_parts.has("numpy")
    assert not memory_parts.has("no_such_module.inside")
