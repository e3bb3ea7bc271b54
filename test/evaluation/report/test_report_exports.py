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

"""Exports for other tools: evo, video players, Foxglove."""

import shutil
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from evaluation_samples import FRAMES, HIDDEN, SEEDS, VARIANTS
from rosbags.rosbag2 import Reader

from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.report import ReportOptions, write_report
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder, topic_name
from vehicle_pf_tracker.evaluation.report.video import frame_rate

OPTIONS = ReportOptions(images=False, video=True, recordings=True, trajectories=True)


@pytest.fixture(scope="module")
def exported(made_evaluation, tmp_path_factory):
    folder = tmp_path_factory.mktemp("exported") / "evaluation"
    shutil.copytree(made_evaluation, folder)
    told = []
    paths = write_report(folder, OPTIONS, told.append).paths
    assert told == []
    return folder, paths


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


def test_evo_agrees_on_the_rmse_of_the_trajectories(evo, exported, runs):
    folder, _ = exported
    for run in runs:
        place = folder / "trajectories" / run.recording
        true = evo.files.read_tum_trajectory_file(place / "truth.tum")
        estimated = evo.files.read_tum_trajectory_file(place / f"{run.system}_seed-{run.seed}.tum")
        assert true.num_poses == estimated.num_poses == FRAMES
        assert rmse(evo, true, estimated) == pytest.approx(run.metrics.rmse_px, abs=1e-9)
    assert len(runs) == len(HIDDEN) * (len(VARIANTS) * len(SEEDS) - 1)


def test_evo_agrees_on_the_rmse_of_the_recording(evo, exported, runs):
    folder, _ = exported
    for run in runs[:: len(SEEDS)]:
        with Reader(folder / "estimates" / run.recording) as reader:
            true = evo.files.read_bag_trajectory(reader, "/ground_truth/position")
            topic = f"/{topic_name(run.system, run.seed)}/position"
            estimated = evo.files.read_bag_trajectory(reader, topic)
        assert rmse(evo, true, estimated) == pytest.approx(run.metrics.rmse_px, abs=1e-9)


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


def test_videos_have_every_frame_and_the_boxes(exported):
    folder, _ = exported
    video = cv2.VideoCapture(str(folder / "videos" / "free.mp4"))
    frames = []
    while True:
        read, image = video.read()
        if not read:
            break
        frames.append(image)
    assert len(frames) == FRAMES
    assert video.get(cv2.CAP_PROP_FPS) == pytest.approx(25)  # a frame each 40 ms
    image = frames[20]
    assert image.shape[1] == 640 and image.shape[0] % 2 == 0
    assert np.ptp(image[-40:].astype(int)) > 150  # the legend


def test_the_rate_is_that_of_the_median_interval(made_evaluation):
    truth = EvaluationFolder(made_evaluation).truth("free")
    assert frame_rate(truth) == pytest.approx(25)
    assert frame_rate({n: truth[n] for n in (1, 5, 9)}) == pytest.approx(25)
    assert frame_rate({}) == 25


def test_recordings_that_are_gone_are_told(made_evaluation, tmp_path):
    folder = tmp_path / "evaluation"
    shutil.copytree(made_evaluation, folder)
    plan = (folder / "evaluation.json").read_text()
    beside = str(made_evaluation.parent)
    (folder / "evaluation.json").write_text(plan.replace(beside, str(tmp_path / "gone")))
    told = []
    paths = write_report(folder, OPTIONS, told.append).paths
    assert sum("no video of" in sentence for sentence in told) == len(HIDDEN)
    assert sum("with estimates" in sentence for sentence in told) == len(HIDDEN)
    assert (folder / "trajectories" / "free" / "truth.tum") in paths
