# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

import json

import pytest
from experiment_samples import SCENE, CountingCell, run_cells

from laboratory.result_store import ResultStore
from reproduction.runs.running import complete
from vehicle_pf_tracker.core.errors import InputError


def silent(done, total):
    pass


@pytest.fixture
def path(tmp_path):
    return tmp_path / "out" / "cells.jsonl"


def lines(path):
    return path.read_text().splitlines()


def test_results_do_not_depend_on_the_number_of_workers(tmp_path):
    cells = run_cells()
    one, two = (complete(cells, ResultStore(tmp_path / str(n)), n, silent) for n in (1, 2))
    assert list(one) == list(two) == cells
    assert json.dumps(list(one.values())) == json.dumps(list(two.values()))


class InterruptedHereError(Exception):
    pass


def test_what_was_interrupted_continues_and_comes_out_the_same(tmp_path, path):
    cells = run_cells(scenes=range(4))
    whole = complete(cells, ResultStore(tmp_path / "whole"), 1, silent)

    def interrupt(done, total):
        if done == 6:
            raise InterruptedHereError

    with pytest.raises(InterruptedHereError):
        complete(cells, ResultStore(path), 1, interrupt)
    assert len(lines(path)) == 6
    seen = []
    rest = complete(cells, ResultStore(path), 1, lambda *counts: seen.append(counts))
    assert json.dumps(list(rest.values())) == json.dumps(list(whole.values()))
    assert seen[-1] == (6, 6)
    assert len(lines(path)) == len(cells)


def test_nothing_is_run_twice(path):
    cells = run_cells()
    complete(cells, ResultStore(path), 1, silent)
    before = path.read_bytes()
    parts = []
    complete([*cells, *cells], ResultStore(path), 1, lambda *counts: parts.append(counts))
    assert path.read_bytes() == before
    assert parts == [(0, 0)]


def test_changed_parameters_are_run_anew(path):
    complete(run_cells(seeds=[0]), ResultStore(path), 1, silent)
    system = run_cells()[0].system.but({"sigma": 31.0})
    complete(run_cells(seeds=[0], system=system), ResultStore(path), 1, silent)
    assert len(lines(path)) == 4


def test_a_line_that_was_not_finished_is_dropped_and_run_anew(path):
    cells = run_cells()
    whole = complete(cells, ResultStore(path), 1, silent)
    text = path.read_bytes()
    path.write_bytes(text[:-40])
    parts = []
    again = complete(cells, ResultStore(path), 1, lambda *counts: parts.append(counts))
    assert parts == [(0, 1), (1, 1)]
    assert again == whole
    assert path.read_bytes() == text


def test_a_line_that_is_no_result_is_passed_over(path):
    cells = run_cells()
    complete(cells, ResultStore(path), 1, silent)
    path.write_text("nonsense\n[1]\n" + path.read_text())
    parts = []
    complete(cells, ResultStore(path), 1, lambda *counts: parts.append(counts))
    assert parts == [(0, 0)]


def test_cells_of_one_scene_share_its_rendering(path, monkeypatch):
    made = []
    make = type(SCENE).make
    monkeypatch.setattr(type(SCENE), "make", lambda self: made.append(self) or make(self))
    complete(run_cells(seeds=range(5), scenes=[0, 1]), ResultStore(path), 1, silent)
    assert made == [SCENE, SCENE.seeded(1)]


def test_cells_that_must_be_alone_are(path, monkeypatch):
    cells = [CountingCell("a"), CountingCell("b", alone=True), CountingCell("c", alone=True)]
    beside = []

    def run_here(function, batches, workers):
        beside.extend(batches)
        return ((batch, function(batch)) for batch in batches)

    monkeypatch.setattr("reproduction.runs.running.run_in_processes", run_here)
    results = complete(cells, ResultStore(path), 2, silent)
    assert {cell.name: result["frames"] for cell, result in results.items()} == {
        "a": SCENE.make().frame_count, "b": SCENE.make().frame_count,
        "c": SCENE.make().frame_count,
    }  # fmt: skip
    assert beside == [(cells[0],)]


def test_a_store_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="file"):
        ResultStore(tmp_path / "file" / "cells.jsonl")
