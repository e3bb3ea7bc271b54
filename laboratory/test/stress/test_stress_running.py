# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Which cases are run, and that results depend on nothing else."""

import functools
import importlib
import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from laboratory.stress import (
    StressSystem,
    full_battery,
    list_cases,
    quick_battery,
    run_battery,
    run_case,
    variant_system,
)
from laboratory.stress.battery import QUICK_FRAMES, QUICK_PER_SEQUENCE
from vehicle_pf_tracker.core.errors import InputError


def test_a_battery_is_deterministic_and_its_names_are_unique(drive, battery):
    assert full_battery([drive]) == battery
    assert len({case.name for case in battery}) == len(battery) > 50
    assert full_battery([drive], seed=1) != battery


def test_the_quick_battery_is_short_and_of_every_group(drive):
    cases = quick_battery([drive])
    assert len(cases) == QUICK_PER_SEQUENCE
    assert all(case.count <= QUICK_FRAMES for case in cases)
    assert sum(case.kind in {"wall", "pole", "lorry"} for case in cases) == 3
    assert len({case.kind for case in cases}) >= 6


def test_subsets_are_drawn_from_the_battery(drive, battery):
    assert set(list_cases([drive], per_sequence=20)) <= set(battery)
    assert len(list_cases([drive], per_sequence=20)) == 20
    assert len(list_cases([drive], per_sequence=10_000)) == len(battery)
    assert list_cases([drive], kinds=["jpeg", "shake"], limit=2) == [
        case for case in battery if case.name.endswith(("jpeg/30", "shake/0.01"))
    ]
    with pytest.raises(InputError, match=r"no kind 'rain'; the kinds are plain"):
        list_cases([drive], kinds=["rain"])


def test_shortened_occlusions_keep_what_they_are_judged_by(drive):
    shortened = list_cases([drive], kinds=["wall", "lorry"], max_frames=90)
    assert shortened
    for case in shortened:
        assert case.count <= 90
        hidden = [i for i, t in enumerate(case.truths()) if t.occlusion == 2]
        assert len(hidden) == int(case.label("hidden"))
        assert case.count - 1 - hidden[-1] >= 20


@pytest.fixture(scope="module")
def few(battery):
    kinds = {"mirrored", "dropped_frames", "noise", "wall"}
    return [case for case in battery if case.kind in kinds][:3]


@pytest.mark.slow
def test_results_do_not_depend_on_workers_and_resume(few, tmp_path):
    systems = [variant_system("ms"), variant_system("pf", {"num_particles": 30}, "pf30")]
    store = tmp_path / "scores.jsonl"
    alone = run_battery(few, systems, seeds=(0, 1), workers=0, store=store)
    many = run_battery(few, systems, seeds=(0, 1), workers=2)
    assert alone == many
    assert [(r.system, r.seed) for r in alone].count(("ms", 0)) == len(few)  # deterministic: once
    assert [(r.system, r.seed) for r in alone].count(("pf30", 1)) == len(few)
    lines = store.read_text().splitlines()
    assert len(lines) == len(alone) == 3 * len(few)
    store.write_text("\n".join(lines[:4]) + "\n" + lines[4][:50])
    steps = []
    again = run_battery(
        few,
        systems,
        seeds=(0, 1),
        workers=0,
        store=store,
        on_progress=lambda done, total: steps.append(done),
    )
    assert again == alone
    assert steps[0] == 4
    assert steps[-1] == len(alone)


def test_other_parameters_and_seeds_are_other_results(few, tmp_path):
    store = tmp_path / "scores.jsonl"
    for particles in (20, 40):
        system = variant_system("pf", {"num_particles": particles})
        run_battery(few[:1], [system], seeds=(0, 1), workers=0, store=store)
    keys = [json.loads(line)["key"] for line in store.read_text().splitlines()]
    assert len(set(keys)) == 4


def test_a_change_of_the_code_that_makes_a_tracker_is_another_system(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    file = tmp_path / "mine_under_test.py"
    file.write_text("def make(seed): ...")
    system = StressSystem("mine", importlib.import_module("mine_under_test").make)
    before = system.identity()
    assert system.identity() == before
    file.write_text("def make(seed): return 1")
    assert system.identity() != before
    assert StressSystem("mine", system.make, {"version": 2}).identity() != system.identity()


class Perfect:
    """Knows the truth."""

    def __init__(self, case, seed):
        self.truths = iter(case.truths())

    def start(self, frame, box):
        return self.step(frame)

    def step(self, frame, elapsed=1.0):
        box = next(self.truths).box
        x, y = box.centre
        scalars = {
            "mode": "TRACKING", "x": x, "y": y, "width": box.width, "height": box.height,
            "confidence": 1.0,
        }  # fmt: skip
        return SimpleNamespace(scalars=lambda: scalars)


def test_anything_that_starts_and_steps_can_be_run(battery):
    for case in battery[::9]:
        system = StressSystem("perfect", functools.partial(Perfect, case))
        score = run_case(case, system)
        assert (score.on_target, score.lost, score.longest_false_tracking) == (1.0, False, 0)
        assert score.mean_iou == pytest.approx(1.0)
        assert score.reliability_visible.calibration_error == 0.0
        assert score.recovered == score.judged


def broken(seed):
    raise RuntimeError("out of order")


def test_a_fault_of_a_tracker_is_told_and_costs_only_its_case(few):
    results = run_battery(few[:2], [StressSystem("broken", broken)], workers=0)
    assert [r.score.on_target for r in results] == [0.0, 0.0]
    assert "out of order" in results[0].score.fault


@pytest.mark.slow
def test_the_documented_example_runs(drive, tmp_path, monkeypatch, capsys):
    text = (Path(__file__).parents[3] / "laboratory" / "notes" / "stress.md").read_text()
    (example,) = [part for part in text.split("```") if "stress import" in part]
    (tmp_path / "recordings").symlink_to(Path(drive.source.path).parents[1])
    monkeypatch.chdir(tmp_path)
    exec(example.removeprefix("python"), {})
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2
    assert "/lorry/" in lines[0]
    assert " straight " in lines[0]
