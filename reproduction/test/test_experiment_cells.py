# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import pytest
from experiment_samples import PF, SCENE, run_cells

from reproduction.runs.cells import RunCell, SceneChoice, System
from reproduction.runs.running import cell_key, run_together
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.following.offline_tracker import OfflineTracker
from vehicle_pf_tracker.trackers.registry import find_variant


def test_a_cell_gives_the_numbers_of_an_offline_run():
    (cell,) = run_cells(seeds=[4], scenes=[2], record=("x", "mode"))
    (result,) = run_together((cell,))
    frames = list(SCENE.seeded(2).make().frames())
    tracker = OfflineTracker(find_variant("pf"), PF.parameters(4), first_truth=frames[0].truth)
    rows = list(tracker.rows((frame.truth.stamp_ns, frame.frame) for frame in frames))
    expected = measure(score_frames(rows, [frame.truth for frame in frames]))
    assert result["metrics"]["rmse_px"] == expected.rmse_px
    assert result["trace"] == {"x": [r.x for r in rows], "mode": [r.mode for r in rows]}


def test_cells_that_run_together_do_not_change_each_other():
    cells = tuple(run_cells(scenes=[0]))
    assert run_together(cells) == [run_together((cell,))[0] for cell in cells]


def test_results_have_no_times():
    metrics = run_together(tuple(run_cells([0], [0])))[0]["metrics"]
    assert not [name for name in metrics if name.startswith("step_ms")]


def test_what_the_first_frame_does_not_have_is_none():
    trace = run_together(tuple(run_cells([0], [0])))[0]["trace"]
    assert trace["pi"][0] is None
    assert all(0 <= value <= 1 for value in trace["pi"][1:])


@pytest.mark.parametrize(
    "other",
    [
        RunCell(SCENE.seeded(1), PF, 0),
        RunCell(SceneChoice.of("bar", {"speed": 38.0, "width": 1.0}), PF, 0),
        RunCell(SCENE, PF.but({"sigma": 31.0}), 0),
        RunCell(SCENE, System.of("PF", "sapf", dict(PF.settings)), 0),
        RunCell(SCENE, PF, 1),
        RunCell(SCENE, PF, 0, ("x",)),
    ],
)
def test_whatever_decides_the_result_is_in_the_key(other):
    assert cell_key(other) != cell_key(RunCell(SCENE, PF, 0))


def test_the_name_in_tables_and_spelt_out_defaults_are_not():
    renamed = System.of("mine", "pf", {**dict(PF.settings), "histogram_bits": 3})
    assert cell_key(RunCell(SCENE, renamed, 0)) == cell_key(RunCell(SCENE, PF, 0))


def test_speeds_come_from_settings_defaults_and_tables():
    assert SCENE.speed == 38.0
    assert SceneChoice.of("clear").speed == 5.0
    assert SceneChoice.of("video03").speed == 4.0


def test_a_misspelt_parameter_is_named():
    with pytest.raises(InputError, match="sigmas"):
        System.of("PF", "pf", {"sigmas": 1.0}).parameters(0)
