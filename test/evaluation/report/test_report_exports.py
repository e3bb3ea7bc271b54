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

"""Recordings with estimates, for other tools: evo, Foxglove."""

import shutil
from types import SimpleNamespace

import pytest
from evaluation_samples import HIDDEN, SEEDS, VARIANTS
from rosbags.rosbag2 import Reader

from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.report import write_report
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder, topic_name


@pytest.fixture(scope="module")
def exported(made_evaluation, tmp_path_factory):
    folder = shutil.copytree(made_evaluation, tmp_path_factory.mktemp("exported") / "evaluation")
    told = []
    write_report(folder, images=False, recordings=True, notify=told.append)
    assert told == []
    return folder


@pytest.fixture(scope="module")
def runs(made_evaluation):
    return score_folder(EvaluationFolder(made_evaluation)).runs


@pytest.fixture(scope="module")
def evo():
    """Names of evo that the tests use."""
    names = ("core.metrics", "core.sync", "tools.file_interface")
    reason = "evo is not installed"
    modules = [pytest.importorskip(f"evo.{name}", reason=reason) for name in names]
    return SimpleNamespace(metrics=modules[0], sync=modules[1], files=modules[2])


def rmse(evo, true, estimated):
    metrics, sync = evo.metrics, evo.sync
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data(sync.associate_trajectories(true, estimated))
    return ape.get_statistic(metrics.StatisticsType.rmse)


def test_evo_agrees_on_the_rmse_of_the_recording(evo, exported, runs):
    for run in runs:
        with Reader(exported / "estimates" / run.recording) as reader:
            true = evo.files.read_bag_trajectory(reader, "/ground_truth/position")
            topic = f"/{topic_name(run.system, run.seed)}/position"
            estimated = evo.files.read_bag_trajectory(reader, topic)
        assert rmse(evo, true, estimated) == pytest.approx(run.metrics.rmse_px, abs=1e-9)
    assert len(runs) == len(HIDDEN) * (len(VARIANTS) * len(SEEDS) - 1)


@pytest.mark.parametrize(
    ("system", "name"),
    [
        ("apf", "apf/seed_3"),
        ("baseline:csrt", "baseline_csrt/seed_3"),
        ("2nd-try", "_2nd_try/seed_3"),
    ],
)
def test_topics_are_names_that_ros_takes(system, name):
    assert topic_name(system, 3) == name


def test_recordings_that_are_gone_are_told(made_evaluation, evaluation_copy, tmp_path):
    plan = (evaluation_copy / "evaluation.json").read_text()
    beside = str(made_evaluation.parent)
    (evaluation_copy / "evaluation.json").write_text(plan.replace(beside, str(tmp_path / "gone")))
    told = []
    write_report(evaluation_copy, images=False, recordings=True, notify=told.append)
    assert sum("with estimates" in sentence for sentence in told) == len(HIDDEN)
