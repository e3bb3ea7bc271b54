# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The grid on a cluster of this machine, of two worker processes."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from grid_samples import here, make_plan, results, silent, system, write_recordings

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.evaluation.grid.cells import BaselineSystem
from vehicle_pf_tracker.evaluation.grid.running import complete, on_cluster, run_checked

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def cluster():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as made:
        yield made


@pytest.fixture
def plan(tmp_path):
    paths = [f"file://{path}" for path in write_recordings(tmp_path / "recordings")]
    return make_plan(paths, seeds=range(8))


@pytest.mark.slow
def test_a_worker_killed_halfway_costs_nothing_and_gives_nothing_twice(cluster, plan, tmp_path):
    with distributed.Client(cluster.scheduler_address, set_as_default=False) as client:
        pids = list(client.run(os.getpid).values())
    ended = []

    def kill_one(cells):
        for turn in on_cluster(cluster.scheduler_address)(cells):
            if turn.ended is not None:
                ended.append(turn.ended[0])
                if len(ended) == len(cells) // 2:
                    os.kill(pids[0], signal.SIGKILL)
            yield turn

    complete(plan, tmp_path / "cluster", kill_one, silent)
    assert len(ended) == len(set(ended)) == len(plan.cells()) == 18
    complete(plan, tmp_path / "here", here, silent)
    assert results(tmp_path / "cluster") == results(tmp_path / "here")
    assert complete(plan, tmp_path / "cluster", on_cluster("tcp://not.asked:1"), silent) == 0


def test_what_cannot_run_there_says_why(cluster, tmp_path):
    paths = write_recordings(tmp_path / "recordings")[:1]
    plan = make_plan(paths, [BaselineSystem("mil", str(tmp_path / "none"))])
    reasons = []

    def listening(cells):
        for turn in on_cluster(cluster.scheduler_address)(cells):
            reasons.extend([turn.ended[1].reason] if turn.ended else [])
            yield turn

    complete(plan, tmp_path / "out", listening, silent)
    assert ["there is no interpreter" in reason for reason in reasons] == [True]


def test_a_worker_with_other_versions_refuses(tmp_path):
    (cell,) = make_plan(write_recordings(tmp_path)[:1], [system("ms")]).cells()
    assert "other versions" in run_checked(cell, "0").reason
    assert run_checked(cell, cell.key()).metrics is not None


def test_a_scheduler_that_does_not_answer_is_named(plan, tmp_path):
    with pytest.raises(InputError, match="cannot reach a Dask scheduler at tcp:"):
        complete(plan, tmp_path, on_cluster("tcp://127.0.0.1:1", seconds=0.5), silent)


def test_a_cluster_without_workers_is_named(plan, tmp_path):
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as empty,
        pytest.raises(InputError, match="has no workers; start `dask worker`"),
    ):
        complete(plan, tmp_path, on_cluster(empty.scheduler_address), silent)


def start_dask(module, *words):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-m", f"distributed.cli.{module}", "--no-dashboard", *words]
    return subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)


@pytest.fixture
def scheduler(tmp_path):
    """A scheduler in a process of its own, with one worker; gives its address and process."""
    file = tmp_path / "scheduler.json"
    with start_dask("dask_scheduler", "--port", "0", "--scheduler-file", str(file)) as process:
        while process.poll() is None and not (file.exists() and file.read_text()):
            time.sleep(0.05)
        address = json.loads(file.read_text())["address"]
        with start_dask("dask_worker", address, "--nthreads", "1", "--no-nanny") as worker:
            with distributed.Client(address, set_as_default=False) as client:
                client.wait_for_workers(1)
            yield address, process
            worker.kill()
        process.kill()


@pytest.mark.slow
def test_a_scheduler_killed_halfway_is_one_sentence_and_the_results_are_kept(
    scheduler, plan, tmp_path, capfd
):
    address, process = scheduler
    ended = []

    def kill(cells):
        for turn in on_cluster(address)(cells):
            ended.extend([turn.ended[0]] if turn.ended else [])
            if len(ended) == 3:
                process.kill()
            yield turn

    with pytest.raises(InputError, match=r"was lost on the way; start it .* again"):
        complete(plan, tmp_path / "out", kill, silent)
    assert "Traceback" not in capfd.readouterr().err
    kept = list(Path(tmp_path / "out" / "cells").glob("*/*/*/metrics.json"))
    assert len(kept) == len(ended)
    rest = len(plan.cells()) - len(ended)
    assert complete(plan, tmp_path / "out", here, silent) == rest
