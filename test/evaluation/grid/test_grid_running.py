# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import itertools
import json
from dataclasses import replace
from types import MappingProxyType

import pytest
from drive import box_of, frame_of, stamp_of
from evaluation_samples import (
    FRAMES,
    HIDDEN,
    here,
    make_plan,
    results,
    silent,
    system,
    write_recording,
    write_recordings,
)

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.baselines import BaselineAnswer
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.grid import running, sources
from vehicle_pf_tracker.evaluation.grid.running import complete, on_this_machine
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder
from vehicle_pf_tracker.evaluation.systems import System
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.recordings.bags.writer import RecordingWriter


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    return write_recordings(tmp_path_factory.mktemp("recordings"))


@pytest.fixture
def plan(recordings):
    return make_plan(recordings)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out"


def test_every_cell_is_in_the_folder_as_run_writes_it(plan, out):
    assert complete(plan, out, here, silent) == 6  # ms, which draws nothing, runs one seed
    folder = EvaluationFolder(out)
    assert [entry.name for entry in folder.recordings] == list(HIDDEN)
    assert [entry["deterministic"] for entry in folder.plan["systems"]] == [False, True]
    assert [entry["seeds"] for entry in folder.plan["systems"]] == [[0, 1], [0]]
    for recording in HIDDEN:
        assert len(folder.truth(recording)) == FRAMES
        for name, seed in (("pf", 0), ("pf", 1), ("ms", 0)):
            rows, run = folder.cell(recording, name, seed)
            assert len(rows) == FRAMES
            assert run["seed"] == seed
            assert run["variant"] == name
    metrics = json.loads((out / "cells" / "free" / "pf" / "seed-1" / "metrics.json").read_text())
    assert metrics["rmse_px"] < 6


def test_results_do_not_depend_on_the_number_of_workers(plan, tmp_path):
    complete(plan, tmp_path / "here", here, silent)
    complete(plan, tmp_path / "two", on_this_machine(2), silent)
    assert results(tmp_path / "two") == results(tmp_path / "here")


class InterruptedHereError(Exception):
    pass


def test_what_was_interrupted_goes_on_and_comes_out_the_same(plan, tmp_path, out):
    complete(plan, tmp_path / "whole", here, silent)

    def interrupt(done, total):
        if done == 4:
            raise InterruptedHereError

    with pytest.raises(InterruptedHereError):
        complete(plan, out, here, interrupt)
    told = []
    assert complete(plan, out, here, lambda *counts: told.append(counts)) == 2
    assert told == [(0, 2), (1, 2), (2, 2)]
    assert results(out) == results(tmp_path / "whole")


def test_what_is_there_is_not_run_again(plan, out):
    complete(plan, out, here, silent)
    before = {path: path.stat().st_mtime_ns for path in out.glob("cells/**/*")}
    assert complete(plan, out, here, silent) == 0
    assert {path: path.stat().st_mtime_ns for path in out.glob("cells/**/*")} == before


@pytest.mark.parametrize(
    "harm",
    [lambda run: run.write_text("[" * 100_000), lambda run: run.write_text("{}"),
     lambda run: run.unlink()],
)  # fmt: skip
def test_a_cell_whose_description_is_damaged_is_run_again(plan, out, harm):
    complete(plan, out, here, silent)
    whole = results(out)
    harm(out / "cells" / "free" / "pf" / "seed-1" / "run.json")
    assert complete(plan, out, here, silent) == 1
    assert results(out) == whole


def test_only_what_changed_is_run_anew(recordings, plan, out):
    complete(plan, out, here, silent)
    changed = make_plan(recordings, [system("pf", sigma=3.0), system("ms")])
    assert complete(changed, out, here, silent) == 4
    assert complete(make_plan(recordings, seeds=(0, 1, 2)), out, here, silent) == 6


def test_systems_that_would_share_a_folder_are_refused(recordings):
    alike = [system("pf", "pf@a:b"), system("pf", "pf@a/b")]
    with pytest.raises(InputError, match="several systems would be called pf@a/b"):
        make_plan(recordings, alike)


def test_whatever_decides_a_run_is_in_its_key(recordings):
    cell = make_plan(recordings, [system("pf")]).cells()[0]
    others = [
        replace(cell, max_diff=0.02),
        replace(cell, seed=5),
        replace(cell, restart=5),
        replace(cell, source=replace(cell.source, topic="/rear")),
        replace(cell, source=replace(cell.source, digest="0")),
        replace(cell, system=system("pf", sigma=3.0)),
        replace(cell, system=system("ms")),
    ]
    assert len({one.key() for one in (cell, *others)}) == 8
    renamed = replace(cell, source=replace(cell.source, name="other", path="/elsewhere"))
    assert renamed.key() == cell.key()


def test_a_recording_that_changed_since_it_was_planned_is_no_result(tmp_path, out):
    path = write_recording(tmp_path / "rec")
    plan = make_plan([path], [system("ms")])
    file = next(path.glob("*.mcap"))
    file.write_bytes(file.read_bytes() + b"\0")
    complete(plan, out, here, silent)
    with pytest.raises(InputError, match="changed since it was planned"):
        EvaluationFolder(out).cell("rec", "ms", 0)


def test_what_a_killed_run_left_half_written_goes(plan, out):
    half = out / "cells" / "free" / "pf" / ".seed-0.123.partial"
    half.mkdir(parents=True)
    complete(plan, out, here, silent)
    assert not list(out.rglob("*.partial"))


def test_what_cannot_run_says_why_and_is_tried_again(recordings, out, tmp_path):
    plan = make_plan(recordings, [System.of_baseline("csrt", str(tmp_path / "none")), system("ms")])
    assert complete(plan, out, here, silent) == 4
    folder = EvaluationFolder(out)
    with pytest.raises(InputError, match="there is no interpreter"):
        folder.cell("free", "baseline:csrt", 0)
    assert folder.cell("free", "ms", 0)
    assert complete(plan, out, here, silent) == 2


def test_a_fault_of_the_program_costs_only_its_cell(plan, out, monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("so")

    monkeypatch.setattr("vehicle_pf_tracker.trackers.papers.ms.MsTracker.start", broken)
    complete(plan, out, here, silent)
    folder = EvaluationFolder(out)
    with pytest.raises(InputError, match="ZeroDivisionError"):
        folder.cell("free", "ms", 0)
    assert folder.cell("free", "pf", 0)


def test_a_variant_without_particles_does_not_depend_on_the_seed(recordings, tmp_path):
    plan = make_plan(recordings[:1], [system("ms")], seeds=(0,))
    other = make_plan(recordings[:1], [system("ms")], seeds=(7,))
    complete(plan, tmp_path / "a", here, silent)
    complete(other, tmp_path / "b", here, silent)
    rows = [
        results(tmp_path / name)[f"cells/bridge/ms/seed-{seed}/estimates.csv"]
        for name, seed in (("a", 0), ("b", 7))
    ]
    assert rows[0] == rows[1]


@pytest.mark.parametrize(("most", "times"), [(sources.FRAMES_BYTES, 1), (0, 3)])
def test_a_recording_is_decoded_once_for_all_its_cells_if_it_fits_into_memory(
    plan, tmp_path, monkeypatch, most, times
):
    complete(plan, tmp_path / "kept", here, silent)
    read, frames = [], Recording.frames
    monkeypatch.setattr(Recording, "frames", lambda *a: read.append(a[0].path.name) or frames(*a))
    monkeypatch.setattr(sources, "FRAMES_BYTES", most)
    monkeypatch.setattr(sources, "HELD", {})
    complete(plan, tmp_path / "out", here, silent)
    assert results(tmp_path / "out") == results(tmp_path / "kept")
    assert read == ["bridge"] * times + ["free"] * times


@pytest.fixture
def lost(tmp_path):
    """A recording that is cut in the middle: `ms` does not follow the vehicle across it."""
    path = tmp_path / "lost"
    with RecordingWriter(path) as writer:
        for index in range(FRAMES):
            shown = index if index < FRAMES // 3 else FRAMES - index
            writer.write_image(stamp_of(index), frame_of(shown))
            writer.write_truth(Truth(stamp_of(index), box_of(shown), Occlusion.NONE))
    return path


def test_restarts_are_a_second_run_beside_the_first(lost, tmp_path):
    systems = [system("ms"), system("pf")]
    once = make_plan([lost], systems)
    again = replace(once, restart=5)
    complete(once, tmp_path / "once", here, silent)
    complete(again, tmp_path / "again", on_this_machine(2), silent)
    folder = EvaluationFolder(tmp_path / "again")
    rows, run = folder.cell("lost", "ms", 0)
    assert run["restart"] == 5
    without, _ = EvaluationFolder(tmp_path / "once").cell("lost", "ms", 0)
    assert [row.position for row in rows] == [row.position for row in without]
    restarted = folder.restarted("lost", "ms", 0)
    failed = FRAMES // 3 + 1
    assert [row.frame for row in restarted] == list(range(1, FRAMES + 1))
    assert [row.frame for row in restarted if row.mode == "WAITING"] == list(
        range(failed + 1, failed + 5)
    )
    assert restarted[failed + 4].box == box_of(FRAMES - failed - 4)
    assert EvaluationFolder(tmp_path / "once").restarted("lost", "ms", 0) == []
    cell = tmp_path / "again" / "cells" / "lost" / "ms" / "seed-0"
    metrics = json.loads((cell / "metrics.json").read_text())
    assert metrics["restarts"]["failures"] == 1
    assert metrics["restarts"]["accuracy"] > 0.7
    scored = {(run.system, run.seed): run.metrics for run in score_folder(folder).runs}
    assert scored["ms", 0].restart_failures == 1
    assert scored["ms", 0].to_json()["restarts"] == metrics["restarts"]


def test_a_run_with_other_restarts_is_run_again_and_not_shown(lost, tmp_path):
    out = tmp_path / "out"
    plans = [replace(make_plan([lost], [system("ms")]), restart=wait) for wait in (None, 5, 8)]
    assert len({plan.cells()[0].key() for plan in plans}) == 3
    complete(plans[1], out, here, silent)
    plans[2].write(out)
    assert EvaluationFolder(out).restarted("lost", "ms", 0) == []
    assert [complete(plan, out, here, silent) for plan in plans] == [1, 1, 1]


def test_a_baseline_is_started_anew_in_a_process_of_its_own(lost, tmp_path, monkeypatch):
    made = []

    class Standing:
        name = "csrt"
        versions = MappingProxyType({"opencv": "4"})

        def __enter__(self):
            made.append(self)
            return self

        def __exit__(self, *failure):
            pass

        def start(self, frame, box):
            self.box = box
            return BaselineAnswer(box, True, 0.0)

        def step(self, frame):
            return BaselineAnswer(self.box, True, 0.0)

    monkeypatch.setattr(running, "Baseline", lambda *_: Standing())
    plan = replace(make_plan([lost], [System.of_baseline("csrt")]), restart=1)
    complete(plan, tmp_path / "out", here, silent)
    restarted = EvaluationFolder(tmp_path / "out").restarted("lost", "baseline:csrt", 0)
    assert [row.frame for row in restarted] == list(range(1, FRAMES + 1))
    # A box of 16 px that stands is left behind after eight frames of 2 px.
    assert restarted[8].box == box_of(0)
    assert restarted[9].box == box_of(9)
    assert len(made) == 1 + sum(a.box != b.box for a, b in itertools.pairwise(restarted))
