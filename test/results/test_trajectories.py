# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

from pathlib import Path

import numpy as np
import pytest

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.results.estimates import WAITING_MODE, EstimateRow
from vehicle_pf_tracker.results.trajectories import trajectory_files, write_trajectories

STAMP_NS = 1_700_000_000_000_000_040


def row(stamp_ns, x, y, mode="TRACKING"):
    numbers = {"x": x, "y": y, "width": 4.0, "height": 3.0}
    return EstimateRow.from_scalars(1, stamp_ns, {"mode": mode, **numbers})


ROWS = [
    EstimateRow.without(1, STAMP_NS - 1, WAITING_MODE),
    row(STAMP_NS, 1.5, 1 / 3),
    row(STAMP_NS + 10**9, np.float64(0.0), 2.0, "OCCLUDED"),
]
TRUTHS = [Truth(STAMP_NS, Box(1.0, 2.0, 4.0, 3.0), Occlusion.NONE)]


def test_every_digit_of_stamps_and_positions_is_written(tmp_path):
    write_trajectories(tmp_path / "new" / "a.tum", {"1": ROWS}, TRUTHS)
    assert (tmp_path / "new" / "a.tum").read_text().splitlines() == [
        "1700000000.000000040 1.5 0.3333333333333333 0 0 0 0 1",
        "1700000001.000000040 0.0 2.0 0 0 0 0 1",
    ]
    true = "1700000000.000000040 3.0 3.5 0 0 0 0 1\n"
    assert (tmp_path / "new" / "a_truth.tum").read_text() == true


def test_several_targets_have_a_file_each_and_no_truth(tmp_path):
    (tmp_path / "a_truth.tum").write_text("of the run before")
    write_trajectories(tmp_path / "a.tum", {"van": ROWS, "2": ROWS[:2]}, TRUTHS)
    lines = {path.name: len(path.read_text().splitlines()) for path in tmp_path.iterdir()}
    assert lines == {"a_van.tum": 2, "a_2.tum": 1}


def test_a_source_without_truth_leaves_one_file(tmp_path):
    write_trajectories(tmp_path / "a.tum", {"1": ROWS}, [])
    assert [path.name for path in tmp_path.iterdir()] == ["a.tum"]


def test_a_target_cannot_take_the_file_of_the_truth():
    with pytest.raises(InputError, match="a target is named truth"):
        trajectory_files(Path("a.tum"), ["1", "truth"])
    assert trajectory_files(Path("a.tum"), ["truth"]) == [Path("a.tum"), Path("a_truth.tum")]


def test_evo_reads_the_positions(tmp_path):
    evo = pytest.importorskip("evo.tools.file_interface", reason="evo is not installed")
    write_trajectories(tmp_path / "a.tum", {"1": ROWS}, [])
    read = evo.read_tum_trajectory_file(tmp_path / "a.tum")
    assert read.positions_xyz.tolist() == [[1.5, 1 / 3, 0.0], [0.0, 2.0, 0.0]]
    assert np.diff(read.timestamps) == pytest.approx([1.0])
    assert read.check()[0]
