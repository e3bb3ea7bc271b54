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

"""Files for others beside the page: figures for a paper, and runs for toolkits."""

import re
import shutil
from dataclasses import astuple, replace

import cv2
import numpy as np
import pytest
from evaluation_samples import FRAMES, HIDDEN, SEEDS, VARIANTS

from vehicle_pf_tracker.cli.main import main
from vehicle_pf_tracker.evaluation.evaluation_folder import EvaluationFolder
from vehicle_pf_tracker.evaluation.report.scored_runs import score_folder
from vehicle_pf_tracker.evaluation.report.writing import write_toolkits
from vehicle_pf_tracker.offline.estimates import EstimateRow

FIGURES = {"success", "precision", "normalised", *(f"errors_{n}" for n in HIDDEN)}
WORDS = ["--figures", "svg,png,pdf,svg", "--write", "otb,vot,mot"]


@pytest.fixture(scope="module")
def written(made_evaluation, tmp_path_factory):
    folder = shutil.copytree(made_evaluation, tmp_path_factory.mktemp("files") / "evaluation")
    assert main(["report", str(folder), *WORDS]) == 0
    return folder


def test_figures_have_the_widths_of_a_paper_and_letters_that_are_embedded(written):
    folder = written / "figures"
    assert {path.stem for path in folder.iterdir()} == FIGURES
    for name in FIGURES:
        width = 7.16 if name.startswith("errors") else 3.5
        pdf, svg = (folder / f"{name}.pdf").read_bytes(), (folder / f"{name}.svg").read_text()
        media = re.search(rb"/MediaBox \[ ?0 0 ([\d.]+) ", pdf)
        size = re.search(r'width="([\d.]+)pt"', svg)
        assert float(media[1]) == float(size[1]) == pytest.approx(72 * width, abs=0.5)
        picture = cv2.imread(str(folder / f"{name}.png"), cv2.IMREAD_GRAYSCALE)
        assert picture.shape[1] == pytest.approx(300 * width, abs=1) and picture.min() < 30
        assert b"/FontFile2" in pdf and b"/Type3" not in pdf and "<text" not in svg


@pytest.mark.slow
def test_the_same_folder_gives_the_same_files(written, evaluation_copy):
    assert main(["report", str(evaluation_copy), *WORDS]) == 0
    files = [p for room in ("figures", "results") for p in (written / room).rglob("*.*")]
    assert len(files) == 3 * len(FIGURES) + 3 * len(HIDDEN) * (len(VARIANTS) * len(SEEDS) - 1)
    for path in files:
        again = evaluation_copy / path.relative_to(written)
        assert again.read_bytes() == path.read_bytes(), path.name


def test_runs_are_written_for_otb_vot_and_mot(written):
    for run in score_folder(EvaluationFolder(written)).runs:
        boxes = np.array([astuple(frame.scored_row.box) for frame in run.frames])
        name, seed, results = run.recording, run.seed, written / "results"
        otb = np.loadtxt(results / "otb" / run.system / f"{name}_{seed}.txt", delimiter=",")
        assert otb == pytest.approx(boxes, abs=5e-4)
        vot = results / "vot" / run.system / "unsupervised" / name / f"{name}_{seed + 1:03d}.txt"
        first, *others = vot.read_text().splitlines()
        assert first == "1" and len(others) == FRAMES - 1
        assert np.loadtxt(others, delimiter=",") == pytest.approx(boxes[1:], abs=5e-4)
        path = results / "mot" / f"{run.system}_seed-{seed}" / "data" / f"{name}.txt"
        mot = np.loadtxt(path, delimiter=",", ndmin=2)
        reported = [frame.row.frame for frame in run.frames if frame.row.mode != "LOST"]
        assert mot[:, 0].tolist() == reported and set(mot[:, 1]) == {1.0}
        assert mot[:, 2:6] == pytest.approx(boxes[np.array(reported) - 1], abs=5e-4)


def test_frames_before_the_start_and_lost_ones_are_marked_or_left_out(written):
    evaluation = score_folder(EvaluationFolder(written))
    run = evaluation.of("free", "ms")[0]
    waiting, lost, last = run.frames[:3]
    frames = [
        replace(waiting, row=EstimateRow.without(1, waiting.row.stamp_ns, "WAITING")),
        replace(lost, row=replace(lost.row, mode="LOST")),
        replace(last, row=replace(last.row, confidence=None)),
    ]
    late = replace(run, seed=9, frames=frames)
    paths = write_toolkits(replace(evaluation, runs=(late,)), ("otb", "vot", "mot"))
    otb, vot, mot = (path.read_text().split() for path in paths)
    assert otb[0] == "nan,nan,nan,nan"
    assert vot == ["0", "1", otb[2]]
    assert mot == [f"3,1,{otb[2]},1.0000,-1,-1,-1"]


def test_an_unknown_format_is_named(tmp_path, capsys):
    assert main(["report", str(tmp_path), "--figures", "pdf,eps"]) == 2
    assert "'eps' is not a format; choose from pdf, png, svg" in capsys.readouterr().err
