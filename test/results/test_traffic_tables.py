# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tables of a run over many vehicles, read from files written by hand."""

import numpy as np
import pytest

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.results.traffic_results import COUNT_COLUMNS, COUNTS_FILE
from vehicle_pf_tracker.results.traffic_tables import read_counts

STAMP = 1_700_000_000_123_456_789
HEADER = ",".join(COUNT_COLUMNS)


def counts(folder, *rows):
    (folder / COUNTS_FILE).write_text("\n".join([HEADER, *rows]))
    return read_counts(folder)


def test_crossings_are_read_with_their_doubts_and_every_digit_of_a_stamp(tmp_path):
    read = counts(
        tmp_path,
        f"7,{STAMP},exit,in,3,car,TRACKING,12.50,,",
        f"9,{STAMP + 1},exit,out,4,,OCCLUDED,80.00,36.00,faster",
    )
    assert read.doubt.tolist() == ["", "faster"]
    assert read.stamp_ns.tolist() == [STAMP, STAMP + 1]
    assert (read.id.tolist(), read.label.tolist()) == ([3, 4], ["car", ""])
    assert np.isnan(read.speed_kmh[0])
    assert read.speed_kmh[1] == 36


def test_a_number_that_is_none_names_the_table(tmp_path):
    with pytest.raises(InputError, match=r"cannot read the table .*counts\.csv"):
        counts(tmp_path, f"7,{STAMP},exit,in,3,car,TRACKING,fast,,")


def test_an_empty_table_is_told(tmp_path):
    (tmp_path / COUNTS_FILE).write_text("")
    with pytest.raises(InputError, match=r"the table .*counts\.csv is empty"):
        read_counts(tmp_path)
