# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The table over many sources: its rows, and what stands for all of them."""

import json

import pytest

from vehicle_pf_tracker.results.run_folder import RUN_FILE
from vehicle_pf_tracker.results.source_table import SOURCE_FILE, read_table


@pytest.fixture
def folder(tmp_path):
    """Results of three sources of `traffic`, of which the last failed."""
    for name, vehicles, at_once, size, count in (("north", 3, 2, 20.5, 1), ("south", 4, 4, 30, 2)):
        counts = [{"place": "exit", "direction": "in", "class": "car", "count": count}]
        summary = {
            "vehicles": vehicles,
            "most_at_once": at_once,
            "least_size_px": size,
            "counted_apart": {"bicycle": 1},
            "counts": counts,
        }
        (tmp_path / name).mkdir()
        (tmp_path / name / SOURCE_FILE).write_text(json.dumps({"reason": ""}))
        (tmp_path / name / RUN_FILE).write_text(json.dumps({"summary": summary}))
    (tmp_path / "west").mkdir()
    (tmp_path / "west" / SOURCE_FILE).write_text(json.dumps({"reason": "it is no video"}))
    return tmp_path


def test_a_source_has_a_row_with_its_numbers_and_counts(folder):
    table = read_table(folder, ["north", "south", "west", "not yet"])
    assert table.header == [
        "source", "vehicles", "most_at_once", "least_size_px", "exit in", "failed",
    ]  # fmt: skip
    assert table.rows == [
        ["north", 3, 2, 20.5, 1, ""],
        ["south", 4, 4, 30, 2, ""],
        ["west", None, None, None, None, "it is no video"],
    ]
    assert table.failures == {"west": "it is no video"}


def test_all_are_summed_but_the_most_at_once_and_sizes(folder):
    table = read_table(folder, ["north", "south", "west"])
    assert table.totals == ["all", 7, 4, "", 3, ""]
