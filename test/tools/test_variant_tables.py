# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The tables of variants go where the markers are."""

import pytest

from tools.variant_tables import BEGIN, END, markdown_table, replace_table
from vehicle_pf_tracker.trackers.registry import VARIANTS


def test_a_table_has_a_row_for_each_variant():
    columns = {"name": lambda variant: variant.name, "node": lambda variant: variant.executable}
    pair = [VARIANTS["pf"], VARIANTS["ms"]]
    assert markdown_table(columns, pair).splitlines() == [
        "| name | node |",
        "| --- | --- |",
        "| pf | pf_tracker |",
        "| ms | ms_tracker |",
    ]


def test_a_page_keeps_what_is_around_its_table():
    page = f"before\n{BEGIN}old\n{END}\nafter\n"
    assert replace_table(page, "new\n") == f"before\n{BEGIN}new\n{END}\nafter\n"


@pytest.mark.parametrize("page", ["", BEGIN, END, END + BEGIN])
def test_a_page_without_markers_is_an_error(page):
    with pytest.raises(ValueError, match="no pair of markers"):
        replace_table(page, "new\n")
