# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tables of fusion's results, from scores counted by hand."""

from collections import namedtuple
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from laboratory import readme_table
from laboratory.fusion import (
    ablation,
    case_lists,
    clips,
    fit,
    mechanisms,
    reliability,
    scene_pictures,
)
from laboratory.fusion.case_lists import listed_cases
from laboratory.fusion.objective import objective
from laboratory.fusion.settings import fitted
from laboratory.stress import Reliability, Result, Score
from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.trackers.estimate import Mode

Made = namedtuple("Made", "name kind sequence camera")


def score(on_target, recovered=0, judged=0, pairs=()):
    return Score(
        frames=10, visible=10, hidden=0, on_target=on_target, mean_iou=0.5, rmse_visible_px=1.0,
        lost=on_target < 0.9, recovered=recovered, judged=judged, occlusions=(), doubted=0.0,
        doubted_in_full_view=0.0, claimed_hidden=None, longest_false_tracking=0,
        reliability_visible=Reliability.of(list(pairs)), reliability_hidden=Reliability(),
        estimates="",
    )  # fmt: skip


def result(camera, on_target, system="default", kind="plain", **values):
    case = Made(f"{camera} {kind}", kind, f"{camera}/one", camera)
    return Result(case, system, 0, score(on_target, **values))


def test_a_change_is_compared_with_the_default_camera_by_camera():
    results = [
        result("a", 0.8, recovered=1, judged=1), result("b", 1.0),
        result("a", 0.6, "less", recovered=0, judged=1), result("b", 1.0, "less"),
    ]  # fmt: skip
    default, less = (ablation.row(name, results) for name in ("default", "less"))
    assert default == ["default", "0.900", "0.500", "1 of 1", "–", "–", "–"]
    assert less[:4] == ["less", "0.800", "0.500", "0 of 1"]
    assert less[4].startswith("-0.100 (-0.200 +0.000")
    assert less[5].startswith("+0.000")
    assert less[6].startswith("-1.000")


def test_every_change_of_the_ablation_is_a_parameter():
    for change in ablation.CHANGES.values():
        ablation.variant_system("fusion", change).make(0)


def test_without_a_mechanism_only_what_it_needs_is_replaced():
    def values():
        return [vars(one.owner)[one.name] for one in mechanisms.WHOLE]

    whole = values()
    for name, replaced in mechanisms.MECHANISMS.items():
        mechanisms.made_without(name, 0)
        changed = sum(now is not before for now, before in zip(values(), whole, strict=True))
        assert changed == len(replaced)
    mechanisms.made_without(mechanisms.DEFAULT, 0)
    assert values() == whole


def test_the_table_of_the_readme_has_means_and_sums(tmp_path):
    table = tmp_path / "baselines.csv"
    table.write_text(
        "baseline,on_target,mean_iou,recovered,judged\n"
        "csrt,1.000,0.400,0,1\ncsrt,0.500,0.300,2,2\nnanotrack_v2,1.000,1.000,1,1\n"
    )
    rows = readme_table.of_baselines(table)
    assert readme_table.cells("CSRT", rows["csrt"]) == ["CSRT", ".750", ".350", "2 of 3"]
    assert readme_table.cells("Nano", rows["nanotrack_v2"]) == ["Nano", "1.000", "1.000", "1 of 1"]
    assert not any(readme_table.of_baselines(tmp_path / "none.csv").values())


def test_the_calibration_error_is_pooled_over_frames_and_names_the_worst_sequence():
    """Nine right frames at 1.0 and one wrong at 0.8: gap 0.08; of the second sequence 0.8."""
    results = [
        result("a", 1.0, pairs=[(1.0, True)] * 9),
        result("b", 0.0, kind="wall", pairs=[(0.8, False)]),
    ]
    table = reliability.reliability_table(results)
    assert "| all | 10 | 0.080 |" in table
    assert "| plain | 9 | 0.000 |" in table
    assert "| wall | 1 | 0.800 |" in table
    assert "| all but b/one | 9 | 0.000 |" in table


def test_the_figure_has_a_line_for_plain_and_one_for_harder_cases(tmp_path):
    results = [
        result("a", 1.0, pairs=[(0.95, True), (0.95, False), (0.25, False)]),
        result("b", 0.0, kind="wall", pairs=[(0.85, False)]),
    ]
    above = reliability.reliability_figure(results).axes[0]
    ideal, plain, hard = (line.get_xydata().tolist() for line in above.lines)
    assert ideal == [[0, 0], [1, 1]]
    assert plain == [[0.25, 0], [pytest.approx(0.95), 0.5]]
    assert hard == [[0.85, 0]]


@pytest.mark.slow
def test_a_picture_may_have_a_row_that_is_not_full(tmp_path):
    short = scene_pictures.Picture("short", "turn", 0, (1, 2, 3, 4))
    scene_pictures.draw_pictures(tmp_path, [short])
    assert (tmp_path / "short.webp").stat().st_size > 0


def drive(first, last, speed):
    """Boxes of a vehicle that ends at the right border of an image of 200 x 100 px."""
    return {
        time: Box.around((195 + speed * (time - last), 50), 20, 10)
        for time in range(first, last + 1)
    }


def test_only_vehicles_that_drive_out_well_before_the_clip_ends_are_judged():
    boxes = {1: drive(0, 40, 4), 2: drive(0, 40, 0.1), 3: drive(100, 160, 3), 4: drive(0, 10, 4)}
    sure = {identity: set(own) for identity, own in boxes.items()}
    runs = clips.leaving(boxes, sure, (200, 100), 180)
    assert [(run.identity, run.first, run.last) for run in runs] == [(1, 0, 40)]


def test_a_start_is_free_of_others():
    """The boxes of both overlap until frame 4."""
    boxes = {1: drive(0, 40, 4), 2: drive(0, 40, 4)}
    boxes[2] = {time: boxes[2][time] for time in range(5)}
    runs = clips.leaving(boxes, {1: set(boxes[1]), 2: set()}, (200, 100), 180)
    assert [(run.identity, run.first) for run in runs] == [(1, 5)]


def test_look_alikes_leave_on_both_sides():
    clip = clips.look_alikes(200)
    runs = clips.leaving(clip.boxes, clip.sure, (640, 360), 200)
    assert {clip.boxes[run.identity][run.last].x < 320 for run in runs} == {False, True}


def test_seeds_are_judged_apart():
    one = clips.Run(1, 0, 2)
    assert replace(one, seed=1).claims is not one.claims


def test_tracking_counts_once_the_vehicle_has_left():
    """On target in one of two frames; of four later ones one is claimed, on another vehicle."""
    run, gone = clips.Run(1, 0, 2), clips.GRACE + 2
    right, other = Box(0, 0, 9, 9), Box(80, 0, 9, 9)
    boxes = {1: {1: right, 2: right}, 2: {gone + 2: other}}
    shown = {1: (right, Mode.TRACKING), 2: (other, Mode.TRACKING), gone: (right, Mode.TRACKING)}
    shown |= {gone + 2: (other, Mode.TRACKING)}
    for frame in range(1, gone + 5):
        box, mode = shown.get(frame, (other, Mode.LOST))
        run.take(frame, SimpleNamespace(box=box, mode=mode), boxes)
    assert clips.row("clip", [run]) == ["clip", "1", "0.500", "4", "0.250", "0.250", "1"]


def test_a_camera_has_no_part_in_the_fit_that_is_judged_on_it():
    """Setting 1 is best on camera a only; without a, setting 0 is."""
    settings = [{"x": 1.0}, {"x": 4.0}]
    by_camera = [{"a": 0.0, "b": 2.0}, {"a": 9.0, "b": 1.0}]
    assert fitted(settings, by_camera) == {"x": 4.0}
    assert fitted(settings, by_camera, "a") == {"x": 1.0}


def test_the_objective_by_hand():
    assert objective(score(0.8, recovered=1, judged=2)) == pytest.approx(0.8 + 0.5 + 0.5)
    assert objective(score(0.8)) == pytest.approx(0.8 + 0.5 + 1.0)
    doubts = replace(score(0.8), doubted=0.1, claimed_hidden=0.2)
    assert objective(doubts) == pytest.approx(0.8 + 0.5 + 1.0 - 0.3)


def make_options(tmp_path, **values):
    cameras = tmp_path / "cameras.csv"
    cameras.write_text("")
    given = {"sequences": [tmp_path], "cameras": cameras, "output": tmp_path, "seed": 0, "cases": 1}
    return SimpleNamespace(**given | values)


@pytest.fixture
def listing(monkeypatch):
    """Calls that list cases anew; each has a case of camera a alone."""
    calls = []

    def list_cases(sources, **choice):
        calls.append(choice)
        return [Made("case", "plain", "a/one", "a")]

    monkeypatch.setattr(case_lists, "find_sequences", lambda folders, cameras: [])
    monkeypatch.setattr(case_lists, "list_cases", list_cases)
    return calls


def test_cases_are_listed_once_for_the_same_options(tmp_path, listing):
    for _ in range(2):
        listed_cases(make_options(tmp_path), "plain_cases", ("plain",), per_sequence=1)
    assert len(listing) == 1


@pytest.mark.parametrize(
    ("changed", "limit"), [({"seed": 1}, 1), ({"sequences": [Path("elsewhere")]}, 1), ({}, 2)]
)
def test_other_options_list_other_cases(tmp_path, listing, changed, limit):
    listed_cases(make_options(tmp_path), "plain_cases", ("plain",), per_sequence=1)
    other = make_options(tmp_path, **changed)
    listed_cases(other, "plain_cases", ("plain",), per_sequence=limit)
    assert len(listing) == 2


def test_one_camera_alone_cannot_be_left_out(tmp_path, listing):
    with pytest.raises(InputError, match="all sequences are of the camera a"):
        fit.fit(make_options(tmp_path))
