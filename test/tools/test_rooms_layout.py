# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The layout of the rooms: rows, bends, and an order in which few arrows cross."""

from tools.rooms_layout import BOX_WIDTH, MARGIN, lay_out, rows_of


def test_rows_follow_the_longest_chain_and_long_arrows_bend_between():
    graph = {"a": {"b", "c"}, "b": {"c"}, "c": set()}
    assert rows_of(graph) == [["c"], [("a", "c", 1), "b"], ["a"]]


def test_a_row_is_ordered_by_what_it_imports_from():
    # In the order of names both arrows would cross.
    centres = lay_out({"a": {"d"}, "b": {"c"}, "c": set(), "d": set()}).centres
    assert centres["a"][0] == centres["d"][0]
    assert centres["b"][0] == centres["c"][0]


def test_a_row_of_one_stands_in_the_middle():
    layout = lay_out({"a": {"b", "c"}, "b": set(), "c": set()})
    assert layout.centres["a"][0] == layout.width / 2
    assert min(layout.centres[room][0] for room in "bc") == MARGIN + BOX_WIDTH / 2
    assert layout.chains == [["a", "b"], ["a", "c"]]
