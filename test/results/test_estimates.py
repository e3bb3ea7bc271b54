# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.results.estimates import (
    ESTIMATE_COLUMNS,
    REJECTED_MODE,
    WAITING_MODE,
    EstimateRow,
    read_estimates,
    write_estimates,
)

numbers = st.floats(allow_nan=False)
rows = st.builds(
    EstimateRow,
    frame=st.integers(1, 10**6),
    stamp_ns=st.integers(0, 2**63 - 1),
    x=numbers,
    y=numbers,
    width=numbers,
    height=numbers,
    mode=st.sampled_from(["TRACKING", "OCCLUDED", "LOST"]),
    confidence=numbers,
    n_eff=numbers,
    step_ms=numbers,
) | st.builds(
    EstimateRow.without,
    st.integers(1, 10**6),
    st.integers(0, 2**63 - 1),
    st.sampled_from([WAITING_MODE, REJECTED_MODE]),
)


@given(st.lists(rows, max_size=5))
def test_every_digit_survives_the_file(tmp_path_factory, written):
    path = tmp_path_factory.mktemp("rows") / "estimates.csv"
    write_estimates(path, written)
    assert read_estimates(path) == written


def test_a_row_as_text(tmp_path):
    path = tmp_path / "estimates.csv"
    row = EstimateRow(1, 2, 0.1 + 0.2, 4.0, 5.0, 6.0, "LOST", 0.5, 100.0, 1.25)
    write_estimates(path, [row, EstimateRow.without(2, 3, WAITING_MODE)])
    assert path.read_bytes().decode().splitlines() == [
        "frame,stamp_ns,x,y,width,height,mode,confidence,n_eff,step_ms",
        "1,2,0.30000000000000004,4.0,5.0,6.0,LOST,0.5,100.0,1.25",
        "2,3,,,,,WAITING,,,",
    ]


def test_scalars_as_numbers_and_as_text_make_the_same_row():
    scalars = {"mode": "TRACKING", "regime": "normal", "x": 0.1, "y": 2.0, "width": 3,
               "height": 4.0, "confidence": 1.0, "n_eff": 77.25, "step_ms": 0.3}  # fmt: skip
    row = EstimateRow.from_scalars(7, 8, scalars)
    assert row == EstimateRow(7, 8, 0.1, 2.0, 3.0, 4.0, "TRACKING", 1.0, 77.25, 0.3)
    assert row == EstimateRow.from_scalars(7, 8, {k: str(v) for k, v in scalars.items()})
    assert row.position == (0.1, 2.0)


def test_a_waiting_row_has_no_numbers():
    row = EstimateRow.from_scalars(1, 0, {"mode": WAITING_MODE, "x": ""})
    assert (row.x, row.width, row.confidence, row.n_eff, row.step_ms, row.position) == (None,) * 6


def test_scalars_without_a_mode_are_refused():
    with pytest.raises(InputError, match="frame 3 has no mode"):
        EstimateRow.from_scalars(3, 0, {"x": 1.0})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "must begin with the line frame,stamp_ns"),
        ("frame,x\n", "must begin with the line frame,stamp_ns"),
        (",".join(ESTIMATE_COLUMNS) + "\n1,2,3\n", "line 2 .* is broken"),
        (
            ",".join(ESTIMATE_COLUMNS) + "\n1,2,a,4,5,6,LOST,8,9,10\n",
            "line 2 .* x is not a number: 'a'",
        ),
        (",".join(ESTIMATE_COLUMNS) + "\none,2,3,4,5,6,LOST,8,9,10\n", "line 2 .* is broken"),
    ],
)
def test_broken_files_are_named(tmp_path, text, message):
    path = tmp_path / "broken.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        read_estimates(path)
    assert str(path) in str(caught.value)
    with pytest.raises(InputError, match=r"none\.csv: No such file"):
        read_estimates(tmp_path / "none.csv")


def test_a_folder_in_the_way_is_named_and_nothing_is_left(tmp_path):
    (tmp_path / "estimates.csv").mkdir()
    with pytest.raises(InputError, match=r"cannot write .*estimates\.csv"):
        write_estimates(tmp_path / "estimates.csv", [])
    assert [path.name for path in tmp_path.iterdir()] == ["estimates.csv"]
