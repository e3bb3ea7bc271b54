# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""evo, which reads recordings of runs, agrees with the scorer."""

from pathlib import Path
from types import SimpleNamespace

import pytest
from evaluation_samples import HIDDEN, SEEDS, VARIANTS
from rosbags.rosbag2 import Reader

from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder
from vehicle_pf_tracker.recordings.bags.reader import Recording
from vehicle_pf_tracker.showing.estimates_recording import run_recording


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


def test_evo_agrees_on_the_rmse_of_a_recorded_run(evo, made_evaluation, tmp_path):
    evaluation = score_folder(EvaluationFolder(made_evaluation))
    paths = {entry.name: Path(entry.path) for entry in evaluation.folder.recordings}
    for number, run in enumerate(evaluation.runs):
        rows, _ = evaluation.folder.cell(run.recording, run.system, run.seed)
        source = Recording(paths[run.recording])
        with run_recording(tmp_path / str(number), "node", ["car"], source.truth()) as keep:
            for found, row in zip(source.frames(), rows, strict=True):
                keep(found, {"car": row})
        with Reader(tmp_path / str(number)) as reader:
            true = evo.files.read_bag_trajectory(reader, "/ground_truth/position")
            estimated = evo.files.read_bag_trajectory(reader, "/node/position")
        assert rmse(evo, true, estimated) == pytest.approx(run.metrics.rmse_px, abs=1e-9)
    assert len(evaluation.runs) == len(HIDDEN) * (len(VARIANTS) * len(SEEDS) - 1)
