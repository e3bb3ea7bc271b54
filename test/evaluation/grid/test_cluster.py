# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The grid on a real Dask scheduler, with two worker processes in folders of their own."""

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest
from dask_processes import scheduler, wait_until_missed, workers
from evaluation_samples import here, make_plan, results, silent, system, write_recordings

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.grid.running import complete, on_cluster, run_cell
from vehicle_pf_tracker.workers import cluster
from vehicle_pf_tracker.workers.cluster import call_if_alike, fingerprint, run_on_cluster


@pytest.fixture(scope="module")
def running_scheduler(tmp_path_factory):
    with scheduler(tmp_path_factory.mktemp("cluster") / "scheduler") as (found, _):
        yield found


@pytest.fixture
def address(running_scheduler):
    """A scheduler without workers, as it has to be again before the next test."""
    yield running_scheduler
    wait_until_missed(running_scheduler)


@pytest.fixture
def plan(tmp_path):
    paths = [f"file://{path}" for path in write_recordings(tmp_path / "recordings")]
    return replace(make_plan(paths, seeds=range(4)), restart=5)


def test_a_worker_killed_halfway_costs_nothing_and_gives_nothing_twice(address, plan, tmp_path):
    done, notices = [], []
    with workers(address, tmp_path, 2) as children:

        def kill_one(cells):
            for cell, outcome in on_cluster(address, notices.append)(cells):
                done.append(cell)
                if len(done) == len(cells) // 2:
                    children[0].kill()
                yield cell, outcome

        assert complete(plan, tmp_path / "cluster", kill_one, silent) == len(plan.cells())
    assert len(done) == len(set(done)) == len(plan.cells()) == 10
    complete(plan, tmp_path / "here", here, silent)
    assert results(tmp_path / "cluster") == results(tmp_path / "here")
    assert "2 workers on 1 machine; the dashboard is http" in notices[0]
    # A second run continues: nothing is left, and nobody is asked.
    assert complete(plan, tmp_path / "cluster", on_cluster("tcp://not.asked:1"), silent) == 0
    runs = list((tmp_path / "cluster").glob("cells/*/*/*/run.json"))
    assert {json.loads(path.read_text())["host"] for path in runs} == {os.uname().nodename}


def test_a_scheduler_lost_on_the_way_is_one_sentence_and_keeps_results(plan, tmp_path, capfd):
    done = []
    with (
        scheduler(tmp_path / "scheduler") as (address, child),
        workers(address, tmp_path, 1),
    ):

        def end_scheduler(cells):
            for cell, outcome in on_cluster(address)(cells):
                done.append(cell)
                if len(done) == 3:
                    child.kill()
                yield cell, outcome

        with pytest.raises(InputError, match=r"was lost on the way; start it .* again"):
            complete(plan, tmp_path / "out", end_scheduler, silent)
    assert "Traceback" not in capfd.readouterr().err
    assert len(list((tmp_path / "out").glob("cells/*/*/*/metrics.json"))) == len(done)
    rest = len(plan.cells()) - len(done)
    assert complete(plan, tmp_path / "out", here, silent) == rest


def test_a_worker_of_another_version_is_named_with_what_differs(address, tmp_path, monkeypatch):
    cells = make_plan(write_recordings(tmp_path)[:1], [system("ms")]).cells()
    monkeypatch.setattr(cluster, "versions", lambda: {"numpy": "0.1"})
    with workers(address, tmp_path, 1), pytest.raises(InputError) as error:
        list(on_cluster(address)(cells))
    assert "would give other numbers" in str(error.value)
    assert "instead of 0.1; install the same everywhere" in str(error.value)


def test_a_worker_that_joins_on_the_way_is_compared_too(tmp_path):
    (cell,) = make_plan(write_recordings(tmp_path)[:1], [system("ms")]).cells()
    with pytest.raises(InputError, match="instead of 0"):
        call_if_alike(run_cell, cell, {**fingerprint(), "code": "0"})
    assert call_if_alike(run_cell, cell, fingerprint()).metrics is not None


def test_a_scheduler_that_does_not_answer_is_named():
    with pytest.raises(InputError, match="no Dask scheduler answers at tcp:"):
        list(run_on_cluster(len, [()], address="tcp://127.0.0.1:1", key=str, seconds=0.5))


def test_a_cluster_without_workers_is_named(address):
    with pytest.raises(InputError, match="has no workers: start `dask worker tcp:"):
        list(run_on_cluster(len, [()], address=address, key=str))


def test_a_recording_that_a_worker_does_not_have_is_that_cells_failure(address, tmp_path):
    (path,) = write_recordings(tmp_path / "recordings")[:1]
    plan = make_plan([path], [system("ms")])
    with workers(address, tmp_path, 1):
        for file in Path(path).iterdir():
            file.unlink()
        ((_, outcome),) = on_cluster(address)(plan.cells())
    assert outcome.metrics is None
    assert str(path) in outcome.reason
