"""The numbers of docs/fusion.md are what their titles say."""

import statistics
from dataclasses import fields

import pytest

from benchmarks import fusion_ablation, fusion_cost, fusion_scenes, fusion_sequences
from benchmarks import fusion_tables as tables
from benchmarks.fusion_runs import Run, find_sequence, longest_run, run, scene, summary
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.estimates import EstimateRow
from vehicle_pf_tracker.evaluation.scores import score_frames
from vehicle_pf_tracker.parameters.table import from_mapping
from vehicle_pf_tracker.trackers.fusion.parameters import FusionParameters

BOX = Box.around((100.0, 100.0), 24.0, 18.0)  # its diagonal is 30 px


def scores(*frames):
    """Frames of (error in px, mode, occlusion) as scores."""
    rows = [
        EstimateRow.from_scalars(
            number, number, {"mode": mode, "x": 100.0 + error, "y": 100.0, "confidence": 1.0}
        )
        for number, (error, mode, _) in enumerate(frames, 1)
    ]
    truth = [Truth(number, BOX, frame[2]) for number, frame in enumerate(frames, 1)]
    return score_frames(rows, truth, max_diff=0.0)


def a_run(**values):
    """A run without anything to complain of but `values`."""
    perfect = {"on_target": 1.0, "close": 1.0, "rmse_px": 0.0, "recovered": ()}
    perfect |= {"hidden": None, "clear": 0.0, "false_run": 0}
    return Run(**(perfect | values))


def test_what_is_told_of_a_run():
    told = summary(
        scores(
            (0.0, "TRACKING", Occlusion.NONE),
            (14.0, "TRACKING", Occlusion.NONE),  # on target and close
            (16.0, "OCCLUDED", Occlusion.NONE),  # neither
            (20.0, "OCCLUDED", Occlusion.PARTIAL),
            (31.0, "OCCLUDED", Occlusion.TOTAL),
            (31.0, "TRACKING", Occlusion.TOTAL),
            (31.0, "TRACKING", Occlusion.NONE),
            (29.0, "TRACKING", Occlusion.NONE),  # within the diagonal
            (31.0, "TRACKING", Occlusion.NONE),
        )
    )
    assert told.on_target == pytest.approx(2 / 7)
    assert told.close == pytest.approx(2 / 7)
    squares = [0, 14**2, 16**2, 20**2, 31**2, 29**2, 31**2]
    assert told.rmse_px == pytest.approx(statistics.fmean(squares) ** 0.5)
    assert told.hidden == pytest.approx(1 / 2)
    assert told.clear == pytest.approx(1 / 6)
    assert told.false_run == 2
    assert told.recovered == ()  # too few frames behind the occlusion to judge by
    assert told.all_recovered is None


def test_hits_on_end():
    assert longest_run([]) == 0
    assert longest_run([True, True, False, True, True, True, False]) == 3


def test_cells():
    assert tables.spread([1.0, None, 2.0, 6.0], 1) == "3.0 (1.0-6.0)"
    assert tables.spread([1.0, 2.0, 6.0], 1, statistics.median) == "2.0 (1.0-6.0)"
    assert tables.spread([0.501, 0.499], 2) == "0.50"
    assert tables.spread([None], 2) == "–"
    assert tables.hits([True, None, False]) == "1 of 2"
    assert tables.hits([None]) == "–"


def test_occlusions_and_runs_are_counted_apart():
    runs = [a_run(recovered=(True, False)), a_run(recovered=(True, True)), a_run()]
    assert tables.recoveries(runs) == ["3 of 4", "1 of 2"]


def test_every_row_has_a_cell_for_each_title():
    runs = [a_run(), a_run(hidden=0.5, recovered=(True,), false_run=7)]
    for module in (fusion_scenes, fusion_sequences):
        head = tables.header("", module.COLUMNS).splitlines()
        line = module.row("name", runs)
        assert {one.count("|") for one in (*head, line)} == {len(module.COLUMNS) + 2}
        assert "| 7 |" in line
    assert len(fusion_ablation.cells(runs, [])) == len(fusion_ablation.COLUMNS)
    line = fusion_cost.row("name", [0.001, 0.001, 0.004], [0.01, 0.02, 0.03])
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells == ["name", "3", "1.00", "2.00", "4.00", "20.00", "20.00", "30.00", "20.0", "10.0"]
    assert len(cells) == len(fusion_cost.COLUMNS) + 1


def test_every_switch_of_a_part_has_a_row():
    defaults = FusionParameters()
    switches = {
        f"{name}.{one.name}"
        for name in ("cues", "motion", "hiding")
        for one in fields(getattr(defaults, name))
        if isinstance(getattr(getattr(defaults, name), one.name), bool)
    }
    turned = {name for row in fusion_ablation.OFF.values() for name in row}
    assert switches <= turned
    for settings in fusion_ablation.OFF.values():
        assert (from_mapping(FusionParameters, settings) == defaults) == (not settings)


def test_a_scene_can_be_run():
    footage = scene("clear", 100)
    short = footage[0][:8], footage[1][:8]
    assert run(short, 100).on_target == 1.0
    assert run(short, 100) == run(short, 100)


def test_a_sequence_is_found_alone_or_in_its_collection(tmp_path):
    (tmp_path / "otb" / "Suv").mkdir(parents=True)
    assert find_sequence(tmp_path, "Suv") == tmp_path / "otb" / "Suv"
    assert find_sequence(tmp_path / "otb", "Suv") == tmp_path / "otb" / "Suv"
    with pytest.raises(InputError, match="Car4"):
        find_sequence(tmp_path, "Car4")


class Stub:
    def __init__(self, seconds, log):
        self.seconds, self.log = seconds, log

    def start(self, frame, box, seed):
        self.log.append((self.seconds, "start", frame))

    def step(self, frame):
        self.log.append((self.seconds, "step", frame))
        return self.seconds


def test_the_cost_is_that_of_every_frame_but_the_first_in_turns():
    log = []
    followers = {"a": Stub(1.0, log), "b": Stub(2.0, log)}
    times = fusion_cost.step_times(followers, list(range(14)), BOX, [0, 1])
    assert times == {"a": [1.0] * 26, "b": [2.0] * 26}
    first_pass = log[: len(log) // 2]
    assert [seconds for seconds, what, _ in first_pass if what == "step"] == (
        [1.0] * 10 + [2.0] * 10 + [2.0] * 3 + [1.0] * 3
    )
    assert [frame for seconds, what, frame in first_pass if seconds == 1.0 and what == "step"] == (
        list(range(1, 14))
    )
